"""A robot as a tree and the joints that close loops, as formats write it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.robot import WORLD, Freedom, Robot, RobotJoint

Array = NDArray[Any]

#: Kinds of joints in the order in which loops are cut at them, the best first.
CUT = ("spherical", "fixed", "revolute", "universal", "cylindrical", "planar", "prismatic")


@dataclass(frozen=True, eq=False)
class Plan:
    """A tree from the world outwards, and loops.

    Parameters
    ----------
    robot : Robot
    tree : tuple of RobotJoint
        From the link nearer to the world to the other one, outwards.
    loops : tuple of RobotJoint
    floating : tuple of str
        Links that no joint attaches to the world: each carries a tree of its own.
    """

    robot: Robot
    tree: tuple[RobotJoint, ...]
    loops: tuple[RobotJoint, ...]
    floating: tuple[str, ...]

    def frames(self) -> dict[str, Array]:
        """Where the frame of each link stands, at its joint of the tree, world axes, (3,), m."""
        found = {WORLD: np.zeros(3)}
        found |= {link.name: link.origin for link in self.robot.links}
        return found | {joint.child: joint.place for joint in self.tree}


def plan_of(robot: Robot, welds: Collection[str] = ()) -> Plan:
    """A spanning tree in which driven and coupled joints are, cut at `CUT` first.

    Parameters
    ----------
    robot : Robot
    welds : collection of str
        Joints that are none of the tree.
    """
    coupled = {end[0] for c in robot.couplings for end in (c.leader, c.follower)}

    def rank(joint: RobotJoint) -> tuple[int, int]:
        driven = any(f.driven for f in joint.freedoms)
        order = CUT.index(joint.kind) if joint.kind in CUT else len(CUT)
        if joint.name in welds:
            return (1, 0)
        if joint.name in coupled:
            return (-3, -order)
        return (-2 if joint.kind == "helical" else -1 if driven else 0, -order)

    piece = {name: name for name in (WORLD, *(link.name for link in robot.links))}

    def root(name: str) -> str:
        while piece[name] != name:
            piece[name] = piece[piece[name]]
            name = piece[name]
        return name

    kept = set()
    for joint in sorted(robot.joints, key=rank):
        one, other = root(joint.parent), root(joint.child)
        if one != other:
            piece[one] = other
            kept.add(joint.name)
    tree, floating = _outwards(robot, kept)
    loops = tuple(joint for joint in robot.joints if joint.name not in kept)
    return Plan(robot, tuple(tree), loops, tuple(floating))


def cut_plan(robot: Robot, held: Collection[str], format_: str, *, massive: bool = False) -> Plan:
    """A plan in which links are cut in two where a format cannot close a loop.

    One half follows the joint of the loop, the other stays, and both are joined rigidly: nothing
    else moves by it, and the mass is the same.

    Parameters
    ----------
    robot : Robot
    held : collection of str
        Kinds of joints by which the format closes loops.
    format_ : str
        For messages.
    massive : bool
        Whether the tree may not end in a link without mass.

    Raises
    ------
    ModelError
        Neither link of such a joint has a mass that could be cut.
    """
    welds: set[str] = set()
    while True:
        plan = plan_of(robot, welds)
        links = {link.name: link for link in robot.links}
        inner = {joint.parent for joint in plan.tree}
        ends = {name for name, link in links.items() if not link.mass and name not in inner}
        if not massive:
            ends = set()
        heavy = {name for name, link in links.items() if link.mass}
        joint = next((j for j in plan.loops if _to_cut(j, held, ends, heavy)), None)
        if joint is None:
            return plan
        own = joint if joint.child in heavy else turned(joint)
        link = links.get(own.child)
        if link is None or not link.mass:
            raise ModelError(
                f"joint {joint.name}",
                f"is {joint.kind} and closes a loop, and neither of its links has a mass that "
                f"could be cut in two for {format_}.",
                "Give one of them a mass, or write SDF.",
            )
        half = replace(link, mass=link.mass / 2, inertia=link.inertia / 2)
        name = f"{link.name[:85]} half {len(welds) + 1}"
        weld = RobotJoint(f"{name} weld", "fixed", link.name, name, link.centre)
        welds.add(weld.name)
        joints = tuple(replace(own, child=name) if j is joint else j for j in robot.joints)
        robot = replace(
            robot,
            links=(*(half if k is link else k for k in robot.links), replace(half, name=name)),
            joints=(*joints, weld),
        )


def _to_cut(
    joint: RobotJoint, held: Collection[str], ends: Collection[str], heavy: Collection[str]
) -> bool:
    """Whether a link must be cut for a loop, or should be for the sake of its drive."""
    links = {joint.parent, joint.child}
    if joint.kind not in held or links & set(ends):
        return True
    return any(f.driven for f in joint.freedoms) and bool(links & set(heavy))


def _outwards(robot: Robot, kept: set[str]) -> tuple[list[RobotJoint], list[str]]:
    beside: dict[str, list[RobotJoint]] = {WORLD: []}
    for link in robot.links:
        beside[link.name] = []
    for joint in robot.joints:
        if joint.name in kept:
            beside[joint.parent].append(joint)
            beside[joint.child].append(joint)
    placed: set[str] = set()
    tree: list[RobotJoint] = []
    floating = []
    for start in beside:
        if start in placed:
            continue
        if start != WORLD:
            floating.append(start)
        placed.add(start)
        waiting = [start]
        for near in waiting:
            for joint in beside[near]:
                outward = joint if joint.parent == near else turned(joint)
                if outward.child in placed:
                    continue
                placed.add(outward.child)
                waiting.append(outward.child)
                tree.append(outward)
    return tree, floating


def turned(joint: RobotJoint) -> RobotJoint:
    """The same joint seen from its child, with the same coordinates.

    Parameters
    ----------
    joint : RobotJoint
        The turn of a ball changes its sign, and shifts of a planar joint go with the other body:
        their ranges are dropped.
    """
    x, y, z = joint.axes.T
    swapped: dict[str, str] = {}
    drop: Sequence[str] = ()
    if joint.kind == "universal":
        axes = np.stack([-z, -y, -x], axis=1)
        swapped = {"rz": "rx", "rx": "rz"}
    elif joint.kind in {"spherical", "fixed"}:
        axes, drop = joint.axes, ("rx", "ry", "rz")
    elif joint.kind == "planar":
        axes, drop = np.stack([-x, y, -z], axis=1), ("x", "y")
    else:
        axes = np.stack([x, -y, -z], axis=1)
    freedoms: list[Freedom] = [
        replace(
            f,
            direction=swapped.get(f.direction, f.direction),
            limits=None if f.direction in drop else f.limits,
        )
        for f in joint.freedoms
    ]
    if swapped:
        freedoms.reverse()
    return replace(
        joint, parent=joint.child, child=joint.parent, axes=axes, freedoms=tuple(freedoms)
    )


@dataclass(frozen=True, eq=False)
class Piece:
    """A joint with one direction, one of those in series that a format writes for a joint.

    Parameters
    ----------
    name : str
    turns : bool
    axis : (3,)
        World axes, no unit.
    freedom : Freedom
        Limits and home of its coordinate, m or rad.
    lead : float or None
        Of the slide of a screw: travel per rad of its turn, m.
    """

    name: str
    turns: bool
    axis: Array
    freedom: Freedom
    lead: float | None = None


def pieces(joint: RobotJoint) -> list[Piece]:
    """Slides and hinges in series that move as a joint does.

    A ball is three hinges about x, y and z of its axes: as a gimbal it fails at a right angle of
    the second.

    Parameters
    ----------
    joint : RobotJoint
    """
    found = []
    if joint.kind == "helical":
        slide = Freedom("z")
        found.append(
            Piece(f"{joint.name}:z", False, joint.axis, slide, (joint.pitch or 0.0) / (2 * np.pi))
        )
    for f in joint.freedoms:
        several = joint.kind == "helical" or len(joint.freedoms) > 1
        name = f"{joint.name}:{f.direction}" if several else joint.name
        limits = None if joint.kind == "spherical" else f.limits
        turns = f.direction.startswith("r")
        found.append(Piece(name, turns, joint.vector(f.direction), replace(f, limits=limits)))
    return found


def piece_names(plan: Plan) -> dict[tuple[str, str], str]:
    """Names of the pieces of all joints of the tree, by joint and direction.

    Of a turned universal joint the directions are those of the robot.

    Parameters
    ----------
    plan : Plan
    """
    found = {}
    own = {joint.name: joint for joint in plan.robot.joints}
    for joint in plan.tree:
        back = joint.kind == "universal" and joint.parent != own[joint.name].parent
        for piece in pieces(joint):
            direction = piece.freedom.direction
            if back:
                direction = {"rz": "rx", "rx": "rz"}[direction]
            found[joint.name, direction] = piece.name
    return found
