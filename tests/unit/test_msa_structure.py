"""Structures: rigid clusters eliminated exactly, and what is refused."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics import GROUND, Body, Linkage, Placement
from strutwork.msa import (
    Beam,
    LoadCase,
    PointMass,
    Spring,
    Structure,
    rigid_map,
    solve,
    system_of,
    tool_compliance,
)
from tests.structure_cases import LIBRARY
from tests.structures import BAR, STEEL, Model, cantilever, wrench


def test_rigid_map_is_the_first_order_of_a_rotation() -> None:
    arm, turn = np.array([0.3, -0.2, 0.5]), 1e-6 * np.array([1.0, 2.0, -3.0])
    moved = Rotation.from_rotvec(turn).apply(arm) - arm
    twist = rigid_map(arm) @ [0, 0, 0, *turn]
    # second order: (4e-6)² times the arm
    np.testing.assert_allclose(twist[:3], moved, atol=2e-11)
    np.testing.assert_array_equal(twist[3:], turn)


def test_a_rigid_body_costs_six_unknowns_whatever_its_nodes() -> None:
    model = LIBRARY["hexapod, rigid struts"]().model
    structure = model.structure()
    # platform, six cylinders, six pistons
    assert structure.vertex_count == 13
    assert structure.linkage.tool is not None
    tool = structure.linkage.node_index[structure.linkage.tool]
    assert tool in structure.reference_nodes
    assert repr(structure).startswith("<Structure: 37 nodes, 0 beams, 18 joints, 78 dof")


def test_nodes_of_a_rigid_body_move_as_one() -> None:
    example = LIBRARY["tripod machine"]()
    found = solve(example.model.place(), example.cases)
    positions = found.placed.placement.positions
    index = found.placed.structure.linkage.node_index
    tool = found.displacement("tool", "push")
    for i in range(3):
        arm = positions[:, index[f"plate{i}"]] - positions[:, index["tool"]]
        plate = found.displacement(f"plate{i}", "push")
        np.testing.assert_allclose(plate[:, 3:], tool[:, 3:], rtol=1e-14)
        expected = tool[:, :3] + np.cross(tool[:, 3:], arm)
        np.testing.assert_allclose(plate[:, :3], expected, rtol=1e-12, atol=1e-18)


def test_a_rigid_group_in_a_flexible_body_is_the_limit_of_a_stiff_beam() -> None:
    def model(rigid: bool) -> Model:
        result = Model("tip")
        result.nodes(root=(0, 0, 0), a=(0.3, 0, 0), b=(0.3, 0.2, 0.1), tip=(0.6, 0.2, 0.1))
        result.beam("first", "root", "a", BAR)
        result.beam("last", "b", "tip", BAR)
        if rigid:
            result.rigid("block", "a", "b")
        else:
            hard = type(STEEL).isotropic(205e9 * 1e4, 0.29)
            result.beam("block", "a", "b", BAR, hard)
        result.support("root")
        return result

    exact, nearly = tool_compliance(model(True).place()), tool_compliance(model(False).place())
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    # the block's own flexibility is about 1e-4 of its neighbours'
    assert 1e-9 < np.abs((nearly - exact) / scale).max() < 4e-4


def test_both_ends_of_a_beam_in_one_rigid_body_carry_nothing() -> None:
    model = cantilever()
    model.nodes(top=(0.6, 0, 0.3))
    plain = tool_compliance(model_with_block(model).place())
    model.beam("inside", "tip", "top", BAR)
    braced = model_with_block(model)
    np.testing.assert_allclose(tool_compliance(braced.place()), plain, rtol=1e-10, atol=1e-18)
    forces = solve(braced.place(), [wrench("push", "tip", 1.0, 2.0, 3.0)]).beam_forces
    # EA/L times a round-off of 1e-16 in the displacements
    assert np.abs(forces[1]).max() < 1e-6


def model_with_block(model: Model) -> Model:
    model.rigid("block", "tip", "top")
    return model


def test_a_batch_is_placed_and_indexed() -> None:
    placed = LIBRARY["hexapod"]().model.place()
    assert placed.batch == (7,)
    assert placed[2:4].batch == (2,)
    assert placed[3].batch == ()
    assert "batch (7,)" in repr(placed)
    assert system_of(placed[3]).poses == 1


def test_a_batch_may_have_several_axes() -> None:
    example = LIBRARY["three-legged frame"]()
    placement = example.model.placement()
    doubled = Placement(
        np.stack([placement.positions, placement.positions[::-1]]),
        np.stack([placement.frames, placement.frames[::-1]]),
        np.zeros((2, 5, 0)),
    )
    structure = example.model.structure()
    plain = solve(structure.at(placement), example.cases)
    found = solve(structure.at(doubled), example.cases)
    assert found.displacements.shape == (2, *plain.displacements.shape)
    np.testing.assert_allclose(
        found.displacements[1, ::-1], plain.displacements, rtol=1e-9, atol=1e-15
    )
    assert tool_compliance(structure.at(doubled)).shape == (2, 5, 6, 6)


def test_an_unreachable_pose_is_named_with_its_reason() -> None:
    placement = LIBRARY["hexapod"]().model.placement()
    status = np.zeros(7, dtype=np.int8)
    status[4] = 1
    bad = Placement(
        placement.positions, placement.frames, placement.values, (), status, ("leg 2 too short",)
    )
    structure = LIBRARY["hexapod"]().model.structure()
    with pytest.raises(UnreachableError, match="pose 4: cannot be reached: leg 2 too short"):
        structure.at(bad)
    assert structure.at(bad[bad.reachable]).batch == (6,)


def test_joint_nodes_apart_are_refused() -> None:
    model = LIBRARY["serial arm"]().model
    model.positions["s1"] = model.positions["s1"] + (0, 0, 0.0032)
    with pytest.raises(ModelError, match=r"joint J1: prismatic joint between .* 0.0032 m apart"):
        model.place()


def two_bodies() -> Model:
    model = Model("d")
    model.nodes(a=(0, 0, 0), b=(1, 0, 0), c=(1, 0, 0), d=(2, 0, 0))
    model.beam("ab", "a", "b", BAR)
    model.beam("cd", "c", "d", BAR)
    model.joint("J", "revolute", ("b", "c"))
    return model


def with_beams(*beams: Beam) -> Callable[[], Structure]:
    def make() -> Structure:
        structure = two_bodies().structure()
        return Structure(structure.linkage, (*structure.beams, *beams))

    return make


def loose_body() -> Structure:
    linkage = Linkage(("a", "b", "c"), (Body("arm", ("a", "b", "c")),), ())
    return Structure(linkage, (Beam("ab", ("a", "b"), STEEL, BAR),))


def shared_group() -> Structure:
    linkage = Linkage(("a", "b", "c"), (Body("arm", ("a", "b", "c")),), ())
    beams = (Beam("ab", ("a", "b"), STEEL, BAR), Beam("bc", ("b", "c"), STEEL, BAR))
    return Structure(linkage, beams, (), (Body("p", ("a", "b")), Body("q", ("b", "c"))))


@pytest.mark.parametrize(
    ("make", "part", "problem"),
    [
        (with_beams(Beam("ez", ("d", "zz"), STEEL, BAR)), "beam ez", 'unknown node "zz"'),
        (with_beams(Beam("bc", ("b", "c"), STEEL, BAR)), "beam bc", "different bodies"),
        (with_beams(Beam("ab", ("a", "b"), STEEL, BAR)), "part ab", "is defined twice"),
        (loose_body, "body arm", "nodes a, b, c are not held together by its beams"),
        (shared_group, "node b", "is in two rigid bodies"),
        (
            lambda: Structure(two_bodies().structure().linkage, masses=(PointMass("zz", 1.0),)),
            "mass at node zz",
            "unknown node",
        ),
        (
            lambda: Structure(
                two_bodies().structure().linkage, springs=(Spring("s", ("zz",), {"x": 1.0}),)
            ),
            "spring s",
            "unknown node",
        ),
    ],
)
def test_a_wrong_structure_is_refused_by_name(
    make: Callable[[], Structure], part: str, problem: str
) -> None:
    with pytest.raises(ModelError, match=re.escape(problem)) as caught:
        make()
    assert caught.value.part == part
    assert caught.value.remedy


def test_the_tool_is_needed_for_its_compliance() -> None:
    model = cantilever()
    model.tool = None
    with pytest.raises(ModelError, match="has no tool"):
        tool_compliance(model.place())
    # but not for load cases
    assert solve(model.place(), [wrench("push", "tip", 1.0)]).strain_energy[0] > 0


def test_a_joint_inside_one_rigid_body_has_nothing_to_hold() -> None:
    """Its rows vanish up to the rounding of coordinates that nearly coincide."""
    model = Model("tool")
    model.ground(base=(0, 0, 0))
    model.nodes(tool=(1, 0, 0), other=(1, 1e-10, 0))
    model.joint("hold", "revolute", ("base", "root"), (0, 0, 1), stiffness={"rz": 100.0})
    model.joint("idle", "spherical", ("tool", "other"))
    model.rigid("body", "root", "tool", "other")
    for method in ("saddle_point", "null_space", "condensed", "sparse"):
        found = solve(model.place(), [wrench("push", "tool", 0, 5.0)], method)  # type: ignore[arg-type]
        assert found.displacement("tool", "push")[5] == pytest.approx(0.05, rel=1e-9), method


def test_a_joint_between_two_ground_nodes_has_nothing_to_hold() -> None:
    model = cantilever()
    model.ground(g=(0, 0, 1), h=(0, 0, 1))
    model.joint("idle", "fixed", ("g", "h"))
    plain = cantilever()
    cases = [wrench("push", "tip", 0, 5.0, 1.0)]
    expected = solve(plain.place(), cases).displacement("tip", "push")
    for method in ("saddle_point", "null_space", "condensed", "sparse"):
        found = solve(model.place(), cases, method)  # type: ignore[arg-type]
        np.testing.assert_allclose(
            found.displacement("tip", "push"), expected, rtol=1e-9, atol=1e-18
        )
        assert not np.any(found.joint_force("idle", "push"))


def test_ground_may_be_absent() -> None:
    linkage = Linkage(("a",), (), ())
    placed = Structure(linkage, springs=(Spring("s", ("a",), {"x": 5.0, "y": 5.0, "z": 5.0}),))
    still = placed.at(Placement(np.zeros((1, 3)), np.zeros((0, 3, 3)), np.zeros(0)))
    found = solve(still, [LoadCase("f", (("a", (10.0, 0, 0, 0, 0, 0)),))])
    np.testing.assert_allclose(found.displacement("a", "f"), [2.0, 0, 0, 0, 0, 0], atol=1e-15)
    assert GROUND not in linkage.body_names
