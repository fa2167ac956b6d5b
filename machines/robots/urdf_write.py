"""Writing URDF; loops as the constraint proposal has them (see `urdf_loops`)."""

from __future__ import annotations

from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.robots.plan import CUT, Piece, Plan, cut_plan, piece_names, pieces
from strutwork.machines.robots.robot import WORLD, Link, Robot, RobotJoint
from strutwork.machines.robots.xml_write import (
    NO_LIMIT,
    add,
    document,
    from_home,
    loop_notes,
    points_of,
    require_tree,
    shown,
)

Array = NDArray[Any]

#: Kinds by which a constraint closes a loop.
HELD = CUT


def urdf_text(robot: Robot) -> str:
    """The text of a URDF file.

    Joints with several directions are several joints with massless links between.

    Parameters
    ----------
    robot : Robot

    Raises
    ------
    ModelError
        A loop or coupling that URDF cannot have; names it.
    """
    plan = cut_plan(robot, HELD, "URDF")
    require_tree(plan, "URDF")
    return _Writer(plan).text()


class _Writer:
    """One file as it grows."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.root = Element("robot", {"name": plan.robot.title})
        self.frames = plan.frames()
        self.names = piece_names(plan)
        self.notes = [*plan.robot.notes, *loop_notes(plan)]
        points = np.array([*self.frames.values()])
        self.size = float(np.abs(points).max(initial=0.0))

    def text(self) -> str:
        plan = self.plan
        tree = list(plan.tree)
        base = self._base()
        if base is None:
            add(self.root, "link", name=WORLD)
        else:
            # its frame is that of the world
            self.frames[base.child] = np.zeros(3)
            tree.remove(base)
        for link in plan.robot.links:
            self._link(link)
        for name in plan.floating:
            element = add(self.root, "joint", name=f"{name} floating", type="floating")
            self._ends(element, WORLD, name, self.frames[name])
        for joint in tree:
            self._joint(joint)
        for name, owner, place in points_of(plan):
            add(self.root, "link", name=name)
            element = add(self.root, "joint", name=f"{name} fixed", type="fixed")
            self._ends(element, owner, name, place)
        for joint in plan.loops:
            self._loop(joint)
        if plan.loops:
            self.notes.append(
                "Loops are <constraint> elements, a proposal to URDF (ros/urdfdom#264): readers "
                "that do not know it see the tree alone."
            )
        return document(self.root, self.notes)

    def _base(self) -> RobotJoint | None:
        """The joint that fixes the only link on the world, which then is the root."""
        on_world = [j for j in self.plan.tree if j.parent == WORLD]
        looped = any(WORLD in {j.parent, j.child} for j in self.plan.loops)
        if len(on_world) == 1 and on_world[0].kind == "fixed" and not looped:
            return None if self.plan.floating else on_world[0]
        return None

    def _link(self, link: Link) -> None:
        element = add(self.root, "link", name=link.name)
        if not link.mass:
            return
        inertial = add(element, "inertial")
        add(inertial, "origin", xyz=self._shown(link.centre - self.frames[link.name]))
        add(inertial, "mass", value=shown(link.mass))
        size = float(np.abs(link.inertia).max(initial=0.0))
        entries = {
            f"i{'xyz'[i]}{'xyz'[j]}": shown(link.inertia[i, j], size)
            for i in range(3)
            for j in range(i, 3)
        }
        add(inertial, "inertia", **entries)

    def _joint(self, joint: RobotJoint) -> None:
        if joint.kind == "fixed":
            element = add(self.root, "joint", name=joint.name, type="fixed")
            self._ends(element, joint.parent, joint.child, joint.place)
            return
        plain = not any(f.driven or f.limits or f.damping for f in joint.freedoms)
        if joint.kind == "planar" and plain:
            element = add(self.root, "joint", name=joint.name, type="planar")
            self._ends(element, joint.parent, joint.child, joint.place)
            add(element, "axis", xyz=shown(joint.axis, 1.0))
            return
        if joint.kind == "spherical":
            self.notes.append(
                f"joint {joint.name} is a ball: three hinges here, which fail where the second "
                "has turned by 90 degrees."
            )
        parts = pieces(joint)
        parent = joint.parent
        for k, piece in enumerate(parts, 1):
            child = joint.child if k == len(parts) else f"{piece.name} link"
            if child != joint.child:
                add(self.root, "link", name=child)
            self.frames.setdefault(child, joint.place)
            self._piece(piece, parent, child, joint)
            parent = child

    def _piece(self, piece: Piece, parent: str, child: str, joint: RobotJoint) -> None:
        limits = from_home(piece.freedom)
        endless = piece.turns and limits is None
        kind = "continuous" if endless else "revolute" if piece.turns else "prismatic"
        element = add(self.root, "joint", name=piece.name, type=kind)
        self._ends(element, parent, child, joint.place)
        add(element, "axis", xyz=shown(piece.axis, 1.0))
        f = piece.freedom
        low, high = (-NO_LIMIT, NO_LIMIT) if limits is None else limits
        ends = {} if endless else {"lower": shown(low), "upper": shown(high)}
        effort = (f.effort or NO_LIMIT) if f.driven else 0.0
        speed = NO_LIMIT if f.speed is None else f.speed
        add(element, "limit", **ends, effort=shown(effort), velocity=shown(speed))
        if f.damping:
            add(element, "dynamics", damping=shown(f.damping))
        if piece.lead is not None:
            turn = f"{joint.name}:rz"
            add(element, "mimic", joint=turn, multiplier=shown(piece.lead), offset="0")
            return
        for c in self.plan.robot.couplings:
            if self.names.get(c.follower) == piece.name:
                leader = self.names[c.leader]
                add(element, "mimic", joint=leader, multiplier=shown(c.ratio), offset="0")

    def _ends(self, element: Element, parent: str, child: str, place: Array) -> None:
        add(element, "origin", xyz=self._shown(place - self.frames[parent]))
        add(element, "parent", link=parent)
        add(element, "child", link=child)

    def _shown(self, values: Array) -> str:
        return shown(values, self.size)

    def _loop(self, joint: RobotJoint) -> None:
        element = add(self.root, "constraint", name=joint.name, type=joint.kind)
        second = joint.second if joint.kind == "universal" else joint.axis
        for end, link, axis in (
            ("parent", joint.parent, joint.axis),
            ("child", joint.child, second),
        ):
            add(element, end, link=link)
            add(element, f"{end}_origin", xyz=self._shown(joint.place - self.frames[link]))
            if joint.kind not in {"fixed", "spherical"}:
                add(element, f"{end}_axis", xyz=shown(axis, 1.0))
