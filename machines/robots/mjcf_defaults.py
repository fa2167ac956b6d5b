"""Defaults, angles and frames of MJCF (https://mujoco.readthedocs.io, XML reference)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.robots.poses import Pose, about, axis_angle, quaternion, unit
from strutwork.machines.robots.xml_text import children, label, numbers, plain

Array = NDArray[Any]

#: Name of the defaults that apply where no class is named.
MAIN = "main"


@dataclass(frozen=True)
class Compiler:
    """How the numbers of the file are meant.

    Parameters
    ----------
    radian : bool
        Angles are in rad, not in degrees.
    sequence : str
        Of Euler angles: small letters turn with the frame, capitals do not.
    autolimits : bool
        A range is a limit unless the file says otherwise.
    from_geometry : str
        "true", "false" or "auto": whether inertia follows from geometry.
    """

    radian: bool = False
    sequence: str = "xyz"
    autolimits: bool = True
    from_geometry: str = "auto"

    def angle(self, value: float) -> float:
        """An angle in rad.

        Parameters
        ----------
        value : float
            In the unit of the file: degrees or rad.
        """
        return value if self.radian else float(np.radians(value))


def compiler_of(root: Element) -> Compiler:
    """The settings of a file, those of its last `<compiler>`.

    Parameters
    ----------
    root : Element

    Raises
    ------
    ModelError
        A setting that is not supported.
    """
    attributes: dict[str, str] = {}
    for element in children(root, "compiler"):
        attributes |= element.attrib
    if attributes.get("coordinate", "local") != "local":
        raise ModelError(
            "compiler", "has global coordinates.", "Save the model again with MuJoCo 2.3 or newer."
        )
    total = attributes.get("settotalmass")
    if total is not None and float(numbers(total, 1, "compiler", "settotalmass")[0]) > 0:
        raise ModelError(
            "compiler", "sets the total mass.", "Write out the masses of the bodies instead."
        )
    sequence = attributes.get("eulerseq", "xyz")
    if len(sequence) != 3 or not set(sequence) <= set("xyzXYZ"):
        raise ModelError("compiler", f'has the eulerseq "{sequence}".', 'Write it as "xyz".')
    return Compiler(
        attributes.get("angle", "degree") == "radian",
        sequence,
        attributes.get("autolimits", "true") == "true",
        attributes.get("inertiafromgeom", "auto"),
    )


@dataclass
class Defaults:
    """Attributes that elements have by their class.

    Parameters
    ----------
    root : Element
        Of the file.
    classes : mapping of class to mapping of tag to attributes
        Made from it.
    """

    root: Element
    classes: dict[str, dict[str, dict[str, str]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.classes[MAIN] = {}
        for element in children(self.root, "default"):
            self._add(element, element.get("class") or MAIN, self.classes[MAIN])

    def _add(self, element: Element, name: str, before: Mapping[str, Mapping[str, str]]) -> None:
        own = {tag: dict(values) for tag, values in before.items()}
        for child in element:
            tag = plain(child.tag)
            if tag and tag != "default":
                own[tag] = own.get(tag, {}) | child.attrib
        self.classes[name] = own
        if MAIN not in self.classes:
            self.classes[MAIN] = own
        for child in children(element, "default"):
            inner = child.get("class")
            if not inner:
                raise ModelError("default", "has no class.", 'Give <default class="…">.')
            self._add(child, inner, own)

    def of(self, element: Element, around: str | None) -> dict[str, str]:
        """All attributes of an element, its own first.

        Parameters
        ----------
        element : Element
        around : str or None
            The childclass of the bodies around it.

        Raises
        ------
        ModelError
            An unknown class.
        """
        name = element.get("class") or around or MAIN
        if name not in self.classes:
            raise ModelError(
                label(element), f'has the unknown class "{name}".', "Define it in <default>."
            )
        return self.classes[name].get(plain(element.tag), {}) | element.attrib


def frame_of(attributes: Mapping[str, str], compiler: Compiler, part: str) -> Pose:
    """The pose that attributes give: pos, and one of quat, axisangle, euler, xyaxes, zaxis.

    Parameters
    ----------
    attributes : mapping of str to str
    compiler : Compiler
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        A wrong number, or two rotations.
    """
    place = attributes.get("pos")
    position = np.zeros(3) if place is None else numbers(place, 3, part, "pos")
    given = [k for k in ("quat", "axisangle", "euler", "xyaxes", "zaxis") if k in attributes]
    if len(given) > 1:
        raise ModelError(part, f"has {given[0]} and {given[1]}.", "Give one of them.")
    if not given:
        return Pose(position)
    return Pose(position, _rotation(given[0], attributes[given[0]], compiler, part))


def _rotation(kind: str, text: str, compiler: Compiler, part: str) -> Array:
    count = {"quat": 4, "axisangle": 4, "euler": 3, "xyaxes": 6, "zaxis": 3}[kind]
    values = numbers(text, count, part, kind)
    if kind == "quat":
        return quaternion(values, part)
    if kind == "axisangle":
        return axis_angle(values[:3], compiler.angle(float(values[3])), part)
    if kind == "euler":
        result = np.eye(3)
        for letter, angle in zip(compiler.sequence, values, strict=True):
            turn = about("xyz".index(letter.lower()), compiler.angle(float(angle)))
            result = result @ turn if letter.islower() else turn @ result
        return result
    if kind == "xyaxes":
        x = unit(values[:3], part)
        y = unit(values[3:] - (values[3:] @ x) * x, part)
        return np.stack([x, y, np.cross(x, y)], axis=1)
    return rotation_to(values, part)


def rotation_to(axis: Array, part: str) -> Array:
    """The least rotation that takes z to an axis, (3, 3).

    Parameters
    ----------
    axis : (3,)
        Any length but zero, any unit.
    part : str
        Named in an error.
    """
    z = unit(axis, part)
    across = np.cross([0.0, 0.0, 1.0], z)
    size = float(np.linalg.norm(across))
    if size < 1e-12:
        return np.eye(3) if z[2] > 0 else about(0, np.pi)
    return axis_angle(across, float(np.arctan2(size, z[2])), part)
