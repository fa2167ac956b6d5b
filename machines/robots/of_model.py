"""A model as a robot: every body of its linkage a rigid link with its mass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint
from strutwork.kinematics.body_masses import BodyMasses
from strutwork.machines.model import Model
from strutwork.machines.robots.robot import FREE, WORLD, Coupled, Freedom, Link, Robot, RobotJoint

Array = NDArray[Any]


def robot_of(model: Model) -> Robot:
    """The rigid robot that moves as a model does.

    Elastic directions of joints are held. Beams and solids are rigid, with their mass.

    Parameters
    ----------
    model : Model

    Raises
    ------
    ModelError
        A joint whose parts the formats cannot have; names it.
    """
    return _Conversion(model).robot()


class _Conversion:
    """Names and places that all steps need."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.linkage = model.structure.linkage
        self.positions = np.asarray(model.placement.positions, dtype=float)
        self.frames = np.asarray(model.placement.frames, dtype=float)
        self.notes: list[str] = []
        self.names = self._link_names()
        values = np.ravel(model.placement.values)
        self.home = dict(zip(model.placement.names, values, strict=False))
        self.renamed: dict[tuple[str, str], tuple[str, str]] = {}
        self.links: list[Link] = []
        self.joints: list[RobotJoint] = []

    def _link_names(self) -> tuple[str, ...]:
        taken = {WORLD}
        names = []
        for name in self.linkage.body_names:
            text, count = name, 2
            while text in taken:
                text, count = f"{name} {count}", count + 1
            taken.add(text)
            names.append(text)
        return tuple(names)

    def link_of(self, node: str) -> str:
        """The link that has a node."""
        body = int(self.linkage.body_of_node[self.linkage.node_index[node]])
        return WORLD if body < 0 else self.names[body]

    def robot(self) -> Robot:
        model = self.model
        masses = self._masses()
        ties = {tie.joint: tie for tie in self.linkage.ties if tie.joint == tie.other_joint}
        for number, joint in enumerate(self.linkage.joints):
            self._joint(number, joint, helical=joint.lead != 0.0 and number in ties)
        self._places(masses)
        self._merge_ground()
        tool = None
        if model.tool is not None and self.link_of(model.tool) in {k.name for k in self.links}:
            place = self.positions[self.linkage.node_index[model.tool]]
            tool = (self.link_of(model.tool), place)
        self._note_what_stays()
        return Robot(
            title=model.title or "machine",
            links=tuple(self.links),
            joints=tuple(self.joints),
            couplings=tuple(self._couplings()),
            gravity=self._gravity(),
            tool=tool,
            tool_name=model.tool or "tcp",
            notes=tuple(self.notes),
        )

    def _gravity(self) -> tuple[float, float, float] | None:
        for case in self.model.cases:
            if case.gravity is not None:
                x, y, z = (float(v) for v in case.gravity)
                return x, y, z
        return None

    def _masses(self) -> BodyMasses | None:
        # imported late: matrices of mass take their time to import
        from strutwork.msa.body_mass import body_masses

        try:
            return body_masses(self.model.placed)
        except ModelError as error:
            self.notes.append(f"Masses are left out: {error.part} {error.problem}")
            return None

    def _places(self, masses: BodyMasses | None) -> None:
        """Links at the place of the first of their joints."""
        between = tuple(self.links)
        first: dict[str, Array] = {}
        for joint in self.joints:
            for end in (joint.child, joint.parent):
                first.setdefault(end, joint.place)
        owner = self.linkage.body_of_node
        links = []
        for b, name in enumerate(self.names):
            nodes = np.flatnonzero(owner == b)
            place = first.get(name, self.positions[nodes[0]] if len(nodes) else np.zeros(3))
            if masses is None or masses.mass[b] <= 0:
                links.append(Link(name, place))
                continue
            mass, centre = float(masses.mass[b]), masses.centre[b]
            links.append(Link(name, place, np.eye(3), mass, centre, _clean(masses, b)))
        self.links = [*links, *between]

    def _merge_ground(self) -> None:
        """Massless links that are fixed to the world are the world."""
        massless = {link.name for link in self.links if link.mass == 0}
        fixed = {
            joint.child if joint.parent == WORLD else joint.parent
            for joint in self.joints
            if joint.kind == "fixed" and WORLD in {joint.parent, joint.child}
        } & massless
        joints = [
            replace(
                joint,
                parent=WORLD if joint.parent in fixed else joint.parent,
                child=WORLD if joint.child in fixed else joint.child,
            )
            for joint in self.joints
            if not (joint.kind == "fixed" and {joint.parent, joint.child} <= {WORLD, *fixed})
        ]
        self.joints = joints
        self.links = [link for link in self.links if link.name not in fixed]

    def _joint(self, number: int, joint: Joint, *, helical: bool) -> None:
        held = self.linkage.elastic_or_locked()[number] & ~self.linkage.driven_mask()[number]
        follows = self.linkage.tied_mask()[number]
        free = [
            d
            for k, d in enumerate(DIRECTIONS)
            if not held[k] or (follows[k] and not (helical and d == "z"))
        ]
        if len(free) == 6:
            self.notes.append(f"joint {joint.name} holds nothing and is left out.")
            return
        first, second = (self.linkage.node_index[node] for node in joint.between)
        del first
        place, axes = self.positions[second], self.frames[number]
        parent, child = (self.link_of(node) for node in joint.between)
        if parent == child:
            return
        if helical:
            freedoms = (self._freedom(joint, "rz", "rz"),)
            self.joints.append(
                RobotJoint(joint.name, "helical", parent, child, place, axes, freedoms, joint.pitch)
            )
            return
        self._pieces(joint, free, (parent, child), place, axes)

    def _pieces(
        self, joint: Joint, free: list[str], ends: tuple[str, str], place: Array, axes: Array
    ) -> None:
        """One joint of the formats, or several in series with massless links between."""
        parts = _parts(free)
        parent = ends[0]
        for k, (kind, directions, order) in enumerate(parts, 1):
            last = k == len(parts)
            child = ends[1] if last else f"{joint.name} between {k}"
            if not last:
                self.links.append(Link(child, place))
            name = joint.name if len(parts) == 1 else f"{joint.name}:{'+'.join(directions)}"
            freedoms = []
            for own, direction in zip(FREE[kind], directions, strict=True):
                freedoms.append(self._freedom(joint, direction, own))
                self.renamed[joint.name, direction] = (name, own)
            self.joints.append(
                RobotJoint(name, kind, parent, child, place, axes[:, order], tuple(freedoms))
            )
            parent = child

    def _freedom(self, joint: Joint, direction: str, own: str) -> Freedom:
        drive = next(
            (d for d in self.model.drives if (d.joint, d.direction) == (joint.name, direction)),
            None,
        )
        return Freedom(
            own,
            home=float(self.home.get((joint.name, direction), 0.0)),
            limits=joint.limits.get(direction),
            driven=direction in joint.driven,
            damping=float(joint.damping.get(direction, 0.0)),
            effort=None if drive is None else drive.force,
            speed=None if drive is None else drive.speed,
        )

    def _couplings(self) -> list[Coupled]:
        found = []
        for c in self.linkage.couplings:
            leader, follower = (self.renamed.get(end, end) for end in (c.first, c.second))
            ratio = c.ratio
            by_name: Mapping[str, Joint] = {j.name: j for j in self.linkage.joints}
            if c.second[1] in by_name[c.second[0]].driven:
                leader, follower, ratio = follower, leader, 1.0 / ratio
            found.append(Coupled(c.name, leader, follower, ratio))
        return found

    def _note_what_stays(self) -> None:
        model = self.model
        flexible = [
            *(["beams"] if model.structure.beams else []),
            *(["solids"] if model.solids else []),
        ]
        if flexible:
            self.notes.append(
                f"Its {' and '.join(flexible)} are written as rigid links, with their mass and "
                "inertia."
            )
        if any(j.stiffness or j.matrix is not None for j in self.linkage.joints):
            self.notes.append("Elastic directions of joints are written as held.")
        left = [
            *(["springs"] if model.structure.springs else []),
            *(["loads"] if any(case.gravity is None for case in model.cases) else []),
            *(["tolerances"] if model.tolerances else []),
        ]
        if left:
            self.notes.append(f"Its {', '.join(left)} are left out.")


