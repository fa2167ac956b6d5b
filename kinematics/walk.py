"""Newton's method along the way from home to many targets, each by steps of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.given import Given
from strutwork.kinematics.independent import spanning_rows
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.linear_step import alike, least
from strutwork.kinematics.quick_step import QuickStep
from strutwork.kinematics.turns import rotation_matrix
from strutwork.kinematics.walk_rows import WalkRows

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


class Walk(WalkRows):
    """Poses on their way, each at its own share of it."""

    shortest = SHORTEST
    #: Poses, or steps of a single one, from which on compiled steps are worth their load time.
    few = 64

    def __init__(
        self,
        joints: JointMotion,
        rotation: Array,
        wanted: Given,
        *,
        lenient: bool = False,
        like: Walk | None = None,
        of_many: int = 0,
    ) -> None:
        super().__init__(joints, rotation, wanted, lenient=lenient, like=like)
        count = wanted.poses
        self.bodies = joints.start(count)
        self.share, self.stride = np.zeros(count), np.ones(count)
        self.error = np.zeros(count)
        self.steps = np.zeros(count, dtype=np.intp)
        self.status = np.zeros(count, dtype=np.int8)
        self.reasons: list[str] = []
        self.active = np.ones(count, dtype=bool)
        # of each pose: rows that are independent at home may depend on each other elsewhere
        self.rows = np.tile(self.kept, (count, 1))
        self.passes = 0
        self.quick = self._quickly() if max(count, of_many) >= self.few else None

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
            good[there] = (whole[closed] <= ELSE * CLOSED) & alike(first[there], matrix[closed])
            going, open_, matrix = going[~closed], open_[~closed], matrix[~closed]
            change = -least(matrix, open_)
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
