"""How far the platform tilts within joint ranges, and which singular poses lie along the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label

from strutwork.machines import ThreeLegs, check_limits
from strutwork.papers.azulay_2014.barrier import RADIUS, signed, tilted

Array = NDArray[Any]

#: Steps of tilt to 180°, half a degree each, and of roll over a whole turn.
TILTS, ROLLS = 361, 144


@dataclass(frozen=True)
class Tilts:
    """Largest tilts from the pole, rad.

    Parameters
    ----------
    reached : float
        With some roll, joint ranges kept, however the machine came there.
    connected : float
        The same by poses within the ranges that lead there from the pole.
    before_the_ring : float
        The same without a singular pose between: what six drives do.
    """

    reached: float
    connected: float
    before_the_ring: float


def tilts(machine: ThreeLegs, radius: float = RADIUS) -> Tilts:
    """Largest tilts of a machine on a hemisphere, with its own joint ranges.

    Bodies are not looked at, so that none of these is the paper's tilt angle.

    Parameters
    ----------
    machine : ThreeLegs
    radius : float
        m.

    Returns
    -------
    Tilts
        Zero where not even the pole counts.
    """
    tilt = np.linspace(0.0, np.pi, TILTS)
    roll = np.arange(ROLLS) * (2.0 * np.pi / ROLLS)
    poses = tilted(machine, tilt[:, None], roll, radius)
    inside = check_limits(machine.limits, machine.place(poses)).reachable
    s = signed(machine, poses)
    same = inside & (np.sign(s) == np.sign(s[0, 0]))
    return Tilts(
        _farthest(tilt, inside),
        _farthest(tilt, _from_the_pole(inside)),
        _farthest(tilt, _from_the_pole(same)),
    )


def _from_the_pole(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What hangs together with the first row; the roll is a circle."""
    parts, _ = label(np.concatenate([mask, mask], axis=1))
    start = np.unique(parts[0])
    found = np.isin(parts, start[start > 0])
    return np.asarray(found[:, : mask.shape[1]] | found[:, mask.shape[1] :])


def _farthest(tilt: Array, good: NDArray[np.bool_]) -> float:
    return float(tilt[np.any(good, axis=1)].max(initial=0.0))
