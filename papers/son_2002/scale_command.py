"""`strutwork scale` for the MIT-SS-1: forces, stiffness and frequencies against its size."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from strutwork.errors import ModelError
from strutwork.names import visible
from strutwork.papers.son_2002.assembly_scale import AssemblyScale, assembly_scale
from strutwork.papers.son_2002.chapters.size import removal_rows
from strutwork.papers.son_2002.size import mit_ss1_scale
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.tolerance_limits import bare
from strutwork.studies.dataset_files import write_long_csv, write_netcdf
from strutwork.studies.scale import ScaleStudy
from strutwork.units import ANGLE, quantity


def run(
    machine: str,
    band: tuple[float, float],
    count: int,
    ratio: float,
    tilt: str,
    out: str | None,
    *,
    granite: bool,
    json: bool,
) -> None:
    """Compute the forces over the length and what the machine's size changes, and print them."""
    if not RATIOS[0] <= ratio <= RATIOS[1]:
        raise ModelError(
            "--width-ratio",
            f"{ratio:g} is not a width of a strut over its length.",
            f"Give a number from {RATIOS[0]:g} to {RATIOS[1]:g}; the default is 0.2.",
        )
    found = assembly_scale(_lengths(band, count), ratio, tilt=quantity(bare(tilt), ANGLE, "--tilt"))
    size = mit_ss1_scale(granite=granite)
    result: dict[str, Any] = {
        "machine": machine,
        **found.to_dict(),
        "size": {"granite": granite, **size.to_dict()},
        "data": [],
    }
    if out is not None:
        name, dataset = f"{machine}-scale", found.to_dataset()
        written = [
            write_netcdf(Path(out) / f"{name}.nc", dataset),
            write_long_csv(Path(out) / f"{name}.csv", dataset[["force"]]),
        ]
        name, dataset = f"{machine}-size", size.to_dataset()
        written += [
            write_netcdf(Path(out) / f"{name}.nc", dataset),
            write_long_csv(Path(out) / f"{name}-stiffness.csv", dataset[["stiffness"]]),
            write_long_csv(Path(out) / f"{name}-frequency.csv", dataset[["frequency"]]),
        ]
        result["data"] = [str(path) for path in written]
    if json:
        print_json(result)
    else:
        screen = console()
        _print(screen, machine, found)
        _print_size(screen, machine, size, granite=granite)
        for path in result["data"]:
            screen.print(visible(path), markup=False, soft_wrap=True)


#: Shortest and longest struts, m, and width over length: what lies beyond is no strut.
SIZES, RATIOS = (1e-6, 1e6), (1e-6, 1e3)


def _lengths(band: tuple[float, float], count: int) -> list[float]:
    low, high = band
    if not (SIZES[0] <= low < high <= SIZES[1]):
        raise ModelError(
            "lengths of the struts",
            f"from {low:g} to {high:g} m are not valid.",
            f"Give --from of at least {SIZES[0]:g} and --to above it, up to {SIZES[1]:g}, in m.",
        )
    # 0.7 and not 0.7000000000000001 in the tables
    return [float(v) for v in np.round(np.linspace(low, high, count), 12)]


def _print(out: Console, machine: str, found: AssemblyScale) -> None:
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


def _print_size(out: Console, machine: str, found: ScaleStudy, *, granite: bool) -> None:
    """Exponents of stiffness and frequency, and of the deflection at constant removal rate."""
    where = "on its granite" if granite else "on held rails"
    low, high = found.factors[0], found.factors[-1]
    out.print(
        f"{machine} {where}, {low:g} to {high:g} times as large, joints by three laws; fitted "
        "powers of the size L (calibrated machine, at home)",
        markup=False,
    )
    count = min(4, found.frequencies.shape[-1])
    rows: list[list[object]] = []
    for i, law in enumerate(found.laws):
        stiffness, frequency = found.stiffness_law(i).exponent, found.frequency_law(i).exponent
        name = f"{law}: {law.formula}"
        rows.append([name, *map(_power, stiffness[:3]), *map(_power, frequency[:count])])
    head = ["joints", "K x", "K y", "K z", *(f"f {n + 1}" for n in range(count))]
    out.print(table("Exponents of stiffness K and frequency f", head, rows))
    rows = []
    for i, law in enumerate(found.laws):
        rows += map(list[object], removal_rows(str(law), found.removal(i), _power))
    head = ["joints", "drives n", "feed", "cutting force", *(f"deflection {a}" for a in "xyz")]
    title = "Exponents at constant removal rate, drives' force ~ L^n (Son 2002, eqs 19 to 23)"
    out.print(table(title, head, rows, names=2))


def _power(exponent: float) -> str:
    """Three decimals, and no zero with a sign."""
    return f"{round(float(exponent), 3) + 0.0:.3f}"
