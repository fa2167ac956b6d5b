"""Inverse dynamics along a trajectory, and the singularities that it must not meet."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.drive_forces import DRIVEN, Forces, inverse_dynamics
from strutwork.kinematics.dynamics import Dynamics, PlacedDynamics
from strutwork.kinematics.motion import Moved
from strutwork.kinematics.path_checks import (
    PARALLEL,
    Way,
    check_touched,
    check_way,
    placed_along,
    singular_at,
)
from strutwork.kinematics.trajectory import Trajectory

Array = NDArray[Any]
Tell = Callable[[int, int], None]
#: From a function of a slice of the poses, how many there are and how many a piece has.
Pieces = Callable[
    [Callable[[slice], dict[str, Array]], int, int],
    Iterable[dict[str, Array]],
]

#: Names of what the parts of a way are called among the arrays of a piece.
WAY = ("way_times", "way_sign", "way_driven", "way_points", "way_speeds")

#: Poses treated at once, and bytes that their matrices may take.
PIECE, BYTES = 256, 4e8
#: Poses of a trajectory, and hours that they may take.
LARGEST, HOURS = 2_000_000, 12.0
#: Pace of a body, as a share of the largest, below which it stands: rounding.
STILL = 1e-12
#: Poses by which the time is foreseen.
TRIAL = 32


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
        Coordinates of the drives, m or rad, their derivatives by s, forces, N or N·m, and powers,
        W.
    held : (n,)
        How well the drives hold the coordinates, as `PlacedDynamics.held`: no unit.
    kinetic, potential : (n,)
        Energies, J.
    given_power : (n,)
        Power of the wrench that acts on the tool, W.
    spins : (n, k)
        As `Forces.spins`, N·m.
    reactions : (n, r) or None
        As `Forces.reactions`, N and N·m, where they were asked for.
    reaction_labels : tuple of str
    paces : (n, b)
        Largest component of each body's twist, m/s or rad/s.
    joint_values : (n, c)
        Coordinates of all joints, in the order of `Motion.joints.names`, m and rad.
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
    given_power: Array
    spins: Array
    paces: Array
    joint_values: Array
    reactions: Array | None = None
    reaction_labels: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<Followed: {len(self.times)} poses, {self.drives.shape[1]} drives>"

    @property
    def moves(self) -> NDArray[np.bool_]:
        """Bodies that move, (b,)."""
        largest = self.paces.max(axis=0)
        return np.asarray(largest > STILL * largest.max(initial=0.0))

    @property
    def moving_mass(self) -> float:
        """Of the bodies that move, kg."""
        return float(self.dynamics.masses.mass[self.moves].sum())

    @property
    def rms_forces(self) -> Array:
        """Root of the mean square of each drive's force over time, (a,), N or N·m."""
        return np.asarray(np.sqrt(self.weights @ self.forces**2 / self.weights.sum()))

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
        turned_over = float(
            self.weights @ (np.abs(self.powers).sum(axis=1) + np.abs(self.given_power))
        )
        gap = abs(self.work + float(self.weights @ self.given_power) - self.energy_change)
        return gap / turned_over if turned_over > 0 else gap


