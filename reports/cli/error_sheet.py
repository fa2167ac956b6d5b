"""`strutwork accuracy --errors`: the error sheet of a pose, a workspace or an axis."""

from __future__ import annotations

import json as json_text
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from strutwork.errors import ModelError
from strutwork.files import write_whole
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.names import visible
from strutwork.reports.calibrated_words import calibration_lines
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import subject
from strutwork.reports.cli.survey_output import print_kept, written
from strutwork.reports.data_files import csv_file
from strutwork.reports.error_tables import axis_heads, axis_rows, sheet_heads, sheet_rows
from strutwork.reports.grid_words import grid_of_words
from strutwork.reports.survey_words import grid_text, largest
from strutwork.studies.error_answer import AxisErrors, ErrorSheets, axis_errors
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_file import read_errors
from strutwork.studies.error_sheet import ErrorSheet
from strutwork.studies.survey import survey

#: A measure of the sheet, its key and what the tables call it.
MEASURES = (
    ("known", "known"),
    ("worst_case", "at worst"),
    ("standard_deviation", "standard deviation"),
    ("within_95_percent", "95 % within"),
)


def run(
    target: str,
    errors: str,
    at: tuple[Sequence[str], Sequence[str]],
    over: list[str] | None,
    axes: list[str] | None,
    out: str | None,
    *,
    workers: int | None,
    json: bool,
) -> None:
    """Print the sheet at a pose, its extremes over a grid, or the errors along axes."""
    if sum(map(bool, (any(at), over, axes))) > 1:
        raise ModelError(
            "accuracy", "is given a pose, a grid or an axis at once.", "Choose one of them."
        )
    if over:
        _over(target, errors, over, out, workers=workers, json=json)
    elif axes:
        _along(target, errors, axes, out, json=json)
    else:
        _at_pose(subject(target, *at), target, errors, out, json=json)


def _at_pose(model: Model, target: str, errors: str, out: str | None, *, json: bool) -> None:
    sheet = error_sheet(model, read_errors(errors, model))
    result = {"target": target, "model": model.title} | sheet.to_dict() | {"data": []}
    if out is not None:
        path = Path(out) / f"{_stem(target)}-error-sheet.csv"
        table_ = csv_file(path.name, "", sheet_heads(), sheet_rows(sheet))
        write_whole(path, table_.write)
        result["data"] = [str(path)]
    if json:
        print_json(result)
        return
    _print(sheet, result)


def _stem(target: str) -> str:
    return Path(target).stem.replace(":", "-")


def _print(sheet: ErrorSheet, result: dict[str, Any]) -> None:
    out = console()
    out.print(visible(result["model"] or result["target"]), markup=False, style="bold")
    parts = [
        *((row.cause, row.part, ErrorSheet((row,))) for row in sheet.rows),
        *((cause, "all", sheet.of(cause)) for cause in sheet.causes),
        ("all", "all", sheet),
    ]
    numbers = np.array([_micro(one) for _, _, one in parts])
    # what rounding leaves where a part does nothing is no displacement
    numbers[numbers < 1e-9 * numbers.max()] = 0.0
    rows: list[tuple[object, ...]] = [
        (cause, part, *map(float, values))
        for (cause, part, _), values in zip(parts, numbers, strict=True)
    ]
    heads = ["cause", "part", *(f"{d}, worst" for d in "xyz"), *(f"{d}, 95 %" for d in "xyz")]
    out.print(table("Displacement of the tool by cause and part, µm", heads, rows, names=2))
    total = result["total"] | {"known": sheet.mean.tolist()}
    sums = [
        (
            d,
            "µrad" if d.startswith("r") else "µm",
            *(1e6 * float(total[key][i]) for key, _ in MEASURES),
        )
        for i, d in enumerate(DIRECTIONS)
    ]
    heads = ["tool", "unit", *(words for _, words in MEASURES)]
    out.print(table("Of all causes together", heads, sums, names=2))
    place = np.array(total["largest"])
    x, y, z = (f"{1e6 * v:.4g}" for v in place)
    out.print(
        f"Largest in any direction: {1e6 * np.linalg.norm(place):.4g} µm, towards "
        f"({x}, {y}, {z}) µm",
        markup=False,
    )
    if sheet.drift:
        drift = [(t / 60, *(1e6 * v for v in u[:3])) for t, u in sheet.drift]
        out.print(table("Thermal drift, µm", ["minutes", "x", "y", "z"], drift, names=0))
    if sheet.drive_forces:
        out.print(
            table("Drives", ["drive", "force under gravity, N or N·m"], _forces(sheet)),
        )
    for line in calibration_lines(sheet):
        out.print(visible(line), markup=False, soft_wrap=True)
    for note in sheet.notes:
        out.print(visible(note), markup=False, soft_wrap=True)
    for path in result["data"]:
        out.print(f"Written: {visible(path)}", markup=False, soft_wrap=True)


