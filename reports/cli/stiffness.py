"""`strutwork map`: stiffness of a machine of the catalogue over its check points or its plane."""

from __future__ import annotations

import json as json_text
from pathlib import Path
from typing import Any

import xarray as xr

from strutwork.machines import GridMachine, Machine, NamedMachine, named_machine, roll_angles
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown
from strutwork.studies import (
    Filters,
    hemisphere,
    plane_map,
    stiffness_map,
    summary,
    write_csv,
    write_netcdf,
)
from strutwork.studies.filters import REASONS
from strutwork.studies.progress import Progress

RANGES: dict[str, tuple[str, ...] | None] = {"all": None, "revolute": ("revolute",), "none": ()}


def run(
    machine: str,
    out: str | None,
    *,
    ranges: str,
    lattice: int,
    rolls: int,
    workers: int | None,
    json: bool,
) -> None:
    """Map the stiffness and print its summary."""
    found = named_machine(machine)
    made = found.machine
    with shown() as started:
        dataset = _map(
            made,
            lattice,
            rolls,
            Filters(joint_kinds=RANGES[ranges]),
            workers,
            started(f"stiffness of {found.name}"),
        )
    result = _result(found, dataset)
    if out is not None:
        folder = Path(out)
        name = f"{found.stem}-map"
        written = [
            write_netcdf(folder / f"{name}.nc", dataset),
            write_csv(folder / f"{name}.csv", dataset),
        ]
        result["data"] = [str(path) for path in written]
    if json:
        print_json(result)
    else:
        _print(result)


def _map(
    machine: Machine,
    lattice: int,
    rolls: int,
    filters: Filters,
    workers: int | None,
    progress: Progress,
) -> xr.Dataset:
    """Over x and a tilt where the machine says so, else over the hemisphere."""
    if isinstance(machine, GridMachine):
        return plane_map(
            machine, machine.pose_grid(lattice), filters, workers=workers, progress=progress
        )
    return stiffness_map(
        machine,
        hemisphere(machine, lattice=lattice),
        roll_angles(rolls),
        filters,
        workers=workers,
        progress=progress,
    )


def _counts(dataset: xr.Dataset) -> dict[str, Any]:
    """Points and candidates, all and kept; on a plane every pose is the only candidate."""
    if "pose" in dataset.dims:
        status = dataset["status"].to_numpy()
        total, kept = int(status.size), int(dataset.attrs["poses_kept"])
        return {
            "points": total,
            "points_kept": kept,
            "candidates": total,
            "candidates_kept": kept,
            "dropped": {code.word: int((status == code).sum()) for code in REASONS},
        }
    dropped = dataset["dropped"].sum("point")
    return {
        "points": int(dataset.sizes["point"]),
        "points_kept": int(dataset.attrs["points_kept"]),
        "candidates": int(dataset.attrs["candidates"]),
        "candidates_kept": int(dataset.attrs["candidates_kept"]),
        "dropped": {str(r): int(dropped.sel(reason=r)) for r in dataset["reason"].to_numpy()},
    }


def _result(found: NamedMachine, dataset: xr.Dataset) -> dict[str, Any]:
    return {
        "machine": found.name,
        "model": found.title,
        **_counts(dataset),
        "dropped_because": json_text.loads(dataset.attrs["dropped_by_reason"]),
        "first_dropped": json_text.loads(dataset.attrs["first_of_reason"]),
        "stiffness": {
            meaning: {axis["direction"]: axis for axis in summed["axes"]}
            for meaning, summed in (
                ("blocked", summary(dataset, "blocked").to_dict()),
                ("free", summary(dataset, "free").to_dict()),
            )
        },
        "data": [],
    }


def _print(result: dict[str, Any]) -> None:
    out = console()
    out.print(
        f"{result['model']}: {result['points_kept']} of {result['points']} points, "
        f"{result['candidates_kept']} of {result['candidates']} candidate poses are valid",
        markup=False,
    )
    for reason, count in result["dropped"].items():
        if count:
            out.print(f"  {count} {reason.replace('_', ' ')}", markup=False)
    # the kinematics' own reasons are counted above by kind; what a solver says is not
    for reason, words in result["first_dropped"].items():
        count = result["dropped_because"][reason]
        out.print(f"  {count}: {visible(reason)}; the first: {visible(words)}", markup=False)
    for meaning, words in (
        ("blocked", "other directions blocked, (C⁻¹)ii"),
        ("free", "other directions free, 1/Cii"),
    ):
        rows = []
        for direction, axis in result["stiffness"][meaning].items():
            s = axis["statistics"]
            numbers = [s["mean"], s["standard_deviation"], axis["worst"]["value"]]
            numbers += [s["quantiles"][2], axis["best"]["value"]]
            rows.append((direction, *(float("inf") if v is None else 1e-6 * v for v in numbers)))
        columns = ["axis", "mean", "deviation", "worst", "median", "best"]
        out.print(table(f"Stiffness in N/µm, {words}", columns, rows))
    for path in result["data"]:
        out.print(visible(path), markup=False, soft_wrap=True)
