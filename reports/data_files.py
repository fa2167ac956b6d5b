"""Data files beside a report: every plotted or tabulated number, unrounded."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import xarray as xr

from strutwork.csv_rows import RowWriter
from strutwork.errors import NumericalError
from strutwork.studies.netcdf import netcdf_bytes


@dataclass(frozen=True)
class DataFile:
    """A file to be written.

    Parameters
    ----------
    name : str
        File name without a folder.
    what : str
        What it holds, in words.
    write : callable
        Receives the path and writes the whole file.
    """

    name: str
    what: str
    write: Callable[[Path], object] = field(repr=False)


def csv_file(
    name: str, what: str, columns: Sequence[str], rows: Sequence[Sequence[Any]]
) -> DataFile:
    """A table with a line of headings; missing numbers are empty, names are no formulas."""
    lines = [[_entry(name, value) for value in row] for row in rows]

    def write(path: Path) -> None:
        with path.open("w", encoding="utf-8", errors="backslashreplace", newline="") as stream:
            writer = RowWriter(stream)
            writer.writerow(columns)
            writer.writerows(lines)

    return DataFile(name, what, write)


def json_file(name: str, what: str, value: Any) -> DataFile:
    """One JSON value.

    Raises
    ------
    NumericalError
        It holds a number that is not finite.
    """
    try:
        text = json.dumps(value, allow_nan=False, ensure_ascii=False, indent=1, default=_plain)
    except ValueError:
        raise NumericalError(
            name, "would contain a number that is not finite.", "Check the model."
        ) from None
    # halves of pairs, as in file names that are no UTF-8, become the escapes that JSON has for them
    return DataFile(
        name,
        what,
        lambda path: path.write_text(text + "\n", encoding="utf-8", errors="backslashreplace"),
    )


def netcdf_file(name: str, what: str, dataset: xr.Dataset) -> DataFile:
    """A dataset as NetCDF-4."""
    return DataFile(name, what, lambda path: path.write_bytes(netcdf_bytes(dataset)))


def held(file: DataFile) -> DataFile:
    """The same file with its content, which can be passed on to another process.

    Raises
    ------
    OSError
        There is no room for it.
    """
    with TemporaryDirectory() as folder:
        # some formats go by the name
        path = Path(folder) / file.name
        file.write(path)
        return replace(file, write=partial(_put, path.read_bytes()))


def _put(content: bytes, path: Path) -> None:
    path.write_bytes(content)


def _entry(name: str, value: Any) -> Any:
    """A cell as text; floats with all their digits."""
    if isinstance(value, float | np.floating):
        number = float(value)
        if np.isinf(number):
            raise NumericalError(name, "would contain an infinite number.", "Check the model.")
        return "" if np.isnan(number) else repr(number)
    return "" if value is None else value


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no JSON form")
