"""Inverse kinematics, joint ranges and the distance from singularities of many poses at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.jacobians import jacobians
from strutwork.kinematics.limits import Limit, check_limits, joint_limits
from strutwork.kinematics.mechanism import Mechanism, Poses
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import characteristic_length

Array = NDArray[Any]

#: Poses that are placed at once: what they take of memory stays near the processor.
PIECE = 2048


@dataclass(frozen=True)
class InverseSurvey:
    """Drive coordinates and margins at poses, without the positions of the bodies.

    Parameters
    ----------
    status : (...) of int
        0 where the pose is good, else 1 + index into `reasons`.
    reasons : tuple of str
        Why a pose is not good: a leg cannot take it, or a joint is out of its range.
    taken : (...) of bool
        Where the legs can take the pose, whatever their joints' ranges.
    values : (..., m)
        Joint coordinates, m or rad, in the order of `names`; zero where no leg takes the pose.
    names : tuple of (joint, direction)
    margin : (...)
        Distance from the next singularity, no unit: 0 at it and where no leg takes the pose, 1 at
        most (`Jacobians.margin`).
    length : float
        What counts as much as one radian in `margin`, m.
    """

    status: NDArray[np.int16]
    reasons: tuple[str, ...]
    taken: NDArray[np.bool_]
    values: Array
    names: tuple[tuple[str, str], ...]
    margin: Array
    length: float

    def __repr__(self) -> str:
        good = int(np.count_nonzero(self.reachable))
        return f"<InverseSurvey: {self.status.size} poses, {good} good>"

    @property
    def reachable(self) -> NDArray[np.bool_]:
        """True where the pose is good, (...)."""
        return np.asarray(self.status == 0)

    def reason(self, index: int | tuple[int, ...]) -> str:
        """Why the pose at `index` is not good; empty where it is.

        Parameters
        ----------
        index : int or tuple of int
            Of a pose in the batch; () for a single one.
        """
        code = int(self.status[index])
        return self.reasons[code - 1] if code else ""


def inverse_survey(
    mechanism: Motion | Mechanism,
    poses: Poses,
    limits: Iterable[Limit] | None = None,
    length: float | None = None,
    coordinates: Sequence[tuple[str, str]] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> InverseSurvey:
    """Whether and how poses of the tool can be taken, and how far they are from a singularity.

    Poses go through in pieces, so that a million of them take little more memory than they
    themselves and the result.

    Parameters
    ----------
    mechanism : Motion or Mechanism
        A motion walks to each pose from its home; a mechanism has its own formulas.
    poses : Poses
        (...)
    limits : iterable of Limit, optional
        Joint ranges. Default: those that the joints state themselves.
    length : float, optional
        How much translation, m, counts as much as one radian in the margin. Default: the
        machine's size at home (`characteristic_length`).
    coordinates : sequence of (joint, direction), optional
        What `values` holds. Default: the driven directions.
    progress : callable, optional
        Called with the number of poses done and that of all.

    Returns
    -------
    InverseSurvey

    Raises
    ------
    ModelError
        A range or coordinate that the mechanism does not give, a length that is not positive,
        no tool or no drive.
    """
    linkage = mechanism.linkage
    home = mechanism.home if isinstance(mechanism, Motion) else mechanism.place(mechanism.home())
    size = characteristic_length(home) if length is None else float(length)
    if not (np.isfinite(size) and size > 0.0):
        raise ModelError(
            "survey", f"has the length {size:g} m.", "Give a length that is greater than zero."
        )
    ranges = joint_limits(linkage) if limits is None else tuple(limits)
    names = tuple(linkage.driven if coordinates is None else coordinates)
    count = int(np.prod(poses.batch, dtype=int))
    place, turn = poses.position.reshape(count, 3), poses.rotation.reshape(count, 3, 3)
    found = _Found(count, names)
    for first in range(0, count, PIECE):
        piece = slice(first, min(first + PIECE, count))
        placement = mechanism.place(Poses(place[piece], turn[piece]))
        found.take(piece, placement, check_limits(ranges, placement))
        good = placement.reachable
        if good.any():
            some = placement if good.all() else placement[good]
            found.margin[piece][good] = jacobians(linkage, some).margin(size)
        if progress is not None:
            progress(piece.stop, count)
    return found.survey(poses.batch, size)


class _Found:
    """Results of the pieces so far."""

    def __init__(self, count: int, names: tuple[tuple[str, str], ...]) -> None:
        self.status = np.zeros(count, dtype=np.int16)
        self.taken = np.zeros(count, dtype=bool)
        self.margin, self.values = np.zeros(count), np.zeros((count, len(names)))
        self.names = names
        self.reasons: list[str] = []

    def take(self, piece: slice, placement: Placement, checked: Placement) -> None:
        """Results of the poses of one piece, before and after the look at joint ranges."""
        good = placement.reachable
        known = {name: i for i, name in enumerate(placement.names)}
        for name in self.names:
            if name not in known:
                raise ModelError(
                    f"joint {name[0]}",
                    f'has no coordinate "{name[1]}" in this mechanism.',
                    "Ask for one of its free directions.",
                )
        self.taken[piece] = good
        columns = [known[name] for name in self.names]
        self.values[piece][good] = placement.values[good][:, columns]
        status = np.asarray(checked.status)
        for code in np.unique(status[status > 0]):
            reason = checked.reasons[int(code) - 1]
            if reason not in self.reasons:
                self.reasons.append(reason)
            # pieces number their reasons each in an order of their own
            self.status[piece][status == code] = self.reasons.index(reason) + 1

    def survey(self, batch: tuple[int, ...], length: float) -> InverseSurvey:
        """All together, with the batch axes."""
        return InverseSurvey(
            self.status.reshape(batch),
            tuple(self.reasons),
            self.taken.reshape(batch),
            self.values.reshape(*batch, len(self.names)),
            self.names,
            self.margin.reshape(batch),
            length,
        )
