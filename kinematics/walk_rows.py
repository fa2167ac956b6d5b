"""What is open at poses on their way, in the joints and against what is given, and its rates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.given import Given
from strutwork.kinematics.home_rows import HomeRows, in_one_unit
from strutwork.kinematics.independent import (
    independent_beside,
    independent_rows,
    refuse_dependent,
)
from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.quick_step import Goals
from strutwork.kinematics.rows import constraint_rows, row_selection
from strutwork.kinematics.spinning import Spins
from strutwork.kinematics.turns import rotation_vector, vector_rates

Array = NDArray[Any]
Indices = NDArray[np.intp]


class WalkRows:
    """The rows of a linkage and of its targets, chosen at home.

    Parameters
    ----------
    joints : JointMotion
        Of the linkage.
    rotation : (3, 3)
        Rotation matrix of the tool at home, no unit.
    wanted : Given
        Targets, p of them.
    lenient : bool
        Whether coordinates that follow from others may be given.
    like : WalkRows, optional
        Of the same linkage, asked the same: its rows are these.

    Raises
    ------
    ModelError
        What is given depends on itself or on the joints.
    """

    length: float
    joint: Indices
    direction: Indices
    asked: NDArray[np.bool_]
    order: Indices
    held_rows: int
    given_at_home: Array
    late: Indices
    kept: Indices
    independent: bool
    spins: Spins | None

    def __init__(
        self,
        joints: JointMotion,
        rotation: Array,
        wanted: Given,
        *,
        lenient: bool = False,
        like: WalkRows | None = None,
    ) -> None:
        self.joints, self.given, self.rotation = joints, wanted, rotation
        self.length = HomeRows.of(joints).length if like is None else like.length
        self.coordinates = np.zeros((wanted.poses, len(joints.names)))
        # the ground's tool never moves: what it is asked depends on nothing and is refused
        self.tool_body = joints.linkage.tool_body if self._tool_directions else -1
        if like is None:
            self._rows_at_home(lenient=lenient)
            return
        self.joint, self.direction, self.asked = like.joint, like.direction, like.asked
        self.order, self.held_rows, self.late = like.order, like.held_rows, like.late
        self.kept, self.independent, self.spins = like.kept, like.independent, like.spins

    def _rows_at_home(self, *, lenient: bool) -> None:
        joints, wanted = self.joints, self.given
        held = np.argwhere(joints.held)
        self.asked, self.order = row_selection(joints.held.shape, wanted.joint, wanted.direction)
        self.joint, self.direction = held[:, 0], held[:, 1]
        self.spins = Spins.of(joints, self.tool_body)
        home = HomeRows.of(joints)
        self.given_at_home = self._given_at_home(home)
        matrix = np.concatenate([home.matrix, self.given_at_home])
        self.kept, self.independent = independent_rows(matrix, len(held), (home.kept, home.basis))
        self.held_rows = len(held)
        # what follows from the rest of what is given agrees at the target, not on the straight way
        given = np.arange(len(matrix)) >= self.held_rows
        given[self.kept] = False
        late = np.flatnonzero(given)
        self.late = late if wanted.tool is None else late[:0]
        if not (self.independent or lenient):
            refuse_dependent(matrix, len(held), wanted)

    def _given_at_home(self, home: HomeRows) -> Array:
        """Rows at home of the joint coordinates and directions of the tool that are given."""
        rows = self._tool_rows(np.zeros(1, dtype=np.intp), home.bodies)
        if self.order.size:
            linkage, points = self.joints.linkage, home.bodies.position
            asked = constraint_rows(linkage, home.placement, self.asked, coupled=False)
            rows = [asked.on_bodies(points)[:, self.order], *rows]
        if not rows:
            return home.matrix[:0]
        directions = np.concatenate([self.given.direction, np.array(self._tool_directions, int)])
        return in_one_unit(np.concatenate(rows, axis=1)[0], directions, self.length)

    def beside(self, first: Sequence[int], then: Sequence[int]) -> list[int]:
        """Those of the given rows at home, one after another, that depend on none before them.

        Parameters
        ----------
        first : sequence of int
            Numbers of given rows that come first; none is left beside them where one depends.
        then : sequence of int
            Numbers of given rows.
        """
        rows = self.given_at_home[[*first, *then]]
        found, _ = independent_beside(rows, HomeRows.of(self.joints).basis)
        if found[: len(first)] != list(range(len(first))):
            return []
        return [then[k - len(first)] for k in found[len(first) :]]

    def system(
        self, at: Indices, bodies: BodyPoses, share: Array, near: Array | None = None
    ) -> tuple[Array, Array]:
        """What is open, lengths over L, and its rates by (v / L, ω), (k, r) and (k, r, 6b).

        Parameters
        ----------
        at : (k,) of int
        bodies : BodyPoses
        share : (k,), no unit
        near : (k, c), m and rad, from which turns count on; those of the last step by default
        """
        near = self.coordinates[at] if near is None else near
        positions, frames, gaps = self.joints.place(bodies)
        placement = Placement(positions, frames, np.zeros((len(positions), 0)))
        linkage, points = self.joints.linkage, bodies.position
        rates = [constraint_rows(linkage, placement, self.joints.held).on_bodies(points)]
        residuals = self.joints.residuals(bodies, gaps, near)
        left = [residuals[:, self.joint, self.direction]]
        if self.order.size:
            asked = constraint_rows(linkage, placement, self.asked, coupled=False)
            rates.append(asked.on_bodies(points)[:, self.order])
            target = share[:, None] * self.given.values[at]
            left.append(self._given_coordinates(bodies, gaps, near) - target)
        matrix = np.concatenate([*rates, *self._tool_rows(at, bodies)], axis=1)
        open_ = np.concatenate([*left, *self._tool_open(at, bodies, share)], axis=1)
        tool = np.array(self._tool_directions, dtype=int)
        rows = np.concatenate([self.direction, self.given.direction, tool])
        over = np.where(rows < 3, 1.0 / self.length, 1.0)
        return open_ * over, in_one_unit(matrix, rows, self.length)

    @property
    def _tool_directions(self) -> tuple[int, ...]:
        return tuple(range(6)) if self.given.tool is not None else self.given.task

    def _tool(self, bodies: BodyPoses) -> tuple[Array, Array]:
        b = self.tool_body
        return bodies.position[:, b], bodies.rotation[:, b] @ self.rotation

    def _tool_rows(self, at: Indices, bodies: BodyPoses) -> list[Array]:
        asked = list(self._tool_directions)
        if not asked:
            return []
        rows = np.zeros((len(at), 6, bodies.position.shape[1] * 6))
        block = rows[:, :, 6 * self.tool_body : 6 * self.tool_body + 6]
        block[:] = np.eye(6)
        if self.given.tool is None:
            turn = rotation_vector(bodies.rotation[:, self.tool_body])
            block[:, 3:, 3:] = vector_rates(turn)
        return [rows[:, asked]]

    def _tool_open(self, at: Indices, bodies: BodyPoses, share: Array) -> list[Array]:
        asked = list(self._tool_directions)
        if not asked:
            return []
        place, rotation = self._tool(bodies)
        if self.given.tool is not None:
            wanted, turned = self.given.pose(at, share)
            apart = rotation_vector(rotation @ np.swapaxes(turned, -1, -2))
            return [np.concatenate([place - wanted, apart], axis=1)]
        turn = rotation_vector(bodies.rotation[:, self.tool_body])
        now = np.concatenate([place, turn], axis=1)[:, asked]
        return [now - self._target(at, share)]

    def _target(self, at: Indices, share: Array) -> Array:
        """Directions of the tool at a share of the way, (k, t)."""
        begin = self._begin(at)
        return np.asarray(begin + share[:, None] * (self.given.task_values[at] - begin))

    def _begin(self, at: Indices) -> Array:  # noqa: ARG002 - all begin at home
        start = self.given.start
        home = np.concatenate([np.zeros(3) if start is None else start.position, np.zeros(3)])
        return np.asarray(home[list(self.given.task)])

    def _goals(self, at: Indices, share: Array) -> Goals:
        asked = self._tool_directions
        if self.given.tool is None:
            return Goals(asked, self._target(at, share) if asked else None)
        return Goals(asked, None, *self.given.pose(at, share))

    def _coordinates(self, bodies: BodyPoses, gaps: Array, near: Array) -> Array:
        """Joint coordinates, turns counted on from those nearby, (k, c)."""
        found = self.joints.coordinates(bodies, gaps, near)
        return np.asarray(found[:, ~self.joints.still])

    def _given_coordinates(self, bodies: BodyPoses, gaps: Array, near: Array) -> Array:
        names = list(map(tuple, np.argwhere(~self.joints.still)))
        asked = zip(self.given.joint, self.given.direction, strict=True)
        return self._coordinates(bodies, gaps, near)[:, [names.index(pair) for pair in asked]]
