"""Bodies, joints and beams of the MIT-SS-1: its topology, without coordinates."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from strutwork.kinematics import GROUND, Body, Joint
from strutwork.msa.beam import Beam
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section
from strutwork.msa.springs import PointMass

TOOL = "tool"
HOUSING = "housing"
STRUTS = (1, 2, 3)
#: The two ends of a strut.
ENDS = ("block", "housing")
#: The two bearings of a pin, from the granite's side outwards.
SIDES = ("near", "far")


def block(i: int, part: str) -> str:
    """Node of a moving block: "slide", "near" or "far".

    Parameters
    ----------
    i : int
        1 to 3.
    part : str
        "slide", "near" or "far".
    """
    return f"block{i}/{part}"


def strut(i: int, end: str, part: str) -> str:
    """Node of a strut, and name of the joint of its bearing there.

    Parameters
    ----------
    i : int
        1 to 3.
    end : str
        One of `ENDS`.
    part : str
        One of `SIDES`, or "end" for the middle of the pin.
    """
    return f"strut{i}/{end} {part}"


def seat(i: int, side: str) -> str:
    """Node of the spindle housing in the middle of a bearing.

    Parameters
    ----------
    i : int
        Of the strut.
    side : str
        One of `SIDES`.
    """
    return f"{HOUSING}/P{i} {side}"


def rail(i: int) -> str:
    """Node of the ground on a guide, where the block stands.

    Parameters
    ----------
    i : int
        Of the block.
    """
    return f"rail{i}"


def guide(i: int) -> str:
    """Driven joint of a moving block.

    Parameters
    ----------
    i : int
        Of the block.
    """
    return f"block{i}/guide"


def pin(i: int, end: str) -> str:
    """Joint of a pin taken as one ideal revolute joint.

    Parameters
    ----------
    i : int
        Of the strut.
    end : str
        One of `ENDS`.
    """
    return f"strut{i}/{end} pin"


def bearings() -> tuple[str, ...]:
    """Joints of the twelve bearings: strut by strut, block before housing, near before far."""
    return tuple(strut(i, end, side) for i in STRUTS for end in ENDS for side in SIDES)


def nodes() -> tuple[str, ...]:
    """All nodes of the machine."""
    return tuple(node for body in bodies() for node in body.nodes)


def bodies() -> tuple[Body, ...]:
    """Ground, spindle housing, moving blocks and struts."""
    return (
        Body(GROUND, tuple(rail(i) for i in STRUTS)),
        Body(HOUSING, (TOOL, *(seat(i, side) for i in STRUTS for side in SIDES))),
        *(Body(f"block{i}", tuple(block(i, p) for p in ("slide", *SIDES))) for i in STRUTS),
        *(
            Body(f"strut{i}", tuple(strut(i, end, p) for end in ENDS for p in (*SIDES, "end")))
            for i in STRUTS
        ),
    )


def guide_joints(drive: float | None, guides: float | None) -> Iterable[Joint]:
    """Driven prismatic joints along z.

    Parameters
    ----------
    drive : float or None
        Stiffness along z, N/m; None: rigid.
    guides : float or None
        Stiffness along x, N/m; None: rigid.
    """
    elastic = {d: k for d, k in (("z", drive), ("x", guides)) if k is not None}
    for i in STRUTS:
        yield Joint(guide(i), "prismatic", (rail(i), block(i, "slide")), elastic, driven=("z",))


def bearing_joints(stiffness: Callable[[str, str], Mapping[str, float]]) -> Iterable[Joint]:
    """Two bearings per pin: they hold three translations and turn freely.

    Parameters
    ----------
    stiffness : callable
        Takes the end of the strut and the side, and gives N/m by direction.
    """
    for i in STRUTS:
        for side in SIDES:
            pair = block(i, side), strut(i, "block", side)
            yield Joint(strut(i, "block", side), "spherical", pair, stiffness("block", side))
        for side in SIDES:
            pair = strut(i, "housing", side), seat(i, side)
            yield Joint(strut(i, "housing", side), "spherical", pair, stiffness("housing", side))


def pin_joints() -> Iterable[Joint]:
    """One ideal revolute joint per pin."""
    for i in STRUTS:
        yield Joint(pin(i, "block"), "revolute", (block(i, "near"), strut(i, "block", "near")))
        yield Joint(pin(i, "housing"), "revolute", (strut(i, "housing", "near"), seat(i, "near")))


def beams(material: Material, section: Section, elements: int) -> tuple[Beam, ...]:
    """A beam along the middle of each strut; its local z is the pins' direction.

    Parameters
    ----------
    material : Material
    section : Section
    elements : int
        Per strut.
    """
    return tuple(
        Beam(
            f"strut{i}",
            (strut(i, "block", "end"), strut(i, "housing", "end")),
            material,
            section,
            orientation=(0.0, 1.0, 0.0),
            elements=elements,
        )
        for i in STRUTS
    )


def shafts() -> tuple[Body, ...]:
    """The rigid pins at the ends of flexible struts."""
    return tuple(
        Body(f"strut{i}/{end} shaft", tuple(strut(i, end, p) for p in (*SIDES, "end")))
        for i in STRUTS
        for end in ENDS
    )


def housing_mass(mass: float, inertia: float, height: float) -> PointMass:
    """The spindle housing's mass on the tool axis.

    Parameters
    ----------
    mass : float
        kg.
    inertia : float
        The same about every axis, kg·m².
    height : float
        Above the tool tip, m.
    """
    rows = ((inertia, 0.0, 0.0), (0.0, inertia, 0.0), (0.0, 0.0, inertia))
    axes = (seat(1, "near"), seat(2, "near"), seat(1, "far"))
    return PointMass(TOOL, mass, rows, (0.0, 0.0, height), axes)


def end_masses(masses: Iterable[float]) -> tuple[PointMass, ...]:
    """Half of what each strut weighs beside its beam, at either end.

    Parameters
    ----------
    masses : iterable of three float
        What each strut weighs beside its beam, kg.
    """
    return tuple(
        PointMass(strut(i, end, "end"), mass / 2.0)
        for i, mass in zip(STRUTS, masses, strict=True)
        for end in ENDS
    )


def lines() -> tuple[tuple[str, str], ...]:
    """Pairs of nodes that a drawing connects."""
    return (
        *((strut(i, "block", s), strut(i, "housing", s)) for i in STRUTS for s in SIDES),
        *((strut(i, end, "near"), strut(i, end, "far")) for i in STRUTS for end in ENDS),
        *((seat(i, s), seat(j, s)) for i, j in ((1, 2), (2, 3), (3, 1)) for s in SIDES),
        *((seat(i, s), TOOL) for i in (1, 2) for s in SIDES),
    )
