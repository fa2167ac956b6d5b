"""`strutwork accuracy`: how far the errors of a machine carry its tool, here or over a grid."""

from __future__ import annotations

import json as json_text
from collections.abc import Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from strutwork.csv_rows import RowWriter
from strutwork.errors import ModelError, UnitError
from strutwork.files import write_text
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.names import visible
from strutwork.overconstraint.accuracy import Accuracy
from strutwork.overconstraint.joint_errors import JointError
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import subject
from strutwork.reports.cli.survey_output import print_kept, written
from strutwork.reports.grid_words import grid_of_words
from strutwork.reports.motion_table import targets_of_words
from strutwork.reports.survey_words import grid_text, largest
from strutwork.studies.accuracy_answer import (
    VolumetricAccuracy,
    drive_errors,
    top_sources,
)
from strutwork.studies.survey import survey
from strutwork.units import ANGLE, LENGTH, quantity

#: How the three measures are called, and by which key.
MEASURES = (
    ("worst_case", "at worst"),
    ("root_sum_square", "root of squares"),
    ("standard_deviation", "standard deviation"),
)


@dataclass(frozen=True)
class Options:
    """What counts as an error, as it was typed.

    Parameters
    ----------
    drives, play : tuple of str
    tolerances : bool
    """

    drives: tuple[str, ...]
    play: tuple[str, ...]
    tolerances: bool


def run(
    target: str,
    at: tuple[Sequence[str], Sequence[str]],
    over: list[str] | None,
    options: Options,
    out: str | None,
    *,
    workers: int | None,
    json: bool,
) -> None:
    """Print the accuracy at a pose, or its extremes over a grid."""
    if over:
        if any(at):
            raise ModelError(
                "accuracy",
                "is given both a pose and a grid.",
                "Give --over, or --pose and --joint.",
            )
        _over(target, over, options, out, workers=workers, json=json)
        return
    model = subject(target, *at)
    model.require_tool()
    answer = _answer(model, options)
    found = answer.at(model.placed)
    place, parts = found.largest()
    result = {
        "target": target,
        "model": model.title,
        "by": "stiffness" if bool(found.elastic) else "rows",
        "sources": list(found.names),
        "worst_case": _six(found.worst),
        "root_sum_square": _six(found.root_sum_square),
        "standard_deviation": _six(found.deviation),
        "middle": _six(found.mean),
        "contributions": {
            name: _six(found.contributions[:, k]) for k, name in enumerate(found.names)
        },
        "largest": {
            "displacement": place.tolist(),
            "length": float(np.linalg.norm(place)),
            "contributions": dict(zip(found.names, parts.tolist(), strict=True)),
        },
        "drives_without_error": _silent(model, answer),
        "data": [],
    }
    if out is not None:
        path = Path(out) / f"{_stem(target)}-accuracy.csv"
        write_text(path, _csv(found))
        result["data"] = [str(path)]
    if json:
        print_json(result)
        return
    _print(result)


def _answer(model: Model, options: Options) -> VolumetricAccuracy:
    lengths: dict[str, float] = {}
    for text in options.drives:
        kind, value = _size(text)
        if kind in lengths:
            raise ModelError("--drive-error", f"gives two {kind}s.", "Give one of each kind.")
        lengths[kind] = value
    errors = [*drive_errors(model, lengths.get("length"), lengths.get("angle"))]
    for (joint, direction), value in targets_of_words(options.play, "--play").items():
        if not joint:
            raise ModelError(
                "--play", f"names no joint for {direction}.", f"Write JOINT:{direction}=VALUE."
            )
        # from stop to stop: half of it to either side of the middle
        errors.append(JointError("play", joint, direction, value / 2))
    tolerances = model.tolerances if options.tolerances else ()
    if not tolerances and not errors:
        raise ModelError(
            "accuracy",
            f"finds no source of error in {model.title or 'the model'}.",
            "Give --drive-error 5um or --play JOINT:DIR=VALUE, or add [[tolerances]] or "
            "[[drives]] with a resolution to the file.",
        )
    return VolumetricAccuracy(tolerances, tuple(errors))


def _size(text: str) -> tuple[str, float]:
    """A length or an angle, by its unit."""
    try:
        return "length", quantity(text, LENGTH, "--drive-error")
    except UnitError:
        try:
            return "angle", quantity(text, ANGLE, "--drive-error")
        except UnitError as error:
            raise ModelError(
                "--drive-error",
                f'"{text}" is neither a length nor an angle.',
                "Write it as 5um or 10urad.",
            ) from error


def _silent(model: Model, answer: VolumetricAccuracy) -> list[str]:
    """Drives that were given no error."""
    known = {(e.joint, e.direction) for e in answer.errors}
    return [f"{j}:{d}" for j, d in model.structure.linkage.driven if (j, d) not in known]


def _six(values: Any) -> dict[str, float]:
    return {d: float(v) for d, v in zip(DIRECTIONS, values, strict=True)}


