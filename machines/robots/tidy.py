"""Joints that a format has to write in several pieces, made one again."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.robots.poses import joint_axes
from strutwork.machines.robots.robot import WORLD, Freedom, Robot, RobotJoint

Array = NDArray[Any]

#: Axes that differ by less are perpendicular, parallel or meet, m and rad.
NEAR = 1e-9


def tidied(robot: Robot) -> Robot:
    """The robot with fewer pieces, which moves in the same way.

    Two joints in series with a massless link between them become one: two hinges whose axes
    meet at right angles a universal joint, a slide and a hinge along one axis a cylindrical
    one. Massless links that are fixed to another and carry nothing become named points of it.
    Two balls NAME:1 and NAME:2 between the same links, as a hinge is written in MJCF, become one.

    Parameters
    ----------
    robot : Robot
    """
    joints, links, points, tool = _points(_on_ground(robot))
    renamed: dict[tuple[str, str], tuple[str, str]] = {}
    kept = {tool[0]} if tool is not None else set()
    kept |= {link for _, link, _ in points}
    massless = [link.name for link in links if link.mass == 0 and link.name not in kept]
    gone = set()
    for name in massless:
        ends = [joint for joint in joints if name in {joint.parent, joint.child}]
        if len(ends) != 2:
            continue
        first, second = ends if ends[0].child == name else ends[::-1]
        if first.child != name or second.parent != name:
            continue
        merged = _universal(first, second) or _ball(first, second) or _cylindrical(first, second)
        if merged is None:
            continue
        joint, mapping = merged
        for key, value in renamed.items():
            renamed[key] = mapping.get(value, value)
        renamed |= mapping
        at = joints.index(first)
        joints[at] = joint
        joints.remove(second)
        gone.add(name)
    joints = _hinges(joints)
    couplings = tuple(
        replace(
            c, leader=renamed.get(c.leader, c.leader), follower=renamed.get(c.follower, c.follower)
        )
        for c in robot.couplings
    )
    return replace(
        robot,
        links=tuple(link for link in links if link.name not in gone),
        joints=tuple(joints),
        couplings=couplings,
        points=points,
        tool=tool,
        start=tuple((renamed.get(key, key), value) for key, value in robot.start),
    )


def _on_ground(robot: Robot) -> Robot:
    """Massless links that are fixed to the world, as the world."""
    kept = {k for _, k, _ in robot.points} | (set() if robot.tool is None else {robot.tool[0]})
    massless = {link.name for link in robot.links if link.mass == 0} - kept
    fixed = {
        joint.child
        for joint in robot.joints
        if joint.kind == "fixed" and joint.parent == WORLD and joint.parent_place is None
    } & massless
    joints = [
        replace(
            joint,
            parent=WORLD if joint.parent in fixed else joint.parent,
            child=WORLD if joint.child in fixed else joint.child,
        )
        for joint in robot.joints
        if not (joint.kind == "fixed" and joint.parent == WORLD and joint.child in fixed)
    ]
    links = tuple(link for link in robot.links if link.name not in fixed)
    return replace(robot, links=links, joints=tuple(joints))


def _points(robot: Robot) -> tuple[Any, Any, Any, Any]:
    """Massless links that are fixed to another, as points of it."""
    joints, links = list(robot.joints), list(robot.links)
    points, tool = list(robot.points), robot.tool
    found = True
    while found:
        found = False
        for link in [link for link in links if link.mass == 0]:
            ends = [joint for joint in joints if link.name in {joint.parent, joint.child}]
            if len(ends) != 1 or ends[0].kind != "fixed" or ends[0].parent_place is not None:
                continue
            other = ends[0].parent if ends[0].child == link.name else ends[0].child
            if other == WORLD:
                # it would be a point of the ground, which nobody needs
                continue
            points = [(n, other if k == link.name else k, p) for n, k, p in points]
            if tool is not None and tool[0] == link.name:
                tool = (other, tool[1])
            else:
                points.append((link.name, other, link.origin))
            joints.remove(ends[0])
            links.remove(link)
            found = True
    return joints, links, tuple(points), tool


def _universal(
    first: RobotJoint, second: RobotJoint
) -> tuple[RobotJoint, dict[tuple[str, str], tuple[str, str]]] | None:
    if first.kind != "revolute" or second.kind != "revolute":
        return None
    if second.parent_place is not None or first.parent_place is not None:
        return None
    z, x = first.axis, second.axis
    meet = _meeting(first, second)
    if abs(float(z @ x)) > NEAR or meet is None:
        return None
    name = _common(first.name, second.name)
    axes = joint_axes(z, f"joint {name}", x)
    freedoms = (first.freedoms[0], replace(second.freedoms[0], direction="rx"))
    made = RobotJoint(name, "universal", first.parent, second.child, meet, axes, freedoms)
    return made, {(first.name, "rz"): (name, "rz"), (second.name, "rz"): (name, "rx")}


def _ball(
    first: RobotJoint, second: RobotJoint
) -> tuple[RobotJoint, dict[tuple[str, str], tuple[str, str]]] | None:
    """Three hinges that are named as the pieces of a ball."""
    if first.kind != "universal" or second.kind != "revolute":
        return None
    name, _, direction = second.name.rpartition(":")
    if name != first.name or direction != "rz" or second.parent_place is not None:
        return None
    x, y, z = first.axis, first.second, second.axis
    apart = float(np.linalg.norm(second.place - first.place))
    if max(apart, abs(float(x @ z)), abs(float(y @ z))) > NEAR:
        return None
    pieces = (*first.freedoms, *second.freedoms)
    if any(f.driven for f in pieces):
        return None
    freedoms = tuple(
        Freedom(d, damping=f.damping) for d, f in zip(("rx", "ry", "rz"), pieces, strict=True)
    )
    axes = np.stack([x, y, np.cross(x, y)], axis=1)
    made = RobotJoint(name, "spherical", first.parent, second.child, second.place, axes, freedoms)
    return made, {}


def _meeting(first: RobotJoint, second: RobotJoint) -> Array | None:
    """Where two perpendicular axes meet."""
    across = np.cross(first.axis, second.axis)
    gap = second.place - first.place
    if abs(float(gap @ across)) > NEAR:
        return None
    if np.linalg.norm(gap) <= NEAR:
        return second.place
    return np.asarray(first.place + (gap @ first.axis) * first.axis)


def _cylindrical(
    first: RobotJoint, second: RobotJoint
) -> tuple[RobotJoint, dict[tuple[str, str], tuple[str, str]]] | None:
    if {first.kind, second.kind} != {"revolute", "prismatic"}:
        return None
    if second.parent_place is not None or first.parent_place is not None:
        return None
    # of the same sense, so that both coordinates stay what they are
    if float(first.axis @ second.axis) < 1 - NEAR:
        return None
    slide, hinge = (first, second) if first.kind == "prismatic" else (second, first)
    name = _common(first.name, second.name)
    freedoms: tuple[Freedom, ...] = (slide.freedoms[0], hinge.freedoms[0])
    made = RobotJoint(
        name, "cylindrical", first.parent, second.child, hinge.place, hinge.axes, freedoms
    )
    return made, {(slide.name, "z"): (name, "z"), (hinge.name, "rz"): (name, "rz")}


def _common(first: str, second: str) -> str:
    """The name of two pieces of one joint, that of the first where they were none."""
    one, _, _ = first.rpartition(":")
    other, _, _ = second.rpartition(":")
    return one if one and one == other else first


def _hinges(joints: list[RobotJoint]) -> list[RobotJoint]:
    """Two balls between the same two links hold them as a hinge does."""
    result = list(joints)
    balls = [joint for joint in joints if joint.kind == "spherical"]
    for first, second in combinations(balls, 2):
        if {first.parent, first.child} != {second.parent, second.child}:
            continue
        if (first.name.rpartition(":")[0], second.name.rpartition(":")[0]).count("") or (
            _common(first.name, second.name) == first.name
        ):
            # balls of their own, as the feet of a frame, stay
            continue
        if first not in result or second not in result:
            continue
        line = second.place - first.place
        if first.parent_place is not None or second.parent_place is not None:
            continue
        if np.linalg.norm(line) <= NEAR:
            continue
        axes = joint_axes(line, f"joint {first.name}")
        name = _common(first.name, second.name)
        at = result.index(first)
        result[at] = RobotJoint(name, "revolute", first.parent, first.child, first.place, axes)
        result.remove(second)
    return result
