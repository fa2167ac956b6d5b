"""What a trajectory asks of a machine's drives, and which of their limits it exceeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics.coordinates import Coordinates, Name, completed
from strutwork.kinematics.dynamics import STANDARD_GRAVITY, Dynamics
from strutwork.kinematics.following import Followed, follow
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.trajectory import Trajectory, roughness, sampled
from strutwork.machines.limits import SLACK
from strutwork.machines.model import Model
from strutwork.msa.body_mass import body_masses, stretched_parts
from strutwork.studies.progress import Progress

Array = NDArray[Any]

#: Rate at an end of the path, as a share of the largest, below which it begins or ends at rest.
REST = 1e-6
#: Moment that would hold a body from spinning, as a share of the largest moment of inertia forces.
QUIET = 1e-9


@dataclass(frozen=True)
class Samples:
    """A trajectory as a table.

    Parameters
    ----------
    times : (k,)
        s.
    values, rates, changes : mapping of (joint, direction) to (k,)
        Coordinates and their first and second derivatives, SI; the joint is empty for the tool.
        Derivatives are of all coordinates or of none.
    """

    times: Array
    values: Mapping[Name, Array]
    rates: Mapping[Name, Array] = field(default_factory=dict)
    changes: Mapping[Name, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class DriveLimit:
    """What one drive can do, m/s, m/s², N and W, or rad and N·m; None where it is not known."""

    speed: float | None = None
    acceleration: float | None = None
    force: float | None = None
    power: float | None = None


@dataclass(frozen=True)
class Peak:
    """The largest magnitude of a quantity of a drive, and when.

    Parameters
    ----------
    value : float
        SI.
    time : float
        s.
    limit : float or None
    """

    value: float
    time: float
    limit: float | None = None

    @property
    def exceeded(self) -> bool:
        """Whether it is beyond its limit."""
        return self.limit is not None and self.value > self.limit


@dataclass(frozen=True)
class DriveDemand:
    """What a trajectory asks of one drive.

    Parameters
    ----------
    joint, direction : str
    low, high : float
        Of its coordinate, m or rad.
    speed, acceleration, force, power : Peak
    rms_force : float
        Root of the mean square over time, N or N·m.
    """

    joint: str
    direction: str
    low: float
    high: float
    speed: Peak
    acceleration: Peak
    force: Peak
    power: Peak
    rms_force: float

    @property
    def label(self) -> str:
        """`joint:direction`."""
        return f"{self.joint}:{self.direction}"


@dataclass(frozen=True)
class OutOfRange:
    """A joint coordinate that leaves its range.

    Parameters
    ----------
    label : str
        `joint:direction`.
    turning : bool
    value, bound : float
        Furthest, and the end of the range, m or rad.
    first, time : float
        When it leaves it, and when it is furthest, s.
    """

    label: str
    turning: bool
    value: float
    bound: float
    first: float
    time: float


@dataclass(frozen=True)
class TrajectoryStudy:
    """A machine along a trajectory.

    Parameters
    ----------
    title : str
    trajectory : Trajectory
    followed : Followed
    demands : tuple of DriveDemand
    ranges : tuple of OutOfRange
    held : mapping of label to float
        Coordinates that were not given and stay as at home, m or rad.
    notes : tuple of str
        What a reader of the numbers must know.
    """

    title: str
    trajectory: Trajectory
    followed: Followed
    demands: tuple[DriveDemand, ...]
    ranges: tuple[OutOfRange, ...]
    held: Mapping[str, float]
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<TrajectoryStudy {self.title!r}: {self.trajectory!r}>"


def model_gravity(model: Model) -> tuple[float, float, float]:
    """The gravity that the model's load cases state, else the standard one along −z, m/s²."""
    stated = [case.gravity for case in model.cases if case.gravity is not None]
    return stated[0] if stated else STANDARD_GRAVITY


def trajectory_of(model: Model, samples: Samples) -> tuple[Trajectory, dict[Name, float]]:
    """A trajectory of all freedoms of a machine, and what was not given and stays.

    Raises
    ------
    ModelError
        Coordinates that do not exist, cannot move or depend on each other, or samples that are
        no trajectory.
    """
    asked = Coordinates(
        tuple(d for d in DIRECTIONS if ("", d) in samples.values),
        tuple(pair for pair in samples.values if pair[0]),
    )
    coordinates, added = completed(model.motion, asked)

    def table(columns: Mapping[Name, Array], still: Mapping[Name, float] | None) -> Array | None:
        if not columns:
            return None
        rest = added if still is None else still
        parts = [
            np.broadcast_to(columns[name] if name in columns else rest[name], samples.times.shape)
            for name in coordinates.names
        ]
        return np.stack(parts, axis=-1)

    none = dict.fromkeys(coordinates.names, 0.0)
    values = table(samples.values, None)
    path = sampled(
        coordinates,
        samples.times,
        np.zeros((len(samples.times), 0)) if values is None else values,
        table(samples.rates, none),
        table(samples.changes, none),
    )
    return path, added


