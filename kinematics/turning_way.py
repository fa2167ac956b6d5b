"""The way of all bodies through the pose at which task coordinates turn back, or ways cross.

A machine that comes to the end of its reach turns back there: along the way of all bodies, which
goes on smoothly, the coordinates that were asked to grow are at their largest. The end is found
along that way (Allgower and Georg 2003, section 2.3: predictor and corrector by arc length), where
it is a simple zero of the tangent, and not in the coordinates, where it is a square root. The way
may also come to a pose through which several ways go, where its rows lose rank.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import characteristic_length, constraint_rows
from strutwork.kinematics.turns import rotation_matrix, rotation_vector, vector_rates

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Share of the tangent in the coordinates at which they have turned: the coordinates themselves
#: are then off by its square.
TURNED = 1e-8
#: Steps along the way, corrections of each, and the longest step, turns in rad.
STEPS, CORRECTIONS, LONGEST = 30, 10, 0.1
#: Singular values of the rows, as a share of the largest, that count as none.
NONE = 1e-9
#: What is left open of a joint or the coordinates, as a share of the machine's size.
CLOSED = 1e-12


@dataclass(frozen=True)
class Turns:
    """Where coordinates turn back, or ways cross.

    Parameters
    ----------
    share : (e,)
        Share of the given direction, from the start.
    placement : Placement
    found : (e,) of bool
        The others left the way or did not turn.
    """

    share: Array
    placement: Placement
    found: Mask


@dataclass(frozen=True)
class TurningWay:
    """Ways of all bodies on which task coordinates go along given directions.

    Parameters
    ----------
    motion : Motion
    asked : tuple of int
        Task coordinates that are given, indices into `DIRECTIONS`.
    wanted : (e, t)
        How they are to change, m and rad.
    """

    motion: Motion
    asked: tuple[int, ...]
    wanted: Array
    joints: JointMotion = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", self.motion.joints)

    @cached_property
    def _length(self) -> float:
        return characteristic_length(self.motion.home)

    @cached_property
    def _size(self) -> Array:
        """Size of the direction, turns in rad and shifts over the length, (e,)."""
        over = np.array([1.0 / self._length if d < 3 else 1.0 for d in self.asked])
        return np.asarray(np.linalg.norm(self.wanted * over, axis=1))

    @cached_property
    def _rows(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        joint, direction = np.nonzero(self.joints.held)
        return joint, direction

    def turns(self, start: Placement, gap: Array) -> Turns:
        """Go on from placements that are reached to where the coordinates turn back.

        Parameters
        ----------
        start : Placement
            Made by the motion; e poses.
        gap : (e,)
            Share of the direction within which the end lies.
        """
        bodies = self._bodies(start)
        tasks = self._task(bodies)
        along = np.zeros(len(gap))
        at = self._first(bodies)
        good = at.slope > 0.0
        # on a parabola the end, half a gap ahead, is a whole gap over the slope along the way
        step = np.clip(0.5 * gap * self._size / np.maximum(at.slope, 1e-9), 1e-7, LONGEST)
        branches = np.zeros(len(gap), dtype=bool)
        for k in range(STEPS):
            arrived = np.abs(np.where(branches, at.crossing, at.slope)) <= TURNED
            arrived &= k > 0
            if np.all(arrived | ~good):
                break
            step = np.where(arrived, 0.0, step)
            bodies, along, closed = self._step(bodies, along, tasks, step[:, None] * at.tangent)
            good &= closed
            new = self._next(bodies, at)
            turn, cross = (
                _ahead(after, before, step)
                for after, before in ((new.slope, at.slope), (new.crossing, at.crossing))
            )
            if k == 0:
                # whichever comes first, the turn or a crossing of ways
                places = np.stack([step + turn, step + cross])
                places = np.where(places > 0.0, places, np.inf)
                branches = places[1] < places[0]
            at = new
            step = np.clip(np.where(branches, cross, turn), -LONGEST, LONGEST)
        arrived = np.abs(np.where(branches, at.crossing, at.slope)) <= TURNED
        positions, frames, _ = self.joints.place(bodies)
        turn = bodies.rotation
        if self.motion.home.turns is not None:
            turn = turn @ self.motion.home.turns
        values = np.zeros((len(positions), len(self.joints.names)))
        placement = Placement(positions, frames, values, self.joints.names, turns=turn)
        return Turns(along / self._size, placement, good & arrived)

    def _bodies(self, start: Placement) -> BodyPoses:
        """Where the bodies of a placement are."""
        linkage, home = self.motion.linkage, self.motion.home
        rotation = np.asarray(start.turns)
        if home.turns is not None:
            rotation = rotation @ np.swapaxes(home.turns, -1, -2)
        reference = self.joints.start(1).position[0]
        # a node that slides stands where the other of its joint does, not on its own body
        slides = np.zeros(len(linkage.nodes), dtype=bool)
        slides[self.joints.nodes[self.joints.sliding, 0]] = True
        position = np.empty((len(start.positions), len(reference), 3))
        for b in range(len(reference)):
            mine = np.flatnonzero(linkage.body_of_node == b)
            node = mine[np.argsort(slides[mine], kind="stable")[0]]
            arm = home.positions[node] - reference[b]
            position[:, b] = start.positions[:, node] - rotation[:, b] @ arm
        return BodyPoses(position, rotation)

    def _task(self, bodies: BodyPoses) -> Array:
        tool = self.motion.linkage.tool_body
        turn = rotation_vector(bodies.rotation[:, tool])
        return np.concatenate([bodies.position[:, tool], turn], axis=1)[:, list(self.asked)]

    def _matrix(self, bodies: BodyPoses) -> tuple[Array, Array]:
        """Rows of held directions and task by (v / L, ω, share); gaps of the held, (e, r)."""
        joint, direction = self._rows
        positions, frames, gaps = self.joints.place(bodies)
        placed = Placement(positions, frames, np.zeros((len(positions), 0)))
        held = constraint_rows(self.motion.linkage, placed, self.joints.held).on_bodies(
            bodies.position
        )
        body = 6 * self.motion.linkage.tool_body
        tool = np.zeros((len(held), 6, held.shape[-1]))
        tool[:, :3, body : body + 3] = np.eye(3)
        turn = rotation_vector(bodies.rotation[:, self.motion.linkage.tool_body])
        tool[:, 3:, body + 3 : body + 6] = vector_rates(turn)
        rows = np.concatenate([held, tool[:, list(self.asked)]], axis=1)
        over = self._over
        matrix = np.zeros((*rows.shape[:2], rows.shape[2] + 1))
        unit = np.tile(np.repeat([self._length, 1.0], 3), rows.shape[-1] // 6)
        matrix[..., :-1] = over[:, None] * rows * unit
        matrix[:, len(joint) :, -1] = -over[len(joint) :] * self.wanted / self._size[:, None]
        open_ = self.joints.residuals(bodies, gaps)[:, joint, direction]
        return matrix, over[: len(joint)] * open_

    @cached_property
    def _over(self) -> Array:
        directions = np.concatenate([self._rows[1], np.array(self.asked)])
        return np.where(directions < 3, 1.0 / self._length, 1.0)

    def _first(self, bodies: BodyPoses) -> _At:
        matrix, _ = self._matrix(bodies)
        left, values, right = np.linalg.svd(matrix)
        rank = int((values > NONE * values[:, :1]).sum(axis=1).max(initial=0))
        aim = np.zeros((len(matrix), matrix.shape[2]))
        aim[:, -1] = 1.0
        tangent = _projected(right[:, rank:], aim)
        return _At(
            tangent,
            values[:, rank - 1],
            np.concatenate([left[:, :, rank - 1], right[:, rank - 1]], axis=1),
            rank,
        )

    def _next(self, bodies: BodyPoses, before: _At) -> _At:
        """The same further on, in the sense of before."""
        matrix, _ = self._matrix(bodies)
        left, values, right = np.linalg.svd(matrix)
        rank = before.rank
        tangent = _projected(right[:, rank:], before.tangent)
        vectors = np.concatenate([left[:, :, rank - 1], right[:, rank - 1]], axis=1)
        rows = matrix.shape[1]
        # left and right vectors come with a common sign of their own: one that turns against
        # the other is a value that has gone through zero
        sides = [
            np.sign((vectors[:, part] * before.vectors[:, part]).sum(axis=1))
            for part in (slice(0, rows), slice(rows, None))
        ]
        sign = np.sign(before.crossing) * sides[0] * sides[1]
        return _At(tangent, sign * values[:, rank - 1], vectors, rank)

    def _step(
        self, bodies: BodyPoses, along: Array, tasks: Array, change: Array
    ) -> tuple[BodyPoses, Array, Mask]:
        """Go by a change (e, n + 1) and back to the way."""
        number = len(self._rows[0])
        worst = np.full(len(change), np.inf)
        for k in range(CORRECTIONS + 1):
            blocks = change[:, :-1].reshape(len(change), -1, 6)
            bodies = BodyPoses(
                bodies.position + self._length * blocks[..., :3],
                rotation_matrix(blocks[..., 3:]) @ bodies.rotation,
            )
            along = along + change[:, -1]
            matrix, open_ = self._matrix(bodies)
            target = tasks + (along / self._size)[:, None] * self.wanted
            asked = self._over[number:] * (self._task(bodies) - target)
            left = np.concatenate([open_, asked], axis=1)
            worst = np.abs(left).max(axis=1, initial=0.0)
            if k == CORRECTIONS or np.all(worst <= CLOSED):
                break
            change = -np.einsum("enr,er->en", np.linalg.pinv(matrix, rcond=NONE), left)
        return bodies, along, np.asarray(worst <= 100.0 * CLOSED)


@dataclass(frozen=True)
class _At:
    """Where the way goes on at a pose.

    Parameters
    ----------
    tangent : (e, n + 1)
        Of unit size, the share last.
    crossing : (e,)
        Least singular value of the rows, signed along the way: zero where ways cross.
    vectors : (e, r + n + 1)
        Its left and right vectors.
    rank : int
    """

    tangent: Array
    crossing: Array
    vectors: Array
    rank: int

    @property
    def slope(self) -> Array:
        """Share of the coordinates in the tangent, (e,): zero where they turn back."""
        return np.asarray(self.tangent[:, -1])


def _ahead(after: Array, before: Array, step: Array) -> Array:
    """How far ahead a line through two values is zero; beyond all ways where it is flat."""
    fall = before - after
    flat = (fall == 0.0) | (step == 0.0)
    return np.where(flat, np.inf, step * after / np.where(flat, 1.0, fall))


def _projected(null: Array, aim: Array) -> Array:
    """Unit projections on the rows of null spaces, (e, k, n) and (e, n)."""
    found = np.einsum("ekn,ek->en", null, np.einsum("ekn,en->ek", null, aim))
    norm = np.linalg.norm(found, axis=1, keepdims=True)
    return np.asarray(found / np.where(norm > 0.0, norm, 1.0))
