"""What Son 2002 says of serial machines, and of all machines over a flat surface; computed."""

from __future__ import annotations

from functools import cache

import numpy as np

from strutwork.kinematics import mobility
from strutwork.kinematics.singular_distance import singularity_distance
from strutwork.kinematics.tool_drive_space import tool_drive_space
from strutwork.machines import HexelHexapod, MovingBridge, SerialFiveAxis
from strutwork.papers.son_2002.measured_statements import TESTS
from strutwork.papers.son_2002.serial import (
    HEADS,
    HEXAPOD_HALF,
    HEXAPOD_POINTS,
    at_turns,
    flat_reversals,
    flat_rows,
    heads,
)
from strutwork.papers.statements import Statement

SERIAL = f"{TESTS}/test_serial_machine.py"
BRIDGE = f"{TESTS}/test_moving_bridge.py"
HERE = f"{TESTS}/test_machine_statements.py"

#: Turn at which a head is singular as printed, degrees, and where.
PRINTED = {"ac": ("eq. 9", 0.0), "ab": ("eq. 10", 90.0)}


def hold() -> float:
    """Least distance of both serial machines from an actuator singularity, upright to level."""
    found = []
    for axes in HEADS:
        machine = SerialFiveAxis(axes=axes)
        known = tool_drive_space(machine.linkage, machine.place(machine.home())).known
        poses = at_turns(machine, 0.3, np.radians(np.arange(0.0, 91.0, 5.0)))
        found.append(
            singularity_distance(machine.linkage, machine.place(poses), None, known).parallel.min()
        )
    return float(min(found))


def serial_statements() -> tuple[Statement, ...]:
    """Section 2.1: singularities of serial machines."""
    rows = [
        Statement(
            "section 2.1.1",
            "actuator singularities of a serial machine",
            "",
            "none",
            f"none: the distance from one is {hold():.2f} or more from upright to level, "
            "both heads, singular poses included",
            "predicted",
            "",
            f"{SERIAL}::test_where_it_is_singular",
        )
    ]
    for head in heads():
        place, printed = PRINTED[head.axes]
        first, second = HEADS[head.axes].split("–")
        size = f"|{'sin' if head.axes == 'ac' else 'cos'} {second.lower()}|"
        rows += [
            Statement(
                place,
                f"head {HEADS[head.axes]}: turn {second.lower()} at which a direction is lost",
                "deg",
                printed,
                float(np.degrees(head.tilt[head.least.argmin()])),
                "predicted",
                f"the tool lies along axis {first}, by the joints alone",
                f"{SERIAL}::test_where_it_is_singular",
            ),
            Statement(
                place,
                f"head {HEADS[head.axes]}: speeds of the tool's axis at rates of size one",
                "",
                "not printed; they follow as 1 and " + size,
                f"1 and {size}, to {head.apart:.0e} from the joints alone",
                "predicted",
                "",
                f"{SERIAL}::test_rates_of_the_axis_are_those_of_equations_9_and_10",
            ),
        ]
    return tuple(rows)


def flat_statements() -> tuple[Statement, ...]:
    """Figs 15 and 21 and sections 4.4 and 6.5: a flat surface, the tool's direction held."""
    test = f"{BRIDGE}::test_machines_beside_each_other_over_a_flat_surface"
    return (
        *(
            Statement(
                "section 4",
                f"flat surface, {row.machine}: singular points",
                "",
                row.printed,
                row.found if row.where == "–" else f"{row.found}; {row.where}",
                "predicted",
                "",
                test,
            )
            for row in flat_rows()
        ),
        *_reached(),
    )


@cache
def free_shares() -> tuple[float, float]:
    """Share of a flat surface reached from its middle without a reversal: A–C, hexapod."""
    found = []
    for machine, half, points in (
        (SerialFiveAxis(), 0.1, 9),
        (HexelHexapod(), HEXAPOD_HALF, HEXAPOD_POINTS),
    ):
        over = flat_reversals(machine, half, points)
        middle = (points // 2, points // 2)
        found.append(float(over.reach(middle).sum() / over.reachable.sum()))
    return found[0], found[1]


@cache
def hexapod_plate() -> tuple[str, float]:
    """Code of the plate in the middle of the hexapod along x, and half of its width there, m.

    The code has a 1 for a leg that grows longer along x. Over the strip between the nearest
    singular points to either side no leg turns back along x, wherever y is.
    """
    over = flat_reversals(HexelHexapod(), HEXAPOD_HALF, HEXAPOD_POINTS)
    middle = HEXAPOD_POINTS // 2
    along = over.gradient[middle, middle, :, 0]
    points = [p.place[0] for drive in over.singular for p in drive.points]
    return "".join("1" if rate > 0 else "0" for rate in along), float(np.abs(points).min())


def _reached() -> tuple[Statement, ...]:
    serial, hexapod = free_shares()
    code, half = hexapod_plate()
    size = f"±{1e3 * HEXAPOD_HALF:g} mm"
    return (
        Statement(
            "section 4.4.5",
            "flat surface, serial machine: reached without a reversal",
            "",
            "the whole workspace",
            f"{100 * serial:.0f} % of the surface",
            "predicted",
            "",
            f"{HERE}::test_shares_that_are_reached_without_a_reversal",
        ),
        Statement(
            "section 4.4.5",
            "flat surface, hexapod: reached without a reversal, from the middle",
            "",
            "a much smaller area",
            f"{100 * hexapod:.0f} % of {size}",
            "predicted",
            "the size of the surface is not printed; here it is wide enough for all singular "
            "points",
            f"{HERE}::test_shares_that_are_reached_without_a_reversal",
        ),
        Statement(
            "section 4.4.4",
            "flat surface, hexapod: plate in which horizontal lines reverse no leg",
            "",
            "011100",
            f"{code}, for |x| < {1e3 * half:.0f} mm",
            "predicted",
            "three neighbouring legs against the other three, as printed; the leg with which the "
            "count begins is in a missing figure",
            f"{HERE}::test_plate_in_the_middle_of_the_hexapod",
        ),
    )


def bridge_statements() -> tuple[Statement, ...]:
    """Chapter 10: what its text carries, and what it does not."""
    return (
        Statement(
            "chapter 10",
            "four-axis machine on a moving bridge: axes",
            "",
            4.0,
            float(_bridge_mobility()),
            "predicted",
            "the planar machine of Appendix B on a bridge along y, the machine “moving-bridge”",
            f"{BRIDGE}::test_it_has_four_axes",
        ),
        Statement(
            "chapter 10",
            "stiffness and modes of the bridge, its travel",
            "",
            "“almost unlimited length”",
            "a rigid bridge on a rigid guideway of unlimited length",
            "not reproducible",
            "no dimension, mass or stiffness of the bridge, its drive and its guideway is printed",
            f"{BRIDGE}::test_statics_are_those_of_the_planar_machine",
        ),
    )


def _bridge_mobility() -> int:
    machine = MovingBridge()
    return mobility(machine.linkage, machine.place(machine.home())).mobility
