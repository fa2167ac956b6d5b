"""Two heads of the serial machine, and reversals over a flat surface beside the other machines."""

from __future__ import annotations

import numpy as np

from strutwork.machines import SerialFiveAxis
from strutwork.machines.serial_five_axis_parts import ROTARY, TRAVELS
from strutwork.papers.son_2002.serial import (
    HALF,
    HEADS,
    Head,
    flat_rows,
    heads,
)
from strutwork.papers.tables import assumed, numbers, texts
from strutwork.reports.content import Cell, Chapter, Figure, Points, Table, Text
from strutwork.reports.data_files import csv_file
from strutwork.reports.figures.curves import Curve, curves
from strutwork.reports.figures.theme import AXIS_COLOURS
from strutwork.reports.numbers import MINUS, significant

#: Tilts of the table, degrees.
SHOWN = (0, 1, 5, 10, 30, 60, 80, 89, 90)

SPEEDS, FLAT, HOME = "axis-speeds.csv", "flat-surface.csv", "heads-at-home.csv"

OURS = "assumed"

NOTES = (
    (
        "Lengths, sections, stiffnesses and masses are assumed: the thesis shows these machines "
        "as skeletons and prints none of their dimensions. Nothing in this table is a prediction "
        "of a printed number."
    ),
    (
        "At home the tool of A–C is tilted by 30° about x; the thesis rotates its surface for "
        "the same reason (section 4.4.1)."
    ),
    (
        "All chapters that follow and name no head show A–C; those of A–B come from the commands "
        "with “serial-five-axis:ab”."
    ),
)


def heads_chapter() -> Chapter:
    """Speed of the tool's axis over its tilt, and both machines at home."""
    found = heads()
    return Chapter(
        "heads",
        "Where does a head lose a direction?",
        (
            Text(
                "Two rotary axes at rates of size one rotate the tool's axis in one direction at "
                "speed 1 and in the other at |sin a| with axes C and A, at |cos b| with A and B "
                "(section 2.1.2, eqs 9 and 10). Where that is zero the tool can be tilted in one "
                "direction only, and near it a rotary axis must rotate faster than the tool by "
                "the inverse. With the tool upright, in the middle of the work, A–C loses a "
                "direction; A–B loses it with the tool level."
            ),
            _speeds_figure(found),
            _speeds_table(found),
            Text(
                "The values follow from the joints alone, without the formulas; the two differ "
                f"by {max(h.apart for h in found):.0e} at most. The spindle is driven as well, so "
                "that such a pose is a serial singularity of the entire machine too."
            ),
            _home_table(found),
            Points(NOTES),
        ),
        (
            csv_file(
                SPEEDS,
                "least speed of the tool's axis over its tilt, both heads",
                ["tilt_deg", *(f"{h.axes}_least_speed_1_per_rad" for h in found)],
                np.column_stack([np.degrees(found[0].tilt), *(h.least for h in found)]).tolist(),
            ),
            csv_file(
                HOME,
                "both heads at home",
                ["quantity", "unit", *(h.axes for h in found)],
                [[what, unit, *values] for what, unit, values in _home_rows(found)],
            ),
        ),
    )


def _speeds_figure(found: tuple[Head, ...]) -> Figure:
    colours = list(AXIS_COLOURS.values())
    return Figure(
        "axis-speeds",
        "Speed of the tool's axis in its slower direction, at rotary rates of size one.",
        curves(
            np.degrees(found[0].tilt),
            [
                Curve(HEADS[head.axes], head.least, colour)
                for head, colour in zip(found, colours, strict=False)
            ],
            ("tilt of the tool from upright (deg)", "least speed (rad/rad)"),
            from_zero=True,
        ),
        "Two curves over the tilt from 0 to 90 degrees: that of A–C rises from zero as a sine, "
        "that of A–B falls to zero as a cosine.",
        SPEEDS,
        340,
    )


def _speeds_table(found: tuple[Head, ...]) -> Table:
    rows: list[list[str | Cell]] = []
    for tilt in SHOWN:
        # a step of the tilts is one degree
        row: list[str | Cell] = [f"{tilt}"]
        for head in found:
            least = float(head.least[tilt])
            row += [significant(least, 3) if least > 1e-12 else Cell("0", "poor")]
            row += [significant(1.0 / least, 3) if least > 1e-12 else Cell("no bound", "poor")]
        rows.append(row)
    columns = numbers("tilt", unit="deg")
    for head in found:
        columns += numbers("least speed", "rate of the axes", group=HEADS[head.axes])
    return Table(
        "Least speed of the tool's axis, and the rates it demands of the rotary axes",
        columns,
        rows,
        SPEEDS,
    )


