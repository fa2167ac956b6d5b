"""The two machines drawn, and the document's tables beside what is modelled."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from strutwork.machines.catalogue import Machine
from strutwork.machines.gough_platform import GoughPlatform
from strutwork.machines.linear_delta import LinearDelta
from strutwork.machines.load import machine_model
from strutwork.papers.corbel_2008.actuation import study_actuation
from strutwork.papers.corbel_2008.measuring import leg_range
from strutwork.papers.corbel_2008.published import DELTA, PLATFORM, TABLE_1, TABLE_2, TEXT
from strutwork.papers.published_rows import PublishedRow, Status, file_name
from strutwork.papers.published_table import PublishedTable, PublishedValue
from strutwork.papers.tables import assumed, rows_file, rows_table
from strutwork.reports.content import Chapter, Figure, Note, Row, Text
from strutwork.reports.data_files import json_file
from strutwork.reports.drawing_data import drawing_data
from strutwork.reports.figures.model import model_view

_OURS = "assumed"
TITLES = {DELTA: "linear Delta", PLATFORM: "measuring platform"}


def table_1_rows() -> tuple[PublishedRow, ...]:
    """Table I beside the dimensions of the machine that is modelled."""
    machine = LinearDelta()
    sizes = (
        machine.base_radius,
        machine.platform_radius,
        machine.rod_length,
        machine.rod_spacing,
    )
    return _taken(TABLE_1, [1e3 * size for size in sizes])


def table_2_rows() -> tuple[PublishedRow, ...]:
    """Table II beside the dimensions of the platform that is modelled."""
    machine = GoughPlatform()
    sizes = (
        1e3 * machine.base_radius,
        round(degrees(machine.base_pair), 9),
        1e3 * machine.plate_radius,
        round(degrees(machine.plate_pair), 9),
    )
    return _taken(TABLE_2, sizes, "taken in the order that meets the printed range of the legs")


def text_rows() -> tuple[PublishedRow, ...]:
    """Numbers of the text: the workspace is taken, ΔR is found, of the legs one end is fitted."""
    legs = leg_range(GoughPlatform())
    best = study_actuation().best_of(LinearDelta().rod_length)
    fitted = "order of Table II, turn and height of the plate were chosen to meet the leg range"
    found: tuple[tuple[float, Status, str], ...] = (
        (1e3 * LinearDelta().workspace_side, "calibrated", "a dimension, taken as printed"),
        (
            1e3 * best.reach,
            "predicted",
            (
                "least of the largest condition numbers; the document calls its choice a "
                "compromise with the size, and any value within 1 % of the least is possible"
            ),
        ),
        (1e3 * legs.shortest, "calibrated", fitted),
        (1e3 * legs.longest, "calibrated", fitted),
    )
    return tuple(_row(value, *ours) for value, ours in zip(TEXT.values, found, strict=True))


def _taken(
    table: PublishedTable, ours: Sequence[float], note: str = "a dimension, taken as printed"
) -> tuple[PublishedRow, ...]:
    return tuple(
        _row(value, number, "calibrated", note)
        for value, number in zip(table.values, ours, strict=True)
    )


def _row(value: PublishedValue, ours: float, status: Status, note: str) -> PublishedRow:
    return PublishedRow(value.row, value.quantity, value.unit, value.value, ours, status, note)


def drawings_chapter(names: Sequence[str] = (DELTA, PLATFORM)) -> Chapter:
    """The machines at home."""
    made: dict[str, Machine] = {DELTA: LinearDelta(), PLATFORM: GoughPlatform()}
    figures, files = [], []
    for name in names:
        machine = made[name]
        file = json_file(
            f"drawing-{name}.json",
            f"what the drawing of the {TITLES[name]} shows",
            drawing_data(machine, machine.place(machine.home())),
        )
        files.append(file)
        figures.append(
            Figure(
                f"drawing-{name}",
                f"The {TITLES[name]} at home, in mm; z points to the work.",
                model_view(machine_model(machine, name)),
                f"Three-dimensional drawing of the {TITLES[name]}",
                file.name,
                480,
            )
        )
    return Chapter(
        "machines",
        "The two machines",
        (
            Text(
                "The Delta moves the tool in three directions without rotation; the platform is "
                "behind it, drives nothing and measures the tool's position and orientation. The "
                "distance between the two is not legible, so each is modelled separately."
            ),
            Row(tuple(figures), 420),
        ),
        tuple(files),
    )


def published_chapter() -> Chapter:
    """Tables I and II and the numbers of the text."""
    groups = ((TABLE_1, table_1_rows()), (TABLE_2, table_2_rows()), (TEXT, text_rows()))
    return Chapter(
        "published",
        "Beside the published numbers",
        (
            Text(
                "Most printed numbers are dimensions, which a model takes as they are. Results "
                "are the ΔR that follows from the length of the rods and the ends of the legs' "
                "range."
            ),
            *(rows_table(t.title, rows, file_name(t.key)) for t, rows in groups),
            Text(TABLE_2.note),
            Note(
                "The copy that was read lacks its first lines and most figures. Title, authors "
                "and year are attributed to it by its abstract and have not been checked against "
                "the publication."
            ),
        ),
        tuple(rows_file(file_name(t.key), t.title, rows) for t, rows in groups),
    )


def assumptions_chapter(names: Sequence[str] = (DELTA, PLATFORM)) -> Chapter:
    """What the document leaves open."""
    delta, platform = LinearDelta(), GoughPlatform()
    rows = {
        DELTA: (
            ("Delta: rods", f"steel, {delta.section.name} mm", _OURS),
            (
                "Delta: stiffness of a drive",
                f"{(delta.drive_stiffness or 0) * 1e-6:g} N/µm",
                _OURS,
            ),
            (
                "Delta: masses of platform and of a carriage",
                f"{delta.platform_mass:g} kg, {delta.carriage_mass:g} kg",
                _OURS,
            ),
            (
                "Delta: stroke of the carriages",
                f"{1e3 * (delta.stroke[1] - delta.stroke[0]):.0f} mm",
                "what the printed workspace needs",
            ),
            ("Delta: carriages behind the platform", "", "assumed; Fig. 1 is not legible"),
        ),
        PLATFORM: (
            (
                "platform: height of the plate at home",
                f"{1e3 * platform.plate_height:g} mm",
                "fitted to the printed shortest leg",
            ),
            ("platform: turn of the plate's lines", f"{degrees(platform.plate_turn):g}°", "fitted"),
            (
                "platform: legs",
                (
                    f"steel, {platform.cylinder.name} mm and {platform.rod.name} mm, universal "
                    "joint at the base"
                ),
                "assumed; the document has a ball joint there as well, whose spin is not measured",
            ),
            (
                "platform: lengths of the legs",
                "measured",
                (
                    "they take the place of another machine's drives: drive forces and stiffness "
                    "are those of clamped legs, while the device itself follows freely"
                ),
            ),
            ("platform: mass of the plate", f"{platform.plate_mass:g} kg", _OURS),
        ),
    }
    return Chapter(
        "assumptions",
        "What the document leaves open",
        (assumed("Assumptions", [row for name in names for row in rows[name]]),),
    )
