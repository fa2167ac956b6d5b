"""Reading URDF, a tree of links, with loops as its proposals have them.

The tree is that of the URDF of ROS (http://wiki.ros.org/urdf/XML). See `urdf_loops` for loops.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from strutwork.errors import ModelError
from strutwork.machines.robots.choices import Choices, actuated, tool_of
from strutwork.machines.robots.poses import Pose, joint_axes, roll_pitch_yaw
from strutwork.machines.robots.robot import WORLD, Coupled, Freedom, Link, Robot, RobotJoint
from strutwork.machines.robots.urdf_loops import loops_of
from strutwork.machines.robots.xml_text import (
    attribute_number,
    attribute_numbers,
    bounded,
    children,
    limit_pair,
    name_of,
    number,
    plain,
    required,
)

#: Joint types of URDF, and ours; None for one that holds nothing.
TYPES = {
    "fixed": "fixed",
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "planar": "planar",
    "floating": None,
}


def urdf_robot(root: Element, choices: Choices) -> Robot:
    """The robot of a URDF file, at zero of all its joints.

    Parameters
    ----------
    root : Element
    choices : Choices

    Raises
    ------
    ModelError
        Names what is wrong.
    """
    if root.tag != "robot":
        raise ModelError("URDF", f"begins with <{plain(root.tag)}>.", "It must begin with <robot>.")
    _require_expanded(root)
    notes: list[str] = []
    inertials = {}
    for element in children(root, "link"):
        name = name_of(element)
        if name in inertials:
            raise ModelError(f"link {name}", "is defined twice.", "Give every link its own name.")
        inertials[name] = element.find("inertial")
    if not inertials:
        raise ModelError("URDF", "has no <link>.", "Define its links.")
    elements = {name_of(e): e for e in children(root, "joint")}
    if len(elements) < sum(1 for _ in children(root, "joint")):
        raise ModelError("URDF", "has two joints of one name.", "Give every joint its own name.")
    root_name, ordered = _tree(inertials, elements)
    grounded = root_name == WORLD
    if grounded and inertials[WORLD] is not None:
        notes.append("The mass of the link world is left out: it does not move.")
    poses = {root_name: Pose()}
    joints = [] if grounded else [_base(root_name)]
    couplings: list[Coupled] = []
    start: list[tuple[tuple[str, str], float]] = []
    efforts: dict[str, float | None] = {}
    for name in ordered:
        element = elements[name]
        joint, pose, effort = _joint(element, poses, notes)
        poses[joint.child] = pose
        if element.get("type") == "floating":
            notes.append(f"joint {name} is floating: its child moves freely.")
            continue
        joints.append(joint)
        if joint.freedoms:
            efforts[name] = effort
        coupled, moved = _mimic(element, joint)
        couplings += coupled
        start += moved
    links = [
        _link(name, inertial, poses[name])
        for name, inertial in inertials.items()
        if name in poses and name != WORLD
    ]
    joints += loops_of(root, poses, notes)
    if any(e.find("joint") is not None for e in children(root, "gazebo")):
        notes.append("Joints in <gazebo> elements are not read: write loops as <constraint>.")
    robot = Robot(
        title=(root.get("name") or "robot")[:100],
        links=tuple(links),
        joints=tuple(joints),
        couplings=tuple(couplings),
        notes=tuple(notes),
        start=tuple(start),
    )
    named = {
        (e.get("name") or "").strip()
        for parent in (*children(root, "transmission"), *children(root, "ros2_control"))
        for e in children(parent, "joint")
        if parent.tag == "transmission" or e.find("command_interface") is not None
    }
    robot = actuated(robot, choices, named & set(elements), efforts)
    return tool_of(robot, choices, {})


def _require_expanded(root: Element) -> None:
    for element in root.iter():
        tag = str(element.tag)
        if "xacro" in tag or plain(tag) == "include":
            raise ModelError(
                "URDF",
                f"has an element <{plain(tag)}> of xacro, or an include: other files are not "
                "opened.",
                "Expand it first: xacro robot.urdf.xacro > robot.urdf",
            )


def _base(name: str) -> RobotJoint:
    return RobotJoint(f"base of {name}"[:100], "fixed", WORLD, name, np.zeros(3))


def _tree(links: dict[str, Element | None], joints: dict[str, Element]) -> tuple[str, list[str]]:
    """The root link, and the joints from it outwards."""
    parent_joint: dict[str, str] = {}
    below: dict[str, list[str]] = {name: [] for name in links}
    for name, element in joints.items():
        parent, child = (_end(element, end, links) for end in ("parent", "child"))
        if child in parent_joint:
            raise ModelError(
                f"link {child}",
                f"is the child of two joints, {parent_joint[child]} and {name}: URDF is a tree.",
                "Close the loop by a <constraint>, or use SDF, in which joints may form loops.",
            )
        if parent == child:
            raise ModelError(f"joint {name}", f'joins link "{child}" to itself.', "Name two links.")
        parent_joint[child] = name
        below[parent].append(name)
    roots = [name for name in links if name not in parent_joint]
    if len(roots) != 1:
        what = "no root link: its joints form a loop" if not roots else f"{len(roots)} root links"
        raise ModelError(
            "URDF",
            f"has {what}{': ' + ', '.join(roots[:6]) if roots else ''}.",
            "Join all links to one tree; close loops by <constraint>.",
        )
    ordered, waiting = [], [roots[0]]
    while waiting:
        for name in below[waiting.pop()]:
            ordered.append(name)
            waiting.append(_end(joints[name], "child", links))
    if len(ordered) < len(joints):
        lost = sorted(set(joints) - set(ordered))
        raise ModelError(
            f"joint {lost[0]}",
            f"belongs to a loop that is not joined to the root link {roots[0]}.",
            "Join all links to one tree; close loops by <constraint>.",
        )
    return roots[0], ordered


def _end(element: Element, end: str, links: dict[str, Element | None]) -> str:
    part, name = f"joint {element.get('name')}", _link_name(element, end)
    if name not in links:
        raise ModelError(
            part, f'names the unknown link "{name}".', "Define the link, or correct the name."
        )
    return name


def _link_name(element: Element, end: str) -> str:
    part = f"joint {element.get('name')}"
    found = element.find(end)
    if found is None:
        raise ModelError(part, f"has no <{end}>.", f'Give <{end} link="…"/>.')
    return required(found, "link", part)


def origin_of(element: Element | None, part: str) -> Pose:
    """The pose of an `<origin>`, or of an element with xyz and rpy; none is no displacement.

    Parameters
    ----------
    element : Element or None
    part : str
        Named in an error.
    """
    zeros = (0.0, 0.0, 0.0)
    return Pose(
        attribute_numbers(element, "xyz", zeros, part),
        roll_pitch_yaw(attribute_numbers(element, "rpy", zeros, part)),
    )


def _link(name: str, inertial: Element | None, pose: Pose) -> Link:
    part = f"link {name}"
    if inertial is None:
        return Link(name, pose.position, pose.rotation)
    mass_element, inertia_element = inertial.find("mass"), inertial.find("inertia")
    if mass_element is None:
        raise ModelError(part, "has an <inertial> without <mass>.", 'Give <mass value="…"/>.')
    mass = number(required(mass_element, "value", part), part, "mass")
    frame = pose @ origin_of(inertial.find("origin"), part)
    values = {}
    for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
        found = attribute_number(inertia_element, key, part)
        values[key] = 0.0 if found is None else found
    own = tensor(values)
    return Link(
        name,
        pose.position,
        pose.rotation,
        mass,
        frame.position,
        turned_inertia(frame.rotation, own),
    )


def tensor(v: dict[str, float]) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """A matrix of inertia from its six entries, (3, 3).

    Parameters
    ----------
    v : dict of str to float
        ixx, ixy, ixz, iyy, iyz, izz, kg·m².
    """
    return np.array(
        [
            [v["ixx"], v["ixy"], v["ixz"]],
            [v["ixy"], v["iyy"], v["iyz"]],
            [v["ixz"], v["iyz"], v["izz"]],
        ]
    )


def turned_inertia(
    rotation: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    own: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Inertia in the outer axes, exactly symmetric, (3, 3).

    Parameters
    ----------
    rotation : (3, 3)
        Rotation matrix of its own axes.
    own : (3, 3)
        kg·m².
    """
    found = rotation @ own @ rotation.T
    return (found + found.T) / 2


