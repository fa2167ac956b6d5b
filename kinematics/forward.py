"""Forward kinematics: the pose of given drive coordinates, followed along one branch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import (
    ModelError,
    NumericalError,
    SingularPoseError,
    StrutworkError,
    UnreachableError,
)
from strutwork.kinematics.jacobians import jacobians
from strutwork.kinematics.mechanism import Mechanism, Poses, drive_values

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: A step may change the Jacobian by this share of itself. Below one the drives' coordinates tell
#: all poses on the way apart (by the mean value theorem), so no other branch can be met.
CHANGE = 0.3
#: What a step may leave of the drives' way it was to make.
LEFT = 0.25
#: Longest step of the tool: turn, rad, and shift as a share of the machine's size.
TURN, SHIFT = 0.2, 0.2
#: Shortest step, as a share of the whole way.
SHORTEST = 1e-9

SINGULAR_PARALLEL = (
    "a parallel singularity lies on the path: there the drives do not hold the tool, and other "
    "assembly modes begin"
)
SINGULAR_SERIAL = (
    "a serial singularity lies on the path: there a leg reaches the end of its working mode"
)
NOT_CONVERGED = "the path was not followed to its end within the steps allowed"
CONTRADICT = "the drive coordinates contradict one another: no pose near the path has them"
NOT_FINITE = "a drive coordinate is not finite"
AT_START = "the start cannot be reached"
START_SINGULAR = "the start is a singular pose, from which no branch can be followed"


@dataclass(frozen=True)
class FoundPoses(Poses):
    """Poses of forward kinematics, with the reasons for missing ones.

    Parameters
    ----------
    position, rotation : (..., 3), (..., 3, 3)
        As in `Poses`; not a number where there is none.
    status : (...) of int
        0 where the pose was found, else 1 + index into `reasons`.
    reasons : tuple of str
        Why a pose was not found.
    reached : (...)
        Share of the way from the start on which the branch was followed; 1 where found.
    steps : (...) of int
        Steps made.
    """

    status: NDArray[np.int16]
    reasons: tuple[str, ...]
    reached: Array
    steps: NDArray[np.intp]

    def __post_init__(self) -> None:
        Poses(self.position[self.found], self.rotation[self.found])

    def __repr__(self) -> str:
        good = int(np.count_nonzero(self.found))
        return f"<FoundPoses: {self.found.size} poses, {good} found, positions in m>"

    @property
    def found(self) -> Mask:
        """True where the pose was found, (...)."""
        return np.asarray(self.status == 0)

    def reason(self, index: int | tuple[int, ...]) -> str:
        """Why no pose was found at `index`, and how far the branch went; empty where it was.

        Parameters
        ----------
        index : int or tuple of int
            Of a pose in the batch; () for a single one.
        """
        code = int(self.status[index])
        if not code:
            return ""
        return f"{self.reasons[code - 1]} (followed for {100 * float(self.reached[index]):.3g} %)"

    def require_found(self) -> Poses:
        """The poses when every one was found.

        Raises
        ------
        UnreachableError, SingularPoseError, NumericalError
            Names the first that was not, with the reason.
        """
        bad = np.argwhere(~self.found)
        if not len(bad):
            return Poses(self.position, self.rotation)
        first = tuple(int(i) for i in bad[0])
        where = f", pose {first[0] if len(first) == 1 else first}" if first else ""
        code = int(self.status[first])
        raise _kind(self.reasons[code - 1])(
            f"forward kinematics{where}",
            f"{self.reason(first)}; {len(bad)} of {self.status.size} poses were not found.",
            "Start closer to the pose, on its side of the singularity, go there through other "
            "poses, or check that the drive coordinates can be reached.",
        )

    def __getitem__(self, index: Any) -> FoundPoses:
        return FoundPoses(
            self.position[index],
            self.rotation[index],
            np.asarray(self.status[index]),
            self.reasons,
            np.asarray(self.reached[index]),
            np.asarray(self.steps[index]),
        )


def forward_kinematics(
    mechanism: Mechanism,
    values: ArrayLike,
    start: Poses,
    tolerance: float = 1e-12,
    iterations: int = 1000,
) -> FoundPoses:
    """Poses at which the drives have the given coordinates, on the branch of `start`.

    The drives go from their coordinates at `start` to those wanted along a straight line, a
    turning drive the shorter way round, and the tool follows. A step, made by the Jacobian at
    its beginning, counts only where the Jacobian at its end is nearly the same; otherwise it is
    halved. So the assembly mode never changes: where the line meets a singularity, beyond which
    it would, the pose is not found, although another way may lead to it. All poses of a batch
    go at once, each by steps of its own.

    Parameters
    ----------
    mechanism : Mechanism
    values : (..., a)
        Coordinates of the driven directions, m or rad.
    start : Poses
        Where the branches begin, broadcast against the batch of `values`.
    tolerance : float
        Largest residual of a drive coordinate, m or rad.
    iterations : int
        Most steps, those that were halved counted.

    Returns
    -------
    FoundPoses
        Poses that were not found are marked with a reason.

    Raises
    ------
    UnreachableError, SingularPoseError, NumericalError
        A single pose, without batch axes, that was not found.
    ModelError
        Coordinates that are not one for each drive.
    """
    target = np.asarray(values, dtype=float)
    drives = len(mechanism.linkage.driven)
    if target.ndim == 0 or target.shape[-1] != drives:
        raise ModelError(
            "forward kinematics",
            f"got drive coordinates of shape {target.shape} for {drives} drives.",
            "Give one coordinate per drive, in the order of the linkage's driven directions.",
        )
    batch = np.broadcast_shapes(target.shape[:-1], start.batch)
    count = int(np.prod(batch, dtype=int))
    walk = _Walk(
        mechanism,
        np.broadcast_to(target, (*batch, target.shape[-1])).reshape(count, target.shape[-1]),
        np.broadcast_to(start.position, (*batch, 3)).reshape(count, 3),
        np.broadcast_to(start.rotation, (*batch, 3, 3)).reshape(count, 3, 3),
        tolerance,
    )
    for _ in range(iterations):
        if not walk.step():
            break
    found = walk.result(batch)
    if batch == ():
        found.require_found()
    return found


class _Walk:
    """Poses on their way, each at its own share of it."""

    def __init__(
        self,
        mechanism: Mechanism,
        target: Array,
        position: Array,
        rotation: Array,
        tolerance: float,
    ) -> None:
        self.mechanism, self.target, self.tolerance = mechanism, target, tolerance
        self.position, self.rotation = position.copy(), rotation.copy()
        count, drives = target.shape
        self.rotary = np.array([d.startswith("r") for _, d in mechanism.linkage.driven])
        self.share = np.zeros(count)
        self.stride = np.ones(count)
        self.steps = np.zeros(count, dtype=np.intp)
        self.status = np.zeros(count, dtype=np.int16)
        self.reasons: list[str] = []
        self.active = np.ones(count, dtype=bool)
        self.blocked = np.zeros(count, dtype=np.int16)
        self._fail(np.flatnonzero(~np.isfinite(target).all(axis=-1)), NOT_FINITE)
        at = np.flatnonzero(self.active)
        placement = mechanism.place(self._poses(at))
        self.size = np.ones(count)
        self.drive = np.zeros((count, drives))
        self.inverse = np.zeros((count, drives, 6))
        self.forward = np.zeros((count, 6, drives))
        self.way = np.zeros((count, drives))
        for code in np.unique(np.asarray(placement.status)[~placement.reachable]):
            bad = at[np.asarray(placement.status) == code]
            self._fail(bad, f"{AT_START}: {placement.reasons[int(code) - 1]}")
        good = placement.reachable
        at = at[good]
        if not at.size:
            return
        found = jacobians(mechanism.linkage, placement[good])
        self.drive[at] = drive_values(mechanism, placement[good])
        self.inverse[at], self.forward[at], self.size[at] = (
            found.inverse,
            found.forward,
            found.length,
        )
        self._fail(at[found.singular], START_SINGULAR)
        self.way[at] = self._round(target[at] - self.drive[at])

    def _poses(self, at: NDArray[np.intp]) -> Poses:
        return Poses(self.position[at], self.rotation[at])

    def _round(self, difference: Array) -> Array:
        """Differences of drive coordinates; angles are compared on the circle."""
        return np.where(self.rotary, np.angle(np.exp(1j * difference)), difference)

    def _fail(self, at: NDArray[np.intp], reason: str) -> None:
        if not at.size:
            return
        if reason not in self.reasons:
            self.reasons.append(reason)
        self.status[at] = self.reasons.index(reason) + 1
        self.active[at] = False

    def step(self) -> bool:
        """One step of every pose on its way; False when none is left."""
        at = np.flatnonzero(self.active)
        if not at.size:
            return False
        self.steps[at] += 1
        share = np.minimum(self.share[at] + self.stride[at], 1.0)
        # what is left of the way is counted from its end, so that angles stay on the circle
        ahead = self._round(
            self.target[at] - self.drive[at] - self.way[at] * (1.0 - share)[:, None]
        )
        twist = np.einsum("pij,pj->pi", self.forward[at], ahead)
        short = self._longest(twist, self.size[at])
        twist = np.where(np.isfinite(twist) & short[:, None], twist, 0.0)
        trial = self._poses(at).moved(twist)
        placement = self.mechanism.place(trial)
        good = placement.reachable & short
        accepted = np.zeros(at.size, dtype=bool)
        change = np.full(at.size, np.inf)
        left = np.full(at.size, np.inf)
        k = np.flatnonzero(good)
        if k.size:
            found = jacobians(self.mechanism.linkage, placement[k])
            drive = drive_values(self.mechanism, placement[k])
            change[k] = self._change(at[k], found.inverse)
            rest = self._round(
                self.target[at[k]] - drive - self.way[at[k]] * (1.0 - share[k])[:, None]
            )
            size = self._size(ahead[k], at[k])
            rounding = 1e-14 * (1.0 + np.abs(drive).max(axis=-1, initial=0.0))
            left[k] = self._size(rest, at[k]) / np.maximum(size, rounding)
            met = np.abs(rest).max(axis=-1) <= self.tolerance
            accepted[k] = (change[k] <= CHANGE) & ((left[k] <= LEFT) | met)
            j = np.flatnonzero(accepted[k])
            i = at[k[j]]
            self.position[i], self.rotation[i] = trial.position[k[j]], trial.rotation[k[j]]
            self.drive[i], self.inverse[i] = drive[j], found.inverse[j]
            self.forward[i], self.size[i] = found.forward[j], found.length[j]
            self.share[i] = share[k[j]]
            done = np.zeros(at.size, dtype=bool)
            done[k] = met & (share[k] == 1.0) & accepted[k]
            self.active[at[done]] = False
        easy = accepted & (change < CHANGE / 3.0) & (left < LEFT / 3.0)
        self.stride[at] *= np.where(accepted, np.where(easy, 2.0, 1.0), 0.5)
        self.stride[at] = np.minimum(self.stride[at], 1.0)
        self._give_up(at, placement, short, ~accepted)
        return True

    def _longest(self, twist: Array, size: Array) -> Mask:
        shift = np.linalg.norm(twist[:, :3], axis=-1)
        turn = np.linalg.norm(twist[:, 3:], axis=-1)
        return np.asarray((shift <= SHIFT * size) & (turn <= TURN))

    def _size(self, rates: Array, at: NDArray[np.intp]) -> Array:
        """Size of differences of drive coordinates, m: angles at the arm of the machine."""
        size = np.linalg.norm(rates * np.where(self.rotary, self.size[at, None], 1.0), axis=-1)
        return np.asarray(size)

    def _change(self, at: NDArray[np.intp], inverse: Array) -> Array:
        """By how much the Jacobian differs from that of the step's beginning, as a share of it."""
        held = self.inverse[at] @ self.forward[at]
        with np.errstate(invalid="ignore"):
            difference = inverse @ self.forward[at] - held
        unit = np.where(self.rotary, self.size[at, None], 1.0)
        difference = difference * unit[:, :, None] / unit[:, None, :]
        norm = np.linalg.norm(difference, axis=(-2, -1))
        return np.where(np.isfinite(norm), norm, np.inf)

    def _give_up(self, at: NDArray[np.intp], placement: Any, short: Mask, refused: Mask) -> None:
        """End the poses whose steps have become too short, with the reason."""
        status = np.asarray(placement.status)
        tried = refused & short
        # the last word of the inverse kinematics on this pose's trial steps
        self.blocked[at] = np.where(tried, status, self.blocked[at] * refused)
        ended = self.stride[at] < SHORTEST
        if not ended.any():
            return
        for code in np.unique(self.blocked[at[ended]]):
            some = at[ended & (self.blocked[at] == code)]
            if code:
                self._fail(some, f"on the way, {placement.reasons[int(code) - 1]}")
                continue
            serial, far = self._nearest(some)
            self._fail(some[serial & ~far], SINGULAR_SERIAL)
            self._fail(some[~serial & ~far], SINGULAR_PARALLEL)
            self._fail(some[far], CONTRADICT)

    def _nearest(self, at: NDArray[np.intp]) -> tuple[Mask, Mask]:
        """Whether the singularity ahead is serial, and where there is none."""
        unit = np.where(self.rotary, self.size[at, None], 1.0)[:, :, None]
        scaled = self.inverse[at] * unit
        scaled[:, :, 3:] /= self.size[at, None, None]
        back = self.forward[at] / np.swapaxes(unit, -1, -2)
        back[:, 3:] *= self.size[at, None, None]
        rates, twists = (np.linalg.norm(m, axis=(-2, -1)) for m in (scaled, back))
        return rates > twists, np.maximum(rates, twists) < 30.0

    def result(self, batch: tuple[int, ...]) -> FoundPoses:
        """What was found; poses still on their way are given up."""
        self._fail(np.flatnonzero(self.active), NOT_CONVERGED)
        lost = self.status != 0
        position, rotation = self.position, self.rotation
        position[lost], rotation[lost] = np.nan, np.nan
        return FoundPoses(
            position.reshape(*batch, 3),
            rotation.reshape(*batch, 3, 3),
            self.status.reshape(batch),
            tuple(self.reasons),
            self.share.reshape(batch),
            self.steps.reshape(batch),
        )


def _kind(reason: str) -> type[StrutworkError]:
    if reason in (SINGULAR_PARALLEL, SINGULAR_SERIAL, START_SINGULAR):
        return SingularPoseError
    if reason in (NOT_CONVERGED, CONTRADICT, NOT_FINITE):
        return NumericalError
    return UnreachableError
