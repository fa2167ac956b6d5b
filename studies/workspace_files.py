"""A workspace as files: its grid, its border, and its surface."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.csv_rows import RowWriter
from strutwork.files import write_whole
from strutwork.studies.dataset_files import write_long_csv, write_netcdf
from strutwork.studies.workspace import GRID_ENDS, Workspace

Array = NDArray[Any]


def write_workspace(folder: Path, stem: str, found: Workspace) -> list[Path]:
    """Write a workspace's grid as NetCDF and CSV, its border as CSV.

    A workspace in x, y and z is written as STL and PLY too, in mm, where it is not empty.

    Parameters
    ----------
    folder : Path
    stem : str
        Of the files' names.
    found : Workspace

    Raises
    ------
    ModelError
        The folder cannot be written.
    """
    dataset = found.to_dataset()
    dims = found.grid.directions
    words = np.array(found.grid.margins.reasons, dtype=object)[found.grid.margins.reason]
    table = dataset[["margin", "component"]].assign(least=(dims, words))
    written = [
        write_netcdf(folder / f"{stem}.nc", dataset),
        write_long_csv(folder / f"{stem}.csv", table),
        _write_border(folder / f"{stem}-border.csv", found),
    ]
    if dims == ("x", "y", "z") and len(found.border.facets):
        import trimesh  # noqa: PLC0415 - a fifth of a second that most commands never need

        surface = trimesh.Trimesh(1e3 * found.border.points, found.border.facets, process=False)
        for kind in ("stl", "ply"):
            content: Any = surface.export(file_type=kind)
            written.append(_write_bytes(folder / f"{stem}.{kind}", content))
    return written


def _write_bytes(path: Path, content: bytes) -> Path:
    return write_whole(path, lambda part: part.write_bytes(content))


def _write_border(path: Path, found: Workspace) -> Path:
    """Points of the border, one a row, with what ends the workspace there."""
    crossings = found.grid.crossings
    words = [*crossings.reasons, GRID_ENDS]
    number = np.full(len(found.border.points), len(words) - 1)
    inner = found.border.crossing >= 0
    number[inner] = crossings.reason[found.border.crossing[inner]]
    units = ["rad" if d.startswith("r") else "m" for d in found.grid.directions]
    head = [f"{d} [{u}]" for d, u in zip(found.grid.directions, units, strict=True)]

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", newline="") as file:
            writer = RowWriter(file)
            writer.writerow([*head, "reason"])
            for point, k in zip(found.border.points, number, strict=True):
                writer.writerow([*(repr(float(v)) for v in point), words[k]])

    return write_whole(path, write)
