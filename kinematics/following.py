"""Inverse dynamics along a trajectory, and the singularities that it must not meet."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, NumericalError, SingularPoseError, UnreachableError
from strutwork.kinematics.dynamics import DRIVEN, Dynamics, Forces, PlacedDynamics
from strutwork.kinematics.motion import Moved
from strutwork.kinematics.trajectory import Trajectory

Array = NDArray[Any]
Tell = Callable[[int, int], None]

#: Poses treated at once.
PIECE = 256
#: Poses of a trajectory, and hours that they may take.
LARGEST, HOURS = 2_000_000, 12.0
#: Poses by which the time is foreseen.
TRIAL = 32
#: Halvings of an interval in which a singularity lies.
HALVINGS = 40
#: Share of the largest `held` below which a least one is looked for between samples, how many
#: are, and share that counts as none.
NEAR, NEAREST, TOUCHED = 0.3, 8, 1e-6

SERIAL = "serial (type 1): a leg reaches the end of its working mode"
PARALLEL = "parallel (type 2): the drives do not hold the tool there"
BOTH = "serial and parallel at once (type 3)"


@dataclass(frozen=True)
class Followed:
    """What a trajectory asks of the drives.

    Parameters
    ----------
    dynamics : Dynamics
    times, weights : (n,)
        s, and the weights of integrals over time.
    values : (n, t)
        Of the coordinates, m and rad.
    drives, speeds, accelerations, forces, powers : (n, a)
        Coordinates of the drives, their derivatives, forces and powers, in SI.
    held : (n,)
        How well the drives hold the coordinates, as `PlacedDynamics.held`.
    kinetic, potential : (n,)
        Energies, J.
    spins : (n, k)
        As `Forces.spins`.
    reactions : (n, r) or None
        As `Forces.reactions`, where they were asked for.
    reaction_labels : tuple of str
    joint_values : (n, c)
        Coordinates of all joints, in the order of `Motion.joints.names`.
    """

    dynamics: Dynamics
    times: Array
    weights: Array
    values: Array
    drives: Array
    speeds: Array
    accelerations: Array
    forces: Array
    powers: Array
    held: Array
    kinetic: Array
    potential: Array
    spins: Array
    joint_values: Array
    reactions: Array | None = None
    reaction_labels: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<Followed: {len(self.times)} poses, {self.drives.shape[1]} drives>"

    @property
    def rms_forces(self) -> Array:
        """Root of the mean square of each drive's force over time, (a,), N or N·m."""
        return np.sqrt(self.weights @ self.forces**2 / self.weights.sum())

    @property
    def work(self) -> float:
        """Integral of the power of all drives over time, J."""
        return float(self.weights @ self.powers.sum(axis=1))

    @property
    def energy_change(self) -> float:
        """Kinetic and potential energy at the end less those at the start, J."""
        whole = self.kinetic + self.potential
        return float(whole[-1] - whole[0])

    @property
    def imbalance(self) -> float:
        """Work less change of energy, as a share of all work that goes in and out."""
        turned_over = float(self.weights @ np.abs(self.powers).sum(axis=1))
        gap = abs(self.work - self.energy_change)
        return gap / turned_over if turned_over > 0 else gap


def follow(
    dynamics: Dynamics,
    trajectory: Trajectory,
    *,
    wrench: ArrayLike = 0.0,
    reactions: bool = False,
    progress: Tell | None = None,
) -> Followed:
    """Forces and powers of the drives along a trajectory.

    At the samples of the trajectory and at four times between each two, so that integrals over
    time are those of a polynomial of degree 9 on each interval.

    Parameters
    ----------
    dynamics : Dynamics
        Of the trajectory's coordinates.
    trajectory : Trajectory
    wrench : (6,)
        That acts on the tool at its centre point, N and N·m, global axes.
    reactions : bool
        Whether joint reactions are wanted.
    progress : callable, optional
        Told how many poses of how many are done.

    Raises
    ------
    UnreachableError
        A pose that cannot be taken; names the time and the reason.
    SingularPoseError
        A singularity on the path; names the time and the kind.
    NumericalError
        The bodies jump between two poses, or more work than is done.
    ModelError
        Coordinates that are not the dynamics', no drive, too few drives, or reactions that are
        not determined.
    """
    if trajectory.coordinates != dynamics.coordinates:
        raise ModelError(
            "trajectory",
            f"gives {', '.join(trajectory.coordinates.labels)}; the dynamics are those of "
            f"{', '.join(dynamics.coordinates.labels)}.",
            "Give it the coordinates of the dynamics.",
        )
    if not dynamics.motion.linkage.driven:
        raise ModelError(
            "linkage", "has no driven direction.", "Mark the directions that drives move."
        )
    times, weights = trajectory.quadrature
    _require_time(dynamics, trajectory, times)
    parts: list[dict[str, Array]] = []
    labels: tuple[str, ...] = ()
    last: tuple[Array, ...] | None = None
    for first in range(0, len(times), PIECE):
        some = times[first : first + PIECE]
        moved, placed = _placed(dynamics, trajectory, some)
        _, rates, changes = trajectory.at(some)
        forces = placed.inverse(rates, changes, wrench)
        state = (
            some,
            placed.placed.sign,
            placed.drive_sign,
            placed.placed.points,
            forces.twists.reshape(len(some), -1, 6)[..., :3],
        )
        if last is not None:
            state = tuple(np.concatenate([a, b]) for a, b in zip(last, state, strict=True))
        _check_way(dynamics, trajectory, *state)
        last = tuple(part[-1:] for part in state)
        parts.append(_collected(trajectory, some, moved, placed, forces, reactions=reactions))
        labels = forces.reaction_labels if reactions else ()
        if progress is not None:
            progress(first + len(some), len(times))
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    turning = np.array([d.startswith("r") for _, d in dynamics.motion.linkage.driven])
    joined["drives"][:, turning] = np.unwrap(joined["drives"][:, turning], axis=0)
    _check_touched(dynamics, trajectory, times, joined["held"])
    return Followed(dynamics, times, weights, reaction_labels=labels, **joined)


