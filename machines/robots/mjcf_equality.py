"""Equality constraints of MJCF: loops and couplings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.mjcf_defaults import Defaults
from strutwork.machines.robots.poses import Pose, quaternion
from strutwork.machines.robots.robot import WORLD, Coupled, RobotJoint
from strutwork.machines.robots.xml_text import children, numbers, plain

Array = NDArray[Any]

Start = list[tuple[tuple[str, str], float]]


def equalities(
    root: Element,
    defaults: Defaults,
    poses: Mapping[str, Pose],
    sites: Mapping[str, tuple[str, Pose]],
    freedoms: Mapping[str, str],
    notes: list[str],
) -> tuple[list[RobotJoint], list[Coupled], Start]:
    """What `connect`, `weld` and `joint` constraints hold.

    Parameters
    ----------
    root : Element
        Of the file.
    defaults : Defaults
    poses : mapping of body to Pose
    sites : mapping of site to (body, Pose)
    freedoms : mapping of joint to direction
        Of hinges and slides; empty for balls.
    notes : list of str
        Is added to.

    Raises
    ------
    ModelError
        An unknown body, site or joint, or a constraint that is not supported.
    """
    joints: list[RobotJoint] = []
    couplings: list[Coupled] = []
    start: Start = []
    for group in children(root, "equality"):
        for count, element in enumerate(group, 1):
            tag = plain(element.tag)
            if not tag:
                continue
            a = {**defaults.classes["main"].get("equality", {}), **defaults.of(element, None)}
            name = a.get("name") or f"{tag} {len(joints) + len(couplings) + count}"
            part = f"{tag} {name}"
            if a.get("active") == "false":
                notes.append(f"{part} is not active and left out.")
            elif tag in {"connect", "weld"}:
                joints.append(_loop(tag, name, a, poses, sites))
            elif tag == "joint":
                _couple(name, a, freedoms, couplings, start, part)
            else:
                notes.append(f"{part} is left out: connect, weld and joint are read.")
    return joints, couplings, start


def _loop(
    tag: str,
    name: str,
    a: Mapping[str, str],
    poses: Mapping[str, Pose],
    sites: Mapping[str, tuple[str, Pose]],
) -> RobotJoint:
    part = f"{tag} {name}"
    kind = "spherical" if tag == "connect" else "fixed"
    if "site1" in a or "site2" in a:
        ends = []
        for key in ("site1", "site2"):
            if a.get(key) not in sites:
                raise ModelError(
                    part, f'names the unknown site "{a.get(key)}".', "Define it, or correct it."
                )
            ends.append(sites[a[key]])
        (first, one), (second, other) = ends
        return RobotJoint(
            name[:100], kind, first, second, other.position, other.rotation,
            parent_place=one.position, parent_axes=one.rotation,
        )  # fmt: skip
    bodies = a.get("body1", ""), a.get("body2", WORLD)
    for body in bodies:
        if body not in poses:
            raise ModelError(
                part, f'names the unknown body "{body}".', "Define it, or correct the name."
            )
    first, second = bodies
    if tag == "connect":
        if "anchor" not in a:
            raise ModelError(part, "has no anchor.", 'Give anchor="x y z" in the first body.')
        place = poses[first].at(numbers(a["anchor"], 3, part, "anchor"))
        return RobotJoint(name[:100], kind, first, second, place)
    relative = numbers(a.get("relpose", "0 1 0 0 0 0 0"), 7, part, "relpose")
    if not np.any(relative[3:]):
        # as the bodies stand
        return RobotJoint(name[:100], kind, first, second, poses[second].position)
    held = poses[first] @ Pose(relative[:3], quaternion(relative[3:], part))
    own = poses[second]
    return RobotJoint(
        name[:100], kind, first, second, own.position, own.rotation,
        parent_place=held.position, parent_axes=held.rotation,
    )  # fmt: skip


def _couple(
    name: str,
    a: Mapping[str, str],
    freedoms: Mapping[str, str],
    couplings: list[Coupled],
    start: Start,
    part: str,
) -> None:
    follower, leader = a.get("joint1", ""), a.get("joint2", "")
    for joint in (follower, leader):
        if not freedoms.get(joint):
            raise ModelError(
                part,
                f'names "{joint}", which is no hinge or slide.' if joint else "holds one joint.",
                "Couple two hinges or slides; remove the joint to hold one.",
            )
    words = a.get("polycoef", "0 1 0 0 0").split()
    c = [*numbers(" ".join(words), len(words), part, "polycoef"), 0.0, 0.0, 0.0, 0.0, 0.0]
    if any(c[2:]) or not c[1]:
        raise ModelError(
            part,
            "has a ratio that is zero or varies with the coordinate.",
            'Give polycoef="0 RATIO 0 0 0".',
        )
    own = (follower, freedoms[follower])
    couplings.append(Coupled(name[:100], (leader, freedoms[leader]), own, float(c[1])))
    if c[0]:
        start.append((own, float(c[0])))
