"""Inverse kinematics leg by leg: the way of `walk.Walk` where the tool's pose fixes each leg."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.given import Given
from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.leg_system import LegSystem
from strutwork.kinematics.turns import rotation_vector
from strutwork.kinematics.walk import (
    CLOSED,
    CORRECTIONS,
    FARTHEST,
    MOST,
    ROUNDING,
    SHORTEST,
    SHRINK,
)
from strutwork.names import listed

Array = NDArray[Any]

#: Correction after which a closed leg is believed: the next is its square.
BELIEVED = 1e-6
#: The same for points on the way, and the gap that they may keep.
ROUGHLY, ROUGH = 1e-2, 1e-6

ENDS = (
    "out of reach: on the path the leg of {} reaches the end of its working mode",
    "the path of the leg of {} was not followed to its end within the steps allowed",
)


class LegWalk:
    """Poses of the tool on their way from home, all legs by themselves.

    The same way and the same rules as `walk.Walk`, so that the same working mode is met; the
    sign of each leg's determinant is kept. What the way ended at names the joints of the leg.

    Parameters
    ----------
    joints : JointMotion
        Of the linkage.
    rotation : (3, 3)
        Rotation matrix of the tool at home.
    wanted : Given
        Poses of the tool.
    system : LegSystem
        The legs of the linkage.
    """

    def __init__(
        self, joints: JointMotion, rotation: Array, wanted: Given, system: LegSystem
    ) -> None:
        self.joints, self.given, self.rotation, self.system = joints, wanted, rotation, system
        count, bodies = wanted.poses, len(system.reference)
        self.bodies = BodyPoses(np.zeros((count, bodies, 3)), np.zeros((count, bodies, 3, 3)))
        self.coordinates = np.zeros((count, len(joints.names)))
        self.share, self.error = np.zeros(count), np.zeros(count)
        self.steps = np.zeros(count, dtype=np.int64)
        self.status = np.zeros(count, dtype=np.int8)
        self.reasons: list[str] = []

    def go(self, poses: NDArray[np.intp]) -> None:
        """Walk some poses until each has arrived or its way has ended.

        Parameters
        ----------
        poses : (k,) of int
            Indices of the targets.
        """
        from strutwork.kinematics.leg_newton import (  # noqa: PLC0415 - numba is slow to import
            home_signs,
            walk_legs,
            workspace,
        )

        given, system = self.given, self.system
        assert given.tool is not None  # noqa: S101 - legs are walked only for poses
        assert given.start is not None  # noqa: S101
        work = workspace(system)
        start = np.ascontiguousarray(given.start.position, dtype=float)
        signs = np.zeros(len(system.legs))
        home_signs(system, signs, work[0], work[2])
        turn = np.ascontiguousarray(given.tool.rotation[poses] @ self.rotation.T)
        place = np.ascontiguousarray(given.tool.position[poses], dtype=float)
        count = len(poses)
        position = np.empty((count, len(system.reference), 3))
        rotation = np.empty((count, len(system.reference), 3, 3))
        coordinates = np.zeros((count, len(self.joints.names)))
        share, gap = np.zeros(count), np.zeros(count)
        steps, ended, which = (np.zeros(count, dtype=np.int64) for _ in range(3))
        walk_legs(
            system,
            start,
            (place, np.ascontiguousarray(rotation_vector(turn)), turn),
            signs,
            (
                (SHRINK, FARTHEST, CLOSED, ROUNDING, BELIEVED, CORRECTIONS),
                (SHRINK, FARTHEST, ROUGH, ROUNDING, ROUGHLY, CORRECTIONS),
                SHORTEST,
                MOST,
            ),
            work,
            (position, rotation, coordinates, share, gap, steps, ended, which),
        )
        self.bodies.position[poses], self.bodies.rotation[poses] = position, rotation
        self.coordinates[poses], self.share[poses] = coordinates, share
        self.error[poses], self.steps[poses] = system.length * gap, steps
        for kind, leg in sorted(set(zip(ended[ended > 0], which[ended > 0], strict=True))):
            self._end(poses[(ended == kind) & (which == leg)], int(kind), int(leg))

    def placed(self) -> tuple[Array, Array]:
        """Node positions and joint frames, (p, n, 3) and (p, j, 3, 3)."""
        return self.joints.place_compiled(self.bodies)

    def _end(self, at: NDArray[np.intp], kind: int, leg: int) -> None:
        system = self.system
        steps = system.steps[system.legs["start"][leg] : system.legs["stop"][leg]]
        names = [self.joints.linkage.joints[j].name for j in steps["joint"]]
        reason = ENDS[kind - 1].format(listed(names))
        if reason not in self.reasons:
            self.reasons.append(reason)
        self.status[at] = self.reasons.index(reason) + 1
