"""Loops in URDF: the constraint proposal, and two extensions that are in use.

- `<constraint>` with parent_origin, parent_axis, child_origin and child_axis is the proposal to
  URDF itself: "Add constraints to describe closed loops", ros/urdfdom#264 and
  ros/urdfdom_headers#108 (2026). It is what is written.
- `<loop>` with predecessor, successor and axis: Chignoli et al., URDF+: An Enhanced URDF for
  Robots with Kinematic Loops, arXiv:2411.19753 (2024).
- `<loop_joint>` with link1 and link2: the URDF importer of NVIDIA Isaac Sim.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.poses import Pose, joint_axes, roll_pitch_yaw
from strutwork.machines.robots.robot import RobotJoint
from strutwork.machines.robots.xml_text import (
    attribute_numbers,
    children,
    name_of,
    plain,
    required,
)

Array = NDArray[Any]

LOOP_TAGS = ("constraint", "loop", "loop_joint")

#: Types of loops, as files spell them, and ours.
TYPES = {
    "fixed": "fixed",
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "cylindrical": "cylindrical",
    "universal": "universal",
    "cardan": "universal",
    "spherical": "spherical",
    "ball": "spherical",
    "planar": "planar",
}


@dataclass(frozen=True)
class _Side:
    """One side of a loop: its link, frame and axis in world axes; the axis is of the frame."""

    link: str
    frame: Pose
    axis: Array


def loops_of(root: Element, poses: Mapping[str, Pose], notes: list[str]) -> list[RobotJoint]:
    """The joints that close loops; their two sides may not meet yet.

    Parameters
    ----------
    root : Element
        Of a URDF file.
    poses : mapping of str to Pose
        Of its links at zero of all joints.
    notes : list of str
        Is added to.

    Raises
    ------
    ModelError
        An unknown link or type, or a missing part.
    """
    found = []
    for element in children(root, *LOOP_TAGS):
        name = name_of(element)
        part = f"{plain(element.tag)} {name}"
        type_ = (element.get("type") or "").strip().lower()
        if type_ not in TYPES:
            raise ModelError(
                part, f'has the unknown type "{type_}".', "Types: " + ", ".join(TYPES) + "."
            )
        found.append(_joint(name, TYPES[type_], _sides(element, poses, part), part))
    if any(children(root, "coupling")):
        notes.append("<coupling> of URDF+ is left out: write <mimic>.")
    return found


def _joint(name: str, kind: str, sides: tuple[_Side, _Side], part: str) -> RobotJoint:
    first, second = sides
    if kind == "universal":
        # the first axis goes with the parent, the second with the child
        z, x = first.axis, second.axis
        across = np.cross(z, x)
        if np.linalg.norm(across) < 1e-9:
            raise ModelError(
                part,
                "is universal, and its two axes are parallel.",
                "Give parent_axis and child_axis, perpendicular to each other.",
            )
        parent_axes = joint_axes(z, part, x)
        # its own side: x is the child's axis, z the parent's made perpendicular to it
        child_axes = joint_axes(np.cross(x, across), part, x)
    else:
        parent_axes = _axes(first, kind, part)
        child_axes = _axes(second, kind, part)
    return RobotJoint(
        name,
        kind,
        first.link,
        second.link,
        second.frame.position,
        child_axes,
        parent_place=first.frame.position,
        parent_axes=parent_axes,
    )


def _axes(side: _Side, kind: str, part: str) -> Array:
    if kind in {"fixed", "spherical"}:
        return side.frame.rotation
    # the same second axis on both sides, where their frames agree
    own = side.frame.rotation.T @ side.axis
    return np.asarray(side.frame.rotation @ joint_axes(own, part))


def _sides(element: Element, poses: Mapping[str, Pose], part: str) -> tuple[_Side, _Side]:
    if element.tag == "constraint":
        return (
            _constraint_side(element, "parent", poses, part),
            _constraint_side(element, "child", poses, part),
        )
    axis = element.find("axis")
    tags = ("predecessor", "successor") if element.tag == "loop" else ("link1", "link2")
    ends = [end for end in element if plain(end.tag) in tags]
    if len(ends) != 2:
        raise ModelError(
            part, f"has {len(ends)} links.", f"Give <{tags[0]}> and <{tags[1]}>, one each."
        )
    return (
        _extension_side(ends[0], axis, poses, part),
        _extension_side(ends[1], axis, poses, part),
    )


def _constraint_side(element: Element, end: str, poses: Mapping[str, Pose], part: str) -> _Side:
    link_element = element.find(end)
    if link_element is None:
        raise ModelError(part, f"has no <{end}>.", f'Give <{end} link="…"/>.')
    axis = element.find(f"{end}_axis")
    return _side(link_element, element.find(f"{end}_origin"), axis, poses, part)


def _extension_side(
    end: Element, axis: Element | None, poses: Mapping[str, Pose], part: str
) -> _Side:
    origin = end.find("origin")
    return _side(end, end if origin is None else origin, axis, poses, part)


def _side(
    link_element: Element,
    origin: Element | None,
    axis: Element | None,
    poses: Mapping[str, Pose],
    part: str,
) -> _Side:
    link = required(link_element, "link", part)
    if link not in poses:
        raise ModelError(
            part, f'names the unknown link "{link}".', "Define the link, or correct the name."
        )
    zeros = (0.0, 0.0, 0.0)
    frame = poses[link] @ Pose(
        attribute_numbers(origin, "xyz", zeros, part),
        roll_pitch_yaw(attribute_numbers(origin, "rpy", zeros, part)),
    )
    own = attribute_numbers(axis, "xyz", (1.0, 0.0, 0.0), part)
    return _Side(link, frame, frame.rotation @ own)
