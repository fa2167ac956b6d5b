"""Assembly forces against size, over the workspace and for designs of the rails."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics import Poses
from strutwork.machines import MitSS1
from strutwork.overconstraint import tolerance_responses, worst_case
from strutwork.papers.son_2002.assembly_map import (
    FORCES,
    assembly_map,
    bearing_quantities,
    compare_designs,
    machine_worst_case,
)
from strutwork.papers.son_2002.assembly_scale import assembly_scale
from strutwork.papers.son_2002.assembly_table import (
    calibrate_assembly,
    joint_forces,
    table_2_worst_case,
)
from strutwork.papers.son_2002.designs import (
    DESIGNS,
    Design,
    datum,
    design_tolerances,
    placed_design,
)
from strutwork.papers.son_2002.strut_assembly import StrutAssembly
from strutwork.papers.son_2002.tolerances import (
    STATIC_RATING,
    bearing_limits,
    machine_bearings,
    mit_ss1_tolerances,
    table_2_tolerances,
)


def test_lengths_of_a_batch_are_those_one_by_one() -> None:
    scale = assembly_scale((0.1, 0.5, 1.0, 3.0))
    np.testing.assert_allclose(scale.forces[1], joint_forces(table_2_worst_case("I")), rtol=1e-12)
    np.testing.assert_allclose(scale.forces[2], joint_forces(table_2_worst_case("II")), rtol=1e-12)
    alone = StrutAssembly(length=3.0, width=0.6)
    placed = alone.structure.at(alone.placement())
    expected = joint_forces(worst_case(tolerance_responses(placed, table_2_tolerances())))
    np.testing.assert_allclose(scale.forces[3], expected, rtol=1e-12)


def test_far_forces_are_proportional_and_near_ones_affine() -> None:
    scale = assembly_scale()
    assert scale.lengths[0] == 0.1
    assert scale.lengths[-1] == 3.0
    radial = "radial force"
    for far in (1, 3):
        assert scale.proportional[radial, far].error < 0.01
    for near in (2, 4):
        assert scale.affine[radial, near].error < 0.01
        assert scale.proportional[radial, near].error > 0.1
        assert scale.affine[radial, near].intercept > 1e3
    for n in range(1, 7):
        # (4/3) k_y τ is the slope of the axial forces in the limit of long struts
        slope = scale.axial_limit[-1] / scale.lengths[-1]
        assert np.diff(scale.forces[-2:, 1, n - 1]) / 0.1 == pytest.approx(slope, rel=0.01)


def test_length_at_which_a_rating_is_reached() -> None:
    scale = assembly_scale()
    at = scale.length_at()
    there = assembly_scale((at,)).forces[0, 0].max()
    # straight between lengths 0.1 m apart
    assert there == pytest.approx(STATIC_RATING, rel=1e-3)
    assert scale.length_at(1e9) == float("inf")
    assert scale.length_at(1.0) == 0.1


def test_widths_of_their_own_and_wrong_ones() -> None:
    ratio, own = assembly_scale((0.5, 1.0), 0.1), assembly_scale((0.5, 1.0), [0.05, 0.1])
    np.testing.assert_array_equal(ratio.forces, own.forces)
    with pytest.raises(ModelError, match="lengths of the struts"):
        assembly_scale((1.0, 0.5))
    with pytest.raises(ModelError, match="widths of the struts"):
        assembly_scale((0.5, 1.0), [0.1])
    with pytest.raises(ModelError, match="widths of the struts"):
        assembly_scale((0.5, 1.0), -0.2)


def test_dataset_and_dict_of_the_scale_hold_its_numbers() -> None:
    scale = assembly_scale((0.5, 1.0))
    dataset = scale.to_dataset()
    assert dataset["force"].attrs["units"] == "N"
    one = dataset["force"].sel(length=1.0, quantity="axial force", joint="joint3")
    assert one.item() == scale.forces[1, 1, 2]
    content = scale.to_dict()
    assert content["radial_force"] == scale.forces[:, 0].tolist()
    assert content["affine"]["radial force joint 1"]["slope"] > 0


def test_no_case_to_fit_to() -> None:
    with pytest.raises(ModelError, match="no case"):
        calibrate_assembly(())
    with pytest.raises(ModelError, match="case IV"):
        calibrate_assembly(("IV",))


def test_forces_over_the_workspace_are_those_pose_by_pose() -> None:
    machine = MitSS1()
    dataset = assembly_map(machine, x=[-0.05, 0.0], b=[-0.3, 0.0])
    home = machine_worst_case(machine)
    found = home.responses
    for kind in FORCES:
        for bearing in machine_bearings(machine):
            there = dataset["force"].sel(x=0.0, b=0.0, force_kind=kind, bearing=bearing)
            assert there.item() == pytest.approx(home.value[found.index(bearing, kind)], rel=1e-9)
    placed = machine.structure.at(machine.place(machine.poses(-0.05, 0.0, -0.3)))
    one = worst_case(tolerance_responses(placed, mit_ss1_tolerances(), bearing_quantities(machine)))
    np.testing.assert_allclose(dataset["tool"].to_numpy()[0, 0], one.value[-6:], rtol=1e-9)


def test_height_does_not_matter_and_a_pose_out_of_reach_is_left_out() -> None:
    machine = MitSS1()
    values = []
    for z in (0.0, 0.2):
        placed = machine.structure.at(machine.place(machine.poses(0.01, z, 0.2)))
        quantities = bearing_quantities(machine)
        values.append(
            worst_case(tolerance_responses(placed, mit_ss1_tolerances(), quantities)).value
        )
    np.testing.assert_allclose(values[0], values[1], rtol=1e-7, atol=1e-12)
    dataset = assembly_map(machine, x=[0.0, 2.0], b=[0.0])
    assert np.all(np.isfinite(dataset["force"].sel(x=0.0)))
    assert np.all(np.isnan(dataset["force"].sel(x=2.0)))
    with pytest.raises(ModelError, match="no pose"):
        assembly_map(machine, x=[2.0], b=[0.0])


def test_common_datums_lower_the_forces_of_the_rails() -> None:
    designs = {d.design.letter: d for d in compare_designs()}
    for kind in FORCES:
        a, b, c = (designs[letter].rails[kind] for letter in "abc")
        assert a > b > c > 0
        a, b, c = (designs[letter].everything[kind] for letter in "abc")
        assert a > b > c
        # more tolerances never lock in less
        assert c > designs["c"].rails[kind]
    assert designs["a"].to_dict()["datums"] == [[1], [2], [3]]


def test_one_datum_for_all_rails_locks_in_nothing_but_moves_the_tool() -> None:
    design = DESIGNS["c"]
    shared = [t for t in design_tolerances(design) if t.name == datum((1, 2, 3))]
    found = worst_case(
        tolerance_responses(placed_design(design), shared, bearing_quantities(MitSS1()))
    )
    # all rails move as one body: forces are rounding beside the kilonewtons of the rails apart
    assert found.value[:-6].max() < 1e-5
    # half of the zone at the middle, and more where the surface tilts
    assert found.value[-5] > 25e-6


def test_design_poses_and_errors() -> None:
    machine = MitSS1()
    placed = placed_design(DESIGNS["b"], machine, machine.poses([0.0, 0.02]))
    assert placed.batch == (2,)
    twice = Design("x", "a rail on two datums", ((1, 2), (2, 3)))
    with pytest.raises(ModelError, match="design x"):
        design_tolerances(twice)
    with pytest.raises(UnreachableError):
        placed_design(DESIGNS["a"], machine, machine.poses(2.0))
    assert isinstance(machine.home(), Poses)


def test_limits_of_bearings() -> None:
    limits = bearing_limits(("a", "b"), 10e3, safety=2.0)
    assert limits["a", "radial force"] == 5e3
    assert limits["b", "axial force"] == 5e3
    assert len(machine_bearings(MitSS1())) == 12
    assert machine_bearings(replace(MitSS1(), pins="revolute")) == ()
