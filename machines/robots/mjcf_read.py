"""Reading MJCF, a tree of bodies with equality constraints that close loops.

See https://mujoco.readthedocs.io (XML reference). Constraints of MuJoCo are compliant; here they
are rigid.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.choices import Choices, actuated, tool_of
from strutwork.machines.robots.mjcf_defaults import Compiler, Defaults, compiler_of, frame_of
from strutwork.machines.robots.mjcf_equality import equalities
from strutwork.machines.robots.mjcf_inertia import Inertial, of_shape, stated, summed
from strutwork.machines.robots.poses import Pose, joint_axes
from strutwork.machines.robots.robot import WORLD, Freedom, Link, Robot, RobotJoint
from strutwork.machines.robots.xml_text import children, label, limit_pair, number, numbers, plain

Array = NDArray[Any]

#: Elements whose meaning is in other files, or that make many bodies of one.
REFUSED = ("include", "attach", "replicate", "composite", "flexcomp")
#: Actuators that act on a joint.
ACTUATORS = (
    "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion",
    "general", "dcmotor",
)  # fmt: skip


def mjcf_robot(root: Element, choices: Choices) -> Robot:
    """The robot of an MJCF file in its reference configuration, qpos0.

    Parameters
    ----------
    root : Element
    choices : Choices

    Raises
    ------
    ModelError
        Names what is wrong, or what is not supported.
    """
    if root.tag != "mujoco":
        raise ModelError(
            "MJCF", f"begins with <{plain(root.tag)}>.", "It must begin with <mujoco>."
        )
    for element in root.iter():
        if element.tag in REFUSED:
            where = element.get("file") or element.get("name") or ""
            raise ModelError(
                f"{element.tag} {where}"[:100].strip(),
                "is not opened or expanded.",
                "Save the model in one file: in MuJoCo, mj_saveLastXML or Save xml.",
            )
    worlds = list(children(root, "worldbody"))
    if not worlds:
        raise ModelError("MJCF", "has no <worldbody>.", "Define its bodies.")
    reading = _Reading(compiler_of(root), Defaults(root))
    for world in worlds:
        reading.bodies(world, WORLD, Pose(), None)
    if not reading.links:
        raise ModelError("MJCF", "has no <body>.", "Define its bodies.")
    joints, couplings, start = equalities(
        root, reading.defaults, reading.poses, reading.sites, reading.freedoms, reading.notes
    )
    option = root.find("option")
    text = None if option is None else option.get("gravity")
    pull = (0.0, 0.0, -9.81) if text is None else numbers(text, 3, "option", "gravity")
    robot = Robot(
        title=(root.get("model") or "robot")[:100],
        links=tuple(reading.links),
        joints=(*reading.joints, *joints),
        couplings=tuple(couplings),
        gravity=(float(pull[0]), float(pull[1]), float(pull[2])),
        notes=tuple(reading.notes),
        start=tuple(start),
    )
    named = {
        attributes["joint"]
        for element in _actuators(root)
        for attributes in [reading.defaults.of(element, None)]
        if "joint" in attributes
    }
    robot = actuated(robot, choices, named, {})
    places = {name: (link, pose.position) for name, (link, pose) in reading.sites.items()}
    return tool_of(robot, choices, places)


def _actuators(root: Element) -> Iterator[Element]:
    for group in children(root, "actuator"):
        yield from children(group, *ACTUATORS)


@dataclass
class _Reading:
    """What has been read of the bodies."""

    compiler: Compiler
    defaults: Defaults
    links: list[Link] = field(default_factory=list)
    joints: list[RobotJoint] = field(default_factory=list)
    poses: dict[str, Pose] = field(default_factory=lambda: {WORLD: Pose()})
    sites: dict[str, tuple[str, Pose]] = field(default_factory=dict)
    freedoms: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def bodies(self, element: Element, parent: str, frame: Pose, around: str | None) -> None:
        """The bodies, sites and frames within an element."""
        for child in element:
            tag = plain(child.tag)
            if tag == "body":
                self._body(child, parent, frame, child.get("childclass") or around)
            elif tag == "frame":
                inner = frame @ frame_of(child.attrib, self.compiler, label(child))
                self.bodies(child, parent, inner, child.get("childclass") or around)
            elif tag == "site":
                attributes = self.defaults.of(child, around)
                name = attributes.get("name")
                if name:
                    pose = frame @ frame_of(attributes, self.compiler, f"site {name}")
                    self.sites[name] = (parent, pose)

    def _body(self, element: Element, parent: str, frame: Pose, around: str | None) -> None:
        name = (element.get("name") or f"body {len(self.links) + 1}")[:100]
        part = f"body {name}"
        if name in self.poses:
            raise ModelError(part, "is defined twice.", "Give every body its own name.")
        if element.get("mocap") == "true":
            self.notes.append(f"{part} is moved by the simulation (mocap): it is fixed here.")
        pose = frame @ frame_of(element.attrib, self.compiler, part)
        self.poses[name] = pose
        self._joints(element, name, parent, pose, around)
        inertial = self._mass(element, part, around).moved(pose)
        self.links.append(
            Link(name, pose.position, pose.rotation, inertial.mass, inertial.centre,
                 inertial.inertia)
        )  # fmt: skip
        self.bodies(element, name, pose, around)

    def _mass(self, element: Element, part: str, around: str | None) -> Inertial:
        own = element.find("inertial")
        mode = self.compiler.from_geometry
        if own is not None and mode != "true":
            return stated(own, self.compiler, part)
        if mode == "false":
            return Inertial(0.0, np.zeros(3), np.zeros((3, 3)))
        parts = []
        for geom, frame, inner in self._geoms(element, Pose(), around):
            attributes = self.defaults.of(geom, inner)
            name = attributes.get("name")
            found = of_shape(attributes, self.compiler, f"geom {name} of {part}" if name else part)
            parts.append(found.moved(frame))
        return summed(parts)

    def _geoms(
        self, element: Element, frame: Pose, around: str | None
    ) -> Iterator[tuple[Element, Pose, str | None]]:
        for child in element:
            if child.tag == "geom":
                yield child, frame, around
            elif child.tag == "frame":
                inner = frame @ frame_of(child.attrib, self.compiler, label(child))
                yield from self._geoms(child, inner, child.get("childclass") or around)

    def _joints(
        self, element: Element, name: str, parent: str, pose: Pose, around: str | None
    ) -> None:
        """The joints of a body to its parent, in series."""
        own = [child for child in element if child.tag in {"joint", "freejoint"}]
        attributes = [
            {"type": "free"} if e.tag == "freejoint" else self.defaults.of(e, around) for e in own
        ]
        if any(a.get("type") == "free" for a in attributes):
            if len(own) > 1:
                raise ModelError(
                    f"body {name}", "has a free joint beside others.", "Leave one of them."
                )
            return
        if not own:
            fixed = f"{name} on {parent}"[:100]
            self.joints.append(RobotJoint(fixed, "fixed", parent, name, pose.position))
            return
        before = parent
        for k, a in enumerate(attributes, 1):
            after = name if k == len(own) else f"{name} between {k}"[:100]
            joint = self._joint(a, a.get("name") or f"{name}:{k}", before, after, pose)
            self.joints.append(joint)
            if after != name:
                self.links.append(Link(after, joint.place))
            before = after

    def _joint(
        self, a: Mapping[str, str], name: str, parent: str, child: str, pose: Pose
    ) -> RobotJoint:
        part = f"joint {name}"
        kind = a.get("type", "hinge")
        place = pose.at(numbers(a.get("pos", "0 0 0"), 3, part, "pos"))
        for what in ("stiffness", "armature", "frictionloss"):
            if any(number(w, part, what) for w in a.get(what, "0").split()):
                self.notes.append(f"{what} of {part} is left out.")
        if kind == "ball":
            self.freedoms[name] = ""
            return RobotJoint(name[:100], "spherical", parent, child, place, pose.rotation)
        if kind not in {"hinge", "slide"}:
            raise ModelError(
                part, f'has the unknown type "{kind}".', "Types: hinge, slide, ball, free."
            )
        axis = pose.rotation @ numbers(a.get("axis", "0 0 1"), 3, part, "axis")
        turns = kind == "hinge"
        measure = self.compiler.angle if turns else float
        limits = None
        limited = a.get("limited", "auto")
        if "range" in a and (limited == "true" or (limited == "auto" and self.compiler.autolimits)):
            low, high = numbers(a["range"], 2, part, "range")
            limits = limit_pair(measure(float(low)), measure(float(high)))
        damping = a.get("damping", "0").split()
        direction = "rz" if turns else "z"
        self.freedoms[name] = direction
        freedom = Freedom(
            direction,
            home=measure(number(a.get("ref", "0"), part, "ref")),
            limits=limits,
            damping=max(number(damping[0] if damping else "0", part, "damping"), 0.0),
        )
        return RobotJoint(
            name[:100],
            "revolute" if turns else "prismatic",
            parent,
            child,
            place,
            joint_axes(axis, part),
            (freedom,),
        )
