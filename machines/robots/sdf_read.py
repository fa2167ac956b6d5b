"""Reading SDFormat, in which joints may form loops (http://sdformat.org/spec, 1.4 to 1.12)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.choices import Choices, actuated, tool_of
from strutwork.machines.robots.poses import Pose, quaternion, roll_pitch_yaw
from strutwork.machines.robots.robot import WORLD, Coupled, Link, Robot, RobotJoint
from strutwork.machines.robots.sdf_joints import sdf_joint
from strutwork.machines.robots.urdf_read import tensor, turned_inertia
from strutwork.machines.robots.xml_text import children, name_of, number, numbers, plain

Array = NDArray[Any]


def sdf_robot(root: Element, choices: Choices) -> Robot:
    """The robot of an SDFormat file as it is drawn.

    Parameters
    ----------
    root : Element
    choices : Choices

    Raises
    ------
    ModelError
        Names what is wrong, or what is not supported: includes, nested or several models.
    """
    if root.tag != "sdf":
        raise ModelError("SDF", f"begins with <{plain(root.tag)}>.", "It must begin with <sdf>.")
    version = _version(root)
    model, world = _model(root)
    frames = _Frames(model)
    notes: list[str] = []
    links = tuple(_link(e, frames, notes) for e in children(model, "link"))
    if not links:
        raise ModelError(f"model {model.get('name')}", "has no <link>.", "Define its links.")
    joints: list[RobotJoint] = []
    couplings: list[Coupled] = []
    start: list[tuple[tuple[str, str], float]] = []
    efforts: dict[str, float | None] = {}
    for element in children(model, "joint"):
        read = sdf_joint(element, frames.pose, frames.link_of, version, notes)
        joints += read.joints
        links = (*links, *read.links)
        couplings += read.couplings
        start += read.start
        efforts |= read.efforts
    if not any(WORLD in {joint.parent, joint.child} for joint in joints):
        first = links[0].name
        joints.append(RobotJoint(f"base of {first}"[:100], "fixed", WORLD, first, np.zeros(3)))
        notes.append(
            f"No joint attaches the model to the world: its first link, {first}, is fixed to it."
        )
    gravity = None if world is None else world.find("gravity")
    pull = (0.0, 0.0, -9.80665)
    if gravity is not None:
        x, y, z = numbers(gravity.text or "", 3, "world", "gravity")
        pull = (float(x), float(y), float(z))
    robot = Robot(
        title=(model.get("name") or "robot")[:100],
        links=links,
        joints=tuple(joints),
        couplings=tuple(couplings),
        gravity=pull,
        notes=tuple(notes),
        start=tuple(start),
    )
    robot = actuated(robot, choices, (), efforts)
    named = {name: (frames.link_of(name), frames.pose(name).position) for name in frames.named}
    return tool_of(robot, choices, named)


def _version(root: Element) -> tuple[int, int]:
    text = (root.get("version") or "").strip()
    major, _, minor = text.partition(".")
    if not (major.isdigit() and minor.isdigit()):
        raise ModelError("SDF", f'has the version "{text}".', 'Give <sdf version="1.9">.')
    return int(major), int(minor)


def _model(root: Element) -> tuple[Element, Element | None]:
    """The only model of the file, and the world it is in."""
    worlds = list(children(root, "world"))
    world = worlds[0] if worlds else None
    models = [e for place in (root, *worlds) for e in children(place, "model")]
    for place in (root, *worlds, *models):
        for element in children(place, "include"):
            uri = element.find("uri")
            raise ModelError(
                f"include {'' if uri is None else (uri.text or '').strip()[:80]}".strip(),
                "is in another file: includes are not opened.",
                "Write out the model: gz sdf -p model.sdf > flat.sdf",
            )
    if len(models) != 1:
        names = ", ".join(str(m.get("name")) for m in models[:6])
        raise ModelError(
            "SDF",
            f"has {len(models)} models{': ' + names if names else ''}.",
            "Give a file with one model.",
        )
    model = models[0]
    part = f"model {model.get('name')}"
    if any(children(model, "model")):
        raise ModelError(
            part, "has a model within it.", "Write out its links and joints in one model."
        )
    static = model.find("static")
    if static is not None and (static.text or "").strip().lower() in {"1", "true"}:
        raise ModelError(part, "is static: nothing in it moves.", "Remove <static>.")
    if model.get("placement_frame"):
        raise ModelError(
            part, "has a placement_frame, which is not supported.", "Give the pose of the model."
        )
    return model, world


@dataclass
class _Frames:
    """Poses of links, joints and frames of a model in the world, found as they are asked for."""

    model: Element
    elements: dict[str, Element] = field(init=False)
    found: dict[str, Pose] = field(init=False)

    def __post_init__(self) -> None:
        self.elements = {}
        for element in children(self.model, "link", "joint", "frame"):
            name = name_of(element)
            if name in self.elements:
                raise ModelError(
                    f"{element.tag} {name}",
                    f"has the name of a {self.elements[name].tag}.",
                    "Give links, joints and frames of a model different names.",
                )
            if name == WORLD or (name.startswith("__") and name.endswith("__")):
                raise ModelError(f"{element.tag} {name}", "has a reserved name.", "Rename it.")
            self.elements[name] = element
        of_model = pose_of(self.model, f"model {self.model.get('name')}")
        self.found = {WORLD: Pose(), "__model__": of_model}

    @property
    def named(self) -> list[str]:
        """Names of the frames."""
        return [name for name, e in self.elements.items() if e.tag == "frame"]

    def _element(self, name: str) -> Element:
        if name not in self.elements:
            raise ModelError(
                f"frame {name}", "is used and not defined.", "Define it, or correct the name."
            )
        return self.elements[name]

    def pose(self, name: str, depth: int = 0) -> Pose:
        """Pose of a link, joint or frame in the world."""
        if name in self.found:
            return self.found[name]
        element = self._element(name)
        part = f"{element.tag} {name}"
        if depth > len(self.elements):
            raise ModelError(
                part, "is placed relative to itself.", "Correct relative_to and attached_to."
            )
        own = element.find("pose")
        before = None if own is None else own.get("relative_to")
        if not before:
            before = "__model__"
            if element.tag == "joint":
                child = element.find("child")
                before = "" if child is None else (child.text or "").strip()
            elif element.tag == "frame":
                before = element.get("attached_to") or "__model__"
        result = self.pose(before, depth + 1) @ pose_of(element, part)
        self.found[name] = result
        return result

    def link_of(self, name: str, depth: int = 0) -> str:
        """The link that carries a link, joint or frame, or the world."""
        if name == WORLD:
            return WORLD
        if name == "__model__":
            return self._first()
        element = self._element(name)
        if element.tag == "link":
            return name
        if depth > len(self.elements):
            raise ModelError(
                f"{element.tag} {name}", "is attached to itself.", "Correct attached_to."
            )
        if element.tag == "joint":
            child = element.find("child")
            return self.link_of("" if child is None else (child.text or "").strip(), depth + 1)
        return self.link_of(element.get("attached_to") or "__model__", depth + 1)

    def _first(self) -> str:
        chosen = self.model.get("canonical_link")
        return chosen or next(name for name, e in self.elements.items() if e.tag == "link")


def pose_of(element: Element, part: str) -> Pose:
    """The `<pose>` of an element; none is no displacement.

    Parameters
    ----------
    element : Element
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        A pose of another form.
    """
    own = element.find("pose")
    text = "" if own is None else (own.text or "").strip()
    if own is None or not text:
        return Pose()
    form = own.get("rotation_format") or "euler_rpy"
    if form == "quat_xyzw":
        values = numbers(text, 7, part, "pose")
        return Pose(values[:3], quaternion(values[[6, 3, 4, 5]], part))
    values = numbers(text, 6, part, "pose")
    angles = values[3:]
    if (own.get("degrees") or "").lower() in {"1", "true"}:
        angles = np.radians(angles)
    return Pose(values[:3], roll_pitch_yaw(angles))


def _link(element: Element, frames: _Frames, notes: list[str]) -> Link:
    name = name_of(element)
    part = f"link {name}"
    pose = frames.pose(name)
    inertial = element.find("inertial")
    if inertial is None:
        notes.append(f"link {name} has no <inertial>: by default it has 1 kg and 1 kg·m².")
        return Link(name, pose.position, pose.rotation, 1.0, pose.position, np.eye(3))
    if (inertial.get("auto") or "").lower() in {"1", "true"}:
        raise ModelError(
            part, "has an inertia computed from its shapes.", "Write out <mass> and <inertia>."
        )
    mass_element, matrix = inertial.find("mass"), inertial.find("inertia")
    mass = 1.0 if mass_element is None else number(mass_element.text or "", part, "mass")
    own_pose = inertial.find("pose")
    before = None if own_pose is None else own_pose.get("relative_to")
    frame = (frames.pose(before) if before else pose) @ pose_of(inertial, part)
    values = {}
    for key, default in (
        ("ixx", 1.0),
        ("ixy", 0.0),
        ("ixz", 0.0),
        ("iyy", 1.0),
        ("iyz", 0.0),
        ("izz", 1.0),
    ):
        entry = None if matrix is None else matrix.find(key)
        values[key] = default if entry is None else number(entry.text or "", part, key)
    inertia = turned_inertia(frame.rotation, tensor(values))
    return Link(name, pose.position, pose.rotation, mass, frame.position, inertia)
