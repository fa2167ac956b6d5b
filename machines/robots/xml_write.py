"""XML that writers of robot formats build."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.plan import Plan
from strutwork.machines.robots.robot import WORLD, Freedom

Array = NDArray[Any]

#: Largest ranges, efforts and speeds, where a format asks for a number and there is none.
NO_LIMIT = 1e9


def shown(values: ArrayLike, size: float = 0.0) -> str:
    """Numbers with all their digits.

    Parameters
    ----------
    values : (n,) or ()
        Any unit.
    size : float
        Below 1e-15 of it a number is zero; same unit.
    """
    return " ".join(_one(float(v), size) for v in np.atleast_1d(np.asarray(values, dtype=float)))


def _one(value: float, size: float) -> str:
    if abs(value) <= 1e-15 * size or value == 0:
        return "0"
    return repr(value).removesuffix(".0")


def add(parent: Element, tag: str, text: str | None = None, /, **attributes: str) -> Element:
    """A new element at the end of another.

    Parameters
    ----------
    parent : Element
    tag : str
    text : str, optional
    **attributes : str
        A name of Python with a mark behind, as class_, loses it.
    """
    child = SubElement(parent, tag, {k.rstrip("_"): v for k, v in attributes.items()})
    child.text = text
    return child


def document(root: Element, notes: Iterable[str]) -> str:
    """The text of a file, its notes as a comment at the head.

    Parameters
    ----------
    root : Element
    notes : iterable of str
    """
    indent(root)
    # two hyphens end a comment
    lines = [" ".join(note.split()).replace("--", "- -") for note in notes]
    head = "".join(f"<!-- {line.rstrip('-')} -->\n" for line in lines)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{head}{tostring(root, encoding="unicode")}\n'


def from_home(freedom: Freedom) -> tuple[float, float] | None:
    """Its range, counted from home: formats draw the robot at zero.

    Parameters
    ----------
    freedom : Freedom
    """
    if freedom.limits is None:
        return None
    return freedom.limits[0] - freedom.home, freedom.limits[1] - freedom.home


def points_of(plan: Plan) -> list[tuple[str, str, Array]]:
    """Named points of links, the tool among them: name, link and place, (3,), m.

    Parameters
    ----------
    plan : Plan
    """
    robot, frames = plan.robot, plan.frames()
    found = [p for p in robot.points if p[1] != WORLD]
    if robot.tool is not None and robot.tool[0] != WORLD:
        found.append((tool_name(plan), robot.tool[0], robot.tool[1]))
    taken = {WORLD, *(link.name for link in robot.links)}
    points = []
    for name, link, place in found:
        if name == link and np.array_equal(place, frames[link]):
            # the frame of the link itself
            continue
        text, count = name, 2
        while text in taken:
            text, count = f"{name} {count}", count + 1
        taken.add(text)
        points.append((text, link, place))
    return points


def tool_name(plan: Plan) -> str:
    """A name for the tool centre point that a reader knows as one.

    Parameters
    ----------
    plan : Plan
    """
    from strutwork.machines.robots.choices import TOOL_NAMES

    name = plan.robot.tool_name
    return name if name.lower() in TOOL_NAMES else "tcp"


def require_tree(plan: Plan, format_: str) -> None:
    """Refuse couplings of joints that close loops: formats couple joints of the tree.

    Parameters
    ----------
    plan : Plan
    format_ : str
        For the message.

    Raises
    ------
    ModelError
        Names the coupling.
    """
    in_tree = {joint.name for joint in plan.tree}
    for c in plan.robot.couplings:
        for end in (c.leader, c.follower):
            if end[0] not in in_tree:
                raise ModelError(
                    f"coupling {c.name}",
                    f"is of joint {end[0]}, which closes a loop: {format_} has no place for it.",
                    "Remove the coupling, or couple another joint of the loop.",
                )


def loop_notes(plan: Plan) -> list[str]:
    """What joints that close loops cannot keep.

    Parameters
    ----------
    plan : Plan
    """
    return [
        f"joint {joint.name} closes a loop: its drive, damping and limits are left out."
        for joint in plan.loops
        if any(f.driven or f.damping or f.limits for f in joint.freedoms)
    ]
