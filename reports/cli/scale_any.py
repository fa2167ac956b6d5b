"""`strutwork scale` of any machine: stiffness and frequencies at several sizes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table
from strutwork.studies.dataset_files import write_netcdf
from strutwork.studies.scale import FACTORS, ScaleStudy, scale_study

#: Sizes of a study at most.
MOST = 1000


def run(
    model: Model,
    target: str,
    span: tuple[float | None, float | None],
    count: int | None,
    out: str | None,
    *,
    json: bool,
) -> None:
    """Study a machine at several sizes beside its own, and print the exponents.

    Parameters
    ----------
    model : Model
    target : str
    span : (float or None, float or None)
        Smallest and largest size beside its own.
    count : int or None
        Sizes, evenly spaced in the logarithm.
    out : str or None
    """
    model.require_tool()
    found = scale_study(model.placed, _factors(span, count))
    result: dict[str, Any] = {"target": target, "model": model.title, **found.to_dict()}
    result["data"] = []
    if out is not None:
        stem = Path(target).stem.replace(":", "-")
        result["data"] = [str(write_netcdf(Path(out) / f"{stem}-scale.nc", found.to_dataset()))]
    if json:
        print_json(result)
        return
    _print(result, found)


def _factors(span: tuple[float | None, float | None], count: int | None) -> list[float]:
    low = FACTORS[0] if span[0] is None else span[0]
    high = FACTORS[-1] if span[1] is None else span[1]
    number = len(FACTORS) if count is None else count
    if not (np.isfinite([low, high]).all() and 0.0 < low < high):
        raise ModelError(
            "scale",
            f"goes from {low:g} to {high:g}.",
            "Give sizes relative to the machine's own, as in --from 0.5 --to 2.",
        )
    if number > MOST:
        raise ModelError("scale", f"has {number} sizes.", f"Use {MOST} at most.")
    return [float(f) for f in np.geomspace(low, high, number)]


def _print(result: dict[str, Any], found: ScaleStudy) -> None:
    out = console()
    out.print(visible(result["model"] or result["target"]), markup=False, style="bold")
    out.print(
        f"{len(found.factors)} sizes from {found.factors[0]:.4g} to {found.factors[-1]:.4g} times "
        "its own; beams, solids and masses are similar, joints follow each law",
        markup=False,
        soft_wrap=True,
    )
    rows = []
    for i, law in enumerate(found.laws):
        stiffness, frequency = found.stiffness_law(i), found.frequency_law(i)
        exponents = [float(e) for e in stiffness.exponent[:3]]
        rows.append((str(law), *exponents, float(np.ravel(frequency.exponent)[0])))
    heads = ["joints", *(f"K{d * 2} ~ L^" for d in "xyz"), "f1 ~ L^"]
    out.print(table("How stiffness and the first frequency grow with the size L", heads, rows))
    shares = [
        (d, 100.0 * float(s)) for d, s in zip(DIRECTIONS[:3], found.joint_share, strict=False)
    ]
    out.print(table("Joints' share of the tool's deflection", ["axis", "%"], shares))
    for path in result["data"]:
        out.print(visible(path), markup=False, soft_wrap=True)
