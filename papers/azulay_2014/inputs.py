"""Dimensions and data that the paper prints and the machines take: Tables 1 and 3, section 3.3."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import degrees, inf
from types import MappingProxyType

from strutwork.machines import Alizade3PRPS, ThreeLegs
from strutwork.papers.azulay_2014.comparison import machines, variant
from strutwork.papers.azulay_2014.published import TABLE_1, TABLE_3
from strutwork.papers.published_table import PublishedTable
from strutwork.papers.statements import Statement

TEST = "tests/verification/azulay_2014/test_statements.py::test_inputs_are_those_of_the_print"

#: Why a number that agrees is no prediction.
TAKEN = "an input: taken from the document as it stands"
MIDDLE = f"{TAKEN}; the strut's length at the middle of its stroke (section 4)"


def _stroke(machine: ThreeLegs) -> tuple[float, float]:
    """Range of a leg's second drive from its lower end's radius or middle, mm."""
    (limit,) = (m for m in machine.limits if m.joint == "leg1/slide")
    return 1e3 * (limit.low - machine.base_radius), 1e3 * (limit.high - machine.base_radius)


def _turn(machine: ThreeLegs) -> float:
    """Range of a carriage on the guide, deg: a whole turn where its joint states none."""
    spans = [m.high - m.low for m in machine.limits if m.joint == "leg1/guide"]
    return degrees(min([*spans, inf])) if spans else 360.0


def _length(machine: ThreeLegs) -> float:
    name = "middle_length" if isinstance(machine, Alizade3PRPS) else "link_length"
    return 1e3 * float(getattr(machine, name))


#: What a machine has under each quantity of the tables, in its printed unit.
QUANTITIES: Mapping[str, Callable[[ThreeLegs], float]] = MappingProxyType(
    {
        "base radius": lambda m: 1e3 * m.base_radius,
        "platform radius": lambda m: 1e3 * m.platform_radius,
        "link length": _length,
        "curvilinear prismatic range": _turn,
        "radial prismatic minimum": lambda m: _stroke(m)[0],
        "radial prismatic maximum": lambda m: _stroke(m)[1],
        "second prismatic range": lambda m: 1e3 * float(getattr(m, "stroke", 0.0)),
        "revolute minimum": lambda m: degrees(m.hinge_range[0]),
        "revolute maximum": lambda m: degrees(m.hinge_range[1]),
        "spherical range to each side": lambda m: degrees(m.ball_range),
    }
)


def input_statements() -> tuple[Statement, ...]:
    """Every dimension of Tables 1 and 3, and the data of the static model."""
    return (*_table(TABLE_1, "Table 1"), *_table(TABLE_3, "Table 3"), *_model())


def _table(table: PublishedTable, place: str) -> tuple[Statement, ...]:
    some = {name: variant(name, "spherical") for name in machines()}
    return tuple(
        Statement(
            place,
            f"{v.row}: {v.quantity}",
            v.unit,
            v.value,
            QUANTITIES[v.quantity](some[v.row]),
            "calibrated",
            MIDDLE if (v.row, v.quantity) == ("alizade-3prps", "link length") else TAKEN,
            TEST,
        )
        for v in table
        if v.quantity in QUANTITIES
    )


def _model() -> tuple[Statement, ...]:
    machine = variant(machines()[0], "spherical")
    guide, drive = machine.guide_stiffness or inf, machine.drive_stiffness or inf
    return tuple(
        Statement("section 3.3.1", what, unit, value, ours, "calibrated", why, TEST)
        for what, unit, value, ours, why in (
            ("stiffness of the joint along the guide", "N/µm", 3.0, guide / 1e6, TAKEN),
            ("stiffness of the second driven joint", "N/µm", 3.0, drive / 1e6, TAKEN),
        )
    )
