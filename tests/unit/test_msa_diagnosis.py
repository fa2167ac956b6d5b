"""Structures that cannot be solved: the message names joints and directions that move."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import MechanismError, NumericalError
from strutwork.msa import LineLoad, LoadCase, solve, tool_compliance
from tests.structure_cases import four_bar, stewart, tripod_of_pinned_rods
from tests.structures import BAR, TUBE, Model, cantilever, wrench

METHODS = ("saddle_point", "null_space", "condensed", "sparse")
methods = pytest.mark.parametrize("method", METHODS)


def swing() -> Model:
    """A rod on a revolute about y."""
    model = Model("tip")
    model.ground(base=(0, 0, 0))
    model.nodes(tip=(0.5, 0, 0))
    model.joint("hinge", "revolute", ("base", "heel"), (0, 1, 0))
    model.beam("rod", "heel", "tip", BAR, elements=2)
    return model


@methods
def test_a_load_on_a_free_hinge_names_it(method: str) -> None:
    with pytest.raises(MechanismError) as caught:
        solve(swing().place(), [wrench("push", "tip", 0, 0, 10.0)], method)  # type: ignore[arg-type]
    error = caught.value
    assert error.part == "joints hinge in rz"
    assert "mechanism under its load" in error.problem
    assert "bodies that move: frame of" in error.problem
    assert error.remedy


@methods
def test_a_load_that_the_hinge_holds_is_solved(method: str) -> None:
    found = solve(swing().place(), [wrench("push", "tip", 0, 10.0, 0)], method)  # type: ignore[arg-type]
    ei = BAR.second_moment_z * 205e9
    bending = 10 * 0.5**3 / (3 * ei)
    assert found.displacement("tip", "push")[1] > bending
    assert found.displacement("tip", "push")[2] == pytest.approx(0.0, abs=1e-15)


def test_a_tool_compliance_needs_all_six_wrenches_held() -> None:
    for method in ("saddle_point", "null_space", "condensed", "sparse", "compiled"):
        with pytest.raises(MechanismError, match="joints hinge in rz"):
            tool_compliance(swing().place(), method)  # type: ignore[arg-type]


def test_the_spin_of_a_strut_that_nothing_excites_is_no_error() -> None:
    example = stewart("spherical")
    found = solve(example.model.place(), [example.cases[0]])
    assert np.all(np.isfinite(found.displacements))
    # struts stay where they are about their own axes: no motion is made up
    placed = example.model.place()
    frames = placed.frame("P0")
    foot = found.displacement("foot0", "push")[..., 3:]
    rod = found.displacement("rod0", "push")[..., 3:]
    spin = np.einsum("pi,pi->p", foot + rod, frames[..., 2])
    assert np.abs(spin).max() < 1e-9


def test_the_spin_of_a_strut_under_a_torque_names_its_joints() -> None:
    example = stewart("spherical")
    with pytest.raises(MechanismError) as caught:
        solve(example.model.place(), [wrench("twist", "rod3", 0, 0, 0, 0.3, 0.1, 1.0)])
    for name in ("U3", "S3"):
        assert name in caught.value.part
    assert "at pose 0" in caught.value.problem


def test_a_force_that_a_pinned_tripod_cannot_hold() -> None:
    model = tripod_of_pinned_rods().model
    solve(model.place(), [wrench("force", "hub", 1.0, 2.0, 3.0)])
    with pytest.raises(MechanismError, match="upper0 in rx"):
        solve(model.place(), [wrench("moment", "hub", 0, 0, 0, 1.0)])


def test_a_four_bar_without_its_drive_names_all_four_hinges() -> None:
    model = four_bar(True).model
    model.joints[0] = type(model.joints[0])("R1", "revolute", ("a0", "b0"))
    with pytest.raises(MechanismError) as caught:
        solve(model.place(), [wrench("push", "tool", 1.0, 0.0, 2.0)])
    assert caught.value.part == "joints R1 in rz, R2 in rz, R3 in rz, R4 in rz"
    # across its plane the same linkage stands
    solve(model.place(), [wrench("push", "tool", 0.0, 1.0, 0.0)])


def test_a_structure_without_supports_says_so() -> None:
    model = cantilever()
    model.joints.clear()
    model.grounded.clear()
    for node in ("root.ground",):
        del model.positions[node]
    with pytest.raises(MechanismError, match="no joint holds these bodies") as caught:
        solve(model.place(), [wrench("push", "tip", 0, 0, 1.0)])
    assert caught.value.part == "structure"


def test_the_pose_is_named_where_only_one_is_a_mechanism() -> None:
    """Two rods in line cannot hold a force across: a singular pose in a batch."""
    model = Model("hub")
    model.ground(a=(-1, 0, 0), b=(1, 0, 0))
    model.nodes(hub=[[0, 0, 0.5], [0, 0, 0.3], [0, 0, 0.0]])
    for end in "ab":
        model.joint(f"{end}0", "revolute", (end, f"{end}1"), (0, 1, 0))
        model.joint(f"{end}2", "revolute", ("hub", f"{end}3"), (0, 1, 0))
        model.rigid(f"rod {end}", f"{end}1", f"{end}3")
    push = [wrench("push", "hub", 0, 0, 1.0)]
    alone = solve(model.place()[:2], push)
    found = solve(model.place(), push)
    assert found.outcome.solved.tolist() == [True, True, False]
    assert found.outcome.of_kind(MechanismError).tolist() == [False, False, True]
    assert found.outcome.counts() == {"the structure moves freely under its load": 1}
    np.testing.assert_array_equal(found.displacements[:2], alone.displacements)
    assert np.isnan(found.displacements[2]).all()
    assert np.isnan(found.strain_energy[2]).all()
    with pytest.raises(MechanismError) as caught:
        found.outcome.require_all()
    assert "at pose 2" in caught.value.problem
    assert "a2" in caught.value.part
    # with nothing solved there is no answer to mark
    with pytest.raises(MechanismError):
        solve(model.place()[2:], push)


@methods
def test_stiffnesses_twenty_orders_apart_are_withheld_or_right(method: str) -> None:
    """Never a number that its own check does not back."""
    model = Model("tip")
    model.ground(base=(0, 0, 0))
    model.nodes(tip=(0.5, 0, 0))
    model.joint("soft", "revolute", ("base", "heel"), (0, 1, 0), stiffness={"rz": 1e-14})
    model.beam("rod", "heel", "tip", TUBE)
    deflection = 1e-9 * 0.5**2 / 1e-14
    try:
        found = solve(model.place(), [wrench("push", "tip", 0, 0, 1e-9)], method)  # type: ignore[arg-type]
        tip = float(found.displacement("tip", "push")[2])
    except NumericalError:
        tip = deflection
    assert tip == pytest.approx(deflection, rel=1e-3)


@methods
def test_a_zero_load_on_a_mechanism_moves_nothing(method: str) -> None:
    found = solve(swing().place(), [LoadCase("nothing")], method)  # type: ignore[arg-type]
    assert not np.any(found.displacements)


def test_a_divided_beam_on_the_ground_beside_a_strut_that_spins() -> None:
    model = tripod_of_pinned_rods().model
    model.ground(g0=(0, 0, 0), g1=(1, 0, 0))
    model.beam("rail", "g0", "g1", BAR, elements=2, shear=False)
    q = LineLoad("rail", (0, 0, -100.0), (0, 0, -100.0))
    found = solve(model.place(), [LoadCase("rest", line_loads=(q,))])
    # clamped on both sides: q L⁴/384EI
    ei = 205e9 * BAR.second_moment_y
    assert found.displacement("rail/1", "rest")[2] == pytest.approx(-100 / (384 * ei), rel=1e-9)
    assert np.abs(found.displacement("hub", "rest")).max() < 1e-15
