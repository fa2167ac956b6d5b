"""Datasets of studies as files: NetCDF, CSV and JSON, whole or not at all."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.csv_rows import RowWriter
from strutwork.errors import ModelError
from strutwork.files import write_text, write_whole
from strutwork.names import visible
from strutwork.studies.dataset_units import (
    stated_unit,
    unit_at,
    without_unit_coordinates,
)
from strutwork.studies.filters import PoseStatus
from strutwork.studies.netcdf import netcdf_bytes


def read_result_file(path: Path, engine: str, key: str, what: str) -> xr.Dataset:
    """Read what a study or a design wrote, all of it.

    Parameters
    ----------
    path : Path
    engine : str
        Of xarray.
    key : str
        Attribute that every such result has.
    what : str
        What wrote it, for messages, such as "study".

    Raises
    ------
    ModelError
        It cannot be read, or something else wrote it.
    """
    try:
        with xr.open_dataset(path, engine=engine) as file:
            found = file.load()
    # libraries raise what they like for a damaged file
    except Exception as error:
        raise ModelError(
            str(path), f"cannot be read ({visible(str(error))}).", "Write it again."
        ) from error
    if key not in found.attrs:
        raise ModelError(str(path), f"is no result of a {what}.", f"Name one that a {what} wrote.")
    return found


def write_netcdf(path: Path, dataset: xr.Dataset) -> Path:
    """Write a dataset as NetCDF-4.

    Parameters
    ----------
    path : Path
    dataset : xarray.Dataset

    Raises
    ------
    ModelError
        The folder cannot be written.
    """
    content = netcdf_bytes(dataset)
    return write_whole(Path(path), lambda part: part.write_bytes(content))


def read_netcdf(path: Path) -> xr.Dataset:
    """Read a complete dataset.

    Parameters
    ----------
    path : Path

    Raises
    ------
    ModelError
        The file is missing or is no NetCDF.
    """
    try:
        with xr.open_dataset(path, engine="h5netcdf") as file:
            return file.load()
    except (OSError, ValueError, KeyError) as error:
        raise ModelError(
            str(path), f"cannot be read as NetCDF ({error}).", "Write it again."
        ) from error


def write_csv(path: Path, dataset: xr.Dataset) -> Path:
    """Write the variables of a dataset along its poses, one row per pose, units in the header.

    Flags stand in words; numbers that are missing are empty. Compliance matrices are left out: they
    are in the NetCDF file.

    Parameters
    ----------
    path : Path
    dataset : xarray.Dataset
        With a dimension `point` or `pose`.

    Raises
    ------
    ModelError
        A dataset without poses, or a folder that cannot be written.
    """
    dim = pose_dimension(dataset)
    columns = dict(_columns(dataset, dim))

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", newline="") as file:
            writer = RowWriter(file)
            writer.writerow([dim, *columns])
            writer.writerows(
                [i, *(_cell(c[i]) for c in columns.values())] for i in range(dataset.sizes[dim])
            )

    return write_whole(Path(path), write)


def write_long_csv(path: Path, dataset: xr.Dataset) -> Path:
    """Write variables that share their dimensions, one row per entry, units in the header.

    Parameters
    ----------
    path : Path
    dataset : xarray.Dataset

    Raises
    ------
    ModelError
        No variables, or variables along different dimensions: choose some by
        `dataset[[names]]`; or a folder that cannot be written.
    """
    kinds = {variable.dims for variable in dataset.data_vars.values()}
    if len(kinds) != 1:
        raise ModelError(
            "dataset",
            f"has variables along {len(kinds)} sets of dimensions.",
            "Choose variables along the same: dataset[[names]].",
        )
    dims = kinds.pop()
    places = [dataset[d].to_numpy() for d in dims]
    arrays = {**{d: dataset[d] for d in dims}, **dataset.data_vars}
    units = {name: stated_unit(array) for name, array in arrays.items()}
    head = [str(n) if unit == "1" else f"{n} [{unit}]" for n, unit in units.items()]
    values = [variable.to_numpy() for variable in dataset.data_vars.values()]

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", newline="") as file:
            writer = RowWriter(file)
            writer.writerow(head)
            for index in np.ndindex(*(len(p) for p in places)):
                where = [_cell(p[i]) for p, i in zip(places, index, strict=True)]
                writer.writerow([*where, *(_cell(v[index]) for v in values)])

    return write_whole(Path(path), write)


def write_json(path: Path, dataset: xr.Dataset) -> Path:
    """Write a dataset as one JSON object; missing numbers are null.

    Parameters
    ----------
    path : Path
    dataset : xarray.Dataset

    Raises
    ------
    ModelError
        The folder cannot be written.
    """
    return write_text(Path(path), json.dumps(to_json(dataset), allow_nan=False) + "\n")


def to_json(dataset: xr.Dataset) -> dict[str, Any]:
    """A dataset as plain values: attributes, coordinates, and variables with unit and shape.

    Parameters
    ----------
    dataset : xarray.Dataset
    """
    dataset = without_unit_coordinates(dataset)
    return {
        "attributes": {name: _plain(value) for name, value in dataset.attrs.items()},
        "coordinates": {str(n): _plain(c.to_numpy()) for n, c in dataset.coords.items()},
        "variables": {
            str(name): {
                "dimensions": [str(d) for d in variable.dims],
                **{key: _plain(value) for key, value in variable.attrs.items()},
                "values": _plain(variable.to_numpy()),
            }
            for name, variable in dataset.data_vars.items()
        },
    }


def pose_dimension(dataset: xr.Dataset) -> str:
    """Name of the dimension of poses: point or pose.

    Parameters
    ----------
    dataset : xarray.Dataset

    Raises
    ------
    ModelError
        It has neither.
    """
    for dim in ("point", "pose"):
        if dim in dataset.dims:
            return dim
    raise ModelError("dataset", "has no poses.", "Give a stiffness map or a sweep.")


def _columns(dataset: xr.Dataset, dim: str) -> Iterator[tuple[str, NDArray[Any]]]:
    """Header and values of every column."""
    for name, variable in dataset.data_vars.items():
        if variable.dims[:1] != (dim,) or name == "compliance":
            continue
        values = variable.to_numpy()
        if name == "status":
            yield "status", np.array([s.word for s in PoseStatus])[values]
            continue
        units = stated_unit(variable)
        labels = [
            dataset[d].to_numpy() if d in dataset.coords else np.arange(dataset.sizes[d])
            for d in variable.dims[1:]
        ]
        for index in np.ndindex(*(len(items) for items in labels)):
            words = [str(items[i]) for items, i in zip(labels, index, strict=True)]
            unit = unit_at(dataset, str(name), words[-1]) if words else units
            head = "_".join([str(name), *words])
            yield (head if unit == "1" else f"{head} [{unit}]"), values[(slice(None), *index)]


def _cell(value: Any) -> Any:
    if isinstance(value, np.floating):
        return "" if np.isnan(value) else repr(float(value))
    if isinstance(value, np.bool_):
        return int(value)
    return value


def _plain(value: Any) -> Any:
    """Lists, numbers and words; not-a-number becomes None."""
    if isinstance(value, np.ndarray):
        if value.dtype.kind == "f" and not np.all(np.isfinite(value)):
            shown = value.astype(object)
            shown[~np.isfinite(value)] = None
            return shown.tolist()
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value
