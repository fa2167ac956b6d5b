"""Joints of SDFormat."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.poses import Pose, joint_axes, unit
from strutwork.machines.robots.robot import Coupled, Freedom, Link, RobotJoint
from strutwork.machines.robots.xml_text import (
    bounded,
    limit_pair,
    name_of,
    number,
    numbers,
)

Array = NDArray[Any]

#: Joint types of SDFormat, and ours.
TYPES = {
    "fixed": "fixed",
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "screw": "helical",
    "ball": "spherical",
    "universal": "universal",
    "revolute2": "universal",
}

#: Axes whose cosine is below are perpendicular.
PERPENDICULAR = 1e-9


@dataclass
class Read:
    """What one joint of the file becomes.

    Parameters
    ----------
    joints : list of RobotJoint
    links : list of Link
        Massless ones between two joints.
    couplings : list of Coupled
        Whose leader has an empty direction where the file names none.
    start : list of ((joint, direction), float)
        Displacements, m and rad.
    efforts : dict of str to float or None
        Greatest effort of its drive, N or N·m.
    """

    joints: list[RobotJoint] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    couplings: list[Coupled] = field(default_factory=list)
    start: list[tuple[tuple[str, str], float]] = field(default_factory=list)
    efforts: dict[str, float | None] = field(default_factory=dict)


def sdf_joint(
    element: Element,
    pose: Callable[[str], Pose],
    link_of: Callable[[str], str],
    version: tuple[int, int],
    notes: list[str],
) -> Read:
    """A joint of the file; two where its axes are not perpendicular.

    Parameters
    ----------
    element : Element
    pose : callable
        Pose in the world of a frame by its name.
    link_of : callable
        The link that carries a frame.
    version : (int, int)
        Of the file.
    notes : list of str
        Is added to.

    Raises
    ------
    ModelError
        A type that is not supported, an unknown link, or a missing part.
    """
    name = name_of(element)
    part = f"joint {name}"
    type_ = (element.get("type") or "").strip()
    if type_ not in TYPES:
        raise ModelError(
            part, f'has the type "{type_}".', "Types that are read: " + ", ".join(TYPES) + "."
        )
    ends: list[str] = []
    for end in ("parent", "child"):
        found = element.find(end)
        # up to version 1.4 the name may stand in an element <link>
        text = "" if found is None else (found.text or "").strip()
        if not text:
            raise ModelError(part, f"has no <{end}>.", f"Give <{end}>LINK</{end}>.")
        ends.append(link_of(text))
    kind, own = TYPES[type_], pose(name)
    first = _axis(element.find("axis"), own, pose, version, part, notes)
    read = Read()
    if kind == "fixed":
        read.joints = [RobotJoint(name, kind, ends[0], ends[1], own.position)]
        return read
    if kind == "spherical":
        read.joints = [RobotJoint(name, kind, ends[0], ends[1], own.position, own.rotation)]
        return read
    if kind == "universal":
        second = _axis(element.find("axis2"), own, pose, version, part, notes)
        _two_axes(read, name, ends, own, first, second)
        read.efforts[name] = first.effort
        return read
    freedom = first.freedom("z" if kind == "prismatic" else "rz", type_ == "continuous")
    joint = RobotJoint(
        name,
        kind,
        ends[0],
        ends[1],
        own.position,
        joint_axes(first.vector, part),
        (freedom,),
        _pitch(element, part) if kind == "helical" else None,
    )
    read.joints = [joint]
    read.efforts[name] = first.effort
    _add_mimic(read, element.find("axis"), (name, freedom.direction), part)
    return read


@dataclass
class _Axis:
    """An axis of a joint in world axes, and what stands beside it."""

    vector: Array
    limits: tuple[float, float] | None
    damping: float
    effort: float | None
    speed: float | None

    def freedom(self, direction: str, endless: bool = False) -> Freedom:
        return Freedom(
            direction,
            limits=None if endless else self.limits,
            damping=self.damping,
            effort=bounded(self.effort),
            speed=bounded(self.speed),
        )


def _two_axes(
    read: Read, name: str, ends: list[str], own: Pose, first: _Axis, second: _Axis
) -> None:
    part = f"joint {name}"
    if abs(float(first.vector @ second.vector)) < PERPENDICULAR:
        axes = joint_axes(first.vector, part, second.vector)
        freedoms = (first.freedom("rz"), second.freedom("rx"))
        read.joints = [
            RobotJoint(name, "universal", ends[0], ends[1], own.position, axes, freedoms)
        ]
        return
    between = f"{name} between"[:100]
    read.links = [Link(between, own.position)]
    for k, (axis, parent, child) in enumerate(
        ((first, ends[0], between), (second, between, ends[1])), 1
    ):
        axes = joint_axes(axis.vector, part)
        read.joints.append(
            RobotJoint(
                f"{name}:{k}"[:100],
                "revolute",
                parent,
                child,
                own.position,
                axes,
                (axis.freedom("rz"),),
            )
        )


def _axis(
    element: Element | None,
    own: Pose,
    pose: Callable[[str], Pose],
    version: tuple[int, int],
    part: str,
    notes: list[str],
) -> _Axis:
    xyz = None if element is None else element.find("xyz")
    text = "" if xyz is None else (xyz.text or "").strip()
    vector = numbers(text, 3, part, "xyz") if text else np.array([0.0, 0.0, 1.0])
    frame = own
    if xyz is not None and xyz.get("expressed_in"):
        frame = pose(str(xyz.get("expressed_in")))
    elif version < (1, 5) or (
        element is not None
        and (element.findtext("use_parent_model_frame") or "").strip().lower() in {"1", "true"}
    ):
        frame = pose("__model__")

    def value(path: str) -> float | None:
        found = None if element is None else element.findtext(path)
        if found is None or not found.strip():
            return None
        # infinity is allowed here, and means none
        endless = found.strip().lower().lstrip("+-") in {"inf", "infinity"}
        return None if endless else number(found, part, path)

    low, high = value("limit/lower"), value("limit/upper")
    limits = limit_pair(-1e9 if low is None else low, 1e9 if high is None else high)
    notes += [
        f"{what.partition('/')[2]} of {part} is left out."
        for what in ("dynamics/friction", "dynamics/spring_stiffness")
        if value(what)
    ]
    return _Axis(
        frame.rotation @ unit(vector, part),
        limits,
        max(value("dynamics/damping") or 0.0, 0.0),
        value("limit/effort"),
        value("limit/velocity"),
    )


def _pitch(element: Element, part: str) -> float:
    for tag in ("screw_thread_pitch", "thread_pitch"):
        text = element.findtext(tag)
        if text is None:
            continue
        value = number(text, part, tag)
        if value == 0.0:
            break
        # the older one is in rad per m, positive for a left-hand thread
        return value if tag == "screw_thread_pitch" else -2 * np.pi / value
    raise ModelError(
        part, "is a screw without a pitch.", "Give <screw_thread_pitch> in m per turn."
    )


def _add_mimic(read: Read, axis: Element | None, own: tuple[str, str], part: str) -> None:
    mimic = None if axis is None else axis.find("mimic")
    if mimic is None:
        return
    leader = (mimic.get("joint") or "").strip()
    if not leader:
        raise ModelError(part, "mimics no joint.", 'Give <mimic joint="…">.')

    texts = {tag: mimic.findtext(tag) or "0" for tag in ("multiplier", "offset", "reference")}
    given = {tag: number(text, part, tag) for tag, text in texts.items()}
    ratio = given["multiplier"]
    second = "rx" if mimic.get("axis") == "axis2" else ""
    read.couplings.append(Coupled(f"{own[0]} follows {leader}"[:100], (leader, second), own, ratio))
    moved = given["offset"] - ratio * given["reference"]
    if moved:
        read.start.append((own, moved))
