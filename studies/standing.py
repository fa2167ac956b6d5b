"""Where a machine stands at the poses of a study, and at home."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS, Placement, Poses
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.studies.filters import PoseStatus
from strutwork.studies.pose_sets import PoseList, PoseSet

Array = NDArray[Any]


@dataclass(frozen=True)
class Standing:
    """A machine at p poses, home being the last.

    Parameters
    ----------
    placement : Placement
        At the g poses that count.
    good : (g,)
        Their numbers.
    status : (p,)
        Codes of `PoseStatus`.
    reasons : tuple of p str
        Why a pose does not count; empty where it does.
    """

    placement: Placement
    good: NDArray[np.intp]
    status: NDArray[np.int8]
    reasons: tuple[str, ...]


@dataclass
class Stand:
    """Places machines at the same poses; those whose joints move alike share one placement.

    Parameters
    ----------
    grid : TaskGrid, TaskList, PoseList or None
        None: home alone.
    """

    grid: PoseSet | None
    _kept: tuple[Any, Any, int, Standing] | None = field(default=None, init=False, repr=False)

    def __call__(self, model: Model, of_many: int = 0) -> Standing:
        """The machine at all poses.

        Parameters
        ----------
        model : Model
        of_many : int
            Poses of all machines of the study: how each is placed is the study's.

        Raises
        ------
        ModelError
            A direction in which its tool cannot move.
        """
        kept = self._kept
        if (
            kept is not None
            and kept[0] is model.motion.joints
            and kept[1:3] == (model.limits, of_many)
        ):
            return kept[3]
        made = self._placed(model, of_many)
        if model.closed_form is None:
            # a machine's own formulas may depend on numbers that its joints do not show
            self._kept = (model.motion.joints, model.limits, of_many, made)
        return made

    def __getstate__(self) -> dict[str, Any]:
        return {"grid": self.grid, "_kept": None}

    def _placed(self, model: Model, of_many: int) -> Standing:
        if isinstance(self.grid, PoseList):
            return _standing(_with_home(self.grid, model), len(self.grid.limits(model)))
        motion = model.motion
        axes = {} if self.grid is None else self.grid.task()
        names = tuple(axes) or tuple(motion.rest())
        if not names:
            # nothing moves
            one = model.placement[None]
            return Standing(one, np.zeros(1, dtype=np.intp), np.zeros(1, dtype=np.int8), ("",))
        home = dict(zip(DIRECTIONS, motion.task_of(motion.home_pose), strict=True))
        task = {d: np.append(axes.get(d, np.empty(0)), home[d]) for d in names}
        _, placement = moved(model, task, of_many=of_many)
        return _standing(placement, len(model.limits))


def _with_home(poses: PoseList, model: Model) -> Placement:
    home = model.motion.home_pose
    whole = Poses(
        np.concatenate([poses.poses.position, home.position.reshape(1, 3)]),
        np.concatenate([poses.poses.rotation, home.rotation.reshape(1, 3, 3)]),
    )
    return replace(poses, poses=whole).placement(model)


def _standing(placement: Placement, limits: int) -> Standing:
    """A placement whose last reasons are those of joint ranges."""
    ranged = np.asarray(placement.status) > len(placement.reasons) - limits
    status = np.where(
        placement.reachable,
        PoseStatus.GOOD,
        np.where(ranged, PoseStatus.JOINT_RANGE, PoseStatus.UNREACHABLE),
    ).astype(np.int8)
    good = np.flatnonzero(placement.reachable)
    words = tuple(placement.reason(i) for i in range(len(status)))
    return Standing(placement[good], good, status, words)
