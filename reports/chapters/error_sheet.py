"""What displaces the tool, by cause and part: where an errors file is given."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.process_file import is_known
from strutwork.reports.chapters.error_calibration import calibration_blocks
from strutwork.reports.chapters.error_heat import heat_blocks
from strutwork.reports.content import Block, Column, Details, Figure, Note, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, json_file, netcdf_file
from strutwork.reports.error_tables import axis_heads, axis_rows, sheet_heads, sheet_rows
from strutwork.reports.figures.charts import Bars, grouped
from strutwork.reports.figures.curves import Curve, curves
from strutwork.reports.figures.slices import slice_figure
from strutwork.reports.figures.theme import AXIS_COLOURS
from strutwork.reports.numbers import count, significant, without_rounding
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text, largest
from strutwork.studies.error_answer import AxisErrors, ErrorSheets, axis_errors
from strutwork.studies.error_causes import ErrorCauses, error_causes
from strutwork.studies.error_file import read_errors
from strutwork.studies.error_inputs import ErrorInputs
from strutwork.studies.error_sheet import ErrorSheet
from strutwork.studies.survey import survey
from strutwork.studies.survey_files import write_survey

Array = NDArray[Any]

SHEET, DRIFT, GROUND = "error-sheet.csv", "error-drift.csv", "error-ground.csv"
MAP, CALIBRATION = "error-sheet-survey", "error-calibration.json"

#: Moments at which the drift is drawn.
MOMENTS = 121

#: Positions along an axis for causes that are assumed: fewer tell enough.
FEW = 5

#: Pairs of points that a spectrum is drawn with at most.
DRAWN = 400

_HEADS = tuple(
    Column(d, "µm", group=group) for group in ("at worst", "within, 95 %") for d in "xyz"
)


def error_blocks(subject: Subject) -> tuple[list[Block], tuple[DataFile, ...]]:
    """Blocks and files of the error sheet; none without an errors file.

    Raises
    ------
    StrutworkError
        The file is wrong, or a cause cannot be computed.
    """
    if subject.errors is None:
        return [], ()
    inputs = read_errors(subject.errors, subject.model).computed(subject.model)
    causes = error_causes(subject.model, inputs)
    sheet = causes.sheet()
    blocks = [*_summary(subject, sheet, inputs), *_tables(sheet), *calibration_blocks(sheet)]
    files = [
        csv_file(
            SHEET, "displacement of the tool by cause and part", sheet_heads(), sheet_rows(sheet)
        )
    ]
    if sheet.calibrated is not None:
        what = "the calibration: poses, combinations that it determines and that it does not"
        files.append(json_file(CALIBRATION, what, sheet.calibrated.to_dict()))
    for some, more in (_curves(sheet, causes), heat_blocks(subject.model, inputs)):
        blocks += some
        files += more
    if not subject.unmoved:
        lines, area = subject, subject
        if is_known(subject.errors):
            axes = {d: _few(v) for d, v in subject.grid.axes.items()}
            lines = _over(subject, axes)
            area = _over(subject, dict(list(axes.items())[:2]))
        for some, beside in (_axes(lines, inputs), _map(area, inputs)):
            blocks += some
            files += beside
    return blocks, tuple(files)


def _few(values: Array) -> Array:
    """At most `FEW` of the positions along an axis, evenly, with both ends."""
    last = len(values) - 1
    picked = np.unique(np.linspace(0, last, FEW).round().astype(int))
    return np.asarray(np.asarray(values)[picked])


def _over(subject: Subject, axes: dict[str, Array]) -> Subject:
    return replace(subject, model=replace(subject.model, workspace=TaskGrid(axes)))


def _summary(subject: Subject, sheet: ErrorSheet, inputs: ErrorInputs) -> list[Block]:
    most = float(np.linalg.norm(sheet.largest()))
    against = inputs.against or subject.model.structure.linkage.against
    to = "the ground" if against is None else f"the workpiece at {against}"
    by_size = sorted(sheet.causes, key=lambda c: -float(np.linalg.norm(sheet.of(c).worst[:3])))
    blocks: list[Block] = [
        Text(
            f"All causes together, {count(len(sheet.rows), 'row')} of the error sheet, displace "
            f"the tool relative to {to} by {significant(1e6 * most)} µm in the worst case. The "
            f"largest causes are {' and '.join(by_size[:2])}. Known displacements add with their "
            "signs; ranges add by their support functions, which makes the worst case exact. A "
            "vibration of the ground counts with three standard deviations."
        )
    ]
    if inputs.source:
        blocks.append(Note(" ".join(inputs.source.split())))
    return [*blocks, *(Note(note) for note in sheet.notes)]


def _six(sheet: ErrorSheet) -> list[float]:
    return [1e6 * float(v) for v in (*sheet.worst[:3], *sheet.within()[:3])]


def _tables(sheet: ErrorSheet) -> list[Block]:
    parts = [(r.cause, r.part, ErrorSheet((r,))) for r in sheet.rows]
    sums = [*((c, sheet.of(c)) for c in sheet.causes), ("all causes", sheet)]
    numbers = np.array([_six(one) for _, one in sums])
    shown = without_rounding(numbers, numbers.max())
    totals = [
        [name, *(significant(float(v)) for v in row)]
        for (name, _), row in zip(sums, shown, strict=True)
    ]
    every = without_rounding(np.array([_six(one) for *_, one in parts]), numbers.max())
    rows = [
        [part, cause, *(significant(float(v)) for v in row)]
        for (cause, part, _), row in zip(parts, every, strict=True)
    ]
    worst = np.array([sheet.of(c).worst[:3] for c in sheet.causes])
    picked = list(zip(sheet.causes, without_rounding(worst, worst.max()), strict=True))
    bars = [
        Bars(d, [1e6 * float(w[i]) for _, w in picked], AXIS_COLOURS[d])
        for i, d in enumerate("xyz")
    ]
    return [
        Table(
            "Displacement of the tool by cause, at home",
            (Column("cause", "", False), *_HEADS),
            totals,
            SHEET,
        ),
        Figure(
            "error-causes",
            "Displacement of the tool by each cause at worst, along the global axes",
            grouped([c for c, _ in picked], bars, "displacement at worst, µm"),
            "Bars of the displacement along x, y and z for each cause: "
            + "; ".join(
                f"{c} {', '.join(significant(1e6 * float(v)) for v in w[:3])} µm" for c, w in picked
            ),
            SHEET,
        ),
        Details(
            "Error sheet by parts",
            (
                Table(
                    "Displacement of the tool by part and cause, at home",
                    (Column("part", "", False), Column("cause", "", False), *_HEADS),
                    rows,
                    SHEET,
                ),
            ),
        ),
    ]


def _curves(sheet: ErrorSheet, causes: ErrorCauses) -> tuple[list[Block], list[DataFile]]:
    figures: list[Figure] = []
    files: list[DataFile] = []
    if sheet.drift:
        last = max(t for t, _ in sheet.drift)
        drift = causes.known.drift(np.linspace(0.0, last, MOMENTS).tolist())
        moved = 1e6 * np.array([u for _, u in drift])
        figures.append(
            Figure(
                "error-drift",
                "Thermal drift of the tool after the temperatures began to change",
                curves([t / 60 for t, _ in drift], _xyz(moved), ("time, min", "displacement, µm")),
                f"Displacement along x, y and z up to {significant(last / 60)} minutes.",
                DRIFT,
                360,
            )
        )
        heads = ["time, s", *(f"{d}, {'rad' if d.startswith('r') else 'm'}" for d in DIRECTIONS)]
        lines = [(t, *u) for t, u in drift]
        files.append(csv_file(DRIFT, "thermal drift of the tool", heads, lines))
    found = causes.vibration
    if found is not None:
        total = np.sqrt((found.cumulative**2).sum(axis=0))
        pick = np.unique(np.linspace(0, len(total) - 1, DRAWN).astype(int))
        drawn = curves(
            found.frequencies[pick],
            _xyz(1e6 * total[pick]),
            ("frequency, Hz", "RMS below this frequency, µm"),
        )
        drawn["layout"]["xaxis"]["type"] = "log"
        figures.append(
            Figure(
                "error-ground",
                "Cumulative RMS of the tool by the vibration of the ground; a step is a mode",
                drawn,
                "Cumulative RMS along x, y and z; in all "
                + ", ".join(significant(1e6 * float(v)) for v in total[-1, :3])
                + " µm.",
                GROUND,
                360,
            )
        )
        heads = [
            "frequency, Hz",
            *(f"RMS {d}, {'rad' if d.startswith('r') else 'm'}" for d in DIRECTIONS),
        ]
        lines = [(f, *row) for f, row in zip(found.frequencies, total, strict=True)]
        files.append(
            csv_file(GROUND, "cumulative RMS by the vibration of the ground", heads, lines)
        )
    return ([Row(tuple(figures), 330)] if figures else []), files


def _xyz(values: Array) -> list[Curve]:
    dashes = {"x": "solid", "y": "dash", "z": "dot"}
    return [Curve(d, values[:, i], AXIS_COLOURS[d], dashes[d]) for i, d in enumerate("xyz")]


def _axes(subject: Subject, inputs: ErrorInputs) -> tuple[list[Block], list[DataFile]]:
    """Linear and angular errors along every axis of the workspace (ISO 230-1)."""
    blocks: list[Block] = []
    files: list[DataFile] = []
    for axis, positions in subject.grid.axes.items():
        reached = _reached(subject, inputs, axis, positions)
        if reached is None:
            continue
        name = f"errors-along-{axis}.csv"
        turns = axis.startswith("r")
        columns = (
            Column(axis, "deg" if turns else "mm", False),
            *(Column(n, "µm" if i < 3 else "µrad") for i, n in enumerate(reached.names)),
        )
        shown = 1e6 * np.vstack([reached.errors, reached.deviation, reached.half_range.max(axis=0)])
        for part in (slice(0, 3), slice(3, 6)):
            shown[:, part] = without_rounding(shown[:, part], np.abs(shown[:, part]).max())
        factor = np.degrees(1.0) if turns else 1e3
        heads = [*(f"{significant(factor * float(p))}" for p in positions), "range", "± at most"]
        rows = [
            [head, *(significant(float(v)) for v in row)]
            for head, row in zip(heads, shown, strict=True)
        ]
        blocks.append(Table(f"Errors along {axis}, as in ISO 230-1", columns, rows, name))
        files.append(
            csv_file(name, f"errors along {axis}", axis_heads(reached), axis_rows(reached))
        )
    if blocks:
        blocks.append(
            Text(
                "Linear and angular errors are relative to the first position, and straightness is "
                "about the line of least squares; the last row has what tolerances, drives and "
                "vibration may add to either side."
            )
        )
    return blocks, files


def _reached(
    subject: Subject,
    inputs: ErrorInputs,
    axis: str,
    positions: Array,
) -> AxisErrors | None:
    """Errors along an axis; None where the machine cannot follow it from home."""
    from strutwork.machines.model_poses import moved

    if len(positions) < 2:
        return None
    _, placement = moved(subject.model, {axis: positions})
    if not np.all(placement.reachable):
        return None
    return axis_errors(subject.model, inputs, axis, positions)


def _map(subject: Subject, inputs: ErrorInputs) -> tuple[list[Block], list[DataFile]]:
    found = survey(subject.model, subject.grid, [ErrorSheets(subject.model, inputs)])
    values = 1e6 * found["largest_displacement"].to_numpy()
    worst = largest(found, values)
    figure = slice_figure(
        found,
        values,
        ("largest displacement by all causes", "µm"),
        "error-map",
        f"{MAP}.csv",
        worst_is_least=False,
    )
    blocks: list[Block] = [
        Note(
            f"Over {grid_text(subject.grid)} all causes together displace the tool by "
            f"{significant(worst.value)} µm at most, at {worst.where}."
        ),
        figure,
    ]
    files = [
        netcdf_file(f"{MAP}.nc", "error sheet over the workspace, NetCDF", found),
        DataFile(
            f"{MAP}.csv",
            "error sheet over the workspace: one line per pose",
            lambda path: write_survey(path, found),
        ),
    ]
    return blocks, files