def study_trajectory(
    model: Model,
    samples: Samples,
    *,
    gravity: ArrayLike | None = None,
    limits: Mapping[Name, DriveLimit] | None = None,
    reactions: bool = False,
    progress: Progress | None = None,
) -> TrajectoryStudy:
    """Follow a trajectory with rigid bodies and hold it against the limits of drives and joints.

    Parameters
    ----------
    model : Model
        Its densities and point masses say what its bodies weigh, at home.
    samples : Samples
    gravity : (3,), optional
        m/s²; default `model_gravity`.
    limits : mapping of (joint, direction) to DriveLimit, optional
        In place of the model's, each where it is given.
    reactions : bool
        Whether joint reactions are wanted.
    progress : callable, optional

    Raises
    ------
    ModelError
        No mass, no drive, wrong samples, or reactions that are not determined.
    UnreachableError, SingularPoseError, NumericalError
        As `follow`.
    """
    path, added = trajectory_of(model, samples)
    masses = body_masses(model.structure.at(model.placement))
    pull = model_gravity(model) if gravity is None else gravity
    dynamics = Dynamics(model.motion, masses, path.coordinates, pull)
    followed = follow(dynamics, path, reactions=reactions, progress=progress)
    found = _limits(model, limits or {})
    held = {(f"{j}:{d}" if j else d): value for (j, d), value in added.items()}
    return TrajectoryStudy(
        model.title,
        path,
        followed,
        _demands(followed, found),
        _ranges(model, followed),
        held,
        tuple(_notes(model, samples, followed, path)),
    )


def _limits(model: Model, given: Mapping[Name, DriveLimit]) -> dict[Name, DriveLimit]:
    stated = {(d.joint, d.direction): d for d in model.drives}
    result = {}
    for pair in model.structure.linkage.driven:
        own, other = given.get(pair, DriveLimit()), stated.get(pair)
        speed = other.speed if other is not None else None
        force = other.force if other is not None else None
        result[pair] = DriveLimit(
            own.speed if own.speed is not None else speed,
            own.acceleration,
            own.force if own.force is not None else force,
            own.power,
        )
    return result


def _demands(
    followed: Followed, limits: Mapping[Name, DriveLimit]
) -> tuple[DriveDemand, ...]:
    def peak(values: Array, limit: float | None) -> Peak:
        first = int(np.argmax(np.abs(values)))
        return Peak(float(abs(values[first])), float(followed.times[first]), limit)

    pairs = followed.dynamics.motion.linkage.driven
    rms = followed.rms_forces
    return tuple(
        DriveDemand(
            *pair,
            float(followed.drives[:, k].min()),
            float(followed.drives[:, k].max()),
            peak(followed.speeds[:, k], limits[pair].speed),
            peak(followed.accelerations[:, k], limits[pair].acceleration),
            peak(followed.forces[:, k], limits[pair].force),
            peak(followed.powers[:, k], limits[pair].power),
            float(rms[k]),
        )
        for k, pair in enumerate(pairs)
    )


def _ranges(model: Model, followed: Followed) -> tuple[OutOfRange, ...]:
    names = model.motion.joints.names
    found = []
    for limit in model.limits:
        pair = (limit.joint, limit.coordinate)
        if pair not in names:
            # a coordinate of the machine's own formulas
            continue
        values = followed.joint_values[:, names.index(pair)]
        beyond = np.maximum(values - limit.high, limit.low - values)
        worst = int(np.argmax(beyond))
        if beyond[worst] <= SLACK:
            continue
        first = int(np.argmax(beyond > SLACK))
        high = bool(values[worst] > limit.high)
        found.append(
            OutOfRange(
                f"{limit.joint}:{limit.coordinate}",
                limit.coordinate.startswith("r"),
                float(values[worst]),
                limit.high if high else limit.low,
                float(followed.times[first]),
                float(followed.times[worst]),
            )
        )
    return tuple(found)


def _notes(
    model: Model, samples: Samples, followed: Followed, path: Trajectory
) -> list[str]:
    dynamics, linkage = followed.dynamics, model.structure.linkage
    notes = []
    if not samples.rates:
        values = path.at(path.times)[0]
        notes += [str(one) for one in roughness(path.coordinates, path.times, values)]
    rates = np.abs(path.at(path.times)[1])
    quick = rates.max(axis=0, initial=0.0)
    moving = np.any(rates[[0, -1]] > REST * quick + 1e-12, axis=1)
    for end, at_end in zip(("begins", "ends"), moving, strict=True):
        if at_end:
            notes.append(f"the path {end} in motion, not at rest")
    light = [
        name
        for name, mass in zip(linkage.body_names, dynamics.masses.mass, strict=True)
        if mass == 0.0
    ]
    if light:
        notes.append(f"without mass: {_listed(light)}")
    stretched = stretched_parts(model.structure)
    if stretched:
        notes.append(f"with the mass that they have at home: {_listed(stretched)}")
    left_out = [f"spring {s.name}" for s in model.structure.springs]
    moves = set(model.motion.joints.names)
    left_out += [
        f"damping of {j.name}"
        for j in linkage.joints
        if any(value and (j.name, d) in moves for d, value in j.damping.items())
    ]
    if left_out:
        notes.append(f"left out, as bodies are rigid and joints free of loss: {_listed(left_out)}")
    if dynamics.bodies.idle:
        notes.append(_idle_note(followed))
    drives, freedoms = len(linkage.driven), len(path.coordinates)
    if drives > freedoms:
        notes.append(
            f"{drives} drives for {freedoms} freedoms: forces are those of least norm, moments "
            f"over the machine's size of {dynamics.motion.length:.4g} m"
        )
    return notes


def _idle_note(followed: Followed) -> str:
    idle = _listed(followed.dynamics.bodies.idle)
    largest = np.abs(followed.spins).max(initial=0.0)
    scale = followed.dynamics.motion.length * np.abs(followed.forces).max(initial=0.0)
    text = f"not turning about their lines, as nothing turns them: {idle}"
    if largest > QUIET * scale:
        text += f"; {largest:.3g} N·m would start to turn one of them"
    return text


def _listed(names: Sequence[str], most: int = 6) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
