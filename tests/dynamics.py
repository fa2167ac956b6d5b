"""Machines with mass and motion, for the tests of dynamics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import DIRECTIONS, Linkage, Placement
from strutwork.kinematics.body_masses import BodyMasses
from strutwork.kinematics.coordinates import Coordinates, completed
from strutwork.kinematics.dynamics import Dynamics, PlacedDynamics
from strutwork.kinematics.motion import Motion, Moved
from strutwork.machines.load import load
from strutwork.msa.body_mass import body_masses

Array = NDArray[Any]

#: Machines of the catalogue that have mass, and model files.
HEAVY = (
    "mit-ss1",
    "eclipse-3pprs:calibrated",
    "proposed-3pprs:calibrated",
    "alizade-3prps:calibrated",
    "glozman-3prrs:calibrated",
    "prototype-3ppprs",
    "examples/03_tripod.toml",
    "examples/04_four_bar.toml",
    "examples/05_two_link_leg.toml",
    "machines/templates/3-rps.toml",
    "machines/templates/6-ups.toml",
    "machines/templates/linear-delta.toml",
    "machines/templates/planar-3-rrr.toml",
    "machines/templates/tricept.toml",
)


@dataclass(frozen=True)
class Case:
    """A machine at a pose with rates and accelerations of its coordinates."""

    dynamics: Dynamics
    values: Array
    rates: Array
    changes: Array

    def move(self, values: ArrayLike) -> Moved:
        found = np.asarray(values, dtype=float)
        names = self.dynamics.coordinates.names
        task = {d: found[..., k] for k, (joint, d) in enumerate(names) if not joint}
        joints = {pair: found[..., k] for k, pair in enumerate(names) if pair[0]}
        moved = self.dynamics.motion.move(task=task or None, joints=joints or None)
        assert moved.reached.all()
        return moved

    def at(self, values: ArrayLike) -> PlacedDynamics:
        return self.dynamics.at(self.move(np.atleast_2d(values)))

    def along(self, step: float, count: int) -> tuple[Array, Array]:
        """Values and rates at times around now, of constant acceleration."""
        times = step * np.arange(-count, count + 1)[:, None]
        values = self.values + times * self.rates + times**2 / 2 * self.changes
        return values, self.rates + times * self.changes


def home_values(motion: Motion, coordinates: Coordinates) -> Array:
    home = dict(zip(motion.joints.names, motion.home_values, strict=True))
    tool = {}
    if motion.linkage.tool is not None:
        tool = dict(zip(DIRECTIONS, motion.task_of(motion.home_pose), strict=True))
    return np.array([float(home[j, d]) if j else float(tool[d]) for j, d in coordinates.names])


def heavy(name: str, seed: int = 1, size: float = 1.0) -> Case:
    """A machine near its home, in some motion; at 1 within 5 mm and 0.05 rad of home."""
    model = load(name)
    motion = model.motion
    asked = Coordinates() if model.tool else Coordinates((), (motion.joints.names[0],))
    coordinates, _ = completed(motion, asked)
    masses = body_masses(model.structure.at(model.placement))
    random = np.random.default_rng(seed)
    scale = size * np.where(coordinates.rotary, 0.05, 0.005)
    rates, changes = (k * scale * random.uniform(-1, 1, len(coordinates)) for k in (5.0, 40.0))
    values = home_values(motion, coordinates) + scale * random.uniform(-1, 1, len(coordinates))
    dynamics = Dynamics(motion, masses, coordinates, (1.0, -2.0, -9.5))
    return Case(dynamics, values, rates, changes)


def masses_of(linkage: Linkage, **parts: tuple[float, ArrayLike, ArrayLike]) -> BodyMasses:
    """Mass, centre and inertia about it of named bodies; others have none."""
    count = len(linkage.body_names)
    mass, centre, inertia = np.zeros(count), np.zeros((count, 3)), np.zeros((count, 3, 3))
    for name, (m, c, i) in parts.items():
        b = linkage.body_names.index(name)
        given = np.asarray(i, dtype=float)
        mass[b], centre[b] = m, c
        inertia[b] = given if given.ndim == 2 else np.diag(np.broadcast_to(given, 3))
    return BodyMasses(mass, centre, inertia)


def simple(
    made: tuple[Linkage, Placement],
    coordinates: Coordinates,
    gravity: ArrayLike,
    **parts: tuple[float, ArrayLike, ArrayLike],
) -> Dynamics:
    linkage, placement = made
    return Dynamics(Motion(linkage, placement), masses_of(linkage, **parts), coordinates, gravity)
