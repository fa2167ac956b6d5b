"""A robot as the tables of a model file, and as its text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics.joint import DIRECTIONS
from strutwork.machines.robots.robot import WORLD, Link, Robot, RobotJoint

Array = NDArray[Any]

#: Rounding that frames leave in numbers that are zero, as a share of the largest one.
ROUNDING = 1e-15


def robot_tables(robot: Robot) -> dict[str, Any]:
    """The tables of the model file that describes a robot, in SI.

    A link is a rigid body with a node for each of its joints, named LINK/JOINT; nodes of the
    world are supported.

    Parameters
    ----------
    robot : Robot
    """
    return _Tables(robot).made()


class _Tables:
    """Names of nodes as they are given out."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.nodes: dict[str, list[float]] = {}
        self.of_link: dict[str, list[str]] = {link.name: [] for link in robot.links}
        self.grounded: list[str] = []
        points = [link.origin for link in robot.links] + [joint.place for joint in robot.joints]
        self.size = float(np.abs(np.array(points)).max(initial=0.0))

    def made(self) -> dict[str, Any]:
        robot = self.robot
        tables: dict[str, Any] = {"title": robot.title}
        if robot.gravity is not None and any(robot.gravity):
            tables["gravity"] = list(robot.gravity)
        joints, home = [], {}
        for joint in robot.joints:
            if self._clamp(joint):
                continue
            joints.append(self._joint(joint))
            named = {f.direction: f.home for f in joint.freedoms if f.home}
            if named:
                home[joint.name] = named
        tool = self._tool()
        for name, link, place in robot.points:
            self._node(name, link, place)
        bodies = [body for link in robot.links for body in self._body(link)]
        tables["nodes"] = self.nodes
        tables["bodies"] = bodies
        tables["joints"] = joints
        tables["couplings"] = [
            coupling for coupled in robot.couplings for coupling in [_coupling(coupled)]
        ]
        tables["supports"] = [{"node": node, "fixed": "all"} for node in self.grounded]
        if tool is not None:
            tables["tool"] = {"tcp": tool}
        tables["home"] = home
        tables["drives"] = [drive for joint in robot.joints for drive in _drives(joint)]
        return {key: value for key, value in tables.items() if value not in ([], {}, "")}

    def _node(self, name: str, link: str, place: ArrayLike) -> str:
        """A node of a link; its name is made unique."""
        text, count = name[:100], 2
        while text in self.nodes or text in {f"{node} (ground)" for node in self.grounded}:
            text = f"{name[:90]} {count}"
            count += 1
        self.nodes[text] = _rounded(place, self.size)
        if link == WORLD:
            self.grounded.append(text)
        else:
            self.of_link[link].append(text)
        return text

    def _clamp(self, joint: RobotJoint) -> bool:
        """Whether it fixes a link to the world: then a node of the link is supported."""
        if joint.kind != "fixed" or WORLD not in {joint.parent, joint.child}:
            return False
        link = joint.child if joint.parent == WORLD else joint.parent
        self.grounded.append(self._node(f"{link} base", link, joint.place))
        return True

    def _joint(self, joint: RobotJoint) -> dict[str, Any]:
        ends = [
            self._node(f"{link}/{joint.name}", link, joint.place)
            for link in (joint.parent, joint.child)
        ]
        table: dict[str, Any] = {"name": joint.name, "type": joint.kind, "between": ends}
        if joint.kind not in {"fixed", "spherical"}:
            table["axis"] = _rounded(joint.axis, 1.0)
        if joint.kind in {"universal", "planar"}:
            table["second_axis"] = _rounded(joint.second, 1.0)
        if joint.pitch is not None:
            table["pitch"] = float(joint.pitch)
        damping = {f.direction: float(f.damping) for f in joint.freedoms if f.damping}
        limits = {f.direction: [float(v) for v in f.limits] for f in joint.freedoms if f.limits}
        driven = [
            d for d in DIRECTIONS if any(f.driven and f.direction == d for f in joint.freedoms)
        ]
        return table | {
            key: value
            for key, value in (("damping", damping), ("driven", driven), ("limits", limits))
            if value
        }

    def _tool(self) -> str | None:
        if self.robot.tool is None or self.robot.tool[0] == WORLD:
            return None
        link, place = self.robot.tool
        return self._node(self.robot.tool_name, link, place)

    def _body(self, link: Link) -> list[dict[str, Any]]:
        nodes = self.of_link[link.name]
        if link.mass and len(nodes) < 2:
            for name, place in ((link.name, link.origin), (f"{link.name}/centre", link.centre)):
                if len(nodes) < 2:
                    self._node(name, link.name, place)
        if len(nodes) < 2:
            return []
        body: dict[str, Any] = {"name": link.name, "nodes": list(nodes)}
        if link.mass:
            size = float(np.abs(link.inertia).max(initial=0.0))
            body["mass"] = float(link.mass)
            body["center_of_mass"] = _rounded(link.centre, self.size)
            if size:
                body["inertia"] = [_rounded(row, size) for row in link.inertia]
        return [body]


def _rounded(values: ArrayLike, size: float) -> list[float]:
    """Numbers without what rotations leave of zeros."""
    found = np.asarray(values, dtype=float)
    return [0.0 if abs(v) <= ROUNDING * size else float(v) for v in found]


def _coupling(coupled: Any) -> dict[str, Any]:
    leader, follower, ratio = coupled.leader, coupled.follower, float(coupled.ratio)
    turns = [end[1].startswith("r") for end in (leader, follower)]
    table: dict[str, Any] = {"name": coupled.name}
    if turns == [False, True]:
        leader, follower, ratio = follower, leader, 1.0 / ratio
        turns = [True, False]
    table["between"] = [":".join(leader), ":".join(follower)]
    if turns == [True, False]:
        table["per_turn"] = 2 * np.pi * ratio
    else:
        table["ratio"] = ratio
    return table


def _drives(joint: RobotJoint) -> Iterable[dict[str, Any]]:
    for f in joint.freedoms:
        if not f.driven or (f.effort is None and f.speed is None):
            continue
        turns = f.direction.startswith("r")
        table: dict[str, Any] = {"joint": joint.name, "direction": f.direction}
        if f.speed is not None:
            table["turning_speed" if turns else "speed"] = float(f.speed)
        if f.effort is not None:
            table["torque" if turns else "force"] = float(f.effort)
        yield table


def model_text(robot: Robot, source: str = "") -> str:
    """The text of the model file that describes a robot.

    Parameters
    ----------
    robot : Robot
    source : str
        Name of the file that it was read from, for the comment at its head.
    """
    # imported late: only what writes a file waits for it
    import tomlkit

    document = tomlkit.document()
    head = [f"From {source}." if source else "From a robot."]
    head += ["Units are SI: m, kg, s, N, rad. All links are rigid: add the elastic parts."]
    for line in (*head, *robot.notes):
        document.add(tomlkit.comment(_one_line(line)))
    for key, value in robot_tables(robot).items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            tables = tomlkit.aot()
            for entry in value:
                tables.append(_table(entry))
            document.add(key, tables)
        elif isinstance(value, dict):
            document.add(key, _table(value))
        else:
            document.add(key, value)
    return tomlkit.dumps(document)


def _table(entry: dict[str, Any]) -> Any:
    import tomlkit

    table = tomlkit.table()
    for key, value in entry.items():
        if isinstance(value, dict):
            inline = tomlkit.inline_table()
            inline.update(value)
            table.add(key, inline)
        else:
            table.add(key, value)
    return table


def _one_line(text: str) -> str:
    from strutwork.names import visible

    return visible(" ".join(text.split()))
