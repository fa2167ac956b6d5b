"""What a trajectory asks of a machine's drives, and which of their limits it exceeds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics.coordinates import Coordinates, Name, completed
from strutwork.kinematics.dynamics import STANDARD_GRAVITY, Dynamics
from strutwork.kinematics.following import Followed, follow
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.trajectory import Trajectory, sampled
from strutwork.machines.model import Model
from strutwork.msa.body_mass import body_masses
from strutwork.studies.chunks import Arrays
from strutwork.studies.description import content_key
from strutwork.studies.drive_demand import (
    DriveDemand,
    DriveLimit,
    OutOfRange,
    demands_of,
    effective_limits,
    ranges_left,
)
from strutwork.studies.progress import Progress
from strutwork.studies.run import Chunk, Run
from strutwork.studies.trajectory_notes import trajectory_notes

Array = NDArray[Any]


@dataclass(frozen=True)
class Samples:
    """A trajectory as a table.

    Parameters
    ----------
    times : (k,)
        s.
    values, rates, changes : mapping of (joint, direction) to (k,)
        Coordinates, m or rad, and their first and second derivatives by s; the joint is empty for
        the tool. Derivatives are of all coordinates or of none.
    """

    times: Array
    values: Mapping[Name, Array]
    rates: Mapping[Name, Array] = field(default_factory=dict)
    changes: Mapping[Name, Array] = field(default_factory=dict)


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
    """The gravity that the model's load cases state, else the standard one along −z, m/s².

    Parameters
    ----------
    model : Model
    """
    stated = [case.gravity for case in model.cases if case.gravity is not None]
    return stated[0] if stated else STANDARD_GRAVITY


def trajectory_of(model: Model, samples: Samples) -> tuple[Trajectory, dict[Name, float]]:
    """A trajectory of all freedoms of a machine, and what was not given and stays.

    Parameters
    ----------
    model : Model
    samples : Samples

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
    coordinates, added = completed(model.motion, asked, model.task)

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

    Pieces of it are computed where `strutwork.studies.executor.computed_on` says.

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
    run = Run(workers=1, progress=progress, inputs=lambda c: _span(path, c))

    def key() -> str:
        home = model.placement.positions
        table = [samples.times, *(_plain(t) for t in (samples.values, samples.rates))]
        changes = _plain(samples.changes)
        return content_key("trajectory", model.structure, home, table, changes, pull, reactions)

    def pieces(function: Any, count: int, size: int) -> Iterator[dict[str, Array]]:
        for _, part in run.chunks(OfItems(function), count, size, key):
            yield part

    followed = follow(dynamics, path, reactions=reactions, pieces=pieces)
    found = effective_limits(model, limits or {})
    held = {(f"{j}:{d}" if j else d): value for (j, d), value in added.items()}
    return TrajectoryStudy(
        model.title,
        path,
        followed,
        demands_of(followed, found),
        ranges_left(model, followed),
        held,
        tuple(trajectory_notes(model, followed, path, splined=not samples.rates)),
    )


@dataclass(frozen=True)
class OfItems:
    """A function of a slice as one of a chunk.

    Parameters
    ----------
    function : callable
    """

    function: Callable[[slice], Arrays]

    def __call__(self, chunk: Chunk) -> Arrays:
        """The arrays of the chunk's items.

        Parameters
        ----------
        chunk : Chunk
        """
        return self.function(chunk.items)


def _plain(columns: Mapping[Name, Array]) -> dict[str, Array]:
    return {":".join(name): values for name, values in columns.items()}


def _span(path: Trajectory, chunk: Chunk) -> str:
    times = path.quadrature[0][chunk.items]
    return f"t {times[0]:.6g} to {times[-1]:.6g} s"
