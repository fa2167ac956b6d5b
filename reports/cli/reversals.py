"""`strutwork reversals`: where drives turn back as the tool goes over a surface."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from io import StringIO
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.csv_rows import RowWriter
from strutwork.errors import ModelError
from strutwork.files import write_text
from strutwork.kinematics.task_surfaces import Dome, Plane, TaskSurface, paraboloid, sphere
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown
from strutwork.reports.grid_words import grid_of_words
from strutwork.reports.survey_words import grid_text, pose_text
from strutwork.studies.reversal_study import ReversalStudy, reversal_study
from strutwork.units import LENGTH, quantity

Array = NDArray[Any]

#: Points along a direction where none are said.
POINTS = 21

DOMES = {"sphere": sphere, "paraboloid": paraboloid}


def run(
    target: str,
    over: Sequence[str],
    shape: tuple[str, str],
    feed: str | None,
    out: str | None,
    *,
    json: bool,
) -> None:
    """Print singular points, the longest path without a reversal, and the number of plates."""
    grid = grid_of_words(over, points=POINTS)
    if len(grid.axes) != 2 or min(grid.shape) < 3:
        raise ModelError(
            "--over",
            f"gives {len(grid.axes)} directions, {' x '.join(map(str, grid.shape))} points.",
            "Give two directions with three points or more, as in x=-100mm..100mm:21,y=…",
        )
    model = load(target)
    model.require_tool()
    first, second = grid.axes
    surface = _surface(model, (first, second), *shape)
    with shown("steps") as started:
        progress = started(f"reversals of {visible(target)}")
        study = reversal_study(
            model, surface, (grid.axes[first], grid.axes[second]), feed, progress
        )
    result = _result(target, model, study, (first, second), feed)
    if out is not None:
        result["data"] = _write(Path(out), Path(target).stem.replace(":", "-"), study, surface)
    if json:
        print_json(result)
        return
    _print(result, grid_text(grid), shape)


def _surface(model: Model, names: tuple[str, str], text: str, orientation: str) -> TaskSurface:
    kind, _, rest = text.partition(":")
    if kind == "plane" and not rest:
        if orientation != "vertical":
            raise ModelError(
                "--orientation",
                "normal to a plane is the orientation of the tool at home.",
                "Leave it out, or choose a sphere or a paraboloid.",
            )
        return Plane(names)
    name, _, value = rest.partition("=")
    if kind not in DOMES or name.strip() != "r":
        raise ModelError(
            "--surface",
            f'"{text}" is not a surface.',
            "Write plane, sphere:r=300mm or paraboloid:r=300mm.",
        )
    if names != ("x", "y"):
        raise ModelError(
            "--surface",
            f"a {kind} lies over x and y, not over {names[0]} and {names[1]}.",
            "Give --over x=…,y=…",
        )
    radius = quantity(value.strip(), LENGTH, "--surface r")
    top = model.motion.home_pose.position
    return Dome(DOMES[kind](radius, top), "normal" if orientation == "normal" else "vertical")


def _result(
    target: str,
    model: Model,
    study: ReversalStudy,
    names: tuple[str, str],
    feed: str | None,
) -> dict[str, Any]:
    found = study.found
    drives = found.field.drives
    longest = study.longest

    def at(place: Iterable[float]) -> dict[str, float]:
        return {n: float(p) for n, p in zip(names, place, strict=True)}

    return {
        "target": target,
        "model": model.title,
        "points": int(found.reachable.size),
        "reachable": int(np.count_nonzero(found.reachable)),
        "outside_joint_ranges": study.outside,
        "still": [d for k, d in enumerate(drives) if k not in found.moving],
        "drives": [
            {
                "drive": s.drive,
                "strong": s.strong,
                "weak": s.weak,
                "winding": s.winding,
                "complete": s.complete,
                "points": [
                    {"at": at(p.place), "kind": p.kind, "hessian": p.hessian.tolist()}
                    for p in s.points
                ],
                "lines": [line.tolist() for line in s.lines],
            }
            for s in found.singular
        ],
        "feed": feed,
        "reversal_lines": {
            drive: [line.tolist() for line in lines] for drive, lines in study.lines.items()
        },
        "longest_path": None
        if longest is None
        else {"length": longest.length, "from": at(longest.start), "to": at(longest.end)},
        "path_unit": "rad" if _turns(names, feed, longest) else "m",
        "plates": study.plates,
        "reach_from_middle": study.reach,
        "data": [],
    }


def _turns(names: tuple[str, str], feed: str | None, longest: Any) -> bool:
    """Whether the longest path turns the tool only."""
    if feed is not None:
        return feed.startswith("r")
    if longest is None:
        return False
    way = np.abs(longest.end - longest.start)
    return all(n.startswith("r") for n, w in zip(names, way, strict=True) if w > 0)


def _print(result: dict[str, Any], grid: str, shape: tuple[str, str]) -> None:
    out = console()
    out.print(visible(result["model"] or result["target"]), markup=False, style="bold")
    how = "" if shape[0] == "plane" else f", on a {shape[0]}, tool {shape[1]}"
    out.print(f"{grid}{how}; {result['reachable']} can be reached", markup=False)
    if result["outside_joint_ranges"]:
        out.print(f"  {result['outside_joint_ranges']} of them outside joint ranges", markup=False)
    rows: list[tuple[object, ...]] = []
    words = {True: "yes", False: "no: take more points", None: "not reported"}
    for entry in result["drives"]:
        lines = len(entry["lines"])
        rows.append(
            (
                entry["drive"],
                str(entry["strong"]),
                str(entry["weak"]),
                str(lines) if lines else "",
                "; ".join(f"{pose_text(p['at'])} ({p['kind']})" for p in entry["points"][:4]),
                words[entry["complete"]],
            )
        )
    heads = ["drive", "strong", "weak", "lines", "at", "agrees with the border"]
    out.print(table("Points where a drive reverses whichever way the tool moves", heads, rows))
    if result["still"]:
        out.print("Still: " + visible(", ".join(result["still"])), markup=False, soft_wrap=True)
    for drive, lines in result["reversal_lines"].items():
        out.print(
            f"Fed along {result['feed']}, {visible(drive)} reverses on {len(lines)} "
            f"line{'' if len(lines) == 1 else 's'}",
            markup=False,
        )
    path = result["longest_path"]
    if path is not None:
        size = (
            f"{degrees(path['length']):.4g}°"
            if result["path_unit"] == "rad"
            else f"{1e3 * path['length']:.4g} mm"
        )
        way = f" along {result['feed']}" if result["feed"] else ""
        out.print(
            f"Longest straight path without a reversal{way}: {size}, "
            f"from {pose_text(path['from'])} to {pose_text(path['to'])}",
            markup=False,
            soft_wrap=True,
        )
    out.print(f"Plates that the grid distinguishes: {result['plates']}", markup=False)
    if result["reach_from_middle"] is not None:
        out.print(
            f"Reached from the middle without a reversal: {100 * result['reach_from_middle']:.3g} "
            "% of the points",
            markup=False,
        )
    for written in result["data"]:
        out.print(f"Written: {visible(written)}", markup=False, soft_wrap=True)


def _write(folder: Path, stem: str, study: ReversalStudy, surface: TaskSurface) -> list[str]:
    """Grid, singular points and lines as CSV; SI."""
    found, names = study.found, surface.parameters
    drives = found.field.drives
    heads = [f"{n}, {'rad' if n.startswith('r') else 'm'}" for n in names]
    grid = [[*heads, "plate", *(f"d {d} / d {n}" for d in drives for n in names)]]
    gradient = found.gradient.reshape(-1, 2 * len(drives))
    for place, plate, slopes in zip(
        found.patch.points.tolist(), found.plates.ravel().tolist(), gradient.tolist(), strict=True
    ):
        grid.append(
            [*map(repr, place), str(plate), *("" if np.isnan(g) else repr(g) for g in slopes)]
        )
    points = [["drive", "kind", *heads, "winding of the drive"]]
    lines = [["drive", "line", "number", *heads]]
    for some in found.singular:
        turns = "" if some.winding is None else str(some.winding)
        points += [
            [some.drive, p.kind, *(repr(float(c)) for c in p.place), turns] for p in some.points
        ]
        lines += _line_rows(some.drive, "singular", some.lines)
    for drive, own in study.lines.items():
        lines += _line_rows(drive, "reversal", own)
    files = {"grid": grid, "points": points, "lines": lines}
    written = []
    for name, rows in files.items():
        text = StringIO(newline="")
        RowWriter(text).writerows(rows)
        path = folder / f"{stem}-reversals-{name}.csv"
        write_text(path, text.getvalue())
        written.append(str(path))
    return written


def _line_rows(drive: str, kind: str, lines: Iterable[Array]) -> list[list[str]]:
    return [
        [drive, kind, str(n), *(repr(float(c)) for c in place)]
        for n, line in enumerate(lines, 1)
        for place in line
    ]