def follow(
    dynamics: Dynamics,
    trajectory: Trajectory,
    *,
    wrench: ArrayLike = 0.0,
    reactions: bool = False,
    progress: Tell | None = None,
    pieces: Pieces | None = None,
) -> Followed:
    """Forces and powers of the drives along a trajectory.

    At the samples of the trajectory and at four times between each two, so that integrals over
    time are those of a polynomial of degree 9 on each interval.

    Parameters
    ----------
    dynamics : Dynamics
        Of the trajectory's coordinates.
    trajectory : Trajectory
    wrench : (6,) or ()
        That acts on the tool at its centre point, N and N·m, global axes; 0 for none.
    reactions : bool
        Whether joint reactions are wanted.
    progress : callable, optional
        Called with the number of poses done and that of all.
    pieces : callable, optional
        Computes the pieces elsewhere: from their function, the number of poses and those of a
        piece to the arrays of each piece, in order; progress is then its own.

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
    last: Way | None = None
    computed = Piece(dynamics, trajectory, wrench, reactions)
    for part in (pieces or _here(progress))(computed, len(times), _piece(dynamics)):
        labels = tuple(part.pop("labels").tolist())
        way = Way(*(part.pop(name) for name in WAY))
        check_way(dynamics, trajectory, way if last is None else last.then(way))
        last = way.end
        parts.append(part)
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    turning = np.array([d.startswith("r") for _, d in dynamics.motion.linkage.driven])
    joined["drives"][:, turning] = np.unwrap(joined["drives"][:, turning], axis=0)
    check_touched(dynamics, trajectory, times, joined["held"])
    return Followed(dynamics, times, weights, reaction_labels=labels, **joined)


@dataclass(frozen=True)
class Piece:
    """Computes some poses of a trajectory by themselves; may be sent to other processes.

    Parameters
    ----------
    dynamics : Dynamics
    trajectory : Trajectory
    wrench : (6,) or ()
        N and N·m.
    reactions : bool
    """

    dynamics: Dynamics
    trajectory: Trajectory
    wrench: ArrayLike
    reactions: bool

    def __call__(self, items: slice) -> dict[str, Array]:
        """Arrays of `Followed` at some times, and of `Way` under `WAY`.

        Parameters
        ----------
        items : slice
            Of the times of `Trajectory.quadrature`.
        """
        some = self.trajectory.quadrature[0][items]
        moved, placed = placed_along(self.dynamics, self.trajectory, some)
        _, rates, changes = self.trajectory.at(some)
        forces = inverse_dynamics(placed, rates, changes, self.wrench)
        way = (
            some,
            placed.placed.sign,
            placed.drive_sign,
            placed.placed.points,
            forces.twists.reshape(len(some), -1, 6)[..., :3],
        )
        found = _collected(self.trajectory, some, moved, placed, forces, reactions=self.reactions)
        labels = np.array(forces.reaction_labels if self.reactions else (), dtype=np.str_)
        return found | dict(zip(WAY, way, strict=True)) | {"labels": labels}


def _here(progress: Tell | None) -> Pieces:
    """One piece after the other, in this thread."""

    def pieces(
        function: Callable[[slice], dict[str, Array]], count: int, size: int
    ) -> Iterator[dict[str, Array]]:
        for first in range(0, count, size):
            stop = min(first + size, count)
            yield function(slice(first, stop))
            if progress is not None:
                progress(stop, count)

    return pieces


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
        A limit that is not positive, or fewer than one per drive.
    """
    allowed = np.asarray(limits, dtype=float)
    if allowed.shape != followed.speeds.shape[1:] or not np.all(allowed > 0):
        raise ModelError(
            "speed limits", "are not one positive number per drive.", "Give m/s or rad/s, or inf."
        )
    return float((np.abs(followed.speeds) / allowed).max(initial=0.0))


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
        raise singular_at(trajectory, float(times[int(np.argmin(held))]), PARALLEL)
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
        "given_power": forces.given_power,
        "spins": forces.spins,
        "paces": np.abs(forces.twists).reshape(len(times), -1, 6).max(axis=-1),
        "joint_values": moved.placement.values,
    }
    return found | ({"reactions": forces.reactions} if reactions else {})


def within_speeds(
    dynamics: Dynamics, make: Callable[[float], Trajectory], limits: ArrayLike
) -> Trajectory:
    """The fastest of a family of trajectories whose drives keep speed limits.

    Parameters
    ----------
    dynamics : Dynamics
    make : callable
        From a duration, s, to a trajectory; all go the same way by the same time law.
    limits : (a,)
        m/s or rad/s; infinite where there is none, but not of every drive that moves.

    Raises
    ------
    ModelError
        No limit that bounds the speed, or as `follow` and `fastest`.
    """
    factor = fastest(follow(dynamics, make(1.0)), limits)
    if not (np.isfinite(factor) and factor > 0):
        raise ModelError(
            "speed limits", "bound no drive that moves.", "Give a limit of a drive that moves."
        )
    return make(factor)


def _piece(dynamics: Dynamics) -> int:
    """Poses treated at once: some six square matrices of all bodies' twists each."""
    size = 6.0 * len(dynamics.masses.mass)
    return max(1, min(PIECE, int(BYTES / (6 * 8 * size**2))))


def _require_time(dynamics: Dynamics, trajectory: Trajectory, times: Array) -> None:
    """Refuse a trajectory that is foreseen to take too long or too much memory."""
    count = len(times)
    if count <= 20 * _piece(dynamics):
        return
    tried = min(TRIAL, _piece(dynamics))
    trial = times[np.linspace(0, count - 1, tried).astype(int)]
    begun = time.perf_counter()
    _, rates, changes = trajectory.at(trial)
    placed = placed_along(dynamics, trajectory, trial)[1]
    _ = inverse_dynamics(placed, rates, changes).coordinates
    hours = (time.perf_counter() - begun) / tried * count / 3600.0
    columns = len(dynamics.motion.joints.names) + 6 * len(dynamics.motion.linkage.driven) + 12
    gigabytes = 8e-9 * count * columns
    if count > LARGEST or hours > HOURS:
        raise ModelError(
            "trajectory",
            f"has {count:,} poses; they would take about {hours:.2g} hours and {gigabytes:.2g} GB.",
            f"Use fewer samples: at most {LARGEST:,} poses or {HOURS:g} hours are allowed.",
        )
