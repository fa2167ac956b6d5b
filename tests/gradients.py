"""Machines and finite differences for tests of gradients, the latter to some ten digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea import modes
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.fea.ports import tool_port
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

#: A slender bar without shear, of two elements, with a tip mass far heavier than itself.
CANTILEVER = """
[materials.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "1e-6 kg/m^3"
[materials.other]
youngs_modulus = "70 GPa"
poissons_ratio = 0.3
density = "2700 kg/m^3"
[sections.bar]
shape = "rod"
diameter = "30 mm"
[nodes]
root = [0, 0, 0]
tip = ["600 mm", 0, 0]
[[beams]]
name = "arm"
from = "root"
to = "tip"
material = "steel"
section = "bar"
shear = false
elements = 2
[[masses]]
node = "tip"
mass = "8 kg"
[[supports]]
node = "root"
fixed = "all"
[[loads]]
case = "pull"
node = "tip"
force = [0, 0, "-100 N"]
[tool]
tcp = "tip"
[damping]
modal_ratio = 0.02
"""

#: A chain of two arms, their joints elastic, the last with a dashpot.
CHAIN = """
[materials.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
loss_factor = 0.01
[sections.bar]
shape = "tube"
outer_diameter = "50 mm"
inner_diameter = "30 mm"
[nodes]
root = [0, 0, 0]
foot = [0, 0, 0]
end = [0, "100 mm", "700 mm"]
begin = [0, "100 mm", "700 mm"]
tip = ["500 mm", "150 mm", "800 mm"]
[[joints]]
name = "shoulder"
type = "revolute"
between = ["root", "foot"]
axis = [1, 0, 0]
[joints.stiffness]
x = "300 N/um"
y = "200 N/um"
z = "250 N/um"
rx = "2e5 N*m/rad"
ry = "3e5 N*m/rad"
rz = "1e5 N*m/rad"
[[beams]]
name = "upper"
from = "foot"
to = "end"
material = "steel"
section = "bar"
elements = 2
[[joints]]
name = "elbow"
type = "revolute"
between = ["end", "begin"]
axis = [0, 1, 0]
stiffness = { rz = "8e4 N*m/rad" }
damping = { rz = "20 N*m*s/rad" }
[[beams]]
name = "fore"
from = "begin"
to = "tip"
material = "steel"
section = "bar"
[[masses]]
node = "tip"
mass = "4 kg"
[[supports]]
node = "root"
fixed = "all"
[[springs]]
name = "balance"
node = "end"
stiffness = { z = "2 N/um", y = "1 N/um" }
[[loads]]
case = "cut"
node = "tip"
force = ["50 N", "20 N", "-100 N"]
[tool]
tcp = "tip"
"""


def placed(model: Model, task: Mapping[str, float]) -> PlacedStructure:
    """One pose, without batch axes."""
    return model.structure.at(moved(model, task)[1] if task else model.placement)


def answers(
    model: Model, asked: Sequence[Asked], task: Mapping[str, float], vibrating: Vibrating
) -> Array:
    """Quantities by the solvers that know nothing of gradients, all at one placement."""
    at = placed(model, task)
    stiff = {"stiffness": axis_stiffness_free, "blocked_stiffness": axis_stiffness_blocked}
    compliance = tool_compliance(at) if any(one.kind in stiff for one in asked) else None
    return np.array(
        [
            stiff[one.kind](compliance)[one.direction]
            if one.kind in stiff
            else _answer(model, at, one, vibrating)
            for one in asked
        ]
    )


def _answer(model: Model, at: PlacedStructure, asked: Asked, vibrating: Vibrating) -> float:
    if asked.kind == "frequency":
        return float(modes(at, asked.direction + 1).frequencies[asked.direction])
    if asked.kind == "least_dynamic_stiffness":
        port = tool_port(model.structure.linkage, DIRECTIONS[asked.direction])
        damping: AnyDamping = vibrating.damping  # type: ignore[assignment]
        return least_dynamic_stiffness(at, port, port, damping, vibrating.band).value
    case = model.case(asked.static.case.name)  # type: ignore[union-attr]
    found = solve(at, [case])
    part = asked.static.part  # type: ignore[union-attr]
    read = found.displacement if asked.kind == "displacement" else found.joint_force
    return float(read(part, case.name)[asked.direction])


def slope(value: Callable[[float], Array], step: float) -> Array:
    """Derivatives at zero: central differences of three steps, extrapolated (Richardson)."""
    found = [(value(h) - value(-h)) / (2 * h) for h in (step, step / 2, step / 4)]
    first, second = ((4 * found[k + 1] - found[k]) / 3 for k in (0, 1))
    extrapolated: Array = (16 * second - first) / 15
    return extrapolated


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

        def at(h: float, parameter: Dimension = parameter) -> Array:
            return answers(model_of(parameter.moved(h)), asked, task, vibrating)

        expected = slope(at, step * size)
        least = 1e-2 * np.abs(found["value"][:, 0].to_numpy()) / size
        error = np.abs(found["gradient"][:, g, 0].to_numpy() - expected)
        result[:, g] = error / np.maximum(np.abs(expected), least)
    return result
