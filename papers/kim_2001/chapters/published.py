"""Table II, its ellipsoids and the singular tilts beside computed values, and what was measured."""

from __future__ import annotations

from strutwork.papers.kim_2001.comparison import (
    HORIZONTAL,
    at_plate,
    barrier_rows,
    ellipsoid,
    table_2_rows,
)
from strutwork.papers.kim_2001.published import AXES, BARRIERS, MEASURED, TABLE_2
from strutwork.papers.published_rows import file_name
from strutwork.papers.tables import numbers, rows_file, rows_table, texts
from strutwork.reports.content import Chapter, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.ellipsoid import compliance_ellipsoid

DRAWN = "structural-ellipsoids.csv"

#: Tilts of Table II by their names.
TILTS = {"0": 0.0, "90": HORIZONTAL}


def published_chapter() -> Chapter:
    """Table II and the singular tilt angles beside the computed values."""
    groups = ((TABLE_2, table_2_rows()), (BARRIERS, barrier_rows()))
    return Chapter(
        "published",
        "Beside the published numbers",
        (
            Text(
                "The document prints neither the link's length nor the platform's radius, the "
                "position of the tool or the columns' section. These four were fitted to the "
                "numbers below, so that all rows are calibrated and none is a prediction. Drives "
                "and joints are rigid; compliance is taken at the platform's centre, singular "
                "tilts with the tool on the guide's axis."
            ),
            *(rows_table(t.title, rows, file_name(t.key)) for t, rows in groups),
            Text(TABLE_2.note),
            Row(tuple(_drawn(name, tilt) for name, tilt in TILTS.items()), 360),
        ),
        (*(rows_file(file_name(t.key), t.title, rows) for t, rows in groups), _drawn_file()),
    )


def _drawn(name: str, tilt: float) -> Figure:
    found = ellipsoid(at_plate(), tilt)
    return Figure(
        f"structural-{name}",
        f"Structural compliance ellipsoid at tilt {name} deg: how far and where a unit force "
        "moves the tool (the document's Figs 11 and 12).",
        compliance_ellipsoid((found.axes * found.magnitudes) @ found.axes.T),
        f"Compliance ellipsoid at tilt {name} degrees, semi-axes "
        + ", ".join(f"{1e6 * m:.3g}" for m in found.magnitudes)
        + " micrometres per newton",
        DRAWN,
    )


def _drawn_file() -> DataFile:
    rows = []
    for name, tilt in TILTS.items():
        found = ellipsoid(at_plate(), tilt)
        rows += [
            [name, axis, float(size), *way.tolist()]
            for axis, size, way in zip(AXES, found.magnitudes, found.axes.T, strict=True)
        ]
    return csv_file(
        DRAWN,
        "semi-axes of the structural compliance ellipsoids of Table II, with their directions",
        ("tilt_deg", "axis", "length_m_per_N", "x", "y", "z"),
        rows,
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
