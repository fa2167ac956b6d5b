"""`strutwork scale`: how the assembly forces grow with the size of a machine."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from reports.cli.output import console, print_json, table
from strutwork.errors import ModelError
from strutwork.units import ANGLE, quantity
from studies.assembly_scale import AssemblyScale, assembly_scale
from studies.dataset_files import write_long_csv, write_netcdf

#: Machines whose size can be studied.
MACHINES = ("mit-ss1",)


def run(
    machine: str,
    band: tuple[float, float],
    count: int,
    ratio: float,
    tilt: str,
    out: str | None,
    *,
    json: bool,
) -> None:
    """Compute the forces over the length and print them."""
    if machine not in MACHINES:
        raise ModelError(
            f"scale of {machine}",
            "is not known: no study of its size exists.",
            "Machines: " + ", ".join(MACHINES) + ".",
        )
    found = assembly_scale(
        _lengths(band, count), ratio, tilt=quantity(_number(tilt), ANGLE, "--tilt")
    )
    result = {"machine": machine, **found.to_dict(), "data": []}
    if out is not None:
        name, dataset = f"{machine}-scale", found.to_dataset()
        written = [
            write_netcdf(Path(out) / f"{name}.nc", dataset),
            write_long_csv(Path(out) / f"{name}.csv", dataset[["force"]]),
        ]
        result["data"] = [str(path) for path in written]
    if json:
        print_json(result)
    else:
        _print(console(), machine, found, result)


def _lengths(band: tuple[float, float], count: int) -> list[float]:
    low, high = band
    if not (np.isfinite(band).all() and 0 < low < high):
        raise ModelError(
            "lengths of the struts",
            f"from {low:g} to {high:g} m are none.",
            "Give --from above zero and --to above it, in m.",
        )
    # 0.7 and not 0.7000000000000001 in the tables
    return [float(v) for v in np.round(np.linspace(low, high, count), 12)]


def _number(text: str) -> float | str:
    """A bare number is in SI."""
    try:
        return float(text)
    except ValueError:
        return text


def _print(out: Console, machine: str, found: AssemblyScale, result: dict[str, Any]) -> None:
    out.print(
        f"{machine}: worst forces that axes tilted by {1e6 * found.tilt:.4g} µm/m lock in, "
        "reconstructed structure of Son 2002, Table 2 (calibrated)",
        markup=False,
    )
    joints = range(found.forces.shape[-1])
    for i, kind in enumerate(("radial", "axial")):
        rows: list[list[object]] = [
            [f"{length:g}", f"{width:.4g}", *(1e-3 * float(force[i, n]) for n in joints)]
            for length, width, force in zip(found.lengths, found.widths, found.forces, strict=True)
        ]
        head = ["length, m", "width, m", *(f"joint {n + 1}" for n in joints)]
        out.print(table(f"Largest {kind} force, kN", head, rows, names=2))
    rows = [
        [
            f"joint {n}, {quantity_}",
            1e-3 * line.slope,
            1e-3 * line.intercept,
            100 * line.error,
            100 * found.proportional[quantity_, n].error,
        ]
        for (quantity_, n), line in found.affine.items()
    ]
    columns = ["force", "slope, kN/m", "at length 0, kN", "affine to, %", "proportional to, %"]
    out.print(table("Straight lines through the cases of Table 2", columns, rows))
    for path in result["data"]:
        out.print(path, markup=False, soft_wrap=True)
