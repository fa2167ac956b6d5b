"""Finite motion of joints: what their held directions leave open, and their coordinates.

The axes of a joint move with the body of its first node, and so does what its free translations
are measured along; of a joint with two free rotations the first axis, z of a universal joint,
moves with the first body and the second, x, with the second.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.frames import cross, turned
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import body_references
from strutwork.kinematics.sliding import sliding_joints
from strutwork.kinematics.turns import rotation_vector

Array = NDArray[Any]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class BodyPoses:
    """Where the moving bodies of a linkage are.

    Parameters
    ----------
    position : (p, b, 3)
        Of the bodies' reference points, m.
    rotation : (p, b, 3, 3)
        Rotation matrices from home.
    """

    position: Array
    rotation: Array

    def __getitem__(self, index: Any) -> BodyPoses:
        return BodyPoses(self.position[index], self.rotation[index])


@dataclass(frozen=True)
class JointMotion:
    """The joints of a linkage on their way from one placement, its home.

    Parameters
    ----------
    linkage : Linkage
    home : Placement
        One pose, without batch axes.

    Raises
    ------
    ModelError
        A node slides along its body in one joint and belongs to another joint too.
    """

    linkage: Linkage
    home: Placement

    def __post_init__(self) -> None:
        _ = self.nodes

    @cached_property
    def held(self) -> Mask:
        """Joint directions with a row that holds them, those that follow others too, (j, 6)."""
        return np.asarray(self.linkage.elastic_or_locked() & ~self.linkage.driven_mask())

    @cached_property
    def still(self) -> Mask:
        """Those that do not move at all: the others have coordinates, (j, 6)."""
        return self.linkage.still_mask()

    @cached_property
    def names(self) -> tuple[tuple[str, str], ...]:
        """Joint and direction of every coordinate, in joint order."""
        joints = self.linkage.joints
        return tuple((joints[j].name, DIRECTIONS[d]) for j, d in np.argwhere(~self.still))

    @cached_property
    def nodes(self) -> NDArray[np.intp]:
        """First and second node of each joint, (j, 2)."""
        index = self.linkage.node_index
        found = np.asarray(
            [[index[n] for n in j.between] for j in self.linkage.joints], dtype=np.intp
        ).reshape(-1, 2)
        sliding = self.sliding
        others = np.ones(len(found), dtype=bool)
        others[self._clamps(found)] = False
        used = np.bincount(found[others].ravel(), minlength=len(self.linkage.nodes))
        for j in np.flatnonzero(sliding):
            joint, node = self.linkage.joints[j], self.linkage.nodes[found[j, 0]]
            if used[found[j, 0]] > 1:
                raise ModelError(
                    f"joint {joint.name}",
                    f'slides on node "{node}", which another joint has too: it cannot follow both.',
                    "Give each sliding joint a node of its own on the body along which it slides.",
                )
        return found

    def _clamps(self, nodes: NDArray[np.intp]) -> NDArray[np.intp]:
        """Joints that clamp a sliding node to a ground node of its own: it may be anywhere."""
        owner = self.linkage.body_of_node
        slides = np.zeros(len(owner), dtype=bool)
        slides[nodes[self.sliding, 0]] = True
        used = np.bincount(nodes.ravel(), minlength=len(owner))
        ground = nodes[:, 0]
        clamp = self.still.all(axis=1) & slides[nodes[:, 1]]
        return np.flatnonzero(clamp & (owner[ground] < 0) & (used[ground] == 1))

    def _carry_clamps(self, positions: Array) -> None:
        """Put the ground nodes of clamps where the nodes slide that they hold."""
        first, second = self.nodes[self._clamps(self.nodes)].T
        positions[:, first] = positions[:, second]

    @cached_property
    def sliding(self) -> Mask:
        """Joints with a free translation: their first node follows the second, (j,)."""
        return sliding_joints(self.linkage)

    @cached_property
    def _references(self) -> Array:
        return body_references(self.linkage, self.home)

    def start(self, poses: int) -> BodyPoses:
        """All bodies at home, `poses` times.

        Parameters
        ----------
        poses : int
            Their number p.
        """
        bodies = self._references
        return BodyPoses(
            np.tile(bodies, (poses, 1, 1)), np.tile(np.eye(3), (poses, len(bodies), 1, 1))
        )

    def place(self, bodies: BodyPoses) -> tuple[Array, Array, Array]:
        """Node positions and joint frames of bodies.

        Parameters
        ----------
        bodies : BodyPoses
            At p poses.

        Returns
        -------
        positions : (p, n, 3)
            The nodes of a joint stand where its second node is.
        frames : (p, j, 3, 3)
        gaps : (p, j, 3)
            From the first node's place on its body to the second's, m.
        """
        owner = self.linkage.body_of_node
        home = self.home.positions
        count = len(bodies.position)
        positions = np.empty((count, len(home), 3))
        positions[:, owner < 0] = home[owner < 0]
        for b in range(bodies.position.shape[1]):
            mine = owner == b
            arms = home[mine] - self._references[b]
            positions[:, mine] = bodies.position[:, b, None] + turned(bodies.rotation[:, b], arms)
        frames = self._axes(*self._frames(bodies))
        a, b_ = self.nodes.T
        gaps = positions[:, b_] - positions[:, a]
        moved = np.flatnonzero(self.sliding)
        positions[:, a[moved]] = positions[:, b_[moved]]
        self._carry_clamps(positions)
        return positions, frames, gaps

    def place_compiled(self, bodies: BodyPoses) -> tuple[Array, Array]:
        """Node positions (p, n, 3) and joint frames (p, j, 3, 3) of `place`, for many poses.

        Parameters
        ----------
        bodies : BodyPoses
            At p poses.
        """
        from strutwork.kinematics.leg_place import place_bodies  # noqa: PLC0415 - numba is slow to import

        owner, home = self.linkage.body_of_node, self.home
        origin = np.concatenate([self._references, np.zeros((1, 3))])
        # the ground is −1, the last
        arms = np.ascontiguousarray(home.positions - origin[owner], dtype=float)
        locked = np.where(self._turning == 2, np.argmax(self._locks, axis=1), -1)
        count = len(bodies.position)
        positions, frames = np.empty((count, *arms.shape)), np.empty((count, *home.frames.shape))
        place_bodies(
            np.ascontiguousarray(bodies.position),
            np.ascontiguousarray(bodies.rotation),
            (owner, arms),
            (self.nodes, self.sliding, locked, np.ascontiguousarray(home.frames, dtype=float)),
            positions,
            frames,
        )
        self._carry_clamps(positions)
        return positions, frames

    @cached_property
    def _locks(self) -> Mask:
        return np.asarray(self.still[:, 3:])

    @cached_property
    def _turning(self) -> NDArray[np.intp]:
        """Number of free rotations of each joint, (j,)."""
        return np.asarray((~self._locks).sum(axis=1))

    def _frames(self, bodies: BodyPoses) -> tuple[Array, Array]:
        """Joint axes that move with the first and with the second body, (p, j, 3, 3)."""
        owner = self.linkage.body_of_node[self.nodes]
        turns = np.concatenate(
            [bodies.rotation, np.broadcast_to(np.eye(3), (len(bodies.rotation), 1, 3, 3))], axis=1
        )
        # the ground is −1, the last
        return tuple(turns[:, owner[:, k]] @ self.home.frames for k in (0, 1))

    def _axes(self, first: Array, second: Array) -> Array:
        """The joints' own axes, between those of their two bodies, (p, j, 3, 3)."""
        frames = first.copy()
        for j in np.flatnonzero(self._turning == 2):
            locked = int(np.flatnonzero(self._locks[j])[0])
            frames[:, j] = _crossed(first[:, j], second[:, j], locked)
        return frames

    def residuals(self, bodies: BodyPoses, gaps: Array, near: Array | None = None) -> Array:
        """What the held directions leave open, m and rad, zero in the others, (p, j, 6).

        Parameters
        ----------
        bodies : BodyPoses
            At p poses.
        gaps : (p, j, 3)
            As `place` gives them for these bodies, m.
        near : (p, c), optional
            Coordinates from which the turns of couplings and screws count on, m and rad, in the
            order of `names`; without it they lie within half a turn of home.
        """
        first, second = self._frames(bodies)
        relative = np.swapaxes(first, -1, -2) @ second
        open_ = np.zeros((len(gaps), len(self.still), 6))
        # along the axes of the rows, so that these are its rates; free translations go with the
        # first body
        axes = np.where(self.sliding[:, None, None], first, self._axes(first, second))
        open_[..., :3] = np.einsum("pjik,pji->pjk", axes, gaps)
        for j, locks in enumerate(self._locks):
            turn = relative[:, j]
            if locks.all():
                open_[:, j, 3:] = rotation_vector(turn)
            elif locks.sum() == 2:
                (e,) = np.flatnonzero(~locks)
                # R e = e + θ × e to first order
                open_[:, j, 3:] = cross(
                    np.broadcast_to(np.eye(3)[e], turn[..., e].shape), turn[..., e]
                )
            elif locks.any():
                (d,) = np.flatnonzero(locks)
                open_[:, j, 3 + d] = -turn[:, (d + 1) % 3, (d + 2) % 3]
        if self.linkage.ties:
            values = self.coordinates(bodies, gaps, near)
            for tie in self.linkage.ties:
                open_[:, tie.joint, tie.direction] = (
                    values[:, tie.joint, tie.direction]
                    - tie.ratio * values[:, tie.other_joint, tie.other_direction]
                )
        return np.where(self.held, open_, 0.0)

    def reversed(self, bodies: BodyPoses) -> Mask:
        """Whether a joint with one free rotation has its axis turned round, (p).

        Its held directions close then too, and no pin goes in so.

        Parameters
        ----------
        bodies : BodyPoses
            At p poses.
        """
        first, second = self._frames(bodies)
        found = np.zeros(len(bodies.position), dtype=bool)
        for j in np.flatnonzero(self._turning == 1):
            e = int(np.flatnonzero(~self._locks[j])[0])
            found |= np.einsum("pi,pi->p", first[:, j, :, e], second[:, j, :, e]) < 0.0
        return found

    def coordinates(self, bodies: BodyPoses, gaps: Array, near: Array | None = None) -> Array:
        """Joint coordinates, m and rad, zero at home and where nothing moves, (p, j, 6).

        Three free rotations are a rotation vector.

        Parameters
        ----------
        bodies : BodyPoses
            At p poses.
        gaps : (p, j, 3)
            As `place` gives them for these bodies, m.
        near : (p, c), optional
            Coordinates within half a turn of which each turn lies, m and rad, in the order of
            `names`; without it turns are between −π and π.
        """
        first, second = self._frames(bodies)
        relative = np.swapaxes(first, -1, -2) @ second
        value = np.zeros((len(gaps), len(self.held), 6))
        value[..., :3] = np.einsum("pjik,pji->pjk", first, gaps)
        for j, locks in enumerate(self._locks):
            turn, free = relative[:, j], ~locks
            if free.all():
                value[:, j, 3:] = rotation_vector(turn)
            elif free.sum() == 1:
                (e,) = np.flatnonzero(free)
                f, g = (e + 1) % 3, (e + 2) % 3
                value[:, j, 3 + e] = np.arctan2(turn[:, g, f], turn[:, f, f])
            elif free.sum() == 2:
                (d,) = np.flatnonzero(locks)
                e, f = (d + 1) % 3, (d + 2) % 3
                value[:, j, 3 + e] = np.arctan2(turn[:, d, f], turn[:, f, f])
                value[:, j, 3 + f] = np.arctan2(turn[:, e, d], turn[:, e, e])
        if near is not None:
            owner, direction = np.nonzero(~self.still)
            turns = direction >= 3
            at = owner[turns], direction[turns]
            before = near[:, turns]
            ahead = value[:, at[0], at[1]] - before
            value[:, at[0], at[1]] = before + np.angle(np.exp(1j * ahead))
        return np.where(self.still, 0.0, value)


def _crossed(first: Array, second: Array, locked: int) -> Array:
    """Axes of a joint that turns about e of the first body and f of the second, (p, 3, 3)."""
    e, f = (locked + 1) % 3, (locked + 2) % 3
    frame = np.empty_like(first)
    frame[..., e] = first[..., e]
    across = cross(first[..., e], second[..., f])
    frame[..., locked] = across / np.linalg.norm(across, axis=-1, keepdims=True)
    frame[..., f] = cross(frame[..., locked], frame[..., e])
    return frame
