"""Derivatives of receptances against differences of the response itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import LossFactor, ModalRatio, PartDamping, Port, Rayleigh, frequency_response
from strutwork.fea.receptance_sensitivity import receptance_sensitivity
from strutwork.studies.dimension import Dimension
from strutwork.studies.parametric import Parametric
from strutwork.studies.tangents import Tangents
from tests.gradients import CANTILEVER, CHAIN

HERTZ = np.array([3.0, 11.0, 24.0, 60.0, 180.0])


@pytest.mark.parametrize(
    "damping",
    [
        ModalRatio(0.03),
        LossFactor(0.05),
        Rayleigh(2.0, 1e-4),
        PartDamping(ModalRatio(0.01), materials=False, dashpots=True),
        PartDamping(None, materials=True, dashpots=True),
    ],
    ids=str,
)
def test_rates_are_those_of_differences(damping: Any) -> None:
    machine = Parametric.of(CHAIN)
    names = [
        p
        for p in machine.paths
        if p.endswith(("youngs_modulus", "density", ".mass"))
        or ".stiffness." in p
        or ".damping." in p
    ]
    parameters = [Dimension.of(machine, p) for p in names]
    assert len(parameters) >= 5
    tangents = Tangents.of(machine.model, parameters)
    tip = machine.model().require_tool()
    ports = [Port(tip, "x"), Port(tip, "z")]
    pairs = [(a, b) for a in ports for b in ports]
    found = tangents.at()
    values, rates = receptance_sensitivity(found.placed, found.changes, pairs, HERTZ, damping)

    def response(numbers: dict[str, float]) -> Any:
        placed = machine.model(numbers).placed
        got = frequency_response(placed, ports, ports, HERTZ, damping, "direct")
        return np.moveaxis(got.receptance, 0, -1).reshape(4, -1)

    assert values == pytest.approx(response({}), rel=1e-7)
    scale = np.abs(values).max(axis=0)
    for parameter, rate in zip(tangents.parameters, rates, strict=True):
        step = 2e-5 * parameter.value
        slope = (response(parameter.moved(step)) - response(parameter.moved(-step))) / (2 * step)
        effect = np.abs(rate) * parameter.value
        # beside a resonance the response bends: differences are as good as its slope is large
        off = np.abs(rate - slope) * parameter.value / (scale + effect)
        assert off.max() < 1e-6, parameter.name


def test_what_moves_parts_is_refused() -> None:
    machine = Parametric.of(CANTILEVER)
    found = Tangents.of(machine.model, [Dimension.of(machine, "nodes.tip.x")]).at()
    port = Port("tip", "z")
    with pytest.raises(ModelError, match="moves parts"):
        receptance_sensitivity(found.placed, found.changes, [(port, port)], HERTZ, ModalRatio(0.02))
