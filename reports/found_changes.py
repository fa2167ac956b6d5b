"""Gradients of the least stiffness of a machine, each at its pose."""

from __future__ import annotations

import numpy as np
import xarray as xr

from strutwork.errors import StrutworkError
from strutwork.machines.model import Model
from strutwork.msa.part_numbers import PartNumbers, same_numbers
from strutwork.reports.survey_words import least
from strutwork.studies.dimension import dimensions
from strutwork.studies.gradient import gradient
from strutwork.studies.parametric import Parametric
from strutwork.studies.tangents import Tangents


def found_changes(model: Model, named: str, surveyed: xr.Dataset) -> tuple[xr.Dataset, ...]:
    """Gradients of the least stiffness along each axis; none without paths.

    A machine that was moved since it was read has none: its file describes it elsewhere.

    Parameters
    ----------
    model : Model
    named : str
        Its file or name.
    surveyed : xarray.Dataset
        Stiffness over its workspace.
    """
    try:
        machine = Parametric.of(named)
    except StrutworkError:
        return ()
    if not _alike(machine.model(), model):
        return ()
    parameters = dimensions(machine)
    if not parameters:
        return ()
    tangents = Tangents.of(machine.model, parameters)
    found, free = [], surveyed["stiffness_free"]
    for axis in "xyz":
        values = free.sel(direction=axis).to_numpy()
        if tangents.parameters and np.isfinite(values).any():
            worst = least(surveyed, np.where(np.isfinite(values), values, np.nan))
            task = {d: [v] for d, v in worst.task.items()}
            found.append(gradient(tangents, (), [f"stiffness_{axis}"], task))
    return tuple(found)


def _alike(one: Model, other: Model) -> bool:
    """Whether two models stand at the same place and have the same parts."""
    return np.array_equal(one.placement.positions, other.placement.positions) and same_numbers(
        PartNumbers.of(one.structure), PartNumbers.of(other.structure)
    )
