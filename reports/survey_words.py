"""Poses of a survey in words, and its extremes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.reports.numbers import MINUS

Array = NDArray[Any]

#: Values of a survey that differ by this share are the same.
TIE = 1e-9


@dataclass(frozen=True)
class Extreme:
    """Where a quantity of a survey is largest or least.

    Parameters
    ----------
    value : float
    index : tuple of int
        Into the grid.
    task : dict of direction to float
        m and rad.
    """

    value: float
    index: tuple[int, ...]
    task: dict[str, float]

    @property
    def where(self) -> str:
        """`x 20, y −10 mm, rz 5°`."""
        return pose_text(self.task)


def axes_of(found: xr.Dataset) -> dict[str, Array]:
    """Values along each direction of a survey's grid."""
    dims = found["status"].dims
    return {str(d): found[d].to_numpy() for d in DIRECTIONS if d in dims}


def least(found: xr.Dataset, values: Array) -> Extreme:
    """The least of an array over the grid; NaN where no pose counts."""
    return _extreme(found, values, float(np.nanmin(values)))


def largest(found: xr.Dataset, values: Array) -> Extreme:
    """The largest of an array over the grid."""
    return _extreme(found, values, float(np.nanmax(values)))


def extremes(found: xr.Dataset, values: Array) -> dict[str, Any] | None:
    """Least and largest of an array over the grid with their poses, for JSON.

    None where no pose has a finite value.
    """
    values = np.where(np.isfinite(values), values, np.nan)
    if not np.isfinite(values).any():
        return None
    low, high = least(found, values), largest(found, values)
    return {
        "least": {"value": low.value, "at": low.task, "words": low.where},
        "largest": {"value": high.value, "at": high.task, "words": high.where},
    }


def kept_poses(found: xr.Dataset) -> dict[str, Any]:
    """How many poses of a survey count, and why the others do not, for JSON."""
    return {
        "poses": int(found.attrs["poses"]),
        "poses_kept": int(found.attrs["poses_kept"]),
        "dropped_by_reason": json.loads(found.attrs["dropped_by_reason"]),
    }


def _extreme(found: xr.Dataset, values: Array, value: float) -> Extreme:
    # of poses that differ by rounding, as a symmetric machine's, the first
    near = np.abs(values - value) <= TIE * abs(value)
    flat = int(np.argmax(near))
    index = tuple(int(i) for i in np.unravel_index(flat, values.shape))
    axes = axes_of(found)
    task = {d: float(v[i]) for (d, v), i in zip(axes.items(), index, strict=True)}
    return Extreme(float(values[index]), index, task)


def pose_text(task: dict[str, float]) -> str:
    """Task coordinates in mm and degrees, in words."""
    words = []
    for name, value in task.items():
        turns = name.startswith("r")
        words.append(f"{name} {_number(name, value)}{'°' if turns else ' mm'}")
    return ", ".join(words)


def grid_text(grid: TaskGrid) -> str:
    """Ranges of a grid in words."""
    words = []
    for name, values in grid.axes.items():
        turns = name.startswith("r")
        low, high = (_number(name, float(v)) for v in (values[0], values[-1]))
        words.append(
            f"{name} from {low} to {high}{'°' if turns else ' mm'} at {len(values)} points"
        )
    return f"{len(grid)} poses: {', '.join(words)}"


def _number(name: str, value: float) -> str:
    """A coordinate in mm or degrees, as somebody would write it."""
    shown = round(degrees(value) if name.startswith("r") else 1e3 * value, 3)
    return f"{shown + 0.0:g}".replace("-", MINUS)
