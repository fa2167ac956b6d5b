"""Writing MJCF; loops as `connect` and `weld` constraints."""

from __future__ import annotations

from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.plan import Plan, cut_plan, piece_names, pieces
from strutwork.machines.robots.robot import WORLD, Link, Robot, RobotJoint
from strutwork.machines.robots.xml_write import (
    add,
    document,
    loop_notes,
    points_of,
    require_tree,
    shown,
)

Array = NDArray[Any]

#: Kinds that equality constraints hold.
HELD = ("spherical", "fixed", "revolute")
#: MuJoCo refuses moving bodies with less, kg and kg·m².
LEAST = 1e-15


def mjcf_text(robot: Robot) -> str:
    """The text of an MJCF file, drawn in its reference configuration.

    A loop closed by another joint than a ball, a hinge or a rigid joint is cut through a link:
    half of it follows the joint, and both halves are welded.

    Parameters
    ----------
    robot : Robot

    Raises
    ------
    ModelError
        A moving link without mass or inertia, or a loop or coupling that MJCF cannot have.
    """
    plan = cut_plan(robot, HELD, "MJCF", massive=True)
    require_tree(plan, "MJCF")
    return _Writer(plan).text()


class _Writer:
    """One file as it grows."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.frames = plan.frames()
        self.names = piece_names(plan)
        self.links = {link.name: link for link in plan.robot.links}
        self.size = float(np.abs(np.array([*self.frames.values()])).max(initial=0.0)) or 1.0
        self.root = Element("mujoco", {"model": plan.robot.title})

    def text(self) -> str:
        plan, robot = self.plan, self.plan.robot
        add(self.root, "compiler", angle="radian", autolimits="true")
        add(self.root, "option", gravity=shown(robot.gravity or (0.0, 0.0, 0.0)))
        bodies = {WORLD: add(self.root, "worldbody")}
        self._require_mass()
        chained = self._chained()
        series: dict[str, tuple[RobotJoint, ...]] = {}
        above = dict.fromkeys(bodies, WORLD)
        for name in plan.floating:
            above[name] = name
            bodies[name] = self._body(bodies[WORLD], self.links[name], WORLD)
            add(bodies[name], "freejoint")
            self._inertial(bodies[name], self.links[name])
        for joint in plan.tree:
            link = self.links[joint.child]
            before = (*series.get(joint.parent, ()), joint)
            above[joint.child] = above.get(joint.parent, joint.parent)
            if joint.child in chained:
                series[joint.child] = before
                continue
            body = self._body(bodies[above[joint.child]], link, above[joint.child])
            above[joint.child] = joint.child
            bodies[joint.child] = body
            for one in before:
                self._joints(body, one)
            self._inertial(body, link)
        for name, owner, place in points_of(plan):
            add(bodies[owner], "site", name=name, pos=self._shown(place - self.frames[owner]))
        self._equality()
        self._actuators()
        return document(self.root, [*robot.notes, *loop_notes(plan)])

    def _chained(self) -> set[str]:
        """Massless links between two joints in series: joints of MJCF need none between them."""
        plan = self.plan
        inner = [joint.parent for joint in plan.tree]
        used = {end for joint in plan.loops for end in (joint.parent, joint.child)}
        used |= {owner for _, owner, _ in points_of(plan)}
        return {
            joint.child
            for joint in plan.tree
            if not self.links[joint.child].mass
            and inner.count(joint.child) == 1
            and joint.kind != "fixed"
            and joint.child not in used
        }

    def _require_mass(self) -> None:
        """MuJoCo inverts the mass of every moving body."""
        carried: dict[str, bool] = {}
        chained = self._chained()
        for joint in reversed(self.plan.tree):
            link = self.links[joint.child]
            heavy = link.mass > LEAST and np.linalg.eigvalsh(link.inertia).min() > LEAST
            carried[joint.child] = heavy or carried.get(joint.child, False)
            if (joint.kind == "fixed" or joint.parent in chained) and carried[joint.child]:
                carried[joint.parent] = True
            if joint.kind != "fixed" and not carried[joint.child]:
                raise ModelError(
                    f"link {link.name}",
                    "moves and has no mass, or no inertia about some axis, which MuJoCo refuses.",
                    "Give it a mass and an inertia, or write SDF or URDF.",
                )

    def _body(self, parent: Element, link: Link, before: str) -> Element:
        place = self._shown(self.frames[link.name] - self.frames[before])
        return add(parent, "body", name=link.name, pos=place)

    def _inertial(self, body: Element, link: Link) -> None:
        if not link.mass:
            return
        size = float(np.abs(link.inertia).max(initial=0.0))
        i = link.inertia
        values = [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]
        add(
            body,
            "inertial",
            pos=self._shown(link.centre - self.frames[link.name]),
            mass=shown(link.mass),
            fullinertia=shown(values, size),
        )

    def _joints(self, body: Element, joint: RobotJoint) -> None:
        if joint.kind == "spherical":
            add(body, "joint", name=joint.name, type="ball", pos=self._in(body, joint))
            return
        for piece in pieces(joint) if joint.kind != "fixed" else ():
            f = piece.freedom
            optional = {}
            if f.limits is not None:
                optional["range"] = shown(f.limits)
            if f.home:
                optional["ref"] = shown(f.home)
            if f.damping:
                optional["damping"] = shown(f.damping)
            add(
                body,
                "joint",
                name=piece.name,
                type="hinge" if piece.turns else "slide",
                pos=self._in(body, joint),
                axis=shown(piece.axis, 1.0),
                **optional,
            )

    def _in(self, body: Element, joint: RobotJoint) -> str:
        """Place of a joint in the frame of a body."""
        return self._shown(joint.place - self.frames[str(body.get("name"))])

    def _equality(self) -> None:
        entries = []
        for joint in self.plan.tree:
            if joint.kind == "helical":
                lead = shown((joint.pitch or 0.0) / (2 * np.pi))
                z, rz = f"{joint.name}:z", f"{joint.name}:rz"
                entries.append((f"{joint.name} screw", z, rz, lead))
        entries += [
            (c.name, self.names[c.follower], self.names[c.leader], shown(c.ratio))
            for c in self.plan.robot.couplings
        ]
        if not entries and not self.plan.loops:
            return
        equality = add(self.root, "equality")
        for name, follower, leader, ratio in entries:
            add(
                equality,
                "joint",
                name=name,
                joint1=follower,
                joint2=leader,
                polycoef=f"0 {ratio} 0 0 0",
            )
        for joint in self.plan.loops:
            self._loop(equality, joint)

    def _loop(self, equality: Element, joint: RobotJoint) -> None:
        first, second = joint.parent, joint.child
        if first == WORLD:
            first, second = second, first
        ends = {"body1": first} | ({} if second == WORLD else {"body2": second})
        if joint.kind == "fixed":
            add(equality, "weld", name=joint.name, **ends)
            return
        places = [joint.place]
        if joint.kind == "revolute":
            # two points of the axis
            places.append(joint.place + 0.1 * self.size * joint.axis)
        for k, place in enumerate(places, 1):
            name = joint.name if len(places) == 1 else f"{joint.name}:{k}"
            anchor = self._shown(place - self.frames[first])
            add(equality, "connect", name=name, **ends, anchor=anchor)

    def _actuators(self) -> None:
        driven = [
            (self.names[joint.name, direction], f.effort)
            for joint in self.plan.robot.joints
            for f in joint.freedoms
            for direction in (f.direction,)
            if f.driven and (joint.name, direction) in self.names
        ]
        if not driven:
            return
        actuator = add(self.root, "actuator")
        for name, effort in driven:
            bounds = {} if effort is None else {"forcerange": shown((-effort, effort))}
            add(actuator, "motor", name=f"{name} motor", joint=name, **bounds)

    def _shown(self, values: Array) -> str:
        return shown(values, self.size)
