"""Bodies, joints and beams of the biglide: its topology, without coordinates."""

from __future__ import annotations

from collections.abc import Iterable

from strutwork.kinematics import GROUND, Body, Joint
from strutwork.msa.beam import Beam
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section

TOOL = "tool"
PLATFORM = "platform"
ARM = "arm"
LEGS = (1, 2)
#: Number of the leg that turns the tool.
THIRD = 3
#: The two rods of a parallelogram.
RODS = ("a", "b")


def rail(i: int) -> str:
    """Node of the ground on a rail, where the carriage stands.

    Parameters
    ----------
    i : int
        Of the leg.
    """
    return f"rail{i}"


def carriage(i: int, part: str) -> str:
    """Node of a carriage.

    Parameters
    ----------
    i : int
        Of the leg.
    part : str
        "slide", and "a" and "b" or "pin" where rods begin.
    """
    return f"carriage{i}/{part}"


def guide(i: int) -> str:
    """Driven joint of a carriage.

    Parameters
    ----------
    i : int
        Of the leg.
    """
    return f"carriage{i}/guide"


def rod(i: int, which: str = "", part: str = "") -> str:
    """A rod, or its node and the joint at one end.

    Parameters
    ----------
    i : int
        Of the leg.
    which : str
        "a" or "b"; empty for the third leg's.
    part : str
        "foot" or "end"; empty for the rod itself.
    """
    return f"rod{i}{which}/{part}" if part else f"rod{i}{which}"


def seat(i: int, which: str) -> str:
    """Node of the platform where a rod ends.

    Parameters
    ----------
    i : int
        Of the leg.
    which : str
        "a" or "b".
    """
    return f"{PLATFORM}/P{i}{which}"


def bodies(turning: bool) -> tuple[Body, ...]:
    """Ground, carriages, rods and platform; where the tool turns, its arm and the third leg.

    Parameters
    ----------
    turning : bool
        Whether a third leg turns the tool.
    """
    seats = tuple(seat(i, r) for i in LEGS for r in RODS)
    hinge = (f"{PLATFORM}/hinge",) if turning else (TOOL,)
    legs = (*LEGS, THIRD) if turning else LEGS
    found = [Body(GROUND, tuple(rail(i) for i in legs)), Body(PLATFORM, (*hinge, *seats))]
    for i in LEGS:
        found.append(Body(f"carriage{i}", tuple(carriage(i, p) for p in ("slide", *RODS))))
        found += [Body(rod(i, r), (rod(i, r, "foot"), rod(i, r, "end"))) for r in RODS]
    if turning:
        found += [
            Body(ARM, (TOOL, f"{ARM}/root", f"{ARM}/end")),
            Body(f"carriage{THIRD}", (carriage(THIRD, "slide"), carriage(THIRD, "pin"))),
            Body(rod(THIRD), (rod(THIRD, part="foot"), rod(THIRD, part="end"))),
        ]
    return tuple(found)


def joints(turning: bool, drive: float | None) -> Iterable[Joint]:
    """Guides and pins, leg by leg.

    Parameters
    ----------
    turning : bool
        Whether a third leg turns the tool.
    drive : float or None
        Stiffness of each drive, N/m; None holds it rigidly.
    """
    elastic = {} if drive is None else {"z": drive}

    def prismatic(i: int) -> Joint:
        pair = rail(i), carriage(i, "slide")
        return Joint(guide(i), "prismatic", pair, elastic, driven=("z",))

    for i in LEGS:
        yield prismatic(i)
        for r in RODS:
            foot, end = rod(i, r, "foot"), rod(i, r, "end")
            yield Joint(foot, "revolute", (carriage(i, r), foot))
            yield Joint(end, "revolute", (end, seat(i, r)))
    if turning:
        foot, end = rod(THIRD, part="foot"), rod(THIRD, part="end")
        yield Joint(f"{ARM}/hinge", "revolute", (f"{PLATFORM}/hinge", TOOL))
        yield prismatic(THIRD)
        yield Joint(foot, "universal", (carriage(THIRD, "pin"), foot))
        yield Joint(end, "universal", (end, f"{ARM}/end"))


def beams(material: Material, section: Section) -> tuple[Beam, ...]:
    """The rods of the parallelograms; their local z is the pins' direction.

    Parameters
    ----------
    material : Material
    section : Section
        Of every rod.
    """
    return tuple(
        Beam(
            rod(i, r),
            (rod(i, r, "foot"), rod(i, r, "end")),
            material,
            section,
            orientation=(0.0, 0.0, 1.0),
        )
        for i in LEGS
        for r in RODS
    )


def turning_beams(material: Material, arm: Section, third: Section) -> tuple[Beam, ...]:
    """The arm and the third rod; their local z is the axis about which the tool turns.

    Parameters
    ----------
    material : Material
    arm, third : Section
        Of the arm and of the third rod.
    """
    ends = rod(THIRD, part="foot"), rod(THIRD, part="end")
    across = (0.0, 1.0, 0.0)
    return (
        Beam(ARM, (f"{ARM}/root", f"{ARM}/end"), material, arm, orientation=across),
        Beam(rod(THIRD), ends, material, third, orientation=across),
    )


def hub() -> Body:
    """The rigid root of the arm, which carries the tool."""
    return Body(f"{ARM}/hub", (TOOL, f"{ARM}/root"))


def lines(turning: bool) -> tuple[tuple[str, str], ...]:
    """Pairs of nodes that a drawing connects.

    Parameters
    ----------
    turning : bool
        Whether a third leg turns the tool.
    """
    plane = (
        *((rod(i, r, "foot"), rod(i, r, "end")) for i in LEGS for r in RODS),
        *((carriage(i, "a"), carriage(i, "b")) for i in LEGS),
        (seat(1, "a"), seat(1, "b")),
        (seat(1, "b"), seat(2, "b")),
        (seat(2, "b"), seat(2, "a")),
        (seat(2, "a"), TOOL),
        (TOOL, seat(1, "a")),
    )
    if not turning:
        return plane
    third = rod(THIRD, part="foot"), rod(THIRD, part="end")
    return (*plane, (f"{ARM}/root", f"{ARM}/end"), third)