def _joint(
    element: Element, poses: dict[str, Pose], notes: list[str]
) -> tuple[RobotJoint, Pose, float | None]:
    """The joint, the pose of its child, and the effort that the file states."""
    name = name_of(element)
    part = f"joint {name}"
    type_ = (element.get("type") or "").strip()
    if type_ not in TYPES:
        raise ModelError(
            part, f'has the unknown type "{type_}".', "Types of URDF: " + ", ".join(TYPES) + "."
        )
    parent, child = _link_name(element, "parent"), _link_name(element, "child")
    pose = poses[parent] @ origin_of(element.find("origin"), part)
    kind = TYPES[type_] or "fixed"
    if kind == "fixed":
        return RobotJoint(name, kind, parent, child, pose.position), pose, None
    axis = attribute_numbers(element.find("axis"), "xyz", (1.0, 0.0, 0.0), part)
    axes = joint_axes(pose.rotation @ axis, part)
    limit, dynamics = element.find("limit"), element.find("dynamics")
    if attribute_number(dynamics, "friction", part):
        notes.append(f"friction of joint {name} is left out.")
    effort = attribute_number(limit, "effort", part)
    damping = attribute_number(dynamics, "damping", part) or 0.0
    if kind == "planar":
        joint = RobotJoint(name, kind, parent, child, pose.position, axes)
        return joint, pose, None
    limits = None
    if type_ != "continuous":
        low = attribute_number(limit, "lower", part) or 0.0
        high = attribute_number(limit, "upper", part) or 0.0
        limits = limit_pair(low, high)
        if limits is None and not low <= -1e9:
            notes.append(f"joint {name} has limits without a range, which are left out.")
    freedom = Freedom(
        "rz" if kind == "revolute" else "z",
        limits=limits,
        damping=damping,
        effort=bounded(effort),
        speed=bounded(attribute_number(limit, "velocity", part)),
    )
    return RobotJoint(name, kind, parent, child, pose.position, axes, (freedom,)), pose, effort


def _mimic(
    element: Element, joint: RobotJoint
) -> tuple[list[Coupled], list[tuple[tuple[str, str], float]]]:
    """What it follows, and where it stands when its leader is at zero."""
    mimic = element.find("mimic")
    if mimic is None:
        return [], []
    part = f"joint {joint.name}"
    leader = required(mimic, "joint", part)
    ratio = attribute_number(mimic, "multiplier", part)
    offset = attribute_number(mimic, "offset", part)
    if not joint.freedoms:
        raise ModelError(part, "is fixed and mimics another.", "Remove <mimic>.")
    own = (joint.name, joint.freedoms[0].direction)
    name = f"{joint.name} follows {leader}"[:100]
    return (
        [Coupled(name, (leader, ""), own, 1.0 if ratio is None else ratio)],
        [(own, offset)] if offset else [],
    )
