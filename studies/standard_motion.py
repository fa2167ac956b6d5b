"""What rigid bodies ask of the drives: at rest over the workspace, and round a standard circle."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.capability import force_zonotope
from strutwork.kinematics.coordinates import Coordinates, completed
from strutwork.kinematics.drive_forces import inverse_dynamics
from strutwork.kinematics.dynamics import Dynamics, PlacedDynamics
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.kinematics.time_laws import circle
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved, walked
from strutwork.msa.body_mass import body_masses
from strutwork.studies.progress import Progress
from strutwork.studies.trajectory import (
    Samples,
    TrajectoryStudy,
    model_gravity,
    study_trajectory,
)

Array = NDArray[Any]

#: Largest acceleration on the circle, m/s².
ACCELERATION = 1.0

#: Radius of the circle as a share of the narrower of the two ranges that it lies in.
SHARE = 0.25

#: Largest s′ of the quintic law from rest to rest.
QUINTIC_PEAK = 15.0 / 8.0

#: How well drives must hold the tool for a pose to count.
HELD = 1e-6

#: Poses treated at once.
PIECE = 256


@dataclass(frozen=True)
class StandardMotion:
    """A machine of rigid bodies with its drives.

    Parameters
    ----------
    labels : tuple of str
        Coordinates that describe its motion.
    held, free : (t,)
        Mass, or moment of inertia, that the tool feels at home along each of them, the others
        held and free, kg or kg m².
    grid : TaskGrid
    standing : (n, a)
        Force of every drive at rest at the poses of the grid, N or N·m; missing (NaN) where a
        pose cannot be taken.
    round : TrajectoryStudy or None
        Once round a circle about home; None where the workspace has no two wide translations.
    radius, duration : float
        Of the circle, m and s.
    plane : tuple of str
        The two translations.
    surely : float or None
        Force in the worst direction of the task's translations that the drives can exert at
        home by their limits, other loads borne elsewhere, N; None where a limit is not known.
    """

    labels: tuple[str, ...]
    held: Array
    free: Array
    grid: TaskGrid
    standing: Array
    round: TrajectoryStudy | None
    radius: float
    duration: float
    plane: tuple[str, ...]
    surely: float | None

    def __repr__(self) -> str:
        return f"<StandardMotion: {len(self.labels)} coordinates, {self.standing.shape[1]} drives>"


def standard_motion(
    model: Model, grid: TaskGrid, progress: Progress | None = None
) -> StandardMotion:
    """Ask a machine what its own weight and a circle ask of its drives.

    The circle lies about home in the first two wide translations of the grid, with the quintic
    law from rest to rest and `ACCELERATION` at its fastest.

    Parameters
    ----------
    model : Model
        With masses and drives.
    grid : TaskGrid
    progress : callable, optional

    Raises
    ------
    ModelError
        No mass, none of the tool's body, no drive, or freedoms that nothing describes.
    UnreachableError, SingularPoseError, NumericalError
        As `study_trajectory`.
    """
    if not model.structure.linkage.driven:
        raise ModelError("drives", "are none.", "Name driven directions of joints.")
    wide = [d for d, values in grid.axes.items() if d in DIRECTIONS[:3] and len(values) > 1][:2]
    asked = Coordinates(tuple(d for d in DIRECTIONS if d in grid.axes), ())
    coordinates, _ = completed(model.motion, asked, model.task)
    masses = body_masses(model.structure.at(model.placement))
    if masses.mass[model.structure.linkage.tool_body] == 0.0:
        raise ModelError(
            "the body of the tool",
            "has no mass: what the drives must accelerate is not known.",
            "Give it a point mass, or name a variant of the machine that has one.",
        )
    dynamics = Dynamics(model.motion, masses, coordinates, model_gravity(model))
    home = dynamics.at(walked(model, {d: np.zeros(1) + _home(model)[d] for d in grid.axes}))
    mass = home.mass[0]
    standing = _standing(model, dynamics, grid)
    radius = duration = 0.0
    found = None
    if len(wide) == 2:
        radius = SHARE * min(float(np.ptp(grid.axes[d])) for d in wide)
        duration = 2.0 * pi * QUINTIC_PEAK * sqrt(radius / ACCELERATION)
        samples = _circle(model, (wide[0], wide[1]), radius, duration)
        found = study_trajectory(model, samples, progress=progress)
    return StandardMotion(
        coordinates.labels,
        np.diag(mass).copy(),
        1.0 / np.diag(np.linalg.inv(mass)),
        grid,
        standing,
        found,
        radius,
        duration,
        tuple(wide),
        _surely(model, home),
    )


def _home(model: Model) -> dict[str, float]:
    task = model.motion.task_of(model.motion.home_pose)
    return dict(zip(DIRECTIONS, task.tolist(), strict=True))


def _standing(model: Model, dynamics: Dynamics, grid: TaskGrid) -> Array:
    """Forces of the drives at rest, (n, a)."""
    task = grid.task()
    forces = np.full((len(grid), len(model.structure.linkage.driven)), np.nan)
    for first in range(0, len(grid), PIECE):
        part = {d: values[first : first + PIECE] for d, values in task.items()}
        _, placement = moved(model, part)
        good = np.flatnonzero(placement.reachable)
        if not len(good):
            continue
        at = dynamics.at(walked(model, {d: values[good] for d, values in part.items()}))
        # a parallel singularity is no pose to stand at
        held = np.flatnonzero(at.held > HELD)
        if len(held) < len(good):
            good = good[held]
            if not len(good):
                continue
            at = dynamics.at(walked(model, {d: values[good] for d, values in part.items()}))
        still = np.zeros((len(good), len(dynamics.coordinates)))
        forces[first + good] = inverse_dynamics(at, still, still).drives
    return forces


def _circle(model: Model, plane: tuple[str, str], radius: float, duration: float) -> Samples:
    home = _home(model)
    names = tuple(d for d in DIRECTIONS if d in plane)
    path = circle(Coordinates(names, ()), [home[d] for d in names], radius, duration, plane)
    values, rates, changes = path.at(path.times)
    # it begins beside home, from rest
    columns = [("", d) for d in names]
    return Samples(
        path.times,
        {name: values[:, k] for k, name in enumerate(columns)},
        {name: rates[:, k] for k, name in enumerate(columns)},
        {name: changes[:, k] for k, name in enumerate(columns)},
    )


def _surely(model: Model, home: PlacedDynamics) -> float | None:
    known = {(d.joint, d.direction): d.force for d in model.drives}
    limits = [known.get(pair) for pair in model.structure.linkage.driven]
    labels = home.of.coordinates.labels
    columns = [k for k, name in enumerate(labels) if name in DIRECTIONS[:3]]
    stated = [limit for limit in limits if limit is not None]
    if len(stated) < len(limits) or not columns:
        return None
    return float(force_zonotope(home.drive_map[0][:, columns], np.array(stated)).guaranteed)
