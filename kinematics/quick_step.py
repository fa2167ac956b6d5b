"""Newton's method of a walk's step in compiled code: the same rules, many times faster."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.singular_values import compiled

Array = NDArray[Any]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Goals:
    """What is asked of the tool at each of p poses.

    Parameters
    ----------
    asked : tuple of int
        Directions of the tool, all six of a pose.
    target : (p, t) or None
        Its coordinates, m and rad; None where a pose is asked.
    place, turned : (p, 3) and (p, 3, 3), or None
        Its pose: place, m, and rotation matrix.
    """

    asked: tuple[int, ...]
    target: Array | None
    place: Array | None = None
    turned: Array | None = None


@dataclass(frozen=True, eq=False)
class QuickStep:
    """Newton's method of `walk.Walk` for a linkage whose rows are as many as its unknowns.

    Parameters
    ----------
    system : row_kernel.RowSystem
    tool : (3, 3)
        Its rotation matrix at home.
    rules : tuple of float
        As `step_kernel.newton_step` takes them: no unit, lengths over L, rad.
    """

    system: Any
    tool: Array
    rules: tuple[float, ...]

    @classmethod
    def of(
        cls, joints: JointMotion, tool: Array, length: float, rules: tuple[float, ...]
    ) -> QuickStep | None:
        """For a linkage, or None where coordinates follow others or there is no compiler.

        Parameters
        ----------
        joints : JointMotion
            Of the linkage.
        tool : (3, 3)
            Rotation matrix of the tool at home.
        length : float
            L, m, by which lengths are divided.
        rules : tuple of float
            As `step_kernel.newton_step` takes them, no unit.
        """
        if joints.linkage.ties or not compiled():
            return None
        from strutwork.kinematics.row_kernel import row_system  # noqa: PLC0415 - numba is slow to import

        # a frozen dataclass keeps derived data in its __dict__, as functools.cached_property does
        kept = joints.__dict__
        if "_row_system" not in kept:
            kept["_row_system"] = row_system(joints, length)
        return cls(kept["_row_system"], np.ascontiguousarray(tool, dtype=float), rules)

    def newton(
        self, bodies: BodyPoses, rows: Indices, goals: Goals
    ) -> tuple[BodyPoses, NDArray[np.bool_], Array]:
        """Bodies that are moved, where a step holds and what it leaves open, (p,), as in `Walk`.

        Parameters
        ----------
        bodies : BodyPoses
            (p) poses.
        rows : (p, 6 b) of int
            Rows that are solved for: held directions in joint order, then what is asked.
        goals : Goals
        """
        from strutwork.kinematics.step_kernel import (  # noqa: PLC0415 - numba is slow to import
            POSE,
            TASK,
            newton_step,
        )

        count = len(rows)
        moved = BodyPoses(
            np.array(bodies.position, dtype=float, order="C"),
            np.array(bodies.rotation, dtype=float, order="C"),
        )
        good, error = np.zeros(count, dtype=np.bool_), np.full(count, np.inf)
        kind = 0 if not goals.asked else POSE if goals.target is None else TASK
        none = (np.zeros((count, 0)), np.zeros((count, 3)), np.zeros((count, 3, 3)))
        given = (goals.target, goals.place, goals.turned)
        targets = [
            np.ascontiguousarray(b if a is None else a, dtype=float)
            for a, b in zip(given, none, strict=True)
        ]
        newton_step(
            self.system,
            (kind, np.asarray(goals.asked, dtype=np.int64), self.tool, *targets),
            np.ascontiguousarray(rows, dtype=np.int64),
            self.rules,
            moved.position,
            moved.rotation,
            good,
            error,
        )
        return moved, good, error

    def coordinates(self, bodies: BodyPoses, before: Array) -> Array:
        """Joint coordinates, turns counted on from those before, (p, c).

        Parameters
        ----------
        bodies : BodyPoses
            At p poses.
        before : (p, c)
            Joint coordinates from which turns count on, m and rad.
        """
        from strutwork.kinematics.row_kernel import joint_coordinates  # noqa: PLC0415 - as above

        values = np.array(before, dtype=float, order="C")
        joint_coordinates(
            self.system,
            np.ascontiguousarray(bodies.position),
            np.ascontiguousarray(bodies.rotation),
            values,
        )
        return values
