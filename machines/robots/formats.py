"""The formats by the endings of their files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from strutwork.errors import ModelError
from strutwork.machines.robots.assemble import assembled
from strutwork.machines.robots.choices import Choices, driven_by
from strutwork.machines.robots.mjcf_read import mjcf_robot
from strutwork.machines.robots.mjcf_write import mjcf_text
from strutwork.machines.robots.robot import Coupled, Robot
from strutwork.machines.robots.sdf_read import sdf_robot
from strutwork.machines.robots.sdf_write import sdf_text
from strutwork.machines.robots.tidy import tidied
from strutwork.machines.robots.urdf_read import urdf_robot
from strutwork.machines.robots.urdf_write import urdf_text
from strutwork.machines.robots.xml_text import parse_file, plain
from strutwork.names import choices as known_choices

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

#: Ending of a file, and what it is called.
FORMATS = {".urdf": "URDF", ".sdf": "SDF", ".xml": "MJCF", ".mjcf": "MJCF"}

_READERS: dict[str, Callable[[Element, Choices], Robot]] = {
    "robot": urdf_robot,
    "sdf": sdf_robot,
    "mujoco": mjcf_robot,
}
_WRITERS: dict[str, Callable[[Robot], str]] = {
    "URDF": urdf_text,
    "SDF": sdf_text,
    "MJCF": mjcf_text,
}


def is_robot_file(path: str | Path) -> bool:
    """Whether a file is one of a robot format, by its ending.

    Parameters
    ----------
    path : str or Path
    """
    return Path(path).suffix.lower() in FORMATS


def read_robot(path: str | Path, choices: Choices | None = None) -> Robot:
    """Read a URDF, SDFormat or MJCF file; its first element says which.

    Joints in series that are one joint of the model become one; the links are moved to a
    configuration in which loops close and joints are within their limits, where the file draws
    another one.

    Parameters
    ----------
    path : str or Path
        In UTF-8, 10 MB at most. No other file is opened.
    choices : Choices, optional
        Tool and drives, where the file does not say.

    Raises
    ------
    ModelError
        The file cannot be read, or its content is wrong; names the part.
    """
    root = parse_file(path, "robot file")
    reader = _READERS.get(plain(root.tag))
    if reader is None:
        raise ModelError(
            str(path),
            f"begins with <{plain(root.tag)[:40]}>: it is no URDF, SDF or MJCF.",
            "Such files begin with <robot>, <sdf> or <mujoco>.",
        )
    chosen = Choices() if choices is None else choices
    robot = assembled(tidied(_with_leaders(reader(root, chosen))))
    return robot if chosen.drives is None else driven_by(robot, chosen.drives)


def robot_text(robot: Robot, path: str | Path) -> str:
    """The text of a robot in the format that the ending of a file names.

    Parameters
    ----------
    robot : Robot
    path : str or Path

    Raises
    ------
    ModelError
        No such format, or a part that it cannot have.
    """
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise ModelError(
            str(path),
            f'ends in "{ending}", which is no robot format.',
            "Endings: " + ", ".join(FORMATS) + ".",
        )
    return _WRITERS[FORMATS[ending]](robot)


def _with_leaders(robot: Robot) -> Robot:
    """Couplings whose leaders have their directions, which the files do not name."""
    known = {joint.name: joint for joint in robot.joints}
    couplings: list[Coupled] = []
    for c in robot.couplings:
        name, direction = c.leader
        if name not in known:
            raise ModelError(
                f"joint {c.follower[0]}",
                f'mimics the unknown joint "{name}".',
                known_choices("Joints", name, known),
            )
        free = [f.direction for f in known[name].freedoms]
        direction = direction or (free[0] if free else "")
        if direction not in free or known[name].kind == "spherical":
            raise ModelError(
                f"joint {c.follower[0]}",
                f"mimics joint {name}, which is {known[name].kind}.",
                "Name a joint with one axis.",
            )
        if c.ratio == 0.0:
            raise ModelError(
                f"joint {c.follower[0]}",
                f"mimics joint {name} with a multiplier of zero.",
                "Make the joint fixed, or give a multiplier.",
            )
        couplings.append(replace(c, leader=(name, direction)))
    return replace(robot, couplings=tuple(couplings))
