"""What a robot file does not say: which joints are driven, and where the tool is."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.robot import WORLD, Robot, RobotJoint
from strutwork.names import choices as known_choices

Array = NDArray[Any]

#: Names of a tool centre point, in small letters.
TOOL_NAMES = ("tcp", "tool", "tool0", "tool_center_point", "tool_centre_point", "ee_link")


@dataclass(frozen=True)
class Choices:
    """What the user decides.

    Parameters
    ----------
    tool : str or None
        The link, frame or site that is the tool centre point.
    drives : tuple of str or None
        Driven joints, or JOINT:DIRECTION; None leaves it to the file.
    """

    tool: str | None = None
    drives: tuple[str, ...] | None = None


def actuated(
    robot: Robot,
    choices: Choices,
    named: Collection[str],
    efforts: Mapping[str, float | None],
) -> Robot:
    """The robot with its driven joints.

    Those that the file names as actuated; else, where it gives some joints an effort of zero or,
    in SDF, a negative one, those with an effort that is not zero, as in Drake
    (https://drake.mit.edu, parsing of effort limits); else all joints with one direction, where
    the joints form no loop.

    Parameters
    ----------
    robot : Robot
    choices : Choices
        Its drives are applied by `driven_by`, later.
    named : collection of str
        Joints that the file names as actuated.
    efforts : mapping of str to float or None
        Greatest effort of joints that move, N or N·m; None where it is not stated.
    """
    if choices.drives is not None:
        return robot
    follow = {coupled.follower[0] for coupled in robot.couplings}
    single = [j.name for j in robot.joints if len(j.freedoms) == 1 and j.name not in follow]
    # zero: no drive; negative, in SDF: a drive without a bound
    speaking = any(effort is not None and effort <= 0.0 for effort in efforts.values())
    if named:
        driven = [name for name in single if name in named]
    elif speaking:
        driven = [name for name in single if efforts.get(name) not in {None, 0.0}]
    elif _has_loops(robot):
        note = "No joint is driven: the file does not say which are. Name them with --drive."
        return replace(robot, notes=(*robot.notes, note))
    else:
        driven = single
    joints = tuple(
        _driven(j, {f.direction for f in j.freedoms}) if j.name in driven else j
        for j in robot.joints
    )
    return replace(robot, joints=joints)


def driven_by(robot: Robot, drives: Collection[str]) -> Robot:
    """The robot with just these drives.

    Parameters
    ----------
    robot : Robot
    drives : collection of str
        Joints that move in one direction, or JOINT:DIRECTION.

    Raises
    ------
    ModelError
        An unknown joint, or a direction in which it does not move.
    """
    wanted: dict[str, set[str]] = {}
    known = {joint.name: joint for joint in robot.joints}
    for text in drives:
        name, colon, direction = text.rpartition(":")
        if text in known:
            name, direction = text, ""
        elif not colon or name not in known:
            raise ModelError(
                f"drive {text}", "is no joint of the robot.", known_choices("Joints", text, known)
            )
        free = [f.direction for f in known[name].freedoms]
        if not direction and len(free) == 1:
            direction = free[0]
        if direction not in free:
            raise ModelError(
                f"drive {text}",
                f"names no direction in which joint {name} moves.",
                f"It moves in {', '.join(free) or 'none'}: write JOINT:DIRECTION.",
            )
        wanted.setdefault(name, set()).add(direction)
    joints = tuple(_driven(joint, wanted.get(joint.name, set())) for joint in robot.joints)
    return replace(robot, joints=joints)


def _driven(joint: RobotJoint, directions: Collection[str]) -> RobotJoint:
    freedoms = tuple(replace(f, driven=f.direction in directions) for f in joint.freedoms)
    return replace(joint, freedoms=freedoms)


def _has_loops(robot: Robot) -> bool:
    """Whether there are more joints than a tree from the world has."""
    return len(robot.joints) > len(robot.links)


def tool_of(robot: Robot, choices: Choices, frames: Mapping[str, tuple[str, Array]]) -> Robot:
    """The robot with its tool centre point.

    The one that was chosen; else a link or frame that is called so (`TOOL_NAMES`); else the only
    link at the end of a chain.

    Parameters
    ----------
    robot : Robot
    choices : Choices
    frames : mapping of str to (link, (3,))
        Named frames or sites on links, m.

    Raises
    ------
    ModelError
        The chosen one does not exist.
    """
    places = {link.name: (link.name, link.origin) for link in robot.links} | dict(frames)
    if choices.tool is not None:
        if choices.tool not in places:
            raise ModelError(
                f"tool {choices.tool}",
                "is no link, frame or site of the robot.",
                known_choices("Known", choices.tool, places),
            )
        return replace(robot, tool=places[choices.tool], tool_name=choices.tool)
    called = [name for name in places if name.lower() in TOOL_NAMES]
    if len(called) != 1:
        count = dict.fromkeys((link.name for link in robot.links), 0)
        for joint in robot.joints:
            for end in {joint.parent, joint.child} - {WORLD}:
                count[end] += 1
        called = [name for name, joints in count.items() if joints == 1]
        called = called if len(robot.links) > 1 else []
    if len(called) != 1:
        note = "There is no tool: the file names none. Name a link with --tool."
        return replace(robot, notes=(*robot.notes, note))
    return replace(robot, tool=places[called[0]], tool_name=called[0])
