"""`strutwork map` over a grid of poses: any machine, asked anything."""

from __future__ import annotations

from typing import Any

import xarray as xr

from strutwork.errors import ModelError
from strutwork.fea.ports import tool_ports
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.load import load, load_heavy
from strutwork.machines.model import Model
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.survey_output import print_kept, written
from strutwork.reports.covering_band import covering_band
from strutwork.reports.grid_words import grid_of_words
from strutwork.reports.survey_words import extremes, grid_text, kept_poses
from strutwork.studies.answers import Answer, Stiffness, Vibration
from strutwork.studies.dynamic import ONE_PERCENT
from strutwork.studies.model_damping import model_damping
from strutwork.studies.survey import survey


def run(
    target: str,
    over: list[str] | None,
    out: str | None,
    *,
    vibration: bool,
    workers: int | None,
    json: bool,
) -> None:
    """Survey a machine over a grid and print the extremes."""
    model = load_heavy(target) if vibration else load(target)
    grid = grid_of_words(over) if over else model.workspace
    if grid is None:
        raise ModelError(
            target,
            "gives no poses to map.",
            "Give --over x=-100mm..100mm:5,y=…, or add a table [workspace] to the file.",
        )
    answer: Answer = _vibration(model) if vibration else Stiffness()
    what = "vibration" if vibration else "stiffness"
    with shown() as started:
        progress = started(f"{what} of {visible(target)}")
        found = survey(model, grid, [answer], workers=workers, progress=progress)
    result = _result(target, model, found, vibration=vibration)
    if out is not None:
        result["data"] = written(out, target, what, found)
    if json:
        print_json(result)
        return
    _print(result, grid_text(grid))


def _vibration(model: Model) -> Vibration:
    tool = model.require_tool()
    band, _ = covering_band(model.vibrating, tool_ports(model.structure.linkage))
    if band is None:
        raise ModelError("structure", "has no elastic mode.", "Give it mass and elastic parts.")
    preload = None if model.preload is None else model.case(model.preload)
    return Vibration(tool, model_damping(model) or ONE_PERCENT, band, preload=preload)


def _result(target: str, model: Model, found: xr.Dataset, *, vibration: bool) -> dict[str, Any]:
    entries: dict[str, Any] = {}
    if vibration:
        entries["natural_frequency_1"] = extremes(
            found, found["natural_frequency"].sel(mode=1).to_numpy()
        )
        for axis in "xyz":
            values = found["least_dynamic_stiffness"].sel(axis=axis)
            entries[f"least_dynamic_stiffness_{axis}"] = extremes(found, values.to_numpy())
    else:
        for meaning in ("free", "blocked"):
            for axis in DIRECTIONS:
                values = found[f"stiffness_{meaning}"].sel(direction=axis)
                entries[f"stiffness_{meaning}_{axis}"] = extremes(found, values.to_numpy())
    return {
        "target": target,
        "model": model.title,
        **kept_poses(found),
        "extremes": entries,
        "data": [],
    }


def _print(result: dict[str, Any], grid: str) -> None:
    print_kept(result, grid)
    out = console()
    rows: list[tuple[object, ...]] = []
    for name, entry in result["extremes"].items():
        words = name.replace("_", " ")
        scale, unit = (1.0, "Hz") if "frequency" in name else (1e-6, "N/µm")
        if name.rpartition("_")[2].startswith("r"):
            scale, unit = 1e-3, "kN·m/rad"
        if entry is None:
            rows.append((words, unit, "infinite", "", "infinite", ""))
            continue
        low, high = entry["least"], entry["largest"]
        rows.append(
            (
                words,
                unit,
                low["value"] * scale,
                low["words"],
                high["value"] * scale,
                high["words"],
            )
        )
    out.print(table("Extremes", ["", "unit", "least", "at", "largest", "at"], rows, names=2))
    for path in result["data"]:
        out.print(visible(path), markup=False, soft_wrap=True)
