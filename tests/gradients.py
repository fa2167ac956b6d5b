"""Finite differences of answers, for tests of gradients: extrapolated, to some ten digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea import Port, modes
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.msa import (
    PlacedStructure,
    axis_stiffness_blocked,
    axis_stiffness_free,
    solve,
    tool_compliance,
)
from strutwork.studies.dimension import Dimension
from strutwork.studies.gradient import gradient
from strutwork.studies.gradient_quantities import Asked, Vibrating, read_quantity
from strutwork.studies.tangents import ModelOf

Array = NDArray[Any]


def placed(model: Model, task: Mapping[str, float]) -> PlacedStructure:
    """One pose, without batch axes."""
    return model.structure.at(moved(model, task)[1] if task else model.placement)


def answer(model: Model, asked: Asked, task: Mapping[str, float], vibrating: Vibrating) -> float:
    """A quantity by the solvers that know nothing of gradients."""
    at = placed(model, task)
    if asked.kind in ("stiffness", "blocked_stiffness"):
        stiffness = axis_stiffness_free if asked.kind == "stiffness" else axis_stiffness_blocked
        return float(stiffness(tool_compliance(at))[asked.direction])
    if asked.kind == "frequency":
        return float(modes(at, asked.direction + 1).frequencies[asked.direction])
    if asked.kind == "least_dynamic_stiffness":
        port = Port(model.require_tool(), DIRECTIONS[asked.direction])
        damping: AnyDamping = vibrating.damping  # type: ignore[assignment]
        return least_dynamic_stiffness(at, port, port, damping, vibrating.band).value
    case = model.case(asked.static.case.name)  # type: ignore[union-attr]
    found = solve(at, [case])
    part = asked.static.part  # type: ignore[union-attr]
    read = found.displacement if asked.kind == "displacement" else found.joint_force
    return float(read(part, case.name)[asked.direction])


def slope(value: Callable[[float], float], step: float) -> float:
    """Derivative at zero: central differences of three steps, extrapolated (Richardson)."""
    found = [(value(h) - value(-h)) / (2 * h) for h in (step, step / 2, step / 4)]
    first, second = ((4 * found[k + 1] - found[k]) / 3 for k in (0, 1))
    return (16 * second - first) / 15


def gap(
    model_of: ModelOf,
    parameters: Sequence[Dimension],
    quantities: Sequence[str],
    task: Mapping[str, float] | None = None,
    vibrating: Vibrating | None = None,
    step: float = 2e-3,
) -> Array:
    """How far gradients are from differences, as shares of the larger of slope and value per step.

    Returns
    -------
    gap : (q, g)
        Of a slope below a hundredth of value per parameter, the share of that: the differences have
        no more digits.
    """
    task, vibrating = task or {}, vibrating or Vibrating()
    found = gradient(model_of, parameters, quantities, {d: [v] for d, v in task.items()}, vibrating)
    assert not found.attrs["refused"]
    asked = [read_quantity(model_of({}), name) for name in quantities]
    result = np.zeros((len(asked), len(parameters)))
    for g, parameter in enumerate(parameters):
        size = abs(parameter.value) or 1.0
        for q, one in enumerate(asked):

            def at(h: float, one: Asked = one, parameter: Dimension = parameter) -> float:
                return answer(model_of(parameter.moved(h)), one, task, vibrating)

            expected = slope(at, step * size)
            value = abs(float(found["value"][q, 0]))
            result[q, g] = abs(float(found["gradient"][q, g, 0]) - expected) / max(
                abs(expected), 1e-2 * value / size
            )
    return result
