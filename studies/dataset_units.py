"""Units of the variables of a dataset, as pint-xarray and the CF conventions read them.

The attribute `units` names one unit. A variable whose labels have several, such as a stiffness in
six directions, says so in `component_units` and has no `units`; `split_units` makes one variable of
each.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import xarray as xr

from strutwork.kinematics import DIRECTIONS

#: What tells that a text names several units.
_SEVERAL = re.compile(r" for | or |[;,]")

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


def unit_of_label(units: str, label: str) -> str:
    """The unit under one label of a variable.

    Parameters
    ----------
    units : str
        As `stated_unit` answers.
    label : str
        A direction, `JOINT:DIRECTION`, or the name of a quantity of joints and tool.
    """
    turns = label.rpartition(":")[2] in DIRECTIONS[3:]
    if units.startswith("N/m"):
        return "N m/rad" if turns and _SEVERAL.search(units) else units.partition(" for ")[0]
    if units in ("m for x y z; rad for rx ry rz", "m or rad", "m; rad"):
        return "rad" if turns else "m"
    if units in ("N, N m, m or rad", "N; N m; m; rad"):
        if label.startswith("tool "):
            return "rad" if "rotation" in label else "m"
        return "N" if label.endswith("force") else "N m"
    return units


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
        whose labels do not tell their units, such as a compliance, stay as they are.
    """
    parts: dict[str, xr.DataArray] = {}
    for name, variable in dataset.data_vars.items():
        units, dim = str(variable.attrs.get("component_units", "")), _labelled(dataset, variable)
        each = [unit_of_label(units, str(v)) for v in dataset[dim].to_numpy()] if dim else []
        if not set(each) <= set(_PARTS) or not each:
            parts[str(name)] = variable
            continue
        for unit in dict.fromkeys(each):
            word = _PARTS[unit]
            at = np.flatnonzero([one == unit for one in each])
            attributes: dict[str, Any] = {
                k: v for k, v in variable.attrs.items() if k != "component_units"
            }
            part = variable.isel({dim: at}).rename({dim: f"{dim}_{word}"})
            parts[f"{name}_{word}"] = part.assign_attrs(attributes | {"units": unit})
            parts[f"{name}_{word}"].attrs.pop("component_units", None)
    return xr.Dataset(parts, attrs=dataset.attrs)


def _labelled(dataset: xr.Dataset, variable: xr.DataArray) -> str:
    """The last dimension of a variable whose labels are words; empty without any."""
    for dim in reversed(variable.dims):
        if dim in dataset.coords and dataset[dim].dtype.kind in "UOT":
            return str(dim)
    return ""
