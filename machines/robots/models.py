"""A model from a robot file, and a robot file from a model."""

from __future__ import annotations

import warnings
from pathlib import Path

from strutwork.errors import ModelError, ModelWarning
from strutwork.machines.model import Model
from strutwork.machines.model_builder import build_model
from strutwork.machines.model_file import checked_tables
from strutwork.machines.robots.choices import Choices
from strutwork.machines.robots.formats import read_robot
from strutwork.machines.robots.robot import Robot
from strutwork.machines.robots.tables import robot_tables
from strutwork.stages import stage


def robot_model(path: str | Path, choices: Choices | None = None) -> Model:
    """The model of a robot file: rigid links, at the configuration that the file draws.

    Parameters
    ----------
    path : str or Path
        As `read_robot`.
    choices : Choices, optional
        Tool and drives, where the file does not say.

    Raises
    ------
    ModelError
        As `read_robot`.

    Warns
    -----
    ModelWarning
        What is not taken over, or assumed.
    """
    robot = read_robot(path, choices)
    if robot.notes:
        warnings.warn(f"{path}: {' '.join(robot.notes)}", ModelWarning, stacklevel=2)
    return model_of(robot, str(path))


def model_of(robot: Robot, source: str = "robot") -> Model:
    """The model of a robot.

    Parameters
    ----------
    robot : Robot
    source : str
        Named in messages.

    Raises
    ------
    ModelError
        It has no joint, or one that a model file cannot have.
    """
    if not robot.joints:
        raise ModelError(source, "has no joint to the world.", "Attach its base to the world.")
    with stage(f"builds the model of {source}"):
        return build_model(checked_tables(robot_tables(robot), source))
