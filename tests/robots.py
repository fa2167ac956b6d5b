"""Robots for the tests: the dynamics of a model beside that of another program."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics.coordinates import Coordinates
from strutwork.kinematics.dynamics import Dynamics, PlacedDynamics
from strutwork.kinematics.motion import Moved
from strutwork.machines.model import Model
from strutwork.machines.robots import Robot
from strutwork.machines.robots.models import model_of
from strutwork.msa.body_mass import body_masses

Array = NDArray[Any]

EXAMPLES = Path(__file__).parents[1] / "examples" / "robots"


def dynamics(model: Model) -> Dynamics:
    """The dynamics of a model in the coordinates of its drives."""
    coordinates = Coordinates((), model.structure.linkage.driven)
    return Dynamics(model.motion, body_masses(model.placed), coordinates)


def moved(model: Model, values: ArrayLike) -> Moved:
    """The model with its drives displaced from home by `values`."""
    driven = model.structure.linkage.driven
    home = dict(zip(model.motion.joints.names, model.motion.home_values, strict=True))
    targets = {
        pair: np.atleast_1d(home[pair] + v)
        for pair, v in zip(driven, np.asarray(values, dtype=float), strict=True)
    }
    found = model.motion.move(joints=targets)
    assert found.reached.all()
    return found


def placed(model: Model, values: ArrayLike) -> tuple[PlacedDynamics, Moved]:
    found = moved(model, values)
    return dynamics(model).at(found), found


def tool_jacobian(at: PlacedDynamics) -> Array:
    """Twist of the tool per rate of the drives, (6, a)."""
    return np.asarray((at.placed.tool_on_bodies @ at.placed.map)[0])


def model(robot: Robot) -> Model:
    return model_of(robot)
