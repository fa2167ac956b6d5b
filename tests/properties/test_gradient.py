"""Gradients of random frames against differences of their answers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork.fea import LossFactor, ModalRatio
from strutwork.studies.dimension import Dimension
from strutwork.studies.gradient import gradient
from strutwork.studies.gradient_quantities import Vibrating
from strutwork.studies.parametric import Parametric
from tests.gradients import gap

share = st.floats(0.2, 1.0)
place = st.floats(-0.3, 0.3)


@st.composite
def chains(draw: st.DrawFn) -> Parametric:
    """Two or three arms from the ground on, joined by hinges that are elastic in one direction."""
    count = draw(st.integers(2, 3))
    nodes: dict[str, list[float]] = {"base": [0.0, 0.0, 0.0]}
    beams, joints = [], []
    at = np.zeros(3)
    before = "base"
    for k in range(count):
        begin, end = f"begin{k}", f"end{k}"
        nodes[begin] = at.tolist()
        at = at + np.array([draw(place), draw(place), draw(st.floats(0.3, 0.6))])
        nodes[end] = at.tolist()
        joints.append(
            {
                "name": f"joint{k}",
                "type": "revolute",
                "between": [before, begin],
                "axis": [1.0, draw(place), draw(place)],
                "stiffness": {"rz": 1e5 * draw(share), "x": 4e8 * draw(share)},
            }
        )
        beams.append(
            {
                "name": f"arm{k}",
                "from": begin,
                "to": end,
                "material": "steel",
                "section": "bar",
                "orientation": [0.3, 1.0, draw(place)],
                "elements": draw(st.integers(1, 2)),
                "shear": draw(st.booleans()),
            }
        )
        before = end
    return Parametric.of(
        {
            "materials": {
                "steel": {"youngs_modulus": 2.1e11, "poissons_ratio": 0.3, "density": 7850.0}
            },
            "sections": {
                "bar": {
                    "shape": "rectangle",
                    "width_y": 0.05 * draw(share),
                    "height_z": 0.06 * draw(share),
                }
            },
            "nodes": nodes,
            "beams": beams,
            "joints": joints,
            "masses": [{"node": before, "mass": 5.0 * draw(share)}],
            "supports": [{"node": "base", "fixed": "all"}],
            "tool": {"tcp": before},
        }
    )


@settings(max_examples=4, deadline=None)
@given(chains())
def test_gradients_of_chains(machine: Parametric) -> None:
    names = [
        "sections.bar.width_y",
        "sections.bar.height_z",
        "materials.steel.youngs_modulus",
        "joints.joint0.stiffness.rz",
        "joints.joint*.stiffness.x",
        "nodes.end0.z+nodes.begin1.z",
        "nodes.end0.x+nodes.begin1.x",
        "masses[0].mass",
    ]
    parameters = [Dimension.of(machine, name) for name in names]
    quantities = ["stiffness_x", "stiffness_rz", "blocked_stiffness_y", "frequency_1"]
    # a step that suits one machine is too long for a softer one; a wrong gradient fails all
    least = np.full((len(quantities), len(parameters)), np.inf)
    for step in (1e-3, 2e-4, 4e-5):
        least = np.minimum(least, gap(machine.model, parameters, quantities, step=step))
        if least.max() < 1e-6:
            break
    assert least.max() < 1e-6


@settings(max_examples=3, deadline=None)
@given(chains(), st.sampled_from([ModalRatio(0.03), LossFactor(0.04)]))
def test_the_least_dynamic_stiffness_of_chains(
    machine: Parametric, damping: ModalRatio | LossFactor
) -> None:
    """In a band without another minimum as low, which differences might step to."""
    names = ["sections.bar.height_z", "materials.steel.density", "joints.joint0.stiffness.rz"]
    parameters = [Dimension.of(machine, name) for name in names]
    vibrating = Vibrating(damping, (1.0, 3000.0))
    quantities = ["least_dynamic_stiffness_x"]
    assert gap(machine.model, parameters, quantities, None, vibrating, 2e-4).max() < 2e-5


@settings(max_examples=10, deadline=None)
@given(chains())
def test_scaling_all_stiffness_scales_the_stiffness_at_the_tool(machine: Parametric) -> None:
    """Euler's theorem: elasticities of all moduli and joint stiffnesses add to one."""
    stiff = [p for p in machine.paths if ".stiffness." in p or p.endswith("youngs_modulus")]
    parameters = [Dimension.of(machine, name) for name in stiff]
    found = gradient(machine.model, parameters, ["stiffness_x", "blocked_stiffness_z"])
    total = found["elasticity"].to_numpy()[:, :, 0].sum(axis=1)
    assert total == pytest.approx(np.ones(2), rel=1e-8)