def _stem(target: str) -> str:
    return Path(target).stem.replace(":", "-")


def _csv(found: Accuracy) -> str:
    """One row a measure and a source, m and rad."""
    text = StringIO(newline="")
    writer = RowWriter(text)
    units = ["rad" if d.startswith("r") else "m" for d in DIRECTIONS]
    writer.writerow(["what", *(f"{d}, {u}" for d, u in zip(DIRECTIONS, units, strict=True))])
    rows = [
        ("at worst", found.worst),
        ("root of squares", found.root_sum_square),
        ("standard deviation", found.deviation),
        ("middle", found.mean),
        *((name, found.contributions[:, k]) for k, name in enumerate(found.names)),
    ]
    for name, values in rows:
        writer.writerow([name, *(repr(float(v)) for v in values)])
    return text.getvalue()


def _print(result: dict[str, Any]) -> None:
    out = console()
    out.print(visible(result["model"] or result["target"]), markup=False, style="bold")
    out.print(
        f"{len(result['sources'])} sources of error; the tool follows them "
        + ("through elastic deformation" if result["by"] == "stiffness" else "without force"),
        markup=False,
    )
    rows = [
        (d, "µrad" if d.startswith("r") else "µm", *(1e6 * result[key][d] for key, _ in MEASURES))
        for d in DIRECTIONS
    ]
    heads = ["tool", "unit", *(words for _, words in MEASURES)]
    out.print(table("Displacement of the tool, to either side", heads, rows, names=2))
    most = result["largest"]
    x, y, z = (f"{1e6 * v:.4g}" for v in most["displacement"])
    out.print(
        f"Largest in any direction: {1e6 * most['length']:.4g} µm, towards ({x}, {y}, {z}) µm",
        markup=False,
    )
    _print_sources(most["contributions"])
    _tail(result)


def _print_sources(contributions: dict[str, float]) -> None:
    total = sum(contributions.values())
    found = top_sources(list(contributions), np.array(list(contributions.values())))
    rows = [(n, 1e6 * v, f"{100 * v / total:.1f} %" if total else "") for n, v in found]
    console().print(table("Its largest contributors", ["source", "µm", "share"], rows))


def _tail(result: dict[str, Any]) -> None:
    out = console()
    if result["drives_without_error"]:
        out.print(
            "No error is given for " + visible(", ".join(result["drives_without_error"])),
            markup=False,
            soft_wrap=True,
        )
    for path in result["data"]:
        out.print(f"Written: {visible(path)}", markup=False, soft_wrap=True)


def _over(
    target: str,
    over: list[str],
    options: Options,
    out: str | None,
    *,
    workers: int | None,
    json: bool,
) -> None:
    model = load(target)
    model.require_tool()
    grid, answer = grid_of_words(over), _answer(model, options)
    with shown() as started:
        progress = started(f"accuracy of {visible(target)}")
        found = survey(model, grid, [answer], workers=workers, progress=progress)
    extremes = {}
    for key, _ in MEASURES:
        for d in DIRECTIONS:
            most = largest(found, found[key].sel(direction=d).to_numpy())
            extremes[f"{key}_{d}"] = {"value": most.value, "at": most.task, "words": most.where}
    most = largest(found, found["largest_displacement"].to_numpy())
    parts = found["contribution"].to_numpy()[most.index]
    sources = [str(s) for s in found["source"].to_numpy()]
    result: dict[str, Any] = {
        "target": target,
        "model": model.title,
        "poses": int(found.attrs["poses"]),
        "poses_kept": int(found.attrs["poses_kept"]),
        "dropped_by_reason": json_text.loads(found.attrs["dropped_by_reason"]),
        "sources": sources,
        "largest_over_poses": extremes,
        "largest": {
            "length": most.value,
            "at": most.task,
            "words": most.where,
            "contributions": dict(zip(sources, parts.tolist(), strict=True)),
        },
        "drives_without_error": _silent(model, answer),
        "data": [],
    }
    if out is not None:
        result["data"] = written(out, target, "accuracy", found)
    if json:
        print_json(result)
        return
    _print_over(result, grid_text(grid))


def _print_over(result: dict[str, Any], grid: str) -> None:
    print_kept(result, grid)
    out = console()
    found = result["largest_over_poses"]
    rows: list[tuple[object, ...]] = []
    for d in DIRECTIONS:
        row: list[object] = [d, "µrad" if d.startswith("r") else "µm"]
        for key, _ in MEASURES:
            row.append(1e6 * found[f"{key}_{d}"]["value"])
        rows.append((*row, found[f"worst_case_{d}"]["words"]))
    heads = ["tool", "unit", *(words for _, words in MEASURES), "at worst at"]
    out.print(table("Largest displacement over the poses", heads, rows, names=2))
    most = result["largest"]
    out.print(
        f"Largest in any direction: {1e6 * most['length']:.4g} µm, at {most['words']}",
        markup=False,
    )
    _print_sources(most["contributions"])
    _tail(result)
