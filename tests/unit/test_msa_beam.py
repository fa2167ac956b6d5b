"""Beams: axes, stiffness in closed form, offsets, subdivision."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.msa import Beam, Section, solve, tool_compliance
from strutwork.msa.beam import beam_axes, local_stiffness
from tests.structures import BAR, STEEL, Model, cantilever, cantilever_compliance, wrench

X, Y, Z = np.eye(3)
# a solve of few unknowns by a pivoted factorisation with one refinement
SOLVED = 1e-11


def axes_of(end: Any, orientation: Any = None) -> np.ndarray:
    up = np.full(3, np.nan) if orientation is None else np.asarray(orientation, dtype=float)
    length, axes = beam_axes(np.zeros((1, 3)), np.asarray([end], float), up[None], ["b"])
    assert length[0] == pytest.approx(np.linalg.norm(end), rel=1e-15)
    return np.asarray(axes[0])


@pytest.mark.parametrize(
    ("end", "orientation", "expected"),
    [
        (2 * X, None, (X, Y, Z)),
        (-2 * X, None, (-X, -Y, Z)),
        (3 * Y, None, (Y, -X, Z)),
        # along global z the default is global y
        (Z, None, (Z, X, Y)),
        (-Z, None, (-Z, -X, Y)),
        # z on the side of the orientation, y = z × x
        (X, Y, (X, -Z, Y)),
        (X, -Z, (X, -Y, -Z)),
        (X, X + Y, (X, -Z, Y)),
        (Z, X, (Z, -Y, X)),
    ],
)
def test_axes_are_those_of_the_model_file(end: Any, orientation: Any, expected: Any) -> None:
    np.testing.assert_allclose(axes_of(end, orientation), expected, atol=1e-15)


def test_a_beam_almost_along_z_keeps_global_z_in_its_plane() -> None:
    axes = axes_of(Z + 1e-3 * X)
    assert axes[2] @ X == pytest.approx(-1.0, abs=1e-5)


@pytest.mark.parametrize("shear", [True, False])
@pytest.mark.parametrize("elements", [1, 4])
def test_tip_compliance_is_the_closed_form(shear: bool, elements: int) -> None:
    model = cantilever(length=0.6, shear=shear, elements=elements)
    found = tool_compliance(model.place())
    expected = cantilever_compliance(model.beams[0], 0.6)
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    np.testing.assert_allclose(found / scale, expected / scale, atol=SOLVED)


def test_compliance_turns_with_the_beam_and_its_orientation() -> None:
    turn = Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix()
    model = cantilever().turned(turn, (3.0, -2.0, 1.0))
    six = np.kron(np.eye(2), turn)
    expected = six @ cantilever_compliance(model.beams[0], 0.6) @ six.T
    found = tool_compliance(model.place())
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    np.testing.assert_allclose(found / scale, expected / scale, atol=SOLVED)


def test_shear_flexibility_that_vanishes_gives_euler_and_bernoulli() -> None:
    stiff = Section(1e-3, 2e-7, 3e-8, 1e-7, shear_areas=(1e9, 1e9))
    bare = replace(stiff, shear_areas=None)
    with_shear, without = (
        tool_compliance(cantilever(section, **options).place())
        for section, options in ((stiff, {}), (bare, {"shear": False}))
    )
    np.testing.assert_allclose(with_shear, without, rtol=1e-9, atol=1e-20)
    # a section without shear areas does not shear, whatever the beam says
    np.testing.assert_array_equal(tool_compliance(cantilever(bare).place()), without)


def test_a_stubby_beam_deflects_by_shear() -> None:
    # L = h: the shear part is (1 + ν) / 2κ of the bending part
    beam = Beam("b", ("a", "c"), STEEL, BAR)
    c = cantilever_compliance(beam, 0.05)
    bending = 0.05**3 / (3 * STEEL.youngs_modulus * BAR.second_moment_y)
    nu = STEEL.poissons_ratio
    kappa = 10 * (1 + nu) / (12 + 11 * nu)
    assert c[2, 2] / bending - 1 == pytest.approx((1 + nu) / (2 * kappa), rel=1e-12)
    found = tool_compliance(cantilever(length=0.05).place())
    assert found[2, 2] == pytest.approx(c[2, 2], rel=SOLVED)


def test_stiffness_has_six_rigid_motions_and_six_strains() -> None:
    beam = Beam("b", ("a", "c"), STEEL, BAR)
    k = local_stiffness(np.asarray(0.7), beam.properties)
    np.testing.assert_array_equal(k, k.T)
    values = np.linalg.eigvalsh(k / np.sqrt(np.outer(np.diag(k), np.diag(k))))
    assert np.all(np.abs(values[:6]) < 1e-14)
    # a share of order (thickness/length)² is the smallest a slender beam has
    assert np.all(values[6:] > 1e-3)


def test_offsets_are_rigid_arms() -> None:
    first, second = np.array([0.05, 0.02, -0.03]), np.array([-0.04, 0.01, 0.06])
    root, tip = np.array([0.1, 0.0, 0.0]), np.array([0.7, 0.3, 0.2])
    short = Model("tip")
    short.nodes(root=root, tip=tip)
    short.beam("b", "root", "tip", BAR, offsets=(tuple(first), tuple(second)), elements=3)
    short.support("root")
    armed = Model("tip")
    armed.nodes(root=root, tip=tip, start=root + first, end=tip + second)
    armed.beam("b", "start", "end", BAR, elements=3)
    armed.rigid("heel", "root", "start")
    armed.rigid("head", "end", "tip")
    armed.support("root")
    cases = [wrench("push", "tip", 10.0, -20.0, 30.0, 1.0, 2.0, -3.0)]
    one, other = solve(short.place(), cases), solve(armed.place(), cases)
    for node in ("root", "tip", "b/1", "b/2"):
        np.testing.assert_allclose(
            one.displacement(node, "push"), other.displacement(node, "push"), rtol=1e-9, atol=1e-17
        )
    np.testing.assert_allclose(one.beam_forces, other.beam_forces, rtol=1e-9, atol=1e-9)


def test_orientation_may_follow_a_joint() -> None:
    def model(orientation: Any) -> Model:
        result = Model("tip")
        result.ground(base=(0, 0, 0))
        result.joint("pin", "revolute", ("base", "root"), (0.3, -0.5, 1.0), stiffness={"rz": 1e4})
        result.nodes(tip=(0.5, 0.2, 0.1))
        result.beam("b", "root", "tip", BAR, orientation=orientation)
        return result

    by_joint = tool_compliance(model("pin").place())
    np.testing.assert_allclose(
        by_joint, tool_compliance(model((0.3, -0.5, 1.0)).place()), rtol=1e-9
    )
    assert not np.allclose(by_joint, tool_compliance(model(None).place()), rtol=1e-3)
    with pytest.raises(ModelError, match='beam b: names the unknown joint "pan"'):
        model("pan").place()


@pytest.mark.parametrize(
    ("change", "part", "problem"),
    [
        ({"tip": (0.0, 0.0, 0.0)}, "beam beam", "has zero length"),
        ({"orientation": (2.0, 0.0, 0.0)}, "beam beam", "lies along the beam"),
        ({"orientation": (0.0, 0.0, 0.0)}, "beam beam", "zero length or lies along"),
        ({"elements": 0}, "beam beam", "has 0 elements"),
    ],
)
def test_a_wrong_beam_is_refused_by_name(change: dict[str, Any], part: str, problem: str) -> None:
    def build() -> None:
        options = dict(change)
        tip = options.pop("tip", (1.0, 0.0, 0.0))
        model = cantilever(**options)
        model.nodes(tip=tip)
        model.place()

    with pytest.raises(ModelError, match=re.escape(problem)) as caught:
        build()
    assert caught.value.part == part
    assert caught.value.remedy


def test_a_beam_needs_two_nodes() -> None:
    with pytest.raises(ModelError, match='beam b: runs from node "a" to itself'):
        Beam("b", ("a", "a"), STEEL, BAR)


def test_one_short_beam_in_a_batch_is_found() -> None:
    model = cantilever()
    model.nodes(tip=[[0.5, 0, 0], [0.0, 0, 0]])
    cases = [wrench("push", "tip", 0, 0, 1.0)]
    found = solve(model.place(), cases)
    assert found.outcome.solved.tolist() == [True, False]
    assert "beam beam: has zero length" in found.outcome.reason(1)
    assert np.isnan(found.displacements[1]).all()
    alone = solve(model.place()[:1], cases).displacements
    np.testing.assert_array_equal(found.displacements[:1], alone)
    with pytest.raises(ModelError, match="beam beam: has zero length"):
        solve(model.place()[1], cases)
