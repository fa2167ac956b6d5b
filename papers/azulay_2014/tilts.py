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
Mask = NDArray[np.bool_]

#: Steps of tilt to 180°, half a degree each, and of roll over a third of a turn: another third puts
#: each leg in the place of the next.
TILTS, ROLLS = 361, 48


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


@dataclass(frozen=True)
class TiltPlane:
    """Poses over tilt and roll, (tilts, rolls).

    Parameters
    ----------
    tilt, roll : (t,) and (r,)
        rad; the roll over a third of a turn, its ends the same pose.
    reached : bool
        The legs reach.
    inside : bool
        Within the machine's own joint ranges as well.
    connected : bool
        By poses within the ranges from the pole.
    before_the_ring : bool
        The same without a singular pose between.
    """

    tilt: Array
    roll: Array
    reached: Mask
    inside: Mask
    connected: Mask
    before_the_ring: Mask

    def __repr__(self) -> str:
        return f"<TiltPlane: {int(self.inside.sum())} of {self.inside.size} poses within ranges>"

    @property
    def largest(self) -> Tilts:
        """Largest tilts with some roll; zero where not even the pole counts."""
        return Tilts(
            _farthest(self.tilt, self.inside),
            _farthest(self.tilt, self.connected),
            _farthest(self.tilt, self.before_the_ring),
        )


def tilt_plane(machine: ThreeLegs, radius: float = RADIUS) -> TiltPlane:
    """What a machine reaches on a hemisphere, with its own joint ranges.

    Bodies are not looked at, so that no tilt of these is the paper's.

    Parameters
    ----------
    machine : ThreeLegs
    radius : float
        m.
    """
    tilt = np.linspace(0.0, np.pi, TILTS)
    roll = np.arange(ROLLS) * (2.0 * np.pi / 3.0 / ROLLS)
    poses = tilted(machine, tilt[:, None], roll, radius)
    placement = machine.place(poses)
    inside = check_limits(machine.limits, placement).reachable
    s = signed(machine, poses)
    same = inside & (np.sign(s) == np.sign(s[0, 0]))
    return TiltPlane(
        tilt, roll, placement.reachable, inside, _from_the_pole(inside), _from_the_pole(same)
    )


def tilts(machine: ThreeLegs, radius: float = RADIUS) -> Tilts:
    """Largest tilts of a machine, as `tilt_plane`."""
    return tilt_plane(machine, radius).largest


def _from_the_pole(mask: Mask) -> Mask:
    """What hangs together with the first row; the roll comes back to its start."""
    parts, _ = label(np.concatenate([mask, mask], axis=1))
    start = np.unique(parts[0])
    found = np.isin(parts, start[start > 0])
    return np.asarray(found[:, : mask.shape[1]] | found[:, mask.shape[1] :])


def _farthest(tilt: Array, good: Mask) -> float:
    return float(tilt[np.any(good, axis=1)].max(initial=0.0))