def move_along(dynamics: Dynamics, trajectory: Trajectory, times: ArrayLike) -> Moved:
    """The linkage at times of a trajectory; poses that it cannot take are marked."""
    values = trajectory.at(times)[0]
    names = trajectory.coordinates.names
    task = {d: values[:, k] for k, (joint, d) in enumerate(names) if not joint}
    joints = {pair: values[:, k] for k, pair in enumerate(names) if pair[0]}
    return dynamics.motion.move(task=task or None, joints=joints or None)


def fastest(followed: Followed, limits: ArrayLike) -> float:
    """Factor on the duration of a trajectory at which its drives just keep speed limits.

    Speeds go with one over the duration whatever the path.

    Parameters
    ----------
    followed : Followed
    limits : (a,)
        m/s or rad/s; infinite where there is none.

    Raises
    ------
    ModelError
        A limit that is not positive, or one a drive too few.
    """
    allowed = np.asarray(limits, dtype=float)
    if allowed.shape != followed.speeds.shape[1:] or not np.all(allowed > 0):
        raise ModelError(
            "speed limits", "are not one positive number a drive.", "Give m/s or rad/s, or inf."
        )
    return float((np.abs(followed.speeds) / allowed).max(initial=0.0))


def _placed(
    dynamics: Dynamics, trajectory: Trajectory, times: Array
) -> tuple[Moved, PlacedDynamics]:
    moved = move_along(dynamics, trajectory, times)
    bad = np.flatnonzero(~moved.reached)
    if bad.size:
        first = int(bad[0])
        raise UnreachableError(
            f"trajectory at t = {times[first]:.6g} s",
            f"cannot be taken: {moved.placement.reason(first)}.",
            "Keep the path within reach of the machine.",
        )
    placed = dynamics.bodies.at(moved)
    lost = np.flatnonzero(placed.singular)
    if lost.size:
        raise _singular(float(times[lost[0]]), SERIAL)
    return moved, PlacedDynamics(dynamics, placed)


def _collected(
    trajectory: Trajectory,
    times: Array,
    moved: Moved,
    placed: PlacedDynamics,
    forces: Forces,
    *,
    reactions: bool,
) -> dict[str, Array]:
    held = placed.held
    # with fewer drives than freedoms the forces themselves tell whether the drives suffice
    if placed.drive_map.shape[-2] >= placed.drive_map.shape[-1] and np.any(held <= DRIVEN):
        raise _singular(float(times[int(np.argmin(held))]), PARALLEL)
    values, rates, _ = trajectory.at(times)
    pairs = placed.of.motion.linkage.driven
    names = placed.of.motion.joints.names
    found = {
        "values": values,
        "drives": moved.placement.values[:, [names.index(pair) for pair in pairs]],
        "speeds": forces.rates_of_drives,
        "accelerations": forces.accelerations_of_drives,
        "forces": forces.drives,
        "powers": forces.powers,
        "held": held,
        "kinetic": placed.kinetic(rates),
        "potential": placed.potential,
        "spins": forces.spins,
        "joint_values": moved.placement.values,
    }
    return found | ({"reactions": forces.reactions} if reactions else {})


def _singular(when: float, kind: str) -> SingularPoseError:
    return SingularPoseError(
        f"trajectory at t = {when:.6g} s",
        f"passes through a singularity, {kind}.",
        "Lead the path round it.",
    )


