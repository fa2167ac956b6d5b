"""Mass of MJCF bodies: stated, or from their shapes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.mjcf_defaults import Compiler, frame_of, rotation_to
from strutwork.machines.robots.poses import Pose
from strutwork.machines.robots.urdf_read import turned_inertia
from strutwork.machines.robots.xml_text import number, numbers

Array = NDArray[Any]

#: Density of shapes that state none, kg/m³.
WATER = 1000.0


@dataclass(frozen=True)
class Inertial:
    """Mass, centre and inertia about it, in the axes that it is given in.

    Parameters
    ----------
    mass : float
        kg.
    centre : (3,)
        m.
    inertia : (3, 3)
        kg·m².
    """

    mass: float
    centre: Array
    inertia: Array

    def moved(self, pose: Pose) -> Inertial:
        """The same in the outer frame.

        Parameters
        ----------
        pose : Pose
            Of this frame.
        """
        inertia = turned_inertia(pose.rotation, self.inertia)
        return Inertial(self.mass, pose.at(self.centre), inertia)


def summed(parts: Sequence[Inertial]) -> Inertial:
    """All of them as one body.

    Parameters
    ----------
    parts : sequence of Inertial
        In the same axes.
    """
    mass = sum(part.mass for part in parts)
    if mass == 0:
        return Inertial(0.0, np.zeros(3), np.zeros((3, 3)))
    centre = np.sum([part.mass * part.centre for part in parts], axis=0) / mass
    inertia = np.zeros((3, 3))
    for part in parts:
        arm = part.centre - centre
        inertia += part.inertia + part.mass * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
    return Inertial(mass, centre, inertia)


def stated(element: Element, compiler: Compiler, part: str) -> Inertial:
    """The `<inertial>` of a body, in its axes.

    Parameters
    ----------
    element : Element
    compiler : Compiler
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        No mass, or a wrong number.
    """
    text = element.get("mass")
    if text is None:
        raise ModelError(part, "has an <inertial> without mass.", 'Give mass="…".')
    pose = frame_of(element.attrib, compiler, part)
    if "fullinertia" in element.attrib:
        a, b, c, d, e, f = numbers(element.attrib["fullinertia"], 6, part, "fullinertia")
        own = np.array([[a, d, e], [d, b, f], [e, f, c]])
    elif "diaginertia" in element.attrib:
        own = np.diag(numbers(element.attrib["diaginertia"], 3, part, "diaginertia"))
    else:
        raise ModelError(part, "has an <inertial> without inertia.", 'Give diaginertia="…".')
    return Inertial(number(text, part, "mass"), np.zeros(3), own).moved(pose)


def of_shape(attributes: Mapping[str, str], compiler: Compiler, part: str) -> Inertial:
    """Mass of a shape by its volume, in the axes of its body.

    Parameters
    ----------
    attributes : mapping of str to str
        Of a `<geom>`, defaults included.
    compiler : Compiler
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        A shape whose inertia is not known here, as a mesh with mass.
    """
    kind = attributes.get("type", "sphere")
    given = attributes.get("mass")
    mass = None if given is None else number(given, part, "mass")
    density = number(attributes.get("density", str(WATER)), part, "density")
    nothing = Inertial(0.0, np.zeros(3), np.zeros((3, 3)))
    if mass == 0 or (mass is None and density == 0) or kind in {"plane", "hfield"}:
        return nothing
    if kind not in _SHAPES or attributes.get("shellinertia") == "true":
        raise ModelError(
            part,
            f"has a mass from a {kind}, whose shape is not read.",
            "Give the body an <inertial>; MuJoCo writes it when it saves a model.",
        )
    sizes = [number(word, part, "size") for word in attributes.get("size", "").split()]
    pose = frame_of(attributes, compiler, part)
    if "fromto" in attributes:
        ends = numbers(attributes["fromto"], 6, part, "fromto")
        way = ends[3:] - ends[:3]
        pose = Pose((ends[:3] + ends[3:]) / 2, rotation_to(way, part))
        half = float(np.linalg.norm(way)) / 2
        sizes = [*sizes[:1], half] if kind in {"capsule", "cylinder"} else [*sizes[:1] * 2, half]
    needed = {"sphere": 1, "capsule": 2, "cylinder": 2, "box": 3, "ellipsoid": 3}[kind]
    if len(sizes) < needed or min(sizes[:needed]) <= 0:
        raise ModelError(part, f"is a {kind} of size {sizes}.", f"Give {needed} positive sizes.")
    volume, per_mass = _SHAPES[kind](*sizes[:needed])
    mass = density * volume if mass is None else mass
    return Inertial(mass, np.zeros(3), mass * np.diag(per_mass)).moved(pose)


def _sphere(r: float) -> tuple[float, Sequence[float]]:
    return 4 / 3 * np.pi * r**3, (0.4 * r * r,) * 3


def _ellipsoid(a: float, b: float, c: float) -> tuple[float, Sequence[float]]:
    return 4 / 3 * np.pi * a * b * c, (
        (b * b + c * c) / 5,
        (a * a + c * c) / 5,
        (a * a + b * b) / 5,
    )


def _box(a: float, b: float, c: float) -> tuple[float, Sequence[float]]:
    return 8 * a * b * c, ((b * b + c * c) / 3, (a * a + c * c) / 3, (a * a + b * b) / 3)


def _cylinder(r: float, half: float) -> tuple[float, Sequence[float]]:
    across = r * r / 4 + half * half / 3
    return 2 * np.pi * r * r * half, (across, across, r * r / 2)


def _capsule(r: float, half: float) -> tuple[float, Sequence[float]]:
    tube, ball = 2 * np.pi * r * r * half, 4 / 3 * np.pi * r**3
    volume = tube + ball
    # half a ball has its centre 3/8 r from its flat side
    ends = 0.4 * r * r + half * half + 0.75 * half * r
    across = (tube * (r * r / 4 + half * half / 3) + ball * ends) / volume
    along = (tube * r * r / 2 + ball * 0.4 * r * r) / volume
    return volume, (across, across, along)


_SHAPES: dict[str, Callable[..., tuple[float, Sequence[float]]]] = {
    "sphere": _sphere,
    "ellipsoid": _ellipsoid,
    "box": _box,
    "cylinder": _cylinder,
    "capsule": _capsule,
}
