"""Writing SDFormat 1.11, in which joints form loops as they are."""

from __future__ import annotations

from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.robots.plan import Piece, Plan, piece_names, pieces, plan_of
from strutwork.machines.robots.robot import WORLD, Freedom, Link, Robot, RobotJoint
from strutwork.machines.robots.xml_write import (
    add,
    document,
    from_home,
    points_of,
    require_tree,
    shown,
)

Array = NDArray[Any]

#: Kinds that SDFormat has, and its names of them.
NATIVE = {
    "fixed": "fixed",
    "revolute": "revolute",
    "prismatic": "prismatic",
    "helical": "screw",
    "universal": "universal",
    "spherical": "ball",
}


def sdf_text(robot: Robot) -> str:
    """The text of an SDFormat file.

    Cylindrical and planar joints are slides and hinges with massless links between.

    Parameters
    ----------
    robot : Robot

    Raises
    ------
    ModelError
        A coupling that SDFormat cannot have; names it.
    """
    plan = plan_of(robot)
    require_tree(plan, "SDF")
    return _Writer(plan).text()


class _Writer:
    """One file as it grows."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.root = Element("sdf", {"version": "1.11"})
        self.model = add(self.root, "model", name=plan.robot.title)
        self.frames = plan.frames()
        self.names = piece_names(plan)
        self.notes = list(plan.robot.notes)
        self.taken: set[str] = {WORLD}
        self.size = float(np.abs(np.array([*self.frames.values()])).max(initial=0.0))

    def text(self) -> str:
        for link in self.plan.robot.links:
            self.taken.add(link.name)
            self._link(link)
        for joint in (*self.plan.tree, *self.plan.loops):
            self._joint(joint)
        for name, owner, place in points_of(self.plan):
            frame = add(self.model, "frame", name=self._unique(name), attached_to=owner)
            self._pose(frame, place - self.frames[owner])
        if any(not link.mass for link in self.plan.robot.links):
            self.notes.append("Links without mass are written with a mass of zero.")
        return document(self.root, self.notes)

    def _unique(self, name: str) -> str:
        """Links, joints and frames share their names."""
        text, count = name, 2
        while text in self.taken:
            text, count = f"{name} {count}", count + 1
        self.taken.add(text)
        return text

    def _pose(self, element: Element, place: Array) -> None:
        add(element, "pose", f"{shown(place, self.size)} 0 0 0")

    def _link(self, link: Link) -> None:
        place = self.frames[link.name]
        element = add(self.model, "link", name=link.name)
        self._pose(element, place)
        inertial = add(element, "inertial")
        if link.mass:
            self._pose(inertial, link.centre - place)
        add(inertial, "mass", shown(link.mass))
        matrix = add(inertial, "inertia")
        size = float(np.abs(link.inertia).max(initial=0.0))
        for i in range(3):
            for j in range(i, 3):
                add(matrix, f"i{'xyz'[i]}{'xyz'[j]}", shown(link.inertia[i, j], size))

    def _joint(self, joint: RobotJoint) -> None:
        if joint.kind in NATIVE:
            self._native(joint)
            return
        parts = pieces(joint)
        parent = joint.parent
        for k, piece in enumerate(parts, 1):
            child = joint.child
            if k < len(parts):
                child = self._unique(f"{piece.name} link")
                self.frames[child] = joint.place
                self._link(Link(child, joint.place))
            self._piece(piece, parent, child, joint.place)
            parent = child

    def _open(self, name: str, kind: str, parent: str, child: str, place: Array) -> Element:
        if child == WORLD:
            parent, child = child, parent
        element = add(self.model, "joint", name=self._unique(name), type=kind)
        self._pose(element, place - self.frames[child])
        add(element, "parent", parent)
        add(element, "child", child)
        return element

    def _native(self, joint: RobotJoint) -> None:
        if joint.child == WORLD:
            from strutwork.machines.robots.plan import turned

            joint = turned(joint)
        element = self._open(joint.name, NATIVE[joint.kind], joint.parent, joint.child, joint.place)
        if joint.kind == "helical":
            add(element, "screw_thread_pitch", shown(joint.pitch or 0.0))
        if joint.kind in {"fixed", "spherical"}:
            return
        for tag, f in zip(("axis", "axis2"), joint.freedoms, strict=False):
            piece = self.names.get((joint.name, f.direction), "")
            axis = joint.axis if joint.kind == "helical" else joint.vector(f.direction)
            self._axis(element, tag, axis, f, piece)

    def _piece(self, piece: Piece, parent: str, child: str, place: Array) -> None:
        axis = piece.axis
        if child == WORLD:
            axis = -axis
        kind = "revolute" if piece.turns else "prismatic"
        element = self._open(piece.name, kind, parent, child, place)
        self._axis(element, "axis", axis, piece.freedom, piece.name)

    def _axis(self, element: Element, tag: str, axis: Array, f: Freedom, piece: str) -> None:
        own = add(element, tag)
        add(own, "xyz", shown(axis, 1.0))
        for c in self.plan.robot.couplings:
            if piece and self.names.get(c.follower) == piece:
                self._mimic(own, c.leader, c.ratio)
        limits = from_home(f)
        limit = add(own, "limit")
        if limits is not None:
            add(limit, "lower", shown(limits[0]))
            add(limit, "upper", shown(limits[1]))
        if not f.driven or f.effort is not None:
            # an effort of zero: no drive, as in Drake
            add(limit, "effort", shown(f.effort or 0.0) if f.driven else "0")
        else:
            add(limit, "effort", "-1")
        if f.speed is not None:
            add(limit, "velocity", shown(f.speed))
        if f.damping:
            add(add(own, "dynamics"), "damping", shown(f.damping))

    def _mimic(self, own: Element, leader: tuple[str, str], ratio: float) -> None:
        joint = next(j for j in self.plan.tree if j.name == leader[0])
        name, axis = self.names[leader], "axis"
        if joint.kind in NATIVE:
            name = joint.name
            axis = "axis2" if joint.kind == "universal" and leader[1] == "rx" else "axis"
        mimic = add(own, "mimic", joint=name, axis=axis)
        add(mimic, "multiplier", shown(ratio))
        add(mimic, "offset", "0")
        add(mimic, "reference", "0")
