"""Closed forms of the catalogue's machines beside the motion that only knows their joints."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from strutwork.machines import CATALOGUE
from strutwork.machines.load import load
from strutwork.machines.model import Model

#: Largest shift, m, and turn, rad, from home, within which every machine keeps its branch.
RANGES = {
    "proposed-3pprs": (4e-3, 0.05),
    "eclipse-3pprs": (4e-3, 0.05),
    "alizade-3prps": (4e-3, 0.05),
    "glozman-3prrs": (4e-3, 0.03),
    "prototype-3ppprs": (4e-3, 0.05),
    "mit-ss1": (0.05, 0.2),
    "hexel-hexapod": (0.1, 0.2),
    "moving-bridge": (0.05, 0.2),
    "serial-five-axis": (0.1, 0.2),
    "eclipse-prototype": (4e-3, 0.05),
    "eclipse-machine": (0.02, 0.05),
    "linear-delta": (0.1, 0.0),
    "gough-platform": (0.1, 0.2),
    "biglide": (0.4, 0.0),
    "biglide:third-leg": (0.4, 0.8),
}
#: Machines whose nodes are all where the tool's pose has them: no part is free to choose.
DECIDED = ("mit-ss1", "biglide", "biglide:third-leg", "linear-delta", "moving-bridge")
MODELS: dict[str, Model] = {}


def model(name: str) -> Model:
    if name not in MODELS:
        MODELS[name] = load(name)
    return MODELS[name]


def test_every_machine_is_held() -> None:
    assert {name.partition(":")[0] for name in RANGES} == set(CATALOGUE)


@pytest.mark.parametrize("name", RANGES)
@settings(
    max_examples=5, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_joints_alone_place_it_as_its_formulas_do(name: str, seed: int) -> None:
    """1e-9 m: joints are closed to 1e-11 of the machine's size, which is below 4 m."""
    found = model(name)
    shift, turn = RANGES[name]
    random = np.random.default_rng(seed)
    rest = found.motion.rest()
    task = {
        d: value + random.uniform(-1.0, 1.0, 8) * (turn if d.startswith("r") else shift)
        for d, value in rest.items()
    }
    # directions that the joints hold stay as they are: the poses are those of the motion
    moved = found.motion.move(task=task)
    assert moved.reached.all()
    assert moved.tool is not None
    assert found.closed_form is not None
    own = found.closed_form(moved.tool)
    assert own.reachable.all()
    linkage = found.structure.linkage
    if len(rest) == 6 and name != "prototype-3ppprs":
        again = found.motion.place(moved.tool)
        # where the nodes of a sliding joint stand along its axis is the machine's choice
        index = linkage.node_index
        slides = found.motion.joints.sliding
        held = np.ones(len(linkage.nodes), dtype=bool)
        for joint in (j for j, s in zip(linkage.joints, slides, strict=True) if s):
            held[[index[n] for n in joint.between]] = False
        assert held.sum() > 6
    else:
        # more can move than the tool is given, and each may choose: what the tool fixes must agree
        again = moved.placement
        held = linkage.body_of_node == linkage.tool_body
        if name in DECIDED:
            held[:] = True
    np.testing.assert_allclose(again.positions[:, held], own.positions[:, held], atol=1e-9)


@pytest.mark.parametrize("name", ["linear-delta", "gough-platform", "hexel-hexapod"])
def test_the_joints_count_as_the_formulas_do(name: str) -> None:
    """1e-9 m and rad: as above; signs and axes of the passive joints are those of the linkage."""
    found = model(name)
    shift, turn = RANGES[name]
    random = np.random.default_rng(11)
    moved = found.motion.move(
        task={
            d: value + random.uniform(-1.0, 1.0, 8) * (turn if d.startswith("r") else shift)
            for d, value in found.motion.rest().items()
        }
    )
    assert moved.tool is not None
    assert found.closed_form is not None
    own = found.closed_form(moved.tool)
    column = [moved.placement.names.index(n) for n in own.names]
    np.testing.assert_allclose(moved.placement.values[:, column], own.values, atol=1e-9)
