"""Maps of the thesis's machines over x and one tilt: marks of extremes, files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.numbers import significant

Array = NDArray[Any]

#: What is looked for in a map of stiffness, and how.
STIFFNESS = {"softest": np.nanargmin, "stiffest": np.nanargmax}


def axes(found: xr.Dataset, tilt: str = "b") -> tuple[Array, Array]:
    """Places along x in mm and tilts in deg."""
    return 1e3 * found["x"].to_numpy(), np.degrees(found[tilt].to_numpy())


def extremes(
    x: Array,
    tilts: Array,
    values: Array,
    picks: Mapping[str, Callable[[Array], Any]] = STIFFNESS,
    shown: Callable[[float], str] = significant,
) -> dict[str, tuple[float, float]]:
    """Where a map has its extremes, by a word and the value there."""
    marks = {}
    for word, pick in picks.items():
        i, j = np.unravel_index(int(pick(values)), values.shape)
        marks[f"{word}, {shown(float(values[i, j]))}"] = (float(x[i]), float(tilts[j]))
    return marks


def plane_file(
    name: str,
    what: str,
    found: xr.Dataset,
    columns: Mapping[str, Array] | Sequence[tuple[str, Array]],
    tilt: str = "b",
) -> DataFile:
    """One line a pose: x in m, tilt in rad, and the values there, each over x and tilt."""
    named = dict(columns)
    return csv_file(
        name,
        what,
        ["x_m", f"{tilt}_rad", *named],
        [
            [float(x), float(angle), *(float(v[i, j]) for v in named.values())]
            for i, x in enumerate(found["x"].to_numpy())
            for j, angle in enumerate(found[tilt].to_numpy())
        ],
    )
