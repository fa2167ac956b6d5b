"""Bounds on amplification and stiffness beside the closed form of an arm and the solver itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.msa import tool_compliance
from strutwork.studies.margin_bounds import AmplificationBound, StiffnessBound
from strutwork.studies.workspace import workspace
from strutwork.studies.workspace_margin import MachineMargin
from tests.linkages import chain
from tests.unit.test_studies_workspace import FIRST, SECOND, model_of


def arm() -> Model:
    """Two bars at right angles, both joints driven."""
    linkage, home = chain(
        [[0, 0, 0], [FIRST, 0, 0], [FIRST, SECOND, 0]], [[0, 0, 1.0]] * 3, driven=0, closed=False
    )
    joints = tuple(replace(j, driven=("rz",)) for j in linkage.joints)
    return model_of(replace(linkage, joints=joints), home)


def closed_form(model: Model) -> tuple[float, float]:
    """Amplifications of the arm at home, joints of L rad/s: those of [-b, -b; a, 0]/L."""
    length = AmplificationBound(model, 0.0, np.inf).length
    jacobian = np.array([[-SECOND, -SECOND], [FIRST, 0.0]]) / length
    values = np.linalg.svd(jacobian, compute_uv=False)
    return float(values[-1]), float(values[0])


def test_amplification_of_an_arm() -> None:
    model = arm()
    found = AmplificationBound(model, 0.0, np.inf).of(model.placement[None])
    np.testing.assert_allclose(found[0], closed_form(model), rtol=1e-12)


def test_slacks_are_shares_of_the_bounds() -> None:
    model = arm()
    least, largest = closed_form(model)
    slacks = AmplificationBound(model, 0.8 * least, 1.5 * largest)(model.placement[None])
    np.testing.assert_allclose([v[0] for v in slacks.values()], [0.5, 0.25], rtol=1e-12)


def test_home_must_keep_them() -> None:
    model = arm()
    least, largest = closed_form(model)
    with pytest.raises(ModelError, match="home does not meet"):
        AmplificationBound(model, 0.0, 0.99 * largest)
    with pytest.raises(ModelError, match="home does not meet"):
        AmplificationBound(model, 1.01 * least, np.inf)
    with pytest.raises(ModelError, match="lower bound first"):
        AmplificationBound(model, 2.0, 1.0)


def test_stiffness_is_that_of_the_softest_direction() -> None:
    model = load("proposed-3pprs")
    compliance = tool_compliance(model.placed)[:3, :3]
    softest = StiffnessBound(model, 1.0).of(model.placement[None])[0]
    rng = np.random.default_rng(1)
    ways = rng.normal(size=(500, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    every = 1.0 / np.einsum("ni,ij,nj->n", ways, compliance, ways)
    assert softest <= every.min() <= 1.1 * softest
    with pytest.raises(ModelError, match="home does not meet"):
        StiffnessBound(model, 1.001 * softest)
    with pytest.raises(ModelError, match="positive"):
        StiffnessBound(model, 0.0)


def test_a_bound_ends_the_workspace_where_it_is_reached() -> None:
    model = load("proposed-3pprs")
    home = StiffnessBound(model, 1.0).of(model.placement[None])[0]
    bound = StiffnessBound(model, 0.9 * home)
    axes = {d: np.linspace(-0.03, 0.03, 9) for d in "xy"}
    margin = MachineMargin(model, ("x", "y"), np.full(2, 0.0075))
    free = workspace(margin, axes)
    held = workspace(replace(margin, bounds=(bound,)), axes)
    assert 0.0 < held.measure < free.measure
    words = [w for w in held.shares if w.startswith("stiffness")]
    assert len(words) == 1
    number = held.grid.crossings.reasons.index(words[0])
    places = held.grid.border[held.grid.crossings.reason == number]
    at = bound.of(margin._placed(places, np.eye(3), None))
    # halved to 1/8192 of a cell
    np.testing.assert_allclose(at, 0.9 * home, rtol=1e-4)
