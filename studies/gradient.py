"""Gradients of a machine's answers with respect to its numbers, by their paths."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.names import visible
from strutwork.studies.description import versions
from strutwork.studies.dimension import Dimension, dimensions
from strutwork.studies.gradient_quantities import Asked, Vibrating, read_quantity, sensitivities
from strutwork.studies.model_damping import model_damping
from strutwork.studies.parametric import Parametric
from strutwork.studies.tangents import ModelOf, Tangents

Array = NDArray[Any]

#: Gradients whose effect of ten percent is a smaller share of the value are none.
NOTHING = 1e-9


def gradient(
    model_of: ModelOf | Tangents,
    parameters: Sequence[Dimension],
    quantities: Sequence[str],
    task: Mapping[str, ArrayLike] | None = None,
    vibrating: Vibrating | None = None,
) -> xr.Dataset:
    """Gradients of quantities at a batch of poses.

    Parameters
    ----------
    model_of : callable or Tangents
        The machine of numbers by path, as `Parametric.model`; or what `Tangents.of` made of it,
        which serves every call.
    parameters : sequence of g Dimension
        As `Dimension.of` and `strutwork.studies.dimension.dimensions` give them; with `Tangents`
        those that it has.
    quantities : sequence of q str
        As `strutwork.studies.gradient_quantities.FORMS`.
    task : mapping of direction to (p,), optional
        Poses of the tool, m and rad; without one the machine as it is described.
    vibrating : Vibrating, optional
        Damping and band of a least dynamic stiffness.

    Returns
    -------
    xarray.Dataset
        `value` (quantity, pose), `gradient` (quantity, parameter, pose) in `gradient_unit`, and
        `elasticity`, the share by which the quantity grows per share by which the parameter does.
        The attribute `refused` names parameters without derivative and why, `no_influence` those
        that change nothing, `remarks` what else is to be known.

    Raises
    ------
    ModelError
        No quantity or parameter, an unknown one, or no parameter that can be changed.
    UnreachableError
        A pose that the machine cannot take.
    MechanismError, NumericalError
        A pose without an answer.
    """
    tangents = (
        model_of if isinstance(model_of, Tangents) else Tangents.of(model_of, tuple(parameters))
    )
    model = tangents.model
    asked = [read_quantity(model, name) for name in quantities]
    if not asked:
        raise ModelError("gradient", "of no quantity.", "Name one, such as stiffness_z.")
    if not tangents.parameters:
        raise ModelError("gradient", "has no parameter.", _why(tangents.refused))
    found = tangents.at(task)
    values, rates, remarks = sensitivities(model, found, asked, vibrating or Vibrating())
    return _dataset(tangents, asked, values, rates, remarks, task or {})


def _why(refused: Mapping[str, str]) -> str:
    if not refused:
        return "Name one by its path, such as sections.strut.outer_diameter."
    return " ".join(f"{visible(name)}: {why}" for name, why in refused.items())


def _dataset(
    tangents: Tangents,
    asked: Sequence[Asked],
    values: Array,
    rates: Array,
    remarks: Sequence[str],
    task: Mapping[str, ArrayLike],
) -> xr.Dataset:
    parameters = tangents.parameters
    at = np.array([p.value for p in parameters])
    with np.errstate(divide="ignore", invalid="ignore"):
        elasticity = rates * at[None, :, None] / values[:, None, :]
    units = np.array([[per(a.unit, p.unit) for p in parameters] for a in asked])
    with np.errstate(invalid="ignore"):
        still = ~np.any(np.abs(elasticity) > NOTHING, axis=(0, 2)) & np.isfinite(rates).any((0, 2))
    coords: dict[str, Any] = {
        "quantity": [a.name for a in asked],
        "parameter": [p.name for p in parameters],
        "quantity_unit": ("quantity", [a.unit for a in asked]),
        "meaning": ("quantity", [a.meaning for a in asked]),
        "parameter_unit": ("parameter", [p.unit or "1" for p in parameters]),
        "parameter_value": ("parameter", at),
        "parameter_meaning": ("parameter", [p.meaning for p in parameters]),
        "gradient_unit": (("quantity", "parameter"), units),
    }
    for direction in DIRECTIONS:
        if direction in task:
            unit = "rad" if direction.startswith("r") else "m"
            poses = np.broadcast_to(np.asarray(task[direction], dtype=float), values.shape[1:])
            coords[direction] = ("pose", poses, {"units": unit})
    several = {"component_units": "that of each quantity; see quantity_unit"}
    return xr.Dataset(
        {
            "value": (("quantity", "pose"), values, several),
            "gradient": (
                ("quantity", "parameter", "pose"),
                rates,
                {"component_units": "see gradient_unit"},
            ),
            "elasticity": (
                ("quantity", "parameter", "pose"),
                elasticity,
                {
                    "units": "1",
                    "long_name": "relative change of the quantity per relative change of the "
                    "parameter",
                },
            ),
        },
        coords=coords,
        attrs={
            "study": "gradient",
            "machine": tangents.model.title,
            "refused": [f"{name}: {why}" for name, why in tangents.refused.items()],
            "no_influence": [p.name for p, none in zip(parameters, still, strict=True) if none],
            "remarks": list(remarks),
            **versions(),
        },
    )


def machine_gradient(
    source: object,
    quantities: Sequence[str] = (),
    by: Sequence[str] = (),
    task: Mapping[str, ArrayLike] | None = None,
    band: tuple[float, float] = (1.0, 1000.0),
) -> xr.Dataset:
    """Gradients of a machine by names, with its own damping.

    Parameters
    ----------
    source : str, Path, Parametric or machine
        As `strutwork.studies.parametric.Parametric.of`.
    quantities : sequence of str
        The stiffnesses of the tool along x, y and z where there is none.
    by : sequence of str
        Paths as of `Dimension.of`; those of `dimensions` where there is none.
    task : mapping of direction to (p,), optional
        Poses of the tool, m and rad.
    band : (float, float)
        Of a least dynamic stiffness, Hz.

    Raises
    ------
    ModelError
        A path that names no number; else as `gradient`.
    UnreachableError, MechanismError, NumericalError
        As `gradient`.
    """
    machine = Parametric.of(source)
    chosen = [Dimension.of(machine, path) for path in by] if by else dimensions(machine)
    dynamic = any(name.startswith("least_dynamic_stiffness") for name in quantities)
    vibrating = Vibrating(model_damping(machine.model()) if dynamic else None, band)
    asked = quantities or ("stiffness_x", "stiffness_y", "stiffness_z")
    return gradient(machine.model, chosen, asked, task, vibrating)


def per(unit: str, parameter: str) -> str:
    """The unit of a gradient.

    Parameters
    ----------
    unit, parameter : str
        SI units of a quantity and a parameter; empty for none.

    Examples
    --------
    >>> per("N/m", "m"), per("Hz", "")
    ('N/m per m', 'Hz per 1')
    """
    return f"{unit} per {parameter or '1'}"


def worst_pose(
    model: Model, quantity: str, grid: TaskGrid, vibrating: Vibrating | None = None
) -> dict[str, float]:
    """The pose of a grid at which a quantity is least, among those the machine can take.

    Parameters
    ----------
    model : Model
    quantity : str
        As `gradient` takes it; of a force or displacement the size counts, and the largest is
        worst.
    grid : TaskGrid
    vibrating : Vibrating, optional

    Raises
    ------
    ModelError
        No pose can be taken, or the quantity has no finite value at any.
    """
    asked = read_quantity(model, quantity)
    task = grid.task()
    placement = moved(model, task)[1]
    good = np.flatnonzero(placement.reachable)
    if not good.size:
        raise ModelError("workspace", "has no pose that can be taken.", "Move the grid.")
    values = np.full(len(good), np.nan)
    plain = Tangents(model, (), (), (), (), {})
    for start in range(0, len(good), 64):
        some = good[start : start + 64]
        found = plain.at({d: v[some] for d, v in task.items()})
        values[start : start + 64] = sensitivities(model, found, [asked], vibrating or Vibrating())[
            0
        ][0]
    if asked.static is not None:
        values = -np.abs(values)
    if not np.isfinite(values).any():
        raise ModelError(visible(quantity), "is finite at no pose.", "Ask for another direction.")
    worst = int(good[int(np.nanargmin(np.where(np.isfinite(values), values, np.nan)))])
    return {d: float(v[worst]) for d, v in task.items()}