def _forces(sheet: ErrorSheet) -> list[tuple[str, float]]:
    # what a symmetric machine leaves of rounding is no force
    size = max(abs(f) for _, f in sheet.drive_forces)
    return [(name, f if abs(f) > 1e-9 * size else 0.0) for name, f in sheet.drive_forces]


def _micro(sheet: ErrorSheet) -> list[float]:
    return [1e6 * float(v) for v in (*sheet.worst[:3], *sheet.within()[:3])]


def _along(target: str, errors: str, axes: list[str], out: str | None, *, json: bool) -> None:
    model = load(target)
    model.require_tool()
    inputs = read_errors(errors, model)
    found: list[AxisErrors] = []
    for words in axes:
        lines = grid_of_words([words]).axes
        if len(lines) != 1:
            raise ModelError("--axis", f'"{words}" names {len(lines)} directions.', "Name one.")
        ((axis, positions),) = lines.items()
        found.append(axis_errors(model, inputs, axis, positions))
    result: dict[str, Any] = {
        "target": target,
        "model": model.title,
        "axes": [one.to_dict() for one in found],
        "data": [],
    }
    if out is not None:
        for one in found:
            path = Path(out) / f"{_stem(target)}-errors-along-{one.axis}.csv"
            table_ = csv_file(path.name, "", axis_heads(one), axis_rows(one))
            write_whole(path, table_.write)
            result["data"].append(str(path))
    if json:
        print_json(result)
        return
    printed = console()
    printed.print(visible(model.title or target), markup=False, style="bold")
    for one in found:
        printed.print(_axis_table(one))
    for path in result["data"]:
        printed.print(f"Written: {visible(path)}", markup=False, soft_wrap=True)


def _axis_table(one: AxisErrors) -> Any:
    turns = one.axis.startswith("r")
    factor = np.degrees(1.0) if turns else 1e3
    heads = [f"{one.axis}, {'deg' if turns else 'mm'}"]
    heads += [f"{n}, {'µm' if i < 3 else 'µrad'}" for i, n in enumerate(one.names)]
    rows: list[tuple[object, ...]] = [
        (f"{factor * at:.6g}", *(1e6 * float(v) for v in known))
        for at, known in zip(one.positions, one.errors, strict=True)
    ]
    rows.append(("range", *(1e6 * float(v) for v in one.deviation)))
    rows.append(("± at most", *(1e6 * float(v) for v in one.half_range.max(axis=0))))
    return table(f"Errors along {one.axis} (ISO 230-1)", heads, rows)


def _over(
    target: str,
    errors: str,
    over: list[str],
    out: str | None,
    *,
    workers: int | None,
    json: bool,
) -> None:
    model = load(target)
    model.require_tool()
    grid, answer = grid_of_words(over), ErrorSheets(model, read_errors(errors, model))
    with shown() as started:
        progress = started(f"error sheet of {visible(target)}")
        found = survey(model, grid, [answer], workers=workers, progress=progress)
    extremes: dict[str, dict[str, Any]] = {}
    for key, _ in MEASURES[1:]:
        for d in DIRECTIONS:
            most = largest(found, found[key].sel(direction=d).to_numpy())
            extremes[f"{key}_{d}"] = {"value": most.value, "at": most.task, "words": most.where}
    most = largest(found, found["largest_displacement"].to_numpy())
    causes = found["cause_worst_case"].to_numpy()[most.index]
    result: dict[str, Any] = {
        "target": target,
        "model": model.title,
        "poses": int(found.attrs["poses"]),
        "poses_kept": int(found.attrs["poses_kept"]),
        "dropped_by_reason": json_text.loads(found.attrs["dropped_by_reason"]),
        "largest_over_poses": extremes,
        "largest": {
            "length": most.value,
            "at": most.task,
            "words": most.where,
            "causes": {c: causes[i].tolist() for i, c in enumerate(answer.causes)},
        },
        "data": [],
    }
    if out is not None:
        result["data"] = written(out, target, "error-sheet", found)
    if json:
        print_json(result)
        return
    print_kept(result, grid_text(grid))
    printed = console()
    rows: list[tuple[object, ...]] = [
        (
            d,
            "µrad" if d.startswith("r") else "µm",
            *(1e6 * extremes[f"{key}_{d}"]["value"] for key, _ in MEASURES[1:]),
            extremes[f"worst_case_{d}"]["words"],
        )
        for d in DIRECTIONS
    ]
    heads = ["tool", "unit", *(words for _, words in MEASURES[1:]), "at worst at"]
    printed.print(table("Largest displacement over the poses", heads, rows, names=2))
    printed.print(
        f"Largest in any direction: {1e6 * most.value:.4g} µm, at {most.where}", markup=False
    )
    parts = [(c, *(1e6 * float(v) for v in causes[i][:3])) for i, c in enumerate(answer.causes)]
    printed.print(table("Causes there, at worst, µm", ["cause", "x", "y", "z"], parts))
    for path in result["data"]:
        printed.print(f"Written: {visible(path)}", markup=False, soft_wrap=True)
