"""Poses followed from the nearest one already reached, so that no straight way need be free."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.given import Given, given
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.joint_motion import BodyPoses
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.singular_values import compiled
from strutwork.kinematics.walk import Walk

Array = NDArray[Any]
Indices = NDArray[np.intp]

#: Poses that are walked to at once.
PIECE = 1024
#: How often a pose is tried, each time from another one.
TRIES = 2
#: A pose is kept to start from where no other is within this share of a step.
APART = 0.3

FAR = "out of reach: no pose near it is reached from home"


@dataclass(eq=False)
class Follower:
    """Task coordinates of a tool, each followed from the nearest pose that was reached before.

    What it has reached it keeps, so that a workspace round a hole is reached round the hole. It
    stays in the assembly mode of the home, as `Motion` does.

    Parameters
    ----------
    motion : Motion
    directions : sequence of str
        Task coordinates that vary; the others of `fixed` stay.
    fixed : mapping of direction to float
        m and rad.
    step : (d,)
        How far a next pose may lie, m and rad.
    told : callable, optional
        Called with how many poses have been walked to, and of how many.
    """

    motion: Motion
    directions: Sequence[str]
    fixed: Mapping[str, float]
    step: Array
    told: Callable[[int, int], None] | None = None
    points: Array = field(init=False)
    bodies: BodyPoses = field(init=False)
    coordinates: Array = field(init=False)
    _tree: Any = field(default=None, init=False, repr=False)
    _like: Walk | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        home = self.motion.task_of(self.motion.home_pose)
        self.points = np.array([[home[DIRECTIONS.index(d)] for d in self.directions]])
        self.bodies = self.motion.joints.start(1)
        self.coordinates = np.zeros((1, len(self.motion.joints.names)))

    @property
    def quick(self) -> bool:
        """Whether it has walked by compiled steps."""
        return self._like is not None and self._like.quick is not None

    def place(self, points: Array) -> Placement:
        """Placements of poses, (p,), those not reached marked.

        Parameters
        ----------
        points : (p, d)
            Of `directions`, m and rad.
        """
        # imported late, as SciPy's spatial part is where it is not needed
        from scipy.spatial import cKDTree  # noqa: PLC0415

        count = len(points)
        joints = self.motion.joints
        bodies, coordinates = joints.start(count), np.zeros((count, len(joints.names)))
        status, reasons = np.ones(count, dtype=np.int8), [FAR]
        tried, last = np.zeros(count, dtype=np.intp), np.full(count, -1)
        while True:
            if self._tree is None:
                self._tree = cKDTree(self.points / self.step)
            distance, start = self._tree.query(points / self.step)
            # a corner of the next cell is within reach, from what stands for the near one
            near = distance <= 1.01 * (np.sqrt(len(self.step)) + APART)
            turn = np.flatnonzero((status != 0) & near & (start != last) & (tried < TRIES))
            if not turn.size:
                break
            tried[turn] += 1
            last[turn] = start[turn]
            for first in range(0, turn.size, PIECE):
                some = turn[first : first + PIECE]
                walk = self._walk(points[some], start[some])
                bodies.position[some] = walk.bodies.position
                bodies.rotation[some] = walk.bodies.rotation
                coordinates[some] = walk.coordinates
                number = [_number(reasons, text) for text in walk.reasons]
                status[some] = np.array([0, *number], dtype=np.int8)[walk.status]
                if self.told is not None:
                    self.told(int(np.count_nonzero(tried)), count)
            got = turn[status[turn] == 0]
            self._keep(points[got], bodies[got], coordinates[got], distance[got])
        return self._placement(bodies, coordinates, status, tuple(reasons))

    def _walk(self, points: Array, start: Indices) -> Walk:
        motion = self.motion
        task: dict[str, Any] = {d: points[:, k] for k, d in enumerate(self.directions)}
        names = [*self.directions, *self.fixed]
        wanted = given(
            motion.joints, motion.home_pose, motion.home_values, None, task | {**self.fixed}, None
        )
        still = np.tile([*self.fixed.values()], (len(start), 1))
        begin = np.concatenate([self.points[start], still], axis=1)
        order = [names.index(DIRECTIONS[k]) for k in wanted.task]
        walk = _Onward(
            motion,
            wanted,
            self.bodies[start],
            self.coordinates[start],
            begin[:, order],
            self._like,
        )
        self._like = self._like or walk
        walk.go(np.arange(len(points)))
        return walk

    def _keep(self, points: Array, bodies: BodyPoses, coordinates: Array, far: Array) -> None:
        new = far > APART
        if not new.any():
            return
        self._tree = None
        self.points = np.concatenate([self.points, points[new]])
        self.bodies = BodyPoses(
            np.concatenate([self.bodies.position, bodies.position[new]]),
            np.concatenate([self.bodies.rotation, bodies.rotation[new]]),
        )
        self.coordinates = np.concatenate([self.coordinates, coordinates[new]])

    def _placement(
        self, bodies: BodyPoses, coordinates: Array, status: Array, reasons: tuple[str, ...]
    ) -> Placement:
        motion = self.motion
        if compiled():
            positions, frames = motion.joints.place_compiled(bodies)
        else:
            positions, frames, _ = motion.joints.place(bodies)
        home = motion.home.turns
        turns = bodies.rotation if home is None else bodies.rotation @ home
        values = coordinates + motion.home_values
        return Placement(positions, frames, values, motion.joints.names, status, reasons, turns)


class _Onward(Walk):
    """A walk whose poses start where others have arrived."""

    # of a way that is a cell long
    shortest = 1e-4
    few = 1

    def __init__(
        self,
        motion: Motion,
        wanted: Given,
        bodies: BodyPoses,
        coordinates: Array,
        begin: Array,
        like: Walk | None,
    ) -> None:
        # the base looks at its rows at once
        self.begin = begin
        super().__init__(motion.joints, motion.rotation, wanted, like=like)
        self.bodies = BodyPoses(bodies.position.copy(), bodies.rotation.copy())
        self.coordinates = coordinates.copy()

    def _begin(self, at: Indices) -> Array:
        return np.asarray(self.begin[at])


def _number(reasons: list[str], text: str) -> int:
    if text not in reasons:
        reasons.append(text)
    return reasons.index(text) + 1
