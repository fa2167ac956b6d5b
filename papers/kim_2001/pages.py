"""Reports of the two Eclipse machines and of their document."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from strutwork.machines.catalogue import get
from strutwork.machines.eclipse_prototype import Drives
from strutwork.machines.literature import KIM_2001
from strutwork.papers.kim_2001.comparison import (
    HORIZONTAL,
    at_plate,
    barrier_rows,
    barriers,
    ellipsoid,
    least_singular_value,
    one_link_thin,
    radius_study,
    table_2_rows,
)
from strutwork.papers.kim_2001.published import BARRIERS, MEASURED, TABLE_2
from strutwork.papers.published_rows import PublishedRow, file_name
from strutwork.papers.tables import difference, numbers, rows_file, texts
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Cell, Chapter, Figure, Points, Row, Table, Text
from strutwork.reports.figures.ellipsoid import compliance_ellipsoid
from strutwork.reports.numbers import significant
from strutwork.studies.description import parameters, plain
from strutwork.studies.progress import Teller

Contents = tuple[str, str, tuple[Chapter, ...]]

#: Statements of the document that are no number of a table: what is printed, ours, status, test.
STATEMENTS = (
    (
        "two extra drives are needed against singular tilts",
        "at spindle angle 0 each one alone leaves a barrier, both leave none",
        "calibrated",
        "test_each_extra_drive_leaves_one_barrier",
    ),
    (
        "compliance is flat from a link radius of 35 mm on",
        "2.4 % above rigid links at 35 mm and tilt 0",
        "calibrated",
        "test_radius_of_the_links",
    ),
    (
        "at tilt 0 the first link matters most, at tilt 90 the other two",
        "the other way about",
        "not reproducible",
        "test_the_printed_order_of_sensitivity_does_not_come_out",
    ),
    (
        "section V: the compliance of a determinate machine from its rods",
        "agrees with the frame solution to 1e-9",
        "predicted",
        "test_the_frame_solution_is_castiglianos",
    ),
    (
        "section V is a reasonable analysis of the machine with eight drives",
        "the largest compliance at tilt 0 is less than half as large with eight",
        "not reproducible",
        "test_eight_drives_are_another_structure",
    ),
    (
        "eq. 3: P_z = h + L sin φ",
        "holds on all legs with φ < 0 where the carriage stands above; the text has it otherwise",
        "predicted",
        "test_height_of_a_hinge",
    ),
)

#: Printed results that are not repeated here, and why.
LEFT = (
    (
        "Table I, Newton's method from disturbed starts (99.29 % and 7.33 iterations): how the "
        "starts are drawn and what counts as converged is not printed. Not reproducible."
    ),
    (
        "Joint compliance of Table II: it depends on stiffnesses of drives that are not printed. "
        "Not reproducible."
    ),
    (
        "Order of sensitivity to the links (Fig. 14): printed as the first link at tilt 0 and the "
        "other two at tilt 90; ours stands in the table of thin links. Not reproducible."
    ),
    (
        "Workspaces (Figs 8 and 9): axes of the ball sockets and strokes are not printed. "
        "Not reproducible."
    ),
)


def machine_chapters(name: str, _progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters that the document adds to a machine's report."""
    entry = get(name)
    machine = entry.factory()
    chapters = [measured_chapter()]
    if name == "eclipse-prototype":
        chapters = [published_chapter(), barriers_chapter(), radius_chapter(), *chapters]
    content = {"parameters": parameters(machine)}
    chapters.append(closing_chapter(name, {"machine": name}, content, chapters))
    return entry.title, KIM_2001.citation, tuple(chapters)


