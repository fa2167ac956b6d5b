"""Where the reach ends between a pose that is reached and one that is not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.pose_family import PoseFamily, TaskSection, joined
from strutwork.kinematics.turning_way import TurningWay

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Halvings of the way between a pose that is reached and one that is not, before the end is
#: looked for along the way of all bodies, and where it is not found there.
HALVINGS, ALL = 4, 50
#: The motion itself tells what is reached no better than this many halvings.
OWN = 18
#: The end lies within the last halving's gap, but for this share of it.
SLACK = 0.05


@dataclass(frozen=True)
class ReachEnds:
    """Ends of reach.

    Parameters
    ----------
    parameters : (e, k)
        m or rad.
    placement : Placement
        There, or at the last pose that was reached.
    turned : (e,) of bool
        Whether the coordinates turn back there; else the end is known to the last halving.
    beyond : (e, k)
        Next to it, not reached, m or rad.
    reasons : tuple of str
        Why.
    """

    parameters: Array
    placement: Placement
    turned: Mask
    beyond: Array
    reasons: tuple[str, ...]


def reach_ends(
    family: PoseFamily, inside: Array, outside: Array, reasons: Sequence[str]
) -> ReachEnds:
    """Ends of reach between poses that are reached and others.

    Parameters
    ----------
    family : PoseFamily
    inside, outside : (e, k)
        Parameters of poses that are reached and of others, in the family's units.
    reasons : sequence of str
        Why those outside are not reached.
    """
    section = family.section
    own = section is not None and family.place == section.place
    low, high, why = inside.copy(), outside.copy(), np.array(reasons, dtype=object)
    turned = np.zeros(len(low), dtype=bool)
    exact = low.copy()
    placements: list[tuple[NDArray[np.intp], Placement]] = []
    # what is not reached costs most: first from where the net stands, then from nearer
    for times in (0, HALVINGS) if section is not None else ():
        rest = np.flatnonzero(~turned)
        if not rest.size or section is None:
            break
        low[rest], high[rest], why[rest] = _halved(family, low[rest], high[rest], times, why[rest])
        # what a range alone forbids is no end of the way
        ends = np.ones(len(rest), dtype=bool)
        if not own:
            ends = ~section.place(high[rest]).reachable
        found, placed, good = _turned(
            section, low[rest], high[rest], (outside - inside)[rest], ends
        )
        exact[rest] = found
        turned[rest] = good
        if placed is not None:
            placements.append((rest[good], placed))
    rest = np.flatnonzero(~turned)
    if rest.size:
        times = (OWN if own else ALL) - (HALVINGS if section is not None else 0)
        low[rest], high[rest], why[rest] = _halved(family, low[rest], high[rest], times, why[rest])
    placement = family.place(low)
    low[turned] = exact[turned]
    for at, placed in placements:
        placement = _with(placement, at, placed)
    return ReachEnds(low, placement, turned, high, tuple(why))


def _halved(
    family: PoseFamily, low: Array, high: Array, times: int, reasons: NDArray[np.object_]
) -> tuple[Array, Array, NDArray[np.object_]]:
    """The same edges, shorter, and why their ends are not reached."""
    reasons = reasons.copy()
    for _ in range(times):
        middle = 0.5 * (low + high)
        placed = family.place(middle)
        good = placed.reachable[:, None]
        low, high = np.where(good, middle, low), np.where(good, high, middle)
        for i in np.flatnonzero(~placed.reachable):
            reasons[i] = placed.reason(int(i))
    return low, high, reasons


def _turned(
    section: TaskSection, low: Array, high: Array, edge: Array, ends: Mask
) -> tuple[Array, Placement | None, Mask]:
    """Ends along the way of all bodies, where they are such: (e, k), those found, (e,)."""
    turned = np.zeros(len(low), dtype=bool)
    start = section.place(low)
    at = np.flatnonzero(ends & start.reachable)
    if not at.size:
        return low, None, turned
    columns = {name: edge[at, k] for k, name in enumerate(section.names)}
    none = np.zeros(len(at))
    wanted = [columns.get(DIRECTIONS[d], none) for d in section.directions]
    way = TurningWay(section.motion, section.directions, np.stack(wanted, axis=1))
    gap = np.linalg.norm((high - low)[at], axis=1) / np.linalg.norm(edge[at], axis=1)
    found = way.turns(start[at], gap)
    good = found.found & (found.share >= 0.0) & (found.share <= (1.0 + SLACK) * gap)
    result = low.copy()
    result[at[good]] += found.share[good, None] * edge[at[good]]
    turned[at[good]] = True
    return result, found.placement[good], turned


def _with(placement: Placement, at: NDArray[np.intp], found: Placement) -> Placement:
    """A placement with other poses at some indices; joint coordinates are not carried."""
    order = np.arange(len(placement.positions))
    order[at] = len(order) + np.arange(len(at))
    bare = [
        replace(p, values=np.zeros((len(p.positions), 0)), names=(), turns=None)
        for p in (placement, found)
    ]
    return joined(bare)[order]
