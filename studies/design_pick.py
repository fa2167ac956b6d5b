"""A machine of the front of a design: its numbers, and its model file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from strutwork.errors import ModelError
from strutwork.files import write_text
from strutwork.machines.model_edit import edited_text
from strutwork.machines.model_file import parse_model, parse_tables
from strutwork.machines.model_numbers import Number, model_numbers
from strutwork.studies.parametric import Parametric


def changes_of(found: xr.Dataset, number: int) -> dict[str, float]:
    """Numbers of a machine of the front by their paths, SI; factors are multiplied out.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    number : int
        On the front, counted from one.

    Raises
    ------
    ModelError
        The front has no such machine.
    """
    front = found["front"].to_numpy()
    if not 1 <= number <= len(front):
        raise ModelError(
            f"machine {number}", "is not on the front.", f"Name one from 1 to {len(front)}."
        )
    numbers = _numbers(found)
    changes: dict[str, float] = {}
    for name in (str(p) for p in found["parameter"].to_numpy()):
        column = found[name]
        value = float(column.to_numpy()[front[number - 1]])
        for path in json.loads(column.attrs["paths"]):
            stated = numbers[path].value
            changes[path] = stated * value if column.attrs["relative"] else value
    return changes


def write_machine(found: xr.Dataset, number: int, path: str | Path) -> Path:
    """Write a machine of the front as a model file; the comments of the original stay.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    number : int
        On the front, counted from one.
    path : str or Path
        Ends in .toml. Where the original names files, as of meshes, it belongs beside them.

    Returns
    -------
    Path

    Raises
    ------
    ModelError
        As `changes_of`; the machine is one of the catalogue; another ending.
    OutputError
        The file cannot be written.
    """
    changes = changes_of(found, number)
    text = str(found.attrs.get("model_file", ""))
    if not text:
        raise ModelError(
            f"machine {number}",
            "is a variant of a machine of the catalogue, which has no model file.",
            "Make it in Python: strutwork.load(NAME).changed(strutwork.studies.changes_of(...)).",
        )
    if Path(path).suffix != ".toml":
        raise ModelError(str(path), "names no model file.", "End it in .toml.")
    numbers = _numbers(found)
    places = {numbers[p].places: value for p, value in changes.items()}
    made = edited_text(text, places, f"machine {number} of a design")
    # files of solids and shapes are found from the folder of the machine
    parse_model(made, str(path), Path(path).parent)
    return write_text(Path(path), made)


def _numbers(found: xr.Dataset) -> Mapping[str, Number]:
    text = str(found.attrs.get("model_file", ""))
    if text:
        # without its meshes, which may lie elsewhere
        return model_numbers(parse_tables(text))
    return Parametric.of(json.loads(found.attrs["settings"])["machine"]).paths