def _check_way(
    dynamics: Dynamics,
    trajectory: Trajectory,
    times: Array,
    sign: Array,
    driven: Array,
    points: Array,
    speeds: Array,
) -> None:
    """No singularity and no jump between neighbouring poses."""
    # the drives' rates per coordinate change sense at both kinds, the rows alone at serial ones
    serial, parallel = np.diff(sign) != 0, np.diff(sign * driven) != 0
    crossed = np.flatnonzero(serial | parallel)
    if crossed.size:
        k = int(crossed[0])
        kind = BOTH if serial[k] and parallel[k] else SERIAL if serial[k] else PARALLEL
        raise _singular(_bisected(dynamics, trajectory, times[k], times[k + 1]), kind)
    span = np.diff(times)[:, None]
    gap = np.diff(points, axis=0) - span[..., None] * (speeds[1:] + speeds[:-1]) / 2.0
    pace = np.linalg.norm(speeds, axis=-1)
    allowed = span * (pace[1:] + pace[:-1]) / 2.0 + 1e-6 * dynamics.motion.length
    jump = np.argwhere(np.linalg.norm(gap, axis=-1) > allowed)
    if len(jump):
        k, body = (int(i) for i in jump[0])
        raise NumericalError(
            f"trajectory between t = {times[k]:.6g} s and {times[k + 1]:.6g} s",
            f"jumps: {dynamics.motion.linkage.body_names[body]} would have to change to another "
            "assembly or working mode, or the samples are too far apart.",
            "Give more samples, or keep the path on one branch.",
        )


def _bisected(dynamics: Dynamics, trajectory: Trajectory, low: float, high: float) -> float:
    """Time between two at which a sign changes."""
    wanted = _signs(dynamics, trajectory, low)
    for _ in range(HALVINGS):
        middle = (low + high) / 2.0
        found = _signs(dynamics, trajectory, middle)
        if found is None:
            return middle
        low, high = (middle, high) if found == wanted else (low, middle)
    return (low + high) / 2.0


def _signs(dynamics: Dynamics, trajectory: Trajectory, when: float) -> tuple[float, float] | None:
    moved = move_along(dynamics, trajectory, [when])
    if not moved.reached.all():
        return None
    placed = PlacedDynamics(dynamics, dynamics.bodies.at(moved))
    if placed.placed.singular.any():
        return None
    return float(placed.placed.sign[0]), float(placed.drive_sign[0])


def _check_touched(
    dynamics: Dynamics, trajectory: Trajectory, times: Array, held: Array
) -> None:
    """No singularity that the path touches between two poses without changing sides."""
    # imported late: it takes a third of a small command's start
    from scipy.optimize import minimize_scalar  # noqa: PLC0415

    padded = np.concatenate([[np.inf], held, [np.inf]])
    least = np.flatnonzero((held <= padded[:-2]) & (held <= padded[2:]) & (held < NEAR * held.max()))
    near = least[np.argsort(held[least])][:NEAREST]

    def hold(when: float) -> float:
        moved = move_along(dynamics, trajectory, [when])
        if not moved.reached.all():
            return 0.0
        placed = dynamics.bodies.at(moved)
        return 0.0 if placed.singular.any() else float(PlacedDynamics(dynamics, placed).held[0])

    for k in near:
        low, high = times[max(k - 1, 0)], times[min(k + 1, len(times) - 1)]
        found = minimize_scalar(
            hold, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * (high - low)}
        )
        if found.fun < TOUCHED * held.max():
            raise _singular(float(found.x), PARALLEL)


def _require_time(dynamics: Dynamics, trajectory: Trajectory, times: Array) -> None:
    """Refuse a trajectory that is foreseen to take too long or too much memory."""
    count = len(times)
    if count <= 20 * PIECE:
        return
    trial = times[np.linspace(0, count - 1, TRIAL).astype(int)]
    begun = time.perf_counter()
    _, rates, changes = trajectory.at(trial)
    _ = _placed(dynamics, trajectory, trial)[1].inverse(rates, changes).coordinates
    hours = (time.perf_counter() - begun) / TRIAL * count / 3600.0
    columns = len(dynamics.motion.joints.names) + 6 * len(dynamics.motion.linkage.driven) + 12
    gigabytes = 8e-9 * count * columns
    if count > LARGEST or hours > HOURS:
        raise ModelError(
            "trajectory",
            f"has {count:,} poses; they would take about {hours:.2g} hours and {gigabytes:.2g} GB.",
            f"Take fewer samples: {LARGEST:,} poses or {HOURS:g} hours are the most.",
        )
