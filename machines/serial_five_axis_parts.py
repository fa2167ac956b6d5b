"""Bodies, joints, beams and masses of the serial five-axis machine: its topology."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import radians
from types import MappingProxyType

from strutwork.kinematics import GROUND, Body, Joint
from strutwork.msa.beam import Beam
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section
from strutwork.msa.springs import PointMass

TOOL = "tool"
#: Moving bodies that turn; the others keep their directions.
FORK, HOUSING, SPINDLE = "fork", "housing", "spindle"
#: Places where nodes stand.
FOOT, BACK, FRONT, END, PIVOT = "foot", "back", "front", "end", "pivot"

#: Names of the two rotary axes, from the ram to the spindle, with their ranges, rad: our choice.
#: That of b keeps the singularity at 90° outside; that of a, upright, cannot.
ROTARY: Mapping[str, tuple[tuple[str, float], tuple[str, float]]] = MappingProxyType(
    {
        "ac": (("c", radians(200.0)), ("a", radians(100.0))),
        "ab": (("a", radians(100.0)), ("b", radians(80.0))),
    }
)

#: Ranges of the slides, m: our choice.
TRAVELS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"x": (-0.300, 0.300), "z": (-0.300, 0.200), "y": (-0.300, 0.300)}
)

#: Radii of gyration of saddle and carriage, of the head's parts, and of the spindle, m: our
#: choice.
LARGE, SMALL, THIN = 0.100, 0.060, 0.030

_NODES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        GROUND: (FOOT,),
        "column": (FOOT, BACK),
        "saddle": (BACK, FRONT),
        "ram": (FRONT, END, PIVOT),
        FORK: (PIVOT, "second"),
        HOUSING: (PIVOT, "nose"),
        SPINDLE: (PIVOT,),
    }
)


def node(body: str, place: str) -> str:
    """Node of a body at a place.

    Parameters
    ----------
    body : str
    place : str
    """
    return f"{body}/{place}"


def place_of(name: str) -> str:
    """Place at which a node stands.

    Parameters
    ----------
    name : str
        Of the node.
    """
    place = name.rpartition("/")[2]
    return PIVOT if place in ("second", "nose") else place


def bodies() -> tuple[Body, ...]:
    """Ground, column, saddle, ram, fork, housing, and the spindle with the tool."""
    return tuple(
        Body(name, (*(node(name, p) for p in places), *((TOOL,) if name == SPINDLE else ())))
        for name, places in _NODES.items()
    )


def nodes() -> tuple[str, ...]:
    """All nodes of the machine."""
    return tuple(name for body in bodies() for name in body.nodes)


def slide_joints(drive: float, across: float, tilting: float) -> Iterable[Joint]:
    """Three driven prismatic joints.

    Parameters
    ----------
    drive : float
        Stiffness along the slide, N/m.
    across : float
        Stiffness across it, N/m.
    tilting : float
        Stiffness about every axis, N·m/rad.
    """
    held = {"x": across, "y": across, "z": drive, "rx": tilting, "ry": tilting, "rz": tilting}
    pairs = {
        "x": (node(GROUND, FOOT), node("column", FOOT)),
        "z": (node("column", BACK), node("saddle", BACK)),
        # the ram slides through the saddle: the node that runs along it comes first
        "y": (node("ram", FRONT), node("saddle", FRONT)),
    }
    for name, pair in pairs.items():
        yield Joint(
            f"slide {name}",
            "prismatic",
            pair,
            held,
            driven=("z",),
            limits={"z": TRAVELS[name]},
        )


def rotary_joints(axes: str, drive: float, bearing: float, tilting: float) -> Iterable[Joint]:
    """Two driven rotary axes, and the spindle, whose bearings belong to the second.

    Parameters
    ----------
    axes : str
        "ac" or "ab".
    drive : float
        Stiffness about the axis, N·m/rad.
    bearing : float
        Stiffness in each direction, N/m.
    tilting : float
        Stiffness across the axis, N·m/rad.
    """
    held = {"x": bearing, "y": bearing, "z": bearing, "rx": tilting, "ry": tilting, "rz": drive}
    pairs = (
        (node("ram", PIVOT), node(FORK, PIVOT)),
        (node(FORK, "second"), node(HOUSING, PIVOT)),
    )
    for (name, reach), pair in zip(ROTARY[axes], pairs, strict=True):
        yield Joint(
            f"axis {name}",
            "revolute",
            pair,
            held,
            driven=("rz",),
            limits={"rz": (-reach, reach)},
        )
    pair = (node(HOUSING, "nose"), node(SPINDLE, PIVOT))
    yield Joint("spindle", "revolute", pair, driven=("rz",))


def beams(material: Material, column: Section, ram: Section, elements: int) -> tuple[Beam, ...]:
    """Column up to the saddle, ram from the saddle to its end, neck down to the pivot.

    Parameters
    ----------
    material : Material
    column, ram : Section
        The neck is of the ram's.
    elements : int
        Of each beam.
    """
    sides = (0.0, 0.0, 1.0)
    return (
        Beam(
            "column",
            (node("column", FOOT), node("column", BACK)),
            material,
            column,
            orientation=(1.0, 0.0, 0.0),
            elements=elements,
        ),
        Beam(
            "ram",
            (node("ram", FRONT), node("ram", END)),
            material,
            ram,
            orientation=sides,
            elements=elements,
        ),
        Beam(
            "neck",
            (node("ram", END), node("ram", PIVOT)),
            material,
            ram,
            orientation=(1.0, 0.0, 0.0),
            elements=elements,
        ),
    )


def masses(
    carriage: float, saddle: float, fork: float, housing: float, spindle: float, length: float
) -> tuple[PointMass, ...]:
    """Masses of the rigid parts; the spindle's centre is halfway to the tool tip.

    Parameters
    ----------
    carriage, saddle, fork, housing, spindle : float
        kg.
    length : float
        From the tool tip to the pivot, m.
    """
    return (
        PointMass(node("column", FOOT), carriage, _inertia(carriage, LARGE)),
        PointMass(node("saddle", BACK), saddle, _inertia(saddle, LARGE)),
        PointMass(node(FORK, PIVOT), fork, _inertia(fork, SMALL)),
        PointMass(node(HOUSING, PIVOT), housing, _inertia(housing, SMALL)),
        PointMass(TOOL, spindle, _inertia(spindle, THIN), (0.0, 0.0, length / 2.0)),
    )


def _inertia(mass: float, radius: float) -> tuple[tuple[float, ...], ...]:
    """The same about every axis, kg m²."""
    one = mass * radius * radius
    return ((one, 0.0, 0.0), (0.0, one, 0.0), (0.0, 0.0, one))


def lines() -> tuple[tuple[str, str], ...]:
    """Pairs of nodes that a drawing connects."""
    return (
        (node("column", FOOT), node("column", BACK)),
        (node("saddle", BACK), node("saddle", FRONT)),
        (node("ram", FRONT), node("ram", END)),
        (node("ram", END), node("ram", PIVOT)),
        (node(SPINDLE, PIVOT), TOOL),
    )
