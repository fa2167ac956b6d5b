"""Margins: by how much a pose is good, positive inside the workspace and zero on its border.

A margin is the smallest of slacks without units, each a share of what it is measured by and at
most one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.capsules import Interference
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.placement import Placement

Array = NDArray[Any]
Indices = NDArray[np.intp]


class JointRange(Protocol):
    """Range of a joint coordinate, m or rad."""

    @property
    def joint(self) -> str:
        """Its joint."""

    @property
    def coordinate(self) -> str:
        """As in `Placement.names`."""

    @property
    def low(self) -> float:
        """Least value."""

    @property
    def high(self) -> float:
        """Largest value."""


@dataclass(frozen=True)
class Margins:
    """Margins of a batch of poses, and the smallest slack of each.

    Parameters
    ----------
    value : (...)
        Positive or zero where a pose is good, at most 1; no unit.
    reason : (...) of int
        Index into `reasons`.
    reasons : tuple of str
        What limits a pose, in words.
    """

    value: Array
    reason: Indices
    reasons: tuple[str, ...]

    def __repr__(self) -> str:
        good = int(np.count_nonzero(self.good))
        return f"<Margins: {self.value.size} poses, {good} good>"

    @property
    def good(self) -> NDArray[np.bool_]:
        """True where the pose is good, (...)."""
        return np.asarray(self.value >= 0.0)


def of_slacks(slacks: Mapping[str, ArrayLike]) -> Margins:
    """The smallest of several slacks, by their names.

    Parameters
    ----------
    slacks : mapping of str to (...)

    Raises
    ------
    ModelError
        No slack, or one that is not a number.
    """
    if not slacks:
        raise ModelError("margin", "has no slack.", "Name what limits the workspace.")
    values = np.stack(np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in slacks.values())))
    if np.isnan(values).any():
        name = list(slacks)[int(np.argwhere(np.isnan(values))[0, 0])]
        raise ModelError(
            "margin", f"{name}: a slack is not a number.", "Mark such poses by a negative one."
        )
    least = values.argmin(axis=0)
    value = np.take_along_axis(values, least[None], axis=0)[0]
    return Margins(np.minimum(value, 1.0), least, tuple(slacks))


def worst(several: Sequence[Margins]) -> Margins:
    """The least of several margins of each pose: all must be good.

    Parameters
    ----------
    several : sequence of Margins
        Of one batch.
    """
    return _chosen(several, np.stack([m.value for m in several]).argmin(axis=0))


def best(several: Sequence[Margins]) -> tuple[Margins, Indices]:
    """The largest of several margins of each pose, one must be good; and which it is, (...).

    Parameters
    ----------
    several : sequence of Margins
        Of one batch.
    """
    chosen = np.stack([m.value for m in several]).argmax(axis=0)
    return _chosen(several, chosen), chosen


def joined(several: Sequence[Margins]) -> Margins:
    """Margins of several batches, one after the other, (p,).

    Parameters
    ----------
    several : sequence of Margins
        Of any batches, which are made flat.
    """
    words, numbers = _together(several)
    return Margins(
        np.concatenate([m.value.ravel() for m in several]),
        np.concatenate([n.ravel() for n in numbers]),
        words,
    )


def placement_slacks(
    placement: Placement,
    ranges: Sequence[JointRange] = (),
    interference: Interference | None = None,
) -> dict[str, Array]:
    """Slacks of placed poses: reach, joint ranges and interference.

    Reach is 1 or −1; a joint coordinate's slack at either end is a share of half its range; that
    of two capsules their gap over the sum of their radii. Where a pose is not reached the other
    slacks are 1.

    Parameters
    ----------
    placement : Placement
        (p) poses.
    ranges : sequence of JointRange
    interference : Interference, optional

    Returns
    -------
    dict of str to (p,)

    Raises
    ------
    ModelError
        A range of a coordinate that the placement does not give.
    """
    status = np.asarray(placement.status)
    slacks: dict[str, Array] = {}
    for k, reason in enumerate(placement.reasons):
        bad = np.where(status == k + 1, -1.0, 1.0)
        slacks[reason] = np.minimum(slacks[reason], bad) if reason in slacks else bad
    if not slacks:
        slacks["reach"] = np.ones(status.shape)
    good = status == 0
    column = {name: i for i, name in enumerate(placement.names)}
    for limit in ranges:
        if (limit.joint, limit.coordinate) not in column:
            raise ModelError(
                f"joint {limit.joint}",
                f'has a range in "{limit.coordinate}", which the placement does not give.',
                "Add the coordinate to the values of the inverse kinematics.",
            )
        value = np.real(placement.values[..., column[limit.joint, limit.coordinate]])
        half = 0.5 * (limit.high - limit.low)
        # an open range has no half: its slack is a length or angle, of a metre or a radian
        unit = half if 0.0 < half < np.inf else 1.0
        for end, slack in (("least", value - limit.low), ("most", limit.high - value)):
            bound = limit.low if end == "least" else limit.high
            # an angle between two axes is never negative: zero is no end of it
            never = end == "least" and bound == 0.0 and limit.coordinate not in DIRECTIONS
            if np.isfinite(bound) and not never:
                slacks[_limit_words(limit, end, bound)] = np.where(good, slack / unit, 1.0)
    if interference is not None and len(interference.pairs):
        gaps = interference.gaps(placement) / interference.reach
        for q in range(gaps.shape[-1]):
            words = f"interference of {interference.words(q)}"
            slacks[words] = np.where(good, gaps[..., q], 1.0)
    return slacks


def _limit_words(limit: JointRange, end: str, bound: float) -> str:
    turns = limit.coordinate not in ("x", "y", "z")
    shown, unit = (degrees(bound), "deg") if turns else (1e3 * bound, "mm")
    return f"{limit.joint}:{limit.coordinate} at its {end}, {shown:.4g} {unit}"


def _together(several: Sequence[Margins]) -> tuple[tuple[str, ...], list[Indices]]:
    """All reasons once, and the numbers of each batch's own among them."""
    words = tuple(dict.fromkeys(word for m in several for word in m.reasons))
    place = {word: i for i, word in enumerate(words)}
    return words, [
        np.array([place[w] for w in m.reasons], dtype=np.intp)[m.reason] for m in several
    ]


def _chosen(several: Sequence[Margins], index: Indices) -> Margins:
    words, numbers = _together(several)
    value = np.stack([m.value for m in several])
    return Margins(
        np.take_along_axis(value, index[None], axis=0)[0],
        np.take_along_axis(np.stack(numbers), index[None], axis=0)[0],
        words,
    )
