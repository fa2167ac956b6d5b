"""Units of the variables of a dataset, as pint-xarray and the CF conventions read them.

The attribute `units` names one unit. A variable whose labels have several, such as a stiffness in
six directions, says so in `component_units` and has no `units`; `split_units` makes one variable of
each. The unit under each label is read from where it is stated, never from the label: either the
text names the labels ("N/m for x y z; N m/rad for rx ry rz"), or a coordinate `NAME_unit` stands
beside the variable as long as it is in memory; files have the text alone.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

#: What tells that a text names several units.
_SEVERAL = re.compile(r" for | or |[;,]")

#: Directions that turn, and what the name of a variable's units has behind its own.
TURNS = ("rx", "ry", "rz")
_BESIDE = "_unit"

#: What is added to the name of a variable for each of its units.
_PARTS = {
    "m": "translation",
    "rad": "rotation",
    "N/m": "translation",
    "N m/rad": "rotation",
    "N": "force",
    "N m": "moment",
}


def unit_attributes(unit: str) -> dict[str, str]:
    """The attribute that states a unit, or several.

    Parameters
    ----------
    unit : str
        One unit, or several as in "N/m for x y z; N m/rad for rx ry rz".
    """
    return {"component_units" if _SEVERAL.search(unit) else "units": unit}


def stated_unit(variable: xr.DataArray | xr.Variable) -> str:
    """The unit of a variable, or its units in words; "1" where none is stated.

    Parameters
    ----------
    variable : xarray.DataArray or xarray.Variable
        Of any shape and unit.
    """
    attributes = variable.attrs
    return str(attributes.get("units", attributes.get("component_units", "1")))


@dataclass(frozen=True)
class LabelledUnits:
    """Units of a variable whose labels have several.

    Parameters
    ----------
    words : str
        All of them, for the attribute `component_units`, as in "m or rad".
    units : tuple of str
        One for each label, in the order of the labels.
    """

    words: str
    units: tuple[str, ...]

    def __str__(self) -> str:
        return self.words


def motion_units(directions: Sequence[str]) -> LabelledUnits:
    """Units of coordinates in some directions: m, or rad where it turns.

    Parameters
    ----------
    directions : sequence of str
        Of `DIRECTIONS`, one for each label.
    """
    return LabelledUnits("m or rad", tuple("rad" if d in TURNS else "m" for d in directions))


def unit_coordinate(name: str, dim: str, units: LabelledUnits) -> dict[str, xr.Variable]:
    """The coordinate that says the unit under each label of a variable.

    Parameters
    ----------
    name : str
        Of the variable.
    dim : str
        The dimension of the labels.
    units : LabelledUnits

    Returns
    -------
    dict
        One coordinate by its name.
    """
    return {f"{name}{_BESIDE}": xr.Variable(dim, list(units.units))}


def without_unit_coordinates(dataset: xr.Dataset) -> xr.Dataset:
    """A dataset without the coordinates of `unit_coordinate`: as files keep it.

    Parameters
    ----------
    dataset : xarray.Dataset
    """
    beside = {f"{name}{_BESIDE}" for name in dataset.data_vars}
    return dataset.drop_vars([name for name in dataset.coords if name in beside])


def label_units(dataset: xr.Dataset, name: str) -> dict[str, str]:
    """The unit under each label of a variable's last labelled dimension.

    Parameters
    ----------
    dataset : xarray.Dataset
    name : str
        Of a variable.

    Returns
    -------
    dict
        By label; empty of a variable without labels, or whose labels' units are not stated.
    """
    variable = dataset[name]
    dim = _labelled(dataset, variable)
    if not dim:
        return {}
    labels = [str(v) for v in dataset[dim].to_numpy()]
    if "units" in variable.attrs:
        return dict.fromkeys(labels, str(variable.attrs["units"]))
    for beside in (f"{name}{_BESIDE}", "unit"):
        if beside in dataset.coords and dataset[beside].dims == (dim,):
            # quantities of joints write a product with a star, attributes with a space
            units = [str(v).replace("*", " ") for v in dataset[beside].to_numpy()]
            return dict(zip(labels, units, strict=True))
    stated = {
        label: unit
        for unit, _, some in (part.partition(" for ") for part in stated_unit(variable).split("; "))
        for label in some.split()
    }
    return {label: stated[label] for label in labels} if set(labels) <= set(stated) else {}


def unit_at(dataset: xr.Dataset, name: str, label: str = "") -> str:
    """The unit of a variable at one label; all of its units in words where that is not stated.

    Parameters
    ----------
    dataset : xarray.Dataset
    name : str
        Of a variable.
    label : str
        Of its last labelled dimension; empty for a variable without.
    """
    return label_units(dataset, name).get(label, stated_unit(dataset[name]))


def split_units(dataset: xr.Dataset) -> xr.Dataset:
    """Each variable of several units as one for each, with one attribute `units`.

    Parameters
    ----------
    dataset : xarray.Dataset

    Returns
    -------
    xarray.Dataset
        In the place of `stiffness_free` along `direction`, `stiffness_free_translation` along
        `direction_translation` and `stiffness_free_rotation` along `direction_rotation`. Variables
        whose labels' units are not stated, such as a compliance, stay as they are.
    """
    parts: dict[str, xr.DataArray] = {}
    for name, variable in dataset.data_vars.items():
        dim = _labelled(dataset, variable)
        several = "component_units" in variable.attrs
        each = list(label_units(dataset, str(name)).values()) if several else []
        if not set(each) <= set(_PARTS) or not each:
            parts[str(name)] = variable
            continue
        for unit in dict.fromkeys(each):
            word = _PARTS[unit]
            at = np.flatnonzero([one == unit for one in each])
            attributes: dict[str, Any] = {
                k: v for k, v in variable.attrs.items() if k != "component_units"
            }
            part = variable.isel({dim: at}).drop_vars(f"{name}{_BESIDE}", errors="ignore")
            part = part.rename({dim: f"{dim}_{word}"})
            parts[f"{name}_{word}"] = part.assign_attrs(attributes | {"units": unit})
            parts[f"{name}_{word}"].attrs.pop("component_units", None)
    return xr.Dataset(parts, attrs=dataset.attrs)


def _labelled(dataset: xr.Dataset, variable: xr.DataArray) -> str:
    """The last dimension of a variable whose labels are words; empty without any."""
    for dim in reversed(variable.dims):
        if dim in dataset.coords and dataset[dim].dtype.kind in "UOT":
            return str(dim)
    return ""
