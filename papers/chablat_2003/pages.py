"""Reports of the two biglides and of their document."""

from __future__ import annotations

from typing import Any

import numpy as np

from strutwork.machines.literature import CHABLAT_2003
from strutwork.machines.naming import named_machine
from strutwork.papers.chablat_2003.published import HIGH, SQUARES
from strutwork.papers.chablat_2003.squares import (
    ANGLES,
    amplification,
    square_area,
    square_corners,
    square_rows,
)
from strutwork.papers.chablat_2003.statements import statements
from strutwork.papers.chablat_2003.third_leg import SIDE, range_map
from strutwork.papers.published_rows import file_name
from strutwork.papers.statement_tables import statements_chapter
from strutwork.papers.statements import (
    NONE,
    count_text,
    statements_file,
    statements_name,
)
from strutwork.papers.tables import rows_file
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter, Column, Figure, Table, Text
from strutwork.reports.data_files import csv_file
from strutwork.reports.figures.curves import heat
from strutwork.studies.description import parameters, plain
from strutwork.studies.progress import Teller

#: Squares by the angle of their sides.
SQUARES_CSV = "largest-squares.csv"

Contents = tuple[str, str, tuple[Chapter, ...]]


def machine_chapters(name: str, _progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters that the document adds to a machine's report."""
    found = named_machine(name)
    own = turning_chapter() if "third" in found.variant.name else amplification_chapter()
    content = {"parameters": parameters(found.machine)}
    closing = closing_chapter(name, {"machine": found.name}, content, (own,))
    return found.title, CHABLAT_2003.citation, (own, closing)


def paper_chapters(_progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters of the document's own page."""
    said = statements()
    table = statements_chapter(
        "statements",
        "Every printed result beside the computed values",
        said,
        statements_name(CHABLAT_2003.key),
    )
    rows = square_rows()
    beside = Chapter(
        table.key,
        table.title,
        (count_text(said), *table.blocks),
        (
            statements_file(CHABLAT_2003.key, said),
            rows_file(file_name(SQUARES.key), SQUARES.title, rows),
        ),
    )
    chapters = [beside, amplification_chapter(), turning_chapter()]
    content: dict[str, Any] = {"rows": plain([r.to_dict() for r in rows])}
    chapters.append(
        closing_chapter(CHABLAT_2003.key, {"document": CHABLAT_2003.key}, content, chapters)
    )
    return (
        "A machine of two legs in a plane, and a third that turns its tool: published and computed",
        CHABLAT_2003.citation,
        tuple(chapters),
    )


def amplification_chapter() -> Chapter:
    """Map of the velocity amplification over the plane."""
    axis = np.linspace(-0.98, 0.98, 31)
    x, y = np.meshgrid(axis, axis, indexing="ij")
    found = amplification(x, y)
    # as far from one on either side: the document bounds both alike
    worst = np.maximum(found[..., 1], 1.0 / found[..., 0])
    file = "velocity-amplification.csv"
    shown = np.where(worst <= HIGH, worst, np.nan)
    areas = {angle: square_area(angle) for angle in ANGLES}
    squares = {
        f"{angle:g}° to the rails, {np.sqrt(area):.3f} m wide": square_corners(angle)
        for angle, area in areas.items()
    }
    return Chapter(
        "amplification",
        "How fast it moves its tool",
        (
            Text(
                "The map shows the larger of the largest amplification of the drives' velocities "
                "and the inverse of the least one, from the constraint rows of the joints. It is "
                "1 at S, where the legs are at right angles, and at most 3 within the document's "
                "bounds of 1/3 and 3. The largest squares about S within these bounds touch them "
                "in their corners. The document has those at 45° and along the rails; the "
                "squares grow as their sides turn towards the rails."
            ),
            Figure(
                "amplification-map",
                "Velocity amplification over the plane of the tool; blank: outside the bounds. "
                "Outlined are the largest squares about S, by the angle of their sides to the "
                "rails.",
                heat(
                    axis,
                    axis,
                    shown,
                    ("x (m)", "y (m)", "amplification (m/s per m/s)"),
                    outlines=squares,
                ),
                "Map of the velocity amplification over x and y, from 1 in the middle to 3, with "
                "four squares about the middle.",
                file,
                560,
            ),
            _squares_table(areas),
        ),
        (
            csv_file(
                SQUARES_CSV,
                "largest squares about S by the angle of their sides to the rails",
                ["angle_deg", "side_m", "area_m2", "of_that_along_the_rails"],
                [[k, float(np.sqrt(area)), area, area / areas[0.0]] for k, area in areas.items()],
            ),
            csv_file(
                file,
                "least and largest velocity amplification over x and y",
                ["x_m", "y_m", "least", "largest", "shown"],
                np.stack(
                    [x.ravel(), y.ravel(), *found.reshape(-1, 2).T, worst.ravel()], axis=-1
                ).tolist(),
            ),
        ),
    )


def _squares_table(areas: dict[float, float]) -> Table:
    printed = dict(zip((45.0, 0.0), SQUARES.values, strict=True))
    columns = (
        Column("sides to the rails", "deg"),
        Column("side", "m"),
        Column("area", "m²"),
        Column("of that along the rails"),
        Column("printed area", "m²"),
    )
    rows = [
        [
            f"{angle:g}",
            f"{np.sqrt(area):.3f}",
            f"{area:.3f}",
            f"{area / areas[0.0]:.3f}",
            f"{printed[angle].value:g}" if angle in printed else NONE,
        ]
        for angle, area in areas.items()
    ]
    return Table("Largest squares about S", columns, rows, SQUARES_CSV)


def turning_chapter() -> Chapter:
    """Map of the range of β over the lengths of arm and third leg."""
    arms, thirds, ranges = range_map()
    degrees = np.degrees(ranges.T)
    file = "turning-range.csv"
    return Chapter(
        "turning",
        "How far the third leg rotates the tool",
        (
            Text(
                f"Range of β about home that is allowed at every place of a square {SIDE:.3f} m "
                "wide, the printed one along the rails, where leg and rail, and leg and arm, "
                "respect the document's angles (sine and cosine 0.2). The ridge lies at L₂ = 1.8 "
                "L₁; blank: the leg exceeds the bounds at β = 0."
            ),
            Figure(
                "turning-map",
                "Range of β over the lengths of the arm and of the third leg, as in Fig. 8.",
                heat(
                    arms,
                    thirds,
                    np.where(degrees > 0.0, degrees, np.nan),
                    ("L1 (m)", "L2 (m)", "range of β (deg)"),
                    {"L2 = 1.8 L1": (2.0, 3.6)},
                ),
                "Map of the range of beta over L1 and L2; the largest lie near L2 = 1.8 L1.",
                file,
                460,
            ),
        ),
        (
            csv_file(
                file,
                "range of beta over the lengths of arm and third leg",
                ["L1_m", "L2_m", "range_deg"],
                [
                    [float(a), float(t), float(degrees[i, j])]
                    for i, a in enumerate(arms)
                    for j, t in enumerate(thirds)
                ],
            ),
        ),
    )
