"""`strutwork map --vibration`: frequencies and least dynamic stiffness over the check points."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.errors import ModelError
from strutwork.machines import GridMachine, named_machine, require_mass, roll_angles
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.stiffness import RANGES
from strutwork.studies import Filters, dynamic_map, hemisphere, write_csv, write_netcdf


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
    """Map the vibration with 1 % of critical damping and print its summary."""
    found = require_mass(named_machine(machine))
    made = found.machine
    if isinstance(made, GridMachine):
        raise ModelError(
            f"machine {machine}",
            "reaches hardly any pose of the hemisphere over which vibration is mapped.",
            "Leave --vibration out for its stiffness over x and a tilt, or use `strutwork modes` "
            "at home.",
        )
    with shown() as started:
        dataset = dynamic_map(
            made,
            hemisphere(made, lattice=lattice),
            roll_angles(rolls),
            Filters(joint_kinds=RANGES[ranges]),
            workers=workers,
            progress=started(f"vibration of {found.name}"),
        )
    result = _result(found.name, found.title, dataset)
    if out is not None:
        name = f"{found.stem}-vibration-map"
        written = [
            write_netcdf(Path(out) / f"{name}.nc", dataset),
            write_csv(Path(out) / f"{name}.csv", dataset),
        ]
        result["data"] = [str(path) for path in written]
    if json:
        print_json(result)
    else:
        _print(result)


def _result(machine: str, model: str, dataset: xr.Dataset) -> dict[str, Any]:
    least = dataset["minimum_dynamic_stiffness"]
    first = dataset["natural_frequency"].isel(mode=0).to_numpy()
    kept = np.isfinite(first)
    dropped = dataset["dropped"].sum("point")
    return {
        "machine": machine,
        "model": model,
        "points": int(dataset.sizes["point"]),
        "points_kept": int(kept.sum()),
        "dropped": {str(r): int(dropped.sel(reason=r)) for r in dataset["reason"].to_numpy()},
        "first_frequency": _spread(first[kept]),
        "minimum_dynamic_stiffness": {
            str(axis): _spread(least.sel(axis=axis).to_numpy()[kept])
            for axis in dataset["axis"].to_numpy()
        },
        "data": [],
    }


def _spread(values: np.ndarray[Any, Any]) -> dict[str, float | None]:
    if not values.size:
        return {"worst": None, "mean": None, "best": None}
    return {
        "worst": float(values.min()),
        "mean": float(values.mean()),
        "best": float(values.max()),
    }


def _print(result: dict[str, Any]) -> None:
    out = console()
    out.print(
        f"{result['model']}: {result['points_kept']} of {result['points']} points are valid",
        markup=False,
    )
    names = ["worst", "mean", "best"]

    def row(label: str, spread: dict[str, float | None], scale: float) -> tuple[Any, ...]:
        numbers = [spread[n] for n in names]
        return (label, *("-" if v is None else scale * v for v in numbers))

    rows = [row("first frequency, Hz", result["first_frequency"], 1.0)]
    rows += [
        row(f"least dynamic stiffness along {axis}, N/µm", spread, 1e-6)
        for axis, spread in result["minimum_dynamic_stiffness"].items()
    ]
    out.print(table("Vibration over the check points", ["", *names], rows))
    for path in result["data"]:
        out.print(visible(path), markup=False, soft_wrap=True)