def _clean(masses: BodyMasses, body: int) -> Array:
    """Inertia without the least negative moments that rounding leaves."""
    inertia = (masses.inertia[body] + masses.inertia[body].T) / 2
    values, vectors = np.linalg.eigh(inertia)
    if values.min() >= 0:
        return np.asarray(inertia)
    found = (vectors * np.maximum(values, 0.0)) @ vectors.T
    return np.asarray((found + found.T) / 2)


def _parts(free: list[str]) -> list[tuple[str, tuple[str, ...], list[int]]]:
    """Joints of the formats that let the free directions move, in series.

    Kind, the model's directions in the order of `FREE`, and the columns of the model's axes that
    are x, y and z of the new ones.
    """
    slides = [d for d in free if not d.startswith("r")]
    turns = [d for d in free if d.startswith("r")]
    if len(turns) == 1 and len(slides) <= 2:
        k = "xyz".index(turns[0][1])
        order = _with_axis(k)
        across = ["xyz"[order[0]], "xyz"[order[1]]]
        if not slides:
            return [("revolute", (turns[0],), order)]
        if slides == ["xyz"[k]]:
            return [("cylindrical", (slides[0], turns[0]), order)]
        if sorted(slides) == sorted(across):
            return [("planar", (across[0], across[1], turns[0]), order)]
    if not free:
        return [("fixed", (), [0, 1, 2])]
    parts: list[tuple[str, tuple[str, ...], list[int]]] = [
        ("prismatic", (d,), _with_axis("xyz".index(d))) for d in slides
    ]
    if len(turns) == 1:
        return [*parts, ("revolute", (turns[0],), _with_axis("xyz".index(turns[0][1])))]
    if len(turns) == 2:
        # the first axis goes with the first body, the second with the other
        locked = 3 - sum("xyz".index(d[1]) for d in turns)
        e, f = (locked + 1) % 3, (locked + 2) % 3
        order = [f, locked, e]
        return [*parts, ("universal", (f"r{'xyz'[e]}", f"r{'xyz'[f]}"), order)]
    if len(turns) == 3:
        return [*parts, ("spherical", ("rx", "ry", "rz"), [0, 1, 2])]
    return parts


def _with_axis(k: int) -> list[int]:
    """Columns of axes whose z is the k-th, right-handed."""
    return [(k + 1) % 3, (k + 2) % 3, k]
