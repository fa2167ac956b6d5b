"""Stiffness of a machine over x and one tilt."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines import GridMachine, Machine, PoseGrid
from strutwork.studies.executor import Executor
from strutwork.studies.filters import Filters
from strutwork.studies.progress import Progress
from strutwork.studies.sweep import sweep
from strutwork.studies.variables import named

Array = NDArray[Any]


def plane_map(
    machine: Machine,
    grid: PoseGrid | None = None,
    filters: Filters | None = None,
    *,
    workers: int | None = None,
    progress: Progress | None = None,
    folder: Path | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Stiffness at every position along x with every tilt.

    Parameters
    ----------
    machine : Machine
    grid : PoseGrid, optional
        Default the machine's own.
    filters, workers, progress, folder, executor
        As `strutwork.studies.sweep`.

    Returns
    -------
    xarray.Dataset
        As of `strutwork.studies.sweep`, tilt fastest, with `tilt` (pose), rad; `on_plane` folds
        what it holds over x and tilt.

    Raises
    ------
    ModelError
        No grid, and a machine that has none.
    """
    if grid is None:
        if not isinstance(machine, GridMachine):
            raise ModelError(
                f"machine {type(machine).__name__}",
                "has no grid of x and tilt.",
                "Give a PoseGrid, or use stiffness_map.",
            )
        grid = machine.pose_grid()
    found = sweep(
        machine,
        grid.positions,
        grid.rotations,
        filters,
        workers=workers,
        progress=progress,
        folder=folder,
        executor=executor,
    )
    axis = {"a": "x", "b": "y"}[grid.tilt]
    tilts = np.tile(grid.tilts, len(grid.positions))
    title = found.attrs["title"].replace("stiffness sweep", "stiffness map")
    return found.assign(
        tilt=named("pose", tilts, "rad", f"tilt {grid.tilt} about {axis}")
    ).assign_attrs(title=title, tilt=grid.tilt)


def on_plane(found: xr.Dataset, values: Array) -> tuple[Array, Array, Array]:
    """Values along the poses of a `plane_map` over its x and tilts.

    Parameters
    ----------
    found : xarray.Dataset
        Of `plane_map`.
    values : (n·q,)
        Along its poses, any unit.

    Returns
    -------
    x : (n,)
        m.
    tilts : (q,)
        rad.
    values : (n, q)
    """
    tilts = np.unique(found["tilt"].to_numpy())
    x = found["position"].sel(axis="x").to_numpy()[:: len(tilts)]
    return x, tilts, np.asarray(values).reshape(len(x), len(tilts))


@dataclass(frozen=True)
class Fall:
    """Variation of the stiffness along one direction over a `plane_map`.

    Parameters
    ----------
    direction : str
    centre : float
        1/C_ii in the middle of the map, N/m.
    middle : float
        Ratio of largest to smallest in the middle: half the map's range to either side.
    whole : float
        Ratio of largest to smallest in the whole map.
    least : (x, tilt)
        Where the smallest stands, m and rad.
    """

    direction: str
    centre: float
    middle: float
    whole: float
    least: tuple[float, float]

    def to_dict(self) -> dict[str, Any]:
        """Fields as plain values, SI."""
        return asdict(self)


def stiffness_falls(found: xr.Dataset, directions: tuple[str, ...] = ("x", "y", "z")) -> list[Fall]:
    """Variation of 1/C_ii over a map, direction by direction.

    Parameters
    ----------
    found : xarray.Dataset
        Of `plane_map`.
    directions : tuple of str

    Raises
    ------
    ModelError
        No pose in the middle of the map counts.
    """
    falls = []
    for direction in directions:
        x, tilts, values = on_plane(
            found, found["stiffness_free"].sel(direction=direction).to_numpy()
        )
        away = [np.abs(v - v.mean()) / max(float(np.ptp(v)), 1e-300) for v in (x, tilts)]
        near = (away[0][:, None] <= 0.25 + 1e-9) & (away[1] <= 0.25 + 1e-9)
        middle = np.where(near, values, np.nan)
        if not np.isfinite(middle).any():
            raise ModelError("stiffness map", "has no valid pose in its middle.", "Move the map.")
        i, j = np.unravel_index(int(np.nanargmin(values)), values.shape)
        falls.append(
            Fall(
                direction,
                float(values[len(x) // 2, len(tilts) // 2]),
                float(np.nanmax(middle) / np.nanmin(middle)),
                float(np.nanmax(values) / values[i, j]),
                (float(x[i]), float(tilts[j])),
            )
        )
    return falls
