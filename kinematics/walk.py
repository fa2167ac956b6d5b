"""Newton's method along the way from home to many targets, each by steps of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.given import Given
from strutwork.kinematics.independent import independent_rows, refuse_dependent, spanning_rows
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.quick_step import Goals, QuickStep
from strutwork.kinematics.rows import characteristic_length, constraint_rows, row_selection
from strutwork.kinematics.spinning import Spins
from strutwork.kinematics.turns import rotation_matrix, rotation_vector, vector_rates

Array = NDArray[Any]
Indices = NDArray[np.intp]

#: Largest share of a correction in the one before (Deuflhard 2011: 1/4 to 1/2), but for rounding.
SHRINK = 0.3
#: Largest first correction of a step: turn, rad, and shift as a share of the machine's size.
FARTHEST = 0.6
#: Corrections of a step; they square, so that more mean that it was too long.
CORRECTIONS = 8
#: Gap that is left in a joint, as a share of the machine's size, and what rounding alone leaves.
CLOSED, ROUNDING = 1e-11, 1e-14
#: Rows that depend on the others may be this many times as open: they are not solved for.
ELSE = 1e3
#: Shortest step, as a share of the whole way, and steps allowed.
SHORTEST, MOST = 1e-6, 2000
#: A singular value of the rows, as a share of the largest, below which the way ends at it.
SINGULAR = 3e-3
#: Gap, as a share of the machine's size or rad, that no rest of the way explains.
OPEN = 1e-4
#: Share of the way within which it ends where only home allowed the first step.
BESIDE = 1e-2
#: How many times better the condition of other rows must be, and the first step with them.
BETTER, RESTART = 2.0, 1e-2

REACH = "out of reach: on the path a leg reaches the end of its working mode"
PARALLEL = (
    "a parallel singularity (type 2) lies on the path, where the given coordinates no longer "
    "hold the tool"
)
CONTRADICT = (
    "the given coordinates contradict one another or the joints: no pose near the path has them"
)
SPECIAL = (
    "home is a special position, such as links in one line or a flat parallelogram, where the "
    "joints allow motions that end at once or split into branches: give a home beside it, or "
    "coordinates of further joints that name the branch"
)
LOST = "the path was not followed to its end within the steps allowed"


class Walk:
    """Poses on their way, each at its own share of it."""

    shortest = SHORTEST
    #: Poses, or steps of a single one, from which on compiled steps are worth their load time.
    few = 64

    length: float
    joint: Indices
    direction: Indices
    asked: NDArray[np.bool_]
    order: Indices
    held_rows: int
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
        like: Walk | None = None,
    ) -> None:
        count = wanted.poses
        self.joints, self.given, self.rotation = joints, wanted, rotation
        self.length = characteristic_length(joints.home) if like is None else like.length
        self.bodies = joints.start(count)
        self.coordinates = np.zeros((count, len(joints.names)))
        self.share, self.stride = np.zeros(count), np.ones(count)
        self.error = np.zeros(count)
        self.steps = np.zeros(count, dtype=np.intp)
        self.status = np.zeros(count, dtype=np.int8)
        self.reasons: list[str] = []
        self.active = np.ones(count, dtype=bool)
        # the ground's tool never moves: what it is asked depends on nothing and is refused
        self.tool_body = joints.linkage.tool_body if self._tool_directions else -1
        if like is None:
            self._rows_at_home(lenient=lenient)
        else:
            # of the same linkage, asked the same: the same rows
            self.joint, self.direction, self.asked = like.joint, like.direction, like.asked
            self.order, self.held_rows, self.late = like.order, like.held_rows, like.late
            self.kept, self.independent, self.spins = like.kept, like.independent, like.spins
        # of each pose: rows that are independent at home may depend on each other elsewhere
        self.rows = np.tile(self.kept, (count, 1))
        self.passes = 0
        self.quick = self._quickly() if count >= self.few else None

    def _rows_at_home(self, *, lenient: bool) -> None:
        joints, wanted = self.joints, self.given
        held = np.argwhere(joints.held)
        self.asked, self.order = row_selection(joints.held.shape, wanted.joint, wanted.direction)
        self.joint, self.direction = held[:, 0], held[:, 1]
        self.spins = Spins.of(joints, self.tool_body)
        _, matrix = self.system(np.zeros(1, dtype=np.intp), joints.start(1), np.zeros(1))
        self.kept, self.independent = independent_rows(matrix[0], len(held))
        self.held_rows = len(held)
        # what follows from the rest of what is given agrees at the target, not on the straight way
        late = np.setdiff1d(np.arange(self.held_rows, len(matrix[0])), self.kept)
        self.late = late if wanted.tool is None else late[:0]
        if not (self.independent or lenient):
            refuse_dependent(matrix[0], len(held), wanted)

    def _quickly(self) -> QuickStep | None:
        """Compiled steps, where there are as many rows as unknowns."""
        if (
            len(self.given.joint)
            or len(self.late)
            or len(self.kept) != 6 * self.bodies.position.shape[1]
        ):
            return None
        rules = (SHRINK, FARTHEST, CLOSED, ROUNDING, 1e-6, CORRECTIONS, ELSE * CLOSED)
        return QuickStep.of(self.joints, self.rotation, self.length, rules)

    def go(self, poses: Indices) -> None:
        """Walk until each of some poses has arrived or its way has ended.

        Parameters
        ----------
        poses : (k,) of int
        """
        for _ in range(MOST):
            at = poses[self.active[poses]]
            if not at.size:
                return
            self._step(at)
        self._end(poses[self.active[poses]], LOST)

    def placed(self) -> tuple[Array, Array]:
        """Node positions and joint frames, (p, n, 3) and (p, j, 3, 3)."""
        if self.quick is not None:
            return self.joints.place_compiled(self.bodies)
        positions, frames, _ = self.joints.place(self.bodies)
        return positions, frames

    def _step(self, at: Indices) -> None:
        self.steps[at] += 1
        self.passes += 1
        # a few poses may go a long way, as those that end at a singularity do
        if self.passes == self.few and self.quick is None:
            self.quick = self._quickly()
        share = np.minimum(self.share[at] + self.stride[at], 1.0)
        if self.quick is None:
            bodies, good, error, near = self._newton(at, share)
            done = at[good]
            _, _, gaps = self.joints.place(bodies[good])
            self.coordinates[done] = self._coordinates(bodies[good], gaps, near[good])
        else:
            bodies, good, error = self.quick.newton(
                self.bodies[at], self.rows[at], self._goals(at, share)
            )
            done = at[good]
            self.coordinates[done] = self.quick.coordinates(bodies[good], self.coordinates[done])
        self.bodies.position[done] = bodies.position[good]
        self.bodies.rotation[done] = bodies.rotation[good]
        self.share[done], self.error[done] = share[good], self.length * error[good]
        self.stride[done] *= 2.0
        self.active[done[self.share[done] >= 1.0]] = False
        failed = at[~good]
        self.stride[failed] = 0.5 * np.minimum(self.stride[failed], 1.0 - self.share[failed])
        ended = failed[self.stride[failed] < self.shortest]
        if ended.size:
            self._give_up(ended)

    def _newton(
        self, at: Indices, share: Array
    ) -> tuple[BodyPoses, NDArray[np.bool_], Array, Array]:
        """Bodies at a share of the way, where a step holds, its gaps, and coordinates nearby."""
        bodies = self.bodies[at]
        bodies = BodyPoses(bodies.position.copy(), bodies.rotation.copy())
        going, good = np.arange(at.size), np.zeros(at.size, dtype=bool)
        error = np.full(at.size, np.inf)
        before = np.full(at.size, np.inf)
        near = self.coordinates[at]
        first: Array | None = None
        for _ in range(CORRECTIONS):
            left, matrix = self.system(at[going], bodies[going], share[going], near[going])
            rows = self.rows[at[going]]
            matrix = np.take_along_axis(matrix, rows[..., None], axis=1)
            open_ = np.take_along_axis(left, rows, axis=1)
            if first is None:
                first = matrix
            left[np.ix_(share[going] < 1.0, self.late)] = 0.0
            whole = np.abs(left).max(axis=-1, initial=0.0)
            size = np.abs(open_).max(axis=-1, initial=0.0)
            error[going] = whole
            # rounding reached, or a whole correction after the gaps had closed
            closed = (size <= ROUNDING) | ((size <= CLOSED) & (before[going] <= 1e-6))
            there = going[closed]
            good[there] = (whole[closed] <= ELSE * CLOSED) & _alike(first[there], matrix[closed])
            going, open_, matrix = going[~closed], open_[~closed], matrix[~closed]
            change = -_least(matrix, open_)
            norm = np.abs(change).max(axis=-1, initial=0.0)
            blocks = change.reshape(len(going), bodies.position.shape[1], 6)
            far = norm
            if self.spins is not None:
                others = self.spins.others(bodies[going], blocks)
                far = np.abs(others).max(axis=(1, 2), initial=0.0)
            fits = (far <= FARTHEST) & ((norm <= SHRINK * before[going]) | (norm <= 1e-9))
            going = going[fits]
            if not going.size:
                break
            before[going] = norm[fits]
            blocks = blocks[fits]
            if self.spins is not None:
                near[going[:, None], self.spins.column] += self.spins.foreseen(
                    bodies[going], blocks
                )
            bodies.position[going] += self.length * blocks[..., :3]
            bodies.rotation[going] = rotation_matrix(blocks[..., 3:]) @ bodies.rotation[going]
        return bodies, good, error, near

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
        unit = np.tile(np.repeat([self.length, 1.0], 3), matrix.shape[-1] // 6)
        return open_ * over, matrix * over[:, None] * unit

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

    def _give_up(self, at: Indices) -> None:
        """End poses whose steps have become too short, with the reason."""
        _, matrix = self.system(at, self.bodies[at], self.share[at])
        rows = self.rows[at]
        values = np.linalg.svd(np.take_along_axis(matrix, rows[..., None], 1), compute_uv=False)
        anew = spanning_rows(matrix, self.kept, self.held_rows)
        other = np.linalg.svd(np.take_along_axis(matrix, anew[..., None], 1), compute_uv=False)
        # rows that do not stand better change nothing: the way ends
        better = other[:, -1] * values[:, 0] > BETTER * values[:, -1] * other[:, 0]
        self.rows[at[better]] = anew[better]
        self.stride[at[better]] = np.minimum(RESTART, 1.0 - self.share[at[better]])
        at, values = at[~better], values[~better]
        singular = values[:, -1] <= SINGULAR * values[:, 0]
        # all but at the target, where what follows from the rest is open by more than the way left
        left, _ = self.system(at, self.bodies[at], np.ones(len(at)))
        other_open = np.abs(left[:, self.late]).max(axis=1, initial=0.0) > OPEN
        singular &= ~((self.share[at] > 1.0 - OPEN) & other_open)
        tool = bool(self._tool_directions)
        self._end(at[singular], REACH if tool else PARALLEL)
        # what home allows to first order and not beside it: rows were lost at home alone
        special = ~singular & (self.share[at] < BESIDE) & self.independent
        self._end(at[special], SPECIAL)
        self._end(at[~singular & ~special], CONTRADICT + self._follows())

    def _follows(self) -> str:
        """Which of more coordinates than there are freedoms follow from those before them."""
        if self.independent or self.given.tool is not None:
            return ""
        names = [*self.given.names, *(DIRECTIONS[d] for d in self.given.task)]
        free = len(self.kept[self.kept >= self.held_rows])
        late = set(range(len(names))) - set((self.kept - self.held_rows).tolist())
        words = ", ".join(names[k] for k in sorted(late))
        return (
            f"; {len(names)} coordinates are given for {free} freedoms, and {words} "
            f"follow{'s' * (len(late) == 1)} from the others: omit {len(late)} of them"
        )

    def _end(self, at: Indices, reason: str) -> None:
        if not at.size:
            return
        if reason not in self.reasons:
            self.reasons.append(reason)
        self.status[at] = self.reasons.index(reason) + 1
        self.active[at] = False


def _alike(before: Array, after: Array) -> NDArray[np.bool_]:
    """Whether rows span their space with one sense, (k, r, n) twice, (k).

    Two branches that part at a singularity have determinants of opposite sign: a step that slips
    from one to the other shows there.
    """
    sign, _ = np.linalg.slogdet(after @ np.swapaxes(before, -1, -2))
    return np.asarray(sign > 0)


def _least(matrix: Array, right: Array) -> Array:
    """Smallest x with A x = b, (k, r, n) and (k, r), for independent rows."""
    if matrix.shape[1] == matrix.shape[2]:
        square, vector = matrix, right[..., None]
        return np.asarray(_solve(square, vector)[..., 0])
    across = np.swapaxes(matrix, -1, -2)
    return np.asarray((across @ _solve(matrix @ across, right[..., None]))[..., 0])


def _solve(matrix: Array, right: Array) -> Array:
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        # one matrix without an inverse must not end the others: its step is refused
        found = np.full(right.shape, np.inf)
        for k in range(len(matrix)):
            try:
                found[k] = np.linalg.solve(matrix[k], right[k])
            except np.linalg.LinAlgError:
                continue
        return found