def _home_rows(found: tuple[Head, ...]) -> list[tuple[str, str, list[float]]]:
    rows = [
        (
            f"stiffness along {d}, other directions free",
            "N/µm",
            [h.stiffness[k] / 1e6 for h in found],
        )
        for k, d in enumerate("xyz")
    ]
    rows.append(("lowest frequency", "Hz", [h.frequency for h in found]))
    rows.append(("mass", "kg", [h.mass for h in found]))
    return rows


def _home_table(found: tuple[Head, ...]) -> Table:
    return Table(
        "Both machines at home",
        (*texts("quantity", "unit"), *numbers(*(HEADS[h.axes] for h in found))),
        [
            [what, unit, *(significant(v, 3) for v in values)]
            for what, unit, values in _home_rows(found)
        ],
        HOME,
    )


def flat_chapter() -> Chapter:
    """Which drives turn back over a flat surface, machine by machine."""
    rows = flat_rows()
    return Chapter(
        "flat-surface",
        "Which drives reverse over a flat surface?",
        (
            Text(
                "This is the simplest task of chapter 4: a flat surface with the tool's "
                "direction held. A drive is at a reversal singularity where it stands still "
                "whichever way the tool moves; there it reverses on almost every path."
            ),
            Table(
                "Reversal singularities, flat surface and tool held",
                texts("machine", "thesis", "computed", "where"),
                [[r.machine, r.printed, r.found, r.where] for r in rows],
                FLAT,
            ),
            Text(
                "A Cartesian machine's slides follow the surface's coordinates one to one, "
                f"whatever its head; the search covers ±{significant(1e3 * HALF)} mm."
            ),
        ),
        (
            csv_file(
                FLAT,
                "reversal singularities over a flat surface, machine by machine",
                ["machine", "thesis", "computed", "where", "places_mm"],
                [
                    [r.machine, r.printed, r.found, r.where, " ".join(map(repr, r.places))]
                    for r in rows
                ],
            ),
        ),
    )


def assumptions_chapter() -> Chapter:
    """Every choice of ours, with its value."""
    m = SerialFiveAxis()

    def mm(*lengths: float) -> str:
        return ", ".join(f"{1e3 * length:g}" for length in lengths) + " mm"

    def reach(low: float, high: float) -> str:
        return f"{1e3 * low:g} to {1e3 * high:g} mm".replace("-", MINUS)

    turns = {name: end for pair in ROTARY.values() for name, end in pair}
    rows = [
        ["Rotary axes and the tool's axis", "C, A or A, B", "section 2.1.2, eqs 9 and 10"],
        ["Order of the slides; both axes in the head", "x, z, y from the ground", OURS],
        ["Both rotary axes and the tool's meet in one point", "the pivot", OURS],
        ["Tool tip to pivot, pivot to the ram's axis", mm(m.tool_length, m.neck_length), OURS],
        ["Column's axis to pivot, to the saddle's", mm(m.column_distance, m.saddle_depth), OURS],
        ["Rails under the tool tip", mm(m.rail_depth), OURS],
        [
            "Sections of column; of ram and neck",
            f"{m.column.name}; {m.ram.name}, {m.material.name}",
            OURS,
        ],
        [
            "Slide along its way, across it, about each axis",
            (
                f"{m.slide_drive_stiffness / 1e6:g}, {m.guide_stiffness / 1e6:g} N/µm, "
                f"{m.guide_tilting_stiffness / 1e6:g} MN·m/rad"
            ),
            OURS,
        ],
        [
            "Rotary axis about itself, in each direction, across itself",
            (
                f"{m.rotary_drive_stiffness / 1e6:g} MN·m/rad, {m.bearing_stiffness / 1e6:g} N/µm, "
                f"{m.bearing_tilting_stiffness / 1e6:g} MN·m/rad"
            ),
            OURS,
        ],
        [
            "Carriage, saddle, fork, housing",
            f"{m.carriage_mass:g}, {m.saddle_mass:g}, {m.fork_mass:g}, {m.housing_mass:g} kg",
            OURS,
        ],
        ["Spindle", f"{m.spindle_mass:g} kg", "section 9, of the MIT-SS-1"],
        *([f"Travel of slide {name}", reach(*ends), OURS] for name, ends in TRAVELS.items()),
        *([f"Range of axis {name}", f"±{np.degrees(end):g}°", OURS] for name, end in turns.items()),
        ["Collisions, friction, play", "none", OURS],
    ]
    return Chapter(
        "assumptions",
        "Assumptions and their sources",
        (assumed("Dimensions and properties", rows),),
    )