def paper_chapters(_progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters of the document's own page."""
    chapters = [
        published_chapter(),
        barriers_chapter(),
        radius_chapter(),
        measured_chapter(),
        statements_chapter(),
        Chapter("left", "What is not repeated", (Points(LEFT),)),
    ]
    content: dict[str, Any] = {"rows": plain([r.to_dict() for r in (*table_2_rows(),)])}
    chapters.append(closing_chapter(KIM_2001.key, {"document": KIM_2001.key}, content, chapters))
    return (
        "A redundantly actuated machine on a circular guide: published and ours",
        KIM_2001.citation,
        tuple(chapters),
    )


def published_chapter() -> Chapter:
    """Table II and the singular tilt angles beside ours."""
    groups = ((TABLE_2, table_2_rows()), (BARRIERS, barrier_rows()))
    return Chapter(
        "published",
        "Beside the published numbers",
        (
            Text(
                "The document prints neither the link's length nor the platform's radius, the "
                "place of the tool or the columns' section. These four were fitted to the numbers "
                "below, so that all rows are calibrated and none is a prediction. Drives and "
                "joints are rigid; compliance is taken at the platform's centre, singular tilts "
                "with the tool on the guide's axis."
            ),
            *(_table(t.title, file_name(t.key), rows) for t, rows in groups),
            Text(TABLE_2.note),
            Row(tuple(_drawn(name, tilt) for name, tilt in (("0", 0.0), ("90", HORIZONTAL)))),
        ),
        tuple(rows_file(file_name(t.key), t.title, rows) for t, rows in groups),
    )


def _drawn(name: str, tilt: float) -> Figure:
    found = ellipsoid(at_plate(), tilt)
    return Figure(
        f"ellipsoid-{name}",
        f"Compliance ellipsoid at tilt {name} deg: how far and where a unit force moves the tool.",
        compliance_ellipsoid((found.axes * found.magnitudes) @ found.axes.T),
        f"Compliance ellipsoid at tilt {name} degrees, semi-axes "
        + ", ".join(f"{1e6 * m:.3g}" for m in found.magnitudes)
        + " micrometres per newton",
    )


def _table(title: str, file: str, rows: Sequence[PublishedRow]) -> Table:
    columns = (
        *texts("quantity", "unit"),
        *numbers("published", "ours", "difference"),
        *texts("status", "note"),
    )
    lines: list[list[str | Cell]] = [
        [
            r.quantity,
            r.unit,
            significant(r.published, 4),
            significant(r.computed, 4),
            difference(r),
            r.status,
            r.note,
        ]
        for r in rows
    ]
    return Table(title, columns, lines, file)


def barriers_chapter() -> Chapter:
    """Singular tilts by spindle angle, and what extra drives remove."""
    tilts = np.arange(0.5, 85.0, 0.5)
    angles = [
        [f"{roll:g}", ", ".join(f"{t:.1f}" for t in barriers(roll)) or "none"]
        for roll in (0.0, 10.0, 20.0, 30.0)
    ]
    words: dict[Drives, str] = {
        "6": "none",
        "7a": "hinge of leg 1",
        "7b": "hinge of leg 2",
        "8": "both hinges",
    }
    margins = [
        [
            text,
            significant(least_singular_value(drives, np.array([0.0]), tilts), 2),
            significant(least_singular_value(drives, np.arange(-30.0, 31.0, 5.0), tilts), 2),
        ]
        for drives, text in words.items()
    ]
    return Chapter(
        "barriers",
        "Singular tilts and extra drives",
        (
            Text(
                "With six drives the platform cannot be tilted from vertical to horizontal "
                "without passing poses in which the drives do not hold it. At spindle angle 0 "
                "each extra drive alone leaves one of them, that of leg 1 the lower and that of "
                "leg 2 the higher; both together leave none for spindle angles up to 30° to "
                "either side. The second barrier is gone beyond spindle angles of about 30° "
                "in any case, the first is not."
            ),
            Table(
                "Singular tilts with six drives, by the calibrated dimensions",
                texts("spindle angle, deg", "singular tilts, deg"),
                angles,
            ),
            Table(
                "Smallest singular value of the drives' rows over tilts of 0 to 85 deg, lengths "
                "scaled by the platform's radius; by the calibrated dimensions",
                (
                    *texts("extra drives"),
                    *numbers("spindle angle 0", "spindle angles -30 to 30 deg"),
                ),
                margins,
            ),
        ),
    )


def radius_chapter() -> Chapter:
    """Compliance by the radius of the links."""
    upright, lying = radius_study(0.0), radius_study(HORIZONTAL)
    thin = zip(one_link_thin(0.0), one_link_thin(HORIZONTAL), strict=True)
    return Chapter(
        "radius",
        "Radius of the links",
        (
            Text(
                "Norm of the compliance of the tool's position. The document finds it flat from "
                "35 mm on, and chose 33 mm; so does ours, with its calibrated dimensions."
            ),
            Table(
                "All links, relative to rigid ones; calibrated",
                numbers("radius, mm", "tilt 0", "tilt 90 deg"),
                [
                    [f"{1e3 * r:g}", f"{a:.3f}", f"{b:.3f}"]
                    for (r, a), (_, b) in zip(upright, lying, strict=True)
                ],
            ),
            Table(
                "One link of 15 mm, relative to all of 33 mm; calibrated",
                (*texts("thin link"), *numbers("tilt 0", "tilt 90 deg")),
                [[f"leg {i}", f"{a:.3f}", f"{b:.3f}"] for i, (a, b) in enumerate(thin, 1)],
            ),
        ),
    )


def statements_chapter() -> Chapter:
    """What the document says in words, and the test that holds ours."""
    columns = texts("printed", "ours", "status", "test")
    return Chapter(
        "statements",
        "Statements beside ours",
        (
            Text(
                "Tests stand in tests/verification/kim_2001; Table II is held by test_table_2, "
                "the singular tilts by test_barriers."
            ),
            Table("Statements of the document", columns, STATEMENTS),
        ),
    )


def measured_chapter() -> Chapter:
    """Measured stiffness, as data."""
    return Chapter(
        "measured",
        "Stiffness as measured",
        (
            Text(MEASURED.note),
            Table(
                MEASURED.title,
                (*texts("machine", "direction"), *numbers("stiffness", unit="N/µm")),
                [[v.row, v.quantity, f"{v.value:g}"] for v in MEASURED],
            ),
        ),
    )
