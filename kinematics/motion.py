"""Motion of a linkage from its joints alone: where its bodies stand for poses, tasks or drives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.given import Given, given
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.leg_system import LegSystem, leg_system
from strutwork.kinematics.leg_walk import LegWalk
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.mechanism import Poses
from strutwork.kinematics.placement import Placement, check_coincidence
from strutwork.kinematics.rows import characteristic_length
from strutwork.kinematics.turns import rotation_vector
from strutwork.kinematics.walk import Walk
from strutwork.kinematics.walk_rows import WalkRows

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Targets that are followed at once.
PIECE = 1024


@dataclass(frozen=True)
class Moved:
    """Configurations that a linkage was moved to.

    Parameters
    ----------
    placement : Placement
        Its values are the coordinates of all joints, turns counted on along the way; its status
        and reasons say which poses were not reached. Those stand where the way ended.
    tool : Poses or None
        Of the tool: where the way ended, for poses that were not reached. None without a tool.
    share : (...)
        Share of the way that was gone, 1 where the pose was reached.
    error : (...)
        Largest gap that is left in a joint or in what was given, m, turns at the characteristic
        length.
    steps : (...) of int
        Steps made.
    bodies : BodyPoses
        Of the moving bodies, (..., b, 3) and (..., b, 3, 3).
    walk : Walk or None
        The way, for what begins beside it; kept of a few poses.
    """

    placement: Placement
    tool: Poses | None
    share: Array
    error: Array
    steps: NDArray[np.intp]
    bodies: BodyPoses
    walk: Walk | None = field(default=None, repr=False, compare=False)

    def __repr__(self) -> str:
        found = self.placement.reachable
        return f"<Moved: {found.size} poses, {int(np.count_nonzero(found))} reached>"

    @property
    def reached(self) -> Mask:
        """True where the pose was reached, (...)."""
        return self.placement.reachable

    def coordinate(self, joint: str, direction: str) -> Array:
        """Coordinate of a joint, m or rad, (...).

        Parameters
        ----------
        joint : str
            Its name.
        direction : str
            One of its directions that move.
        """
        return np.asarray(
            self.placement.values[..., self.placement.names.index((joint, direction))]
        )


@dataclass(frozen=True)
class Motion:
    """Motion of a linkage of rigid bodies that keeps the locked joint directions closed.

    Parameters
    ----------
    linkage : Linkage
        Elastic directions are held, driven ones are free.
    home : Placement
        Where all motion starts, one pose without batch axes. Joint coordinates that it names
        keep their values there; all others are zero at home.
    rotation : (3, 3)
        Rotation matrix of the tool at home.

    Raises
    ------
    ModelError
        The joints do not close at home (names the joint and its gap), or a node slides in one
        joint and belongs to another.
    """

    linkage: Linkage
    home: Placement
    rotation: Array = field(default_factory=lambda: np.eye(3))

    def __post_init__(self) -> None:
        check_coincidence(self.linkage, self.home)
        _ = self.joints.nodes

    @cached_property
    def joints(self) -> JointMotion:
        """Finite motion of the joints."""
        return JointMotion(self.linkage, self.home)

    @cached_property
    def length(self) -> float:
        """The machine's size, m, at which turns are compared with shifts."""
        return characteristic_length(self.home)

    @cached_property
    def home_values(self) -> Array:
        """Coordinates at home in the order of `joints.names`, m or rad, (c,)."""
        known = dict(zip(self.home.names, np.ravel(self.home.values), strict=False))
        return np.array([float(known.get(name, 0.0)) for name in self.joints.names])

    @cached_property
    def legs(self) -> LegSystem | None:
        """The legs, where the tool's pose fixes each by itself: poses are then found leg by leg."""
        return leg_system(self.joints)

    def with_joints_of(self, linkage: Linkage) -> Motion:
        """The same motion for a linkage whose joints differ in stiffness, damping or limits alone.

        What was derived stays: none of it depends on them.

        Parameters
        ----------
        linkage : Linkage
            Of the same bodies, joints and free, locked and elastic directions.
        """
        if linkage is self.linkage:
            return self
        made = copy(self)
        object.__setattr__(made, "linkage", linkage)
        return made

    @property
    def home_pose(self) -> Poses:
        """The tool at home.

        Raises
        ------
        ModelError
            The linkage has no tool.
        """
        _ = self.linkage.tool_body
        tool = self.linkage.node_index[self.linkage.tool or ""]
        return Poses(self.home.positions[tool], self.rotation)

    def move(
        self,
        tool: Poses | None = None,
        task: Mapping[str, ArrayLike] | None = None,
        joints: Mapping[tuple[str, str], ArrayLike] | None = None,
        beside: Moved | None = None,
        of_many: int = 0,
    ) -> Moved:
        """Move from home to a batch of targets, all at once.

        What is given goes from its value at home to its target: places and coordinates straight,
        a rotation about one axis. Where more can move than is given, the bodies move least
        (in the sum of squares of their twists, turns at the characteristic length) from step to
        step. Each step is Newton's method from the one before and counts only where its
        corrections shrink at once (Deuflhard 2011, section 5.1), so that the assembly mode stays;
        otherwise it is halved.

        Parameters
        ----------
        tool : Poses, optional
            Poses of the tool. Directions in which it cannot move from home are not moved and
            must agree.
        task : mapping of direction to (...), optional
            Some coordinates of the tool: x, y, z of the tool centre point, m, and rx, ry, rz,
            components of its rotation vector from home, rad.
        joints : mapping of (joint, direction) to (...), optional
            Joint coordinates, m or rad, driven or not. Where more are given than freedoms, they
            must agree.
        beside : Moved, optional
            Where a machine that hardly differs from this one was moved by the same targets, one
            batch axis: the way begins there. Legs that are found one by one do without.
        of_many : int
            Targets of the study of which these are a part: from as many as pay for compiled steps
            on, these are made so, however few they are.

        Returns
        -------
        Moved
            Poses that were not reached are marked with a reason.

        Raises
        ------
        ModelError
            Nothing is given, both `tool` and `task` are, a joint or direction that does not
            exist or cannot move at home, or values that are not finite.
        """
        start = self.home_pose if tool is not None or task else None
        wanted = given(self.joints, start, self.home_values, tool, task, joints)
        walk: Walk | LegWalk
        if tool is not None and not joints and self.legs is not None:
            walk = LegWalk(self.joints, self.rotation, wanted, self.legs)
        else:
            like = None if beside is None else beside.walk
            walk = Walk(self.joints, self.rotation, wanted, like=like, of_many=of_many)
            if beside is not None:
                found = beside.bodies
                walk.bodies = BodyPoses(found.position.copy(), found.rotation.copy())
                walk.coordinates = beside.placement.values - self.home_values
        # rows of one piece at a time: those of a million targets would take tens of gigabytes
        for first in range(0, wanted.poses, PIECE):
            walk.go(np.arange(first, min(first + PIECE, wanted.poses)))
        return self._moved(walk, wanted)

    def task_of(self, poses: Poses) -> Array:
        """Task coordinates of poses: place, m, and rotation vector from home, rad, (..., 6).

        Parameters
        ----------
        poses : Poses
            (...); of the tool.
        """
        turned = poses.rotation @ self.rotation.T
        return np.concatenate([poses.position, rotation_vector(turned)], axis=-1)

    def rest(
        self, named: tuple[str, ...] = (), joints: tuple[tuple[str, str], ...] = ()
    ) -> dict[str, float]:
        """Other directions of the tool that can be held while some coordinates move.

        Parameters
        ----------
        named : tuple of directions
            Of the tool, that are given.
        joints : tuple of (joint, direction)
            Joint coordinates that are given.

        Returns
        -------
        dict of direction to float
            Those that are independent of what is given at home, x first, with their values there,
            m and rad.
        """
        start = self.home_pose
        others = [d for d in DIRECTIONS if d not in named]
        if not others:
            return {}
        task: dict[str, ArrayLike] = dict.fromkeys((*named, *DIRECTIONS), 0.0)
        asked: dict[tuple[str, str], ArrayLike] = dict.fromkeys(joints, 0.0)
        wanted = given(self.joints, start, self.home_values, None, task, asked)
        rows = WalkRows(self.joints, self.rotation, wanted, lenient=True)
        tool = {d: len(asked) + k for k, d in enumerate(DIRECTIONS)}
        first = [*range(len(asked)), *(tool[d] for d in dict.fromkeys(named))]
        free = set(rows.beside(first, [tool[d] for d in others]))
        home = self.task_of(start)
        return {d: float(home[k]) for k, d in enumerate(DIRECTIONS) if tool[d] in free}

    def require_task(self, directions: Sequence[str]) -> None:
        """Check that the tool can move from home in some directions, one by one.

        Parameters
        ----------
        directions : sequence of str
            x, y, z of the tool centre point, rx, ry, rz of its rotation vector.

        Raises
        ------
        ModelError
            Names a direction in which the joints hold it.
        """
        try:
            # directions that are independent together are so one by one
            self._require(directions)
        except ModelError:
            for direction in directions:
                self._require([direction])

    def _require(self, directions: Sequence[str]) -> None:
        task = dict.fromkeys(directions, 0.0)
        wanted = given(self.joints, self.home_pose, self.home_values, None, task, None)
        WalkRows(self.joints, self.rotation, wanted)

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics of poses of the tool; those that cannot be taken are marked.

        Parameters
        ----------
        poses : Poses
            (...); of the tool.
        """
        return self.move(tool=poses).placement

    def _moved(self, walk: Walk | LegWalk, wanted: Given) -> Moved:
        batch = wanted.batch
        bodies: BodyPoses = walk.bodies
        positions, frames = walk.placed()
        values = walk.coordinates + self.home_values
        placement = Placement(
            positions.reshape(*batch, *positions.shape[1:]),
            frames.reshape(*batch, *frames.shape[1:]),
            values.reshape(*batch, values.shape[1]),
            self.joints.names,
            walk.status.reshape(batch),
            tuple(walk.reasons),
            self._turns(bodies).reshape(*batch, -1, 3, 3),
        )
        return Moved(
            placement,
            self._tool(bodies, positions, batch),
            walk.share.reshape(batch),
            walk.error.reshape(batch),
            walk.steps.reshape(batch),
            BodyPoses(
                bodies.position.reshape(*batch, *bodies.position.shape[1:]),
                bodies.rotation.reshape(*batch, *bodies.rotation.shape[1:]),
            ),
            walk if isinstance(walk, Walk) and wanted.poses <= PIECE else None,
        )

    def _turns(self, bodies: BodyPoses) -> Array:
        """Rotations of the bodies from where the home's own are counted, (p, b, 3, 3)."""
        return bodies.rotation if self.home.turns is None else bodies.rotation @ self.home.turns

    def _tool(self, bodies: BodyPoses, positions: Array, batch: tuple[int, ...]) -> Poses | None:
        if self.linkage.tool is None:
            return None
        body, node = self.linkage.tool_body, self.linkage.node_index[self.linkage.tool]
        turned = np.broadcast_to(self.rotation, (len(positions), 3, 3))
        if body >= 0:
            turned = bodies.rotation[:, body] @ self.rotation
        return Poses(positions[:, node].reshape(*batch, 3), turned.reshape(*batch, 3, 3))
