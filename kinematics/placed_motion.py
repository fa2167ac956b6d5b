"""The motion of all bodies of a linkage at a batch of poses, to second order."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.frames import cross, turned
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.row_rates import row_rates
from strutwork.kinematics.rows import ConstraintRows, constraint_rows, row_selection
from strutwork.kinematics.turns import rotation_vector, vector_rates, velocity_rates

if TYPE_CHECKING:
    from strutwork.kinematics.body_motion import BodyMotion

Array = NDArray[Any]

#: Bodies that move faster than this per unit coordinate rate, in units of the machine's size.
FASTEST = 1e6


@dataclass(frozen=True)
class PlacedMotion:
    """The motion of bodies at p poses; made by `BodyMotion.at`.

    Twists are velocities of the bodies' points and angular velocities, global axes, (p, 6 b).

    Parameters
    ----------
    of : BodyMotion
    placement : Placement
        One batch axis.
    position : (p, b, 3)
        Of the bodies' reference points, m.
    rotation : (p, b, 3, 3)
        Rotation matrices of the bodies from home.
    """

    of: BodyMotion
    placement: Placement
    position: Array
    rotation: Array

    def __repr__(self) -> str:
        return f"<PlacedMotion: {len(self.of.coordinates)} coordinates, {len(self.position)} poses>"

    @cached_property
    def points(self) -> Array:
        """Where the points of the bodies are, (p, b, 3), m."""
        home = self.of.motion.joints.start(1).position[0]
        arms = [
            turned(self.rotation[:, b], (self.of.points[b] - home[b])[None])[:, 0]
            for b in range(len(home))
        ]
        return self.position + np.stack(arms, axis=1) if arms else self.position

    def rows(self, select: NDArray[np.bool_], *, coupled: bool = True) -> ConstraintRows:
        """Rows of joint directions, whose shifts are along axes of the joint's first body.

        Parameters
        ----------
        select : (j, 6) of bool
            Which joint directions.
        coupled : bool
            As in `constraint_rows`.
        """
        return self._along(
            constraint_rows(self.of.motion.linkage, self.placement, select, coupled=coupled)
        )

    def _along(self, rows: ConstraintRows) -> ConstraintRows:
        if rows.tied is not None:
            rows = replace(rows, tied=replace(rows.tied, others=self._along(rows.tied.others)))
        joints = self.of.motion.joints
        two = (~joints.still[:, 3:]).sum(axis=1) == 2
        shifts = np.flatnonzero(two[rows.joint] & joints.sliding[rows.joint] & (rows.direction < 3))
        if not shifts.size:
            return rows
        # of a joint that turns in two ways and slides, `frames` holds the crossed axes
        axes = rows.axes.copy()
        owner = self.of.motion.linkage.body_of_node[rows.nodes[shifts, 0]]
        for r, body in zip(shifts, owner, strict=True):
            first = joints.home.frames[rows.joint[r], :, rows.direction[r]]
            axes[:, r, :3] = first if body < 0 else self.rotation[:, body] @ first
        return replace(rows, axes=axes)

    @cached_property
    def held(self) -> ConstraintRows:
        """Rows of the held joint directions, those that depend on others too."""
        return self.rows(self.of.motion.joints.held)

    @cached_property
    def held_on_bodies(self) -> Array:
        """Those rows on the bodies' twists, (p, r, 6 b)."""
        return np.asarray(self.held.on_bodies(self.points))

    @cached_property
    def drives(self) -> ConstraintRows:
        """Rows of the driven directions, in the linkage's order."""
        return self.rows(self.of.motion.linkage.driven_mask())

    @cached_property
    def drives_on_bodies(self) -> Array:
        """Those rows on the bodies' twists, (p, a, 6 b)."""
        return np.asarray(self.drives.on_bodies(self.points))

    @cached_property
    def _joints(self) -> tuple[ConstraintRows, NDArray[np.intp]]:
        """Rows of the given joint coordinates, and where each of ours is among them."""
        linkage = self.of.motion.linkage
        joint = np.array([linkage.joint_index[j] for j, _ in self._asked_joints], dtype=np.intp)
        turn = np.array([DIRECTIONS.index(d) for _, d in self._asked_joints], dtype=np.intp)
        select, order = row_selection((len(linkage.joints), 6), joint, turn)
        return self.rows(select, coupled=False), order

    @property
    def _asked_joints(self) -> tuple[tuple[str, str], ...]:
        return self.of.coordinates.joints

    @property
    def _asked_tool(self) -> list[int]:
        return [DIRECTIONS.index(d) for d in self.of.coordinates.tool]

    @cached_property
    def tool_arm(self) -> Array:
        """From the point of the tool's body to the tool centre point, (p, 3), m."""
        body = self.of.motion.linkage.tool_body
        return np.asarray(self.position[:, body] - self.points[:, body])

    @cached_property
    def tool_on_bodies(self) -> Array:
        """Twist of the tool from those of the bodies, (p, 6, 6 b); zero for a tool on the ground.

        Raises
        ------
        ModelError
            The linkage has no tool.
        """
        body = self.of.motion.linkage.tool_body
        rows = np.zeros((len(self.position), 6, self.position.shape[1], 6))
        if body >= 0:
            rows[..., body, :] = np.eye(6)
            for k in range(3):
                unit = np.broadcast_to(np.eye(3)[k], self.tool_arm.shape)
                rows[:, :3, body, 3 + k] = cross(unit, self.tool_arm)
        return rows.reshape(len(rows), 6, -1)

    @cached_property
    def _turn_rates(self) -> tuple[Array, Array]:
        """Rotation vector of the tool from home, and the matrix from ω to its rate."""
        vector = rotation_vector(self.rotation[:, self.of.motion.linkage.tool_body])
        return vector, vector_rates(vector)

    @cached_property
    def _given(self) -> Array:
        """Rows of the coordinates, (p, t, 6 b)."""
        parts = [np.zeros((len(self.position), 0, 6 * self.position.shape[1]))]
        if self.of.coordinates.tool:
            rows = self.tool_on_bodies.copy()
            rows[:, 3:] = self._turn_rates[1] @ rows[:, 3:]
            parts.append(rows[:, self._asked_tool])
        if self.of.coordinates.joints:
            rows_, order = self._joints
            parts.append(rows_.on_bodies(self.points)[:, order])
        return np.concatenate(parts, axis=1)

    @cached_property
    def lines(self) -> Array:
        """Lines about which bodies spin freely, (p, k, 3)."""
        spins = self.of.plan[1]
        found = [self.rotation[:, body] @ axis for body, axis in spins]
        return np.stack(found, axis=1) if found else np.zeros((len(self.position), 0, 3))

    def _spins(self, vectors: Array) -> Array:
        rows = np.zeros((*vectors.shape[:2], self.position.shape[1], 6))
        for k, (body, _) in enumerate(self.of.plan[1]):
            rows[:, k, body, 3:] = vectors[:, k]
        return rows.reshape(*vectors.shape[:2], 6 * self.position.shape[1])

    @cached_property
    def _solved(self) -> tuple[Array, Array, Array]:
        """Inverse of all rows, sign of their determinant, and where it is singular."""
        length, count = self.of.motion.length, self.position.shape[1]
        matrix = np.concatenate(
            [self.held_on_bodies[:, self.of.plan[0]], self._given, self._spins(self.lines)], axis=1
        )
        # lengths over the machine's size, as in `home_rows`
        shift = np.concatenate(
            [
                self.held.direction[self.of.plan[0]] < 3,
                ~self.of.coordinates.rotary,
                np.zeros(len(self.of.plan[1]), dtype=bool),
            ]
        )
        over = np.where(shift, 1.0 / length, 1.0)
        unit = np.tile(np.repeat([length, 1.0], 3), count)
        scaled = matrix * over[:, None] * unit
        sign, _ = np.linalg.slogdet(scaled)
        lost = sign == 0
        inverse = np.zeros_like(scaled)
        inverse[~lost] = np.linalg.inv(scaled[~lost])
        fast = np.abs(inverse).max(axis=(-2, -1), initial=0.0)
        return unit[:, None] * inverse * over, sign, lost | ~(fast < FASTEST)

    @property
    def sign(self) -> Array:
        """Sense of the rows, (p,): between poses of opposite sign the coordinates fail."""
        return self._solved[1]

    @property
    def singular(self) -> NDArray[np.bool_]:
        """Where the coordinates do not determine how the bodies move, (p,)."""
        return np.asarray(self._solved[2], dtype=bool)

    @property
    def _columns(self) -> slice:
        first = len(self.of.plan[0])
        return slice(first, first + len(self.of.coordinates))

    @property
    def map(self) -> Array:
        """N, twists of the bodies per rate of the coordinates, (p, 6 b, t)."""
        return np.asarray(self._solved[0][..., self._columns])

    @property
    def spin_map(self) -> Array:
        """Twists of the bodies per free spin, (p, 6 b, k)."""
        return np.asarray(self._solved[0][..., self._columns.stop :])

    def row_forces(self, forces: Array) -> Array:
        """Forces of the independent held rows that balance forces on the bodies, (p, r).

        Parameters
        ----------
        forces : (p, 6 b)
            At the bodies' points, N and N·m; they do no work in a motion of the coordinates.
        """
        found = np.einsum("pnk,pn->pk", self._solved[0], forces)
        return np.asarray(found[:, : len(self.of.plan[0])])

    def twists(self, rates: Array) -> Array:
        """Twists of the bodies for rates (p, t), m/s and rad/s, (p, 6 b).

        Parameters
        ----------
        rates : (p, t)
            Of the coordinates, m/s or rad/s.
        """
        return np.asarray(np.einsum("pnt,pt->pn", self.map, rates))

    def rows_rate(self, rates: Array) -> Array:
        """Time derivative of all rows that are solved, (p, 6 b, 6 b).

        Parameters
        ----------
        rates : (p, t)
            Of the coordinates, m/s or rad/s.
        """
        twists = self.twists(rates)
        parts = [row_rates(self.held, self.points, twists)[:, self.of.plan[0]]]
        if self.of.coordinates.tool:
            parts.append(self._tool_rate(twists))
        if self.of.coordinates.joints:
            rows, order = self._joints
            parts.append(row_rates(rows, self.points, twists)[:, order])
        spin = twists.reshape(len(twists), -1, 6)[..., 3:]
        change = [cross(spin[:, b], self.lines[:, k]) for k, (b, _) in enumerate(self.of.plan[1])]
        lines = np.stack(change, axis=1) if change else self.lines
        return np.concatenate([*parts, self._spins(lines)], axis=1)

    def _tool_rate(self, twists: Array) -> Array:
        body = self.of.motion.linkage.tool_body
        spin = twists.reshape(len(twists), -1, 6)[:, body, 3:]
        rows = np.zeros((len(twists), 6, self.position.shape[1], 6))
        moved = cross(spin, self.tool_arm)
        for k in range(3):
            rows[:, :3, body, 3 + k] = cross(np.broadcast_to(np.eye(3)[k], moved.shape), moved)
        vector, matrix = self._turn_rates
        rate = np.einsum("pij,pj->pi", matrix, spin)
        # d(J⁻¹)/dt = −J⁻¹ J̇ J⁻¹
        rows[:, 3:, body, 3:] = -matrix @ velocity_rates(vector, rate) @ matrix
        return rows.reshape(len(twists), 6, -1)[:, self._asked_tool]

    def map_rate(self, rates: Array) -> Array:
        """Ṅ along rates (p, t), (p, 6 b, t).

        Parameters
        ----------
        rates : (p, t)
            Of the coordinates, m/s or rad/s.
        """
        return np.asarray(-self._solved[0] @ (self.rows_rate(rates) @ self.map))

    def accelerations(self, rates: Array, changes: Array) -> Array:
        """Accelerations of the bodies' points and angular accelerations, (p, 6 b).

        Parameters
        ----------
        rates, changes : (p, t)
            First and second derivatives of the coordinates, m and rad over s and s².
        """
        drift = np.einsum("pij,pj->pi", self.rows_rate(rates), self.twists(rates))
        right = -drift
        right[:, self._columns] += changes
        return np.asarray(np.einsum("pij,pj->pi", self._solved[0], right))
