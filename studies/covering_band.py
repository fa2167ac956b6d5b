"""A frequency band wide enough that the modes inside it explain the static compliance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from strutwork.fea import ModalRatio, Port, modal_model
from strutwork.fea.modal import STATIC_SHARE
from strutwork.msa import PlacedStructure
from strutwork.studies.dynamic import MODES

#: How many times as high as it starts out the end of a band may come.
FARTHEST = 10.0

#: The band starts at this part of the first frequency.
BELOW = 20.0

#: The band ends this much above the last mode that it needs.
ROOM = 1.1


@dataclass(frozen=True)
class Band:
    """A band of frequencies.

    Parameters
    ----------
    low, high : float
        Hz.
    short : tuple of (Port, float)
        Ports of which the modes inside carry less of the static compliance than they should, and
        which share, no unit; empty where the band covers all.
    """

    low: float
    high: float
    short: tuple[tuple[Port, float], ...] = ()


def band_of(placed: PlacedStructure, ports: Sequence[Port], count: int = MODES) -> Band | None:
    """A band from well below the first elastic mode to twice the last of `count`, or higher.

    It is extended until the modes inside carry 99 % of each port's static compliance. What motions
    without mass give way has no resonance and is not counted. The band ends at `FARTHEST` times its
    first end at the latest. None where no mode has a frequency.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    ports : sequence of Port
    count : int
        Modes that lie inside at least.

    Raises
    ------
    ModelError
        No mass, or a port that cannot move.
    """
    model = modal_model(placed, ports, ModalRatio(0.0))
    massive = model.square[0] > 0
    natural = 1.0 / np.sqrt(model.square[0][massive]) / (2.0 * np.pi)
    if not len(natural):
        return None
    order = np.argsort(natural)
    natural, compliance = natural[order], (model.residues[0] ** 2)[:, massive][:, order]
    band = (float(natural[0]) / BELOW, 2.0 * float(natural[:count][-1]))
    whole = compliance.sum(axis=1, keepdims=True)
    carried = np.cumsum(compliance, axis=1) / np.where(whole > 0, whole, 1.0)
    needed = [
        float(natural[np.argmax(part >= STATIC_SHARE)])
        for part, all_ in zip(carried, whole[:, 0], strict=True)
        if all_ > 0
    ]
    limit = FARTHEST * band[1]
    end = max([band[1], *(ROOM * f for f in needed)])
    if end <= limit:
        return Band(band[0], end)
    inside = natural <= limit
    short = tuple(
        (port, float(part[inside].max(initial=0.0)))
        for port, part, all_ in zip(ports, carried, whole[:, 0], strict=True)
        if all_ > 0 and part[inside].max(initial=0.0) < STATIC_SHARE
    )
    return Band(band[0], limit, short)
