"""Robot formats: URDF, SDFormat and MJCF, read into a machine and written from one.

`read_robot` reads a file into a `Robot`, `robot_tables` and `model_text` make a model of it,
`robot_of` makes a `Robot` of a model, and `robot_text` writes it in a format.
"""

from strutwork.machines.robots.formats import FORMATS, is_robot_file, read_robot, robot_text
from strutwork.machines.robots.of_model import robot_of
from strutwork.machines.robots.robot import WORLD, Coupled, Freedom, Link, Robot, RobotJoint
from strutwork.machines.robots.tables import model_text, robot_tables

__all__ = [
    "FORMATS",
    "WORLD",
    "Coupled",
    "Freedom",
    "Link",
    "Robot",
    "RobotJoint",
    "is_robot_file",
    "model_text",
    "read_robot",
    "robot_of",
    "robot_tables",
    "robot_text",
]
