"""Forces per unit misfit: what is asked, what cannot be answered, and odd structures."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import (
    InconsistentConstraintsError,
    MechanismError,
    ModelError,
    NumericalError,
)
from strutwork.kinematics import Poses
from strutwork.msa import LoadCase, PlacedStructure, Spring, Structure, rigid_map, solve
from strutwork.overconstraint import (
    Quantity,
    RigidAssembly,
    Tolerance,
    assembly_forces,
    influence,
    joint_quantities,
    misfit_sources,
    redundancy,
    responses,
    rigid_equilibrium,
    tolerance_responses,
    worst_case,
)
from tests.assemblies import block_on_joints, square, unbalanced
from tests.linkages import gough
from tests.structure_cases import (
    bricard,
    door_on_two_hinges,
    four_bar,
    plate_on_four,
    rigid_table,
    stewart,
    tripod_machine,
)
from tests.structures import BAR, Model, every_direction

Array = NDArray[Any]


def same(placed: PlacedStructure, columns: list[tuple[str, str]]) -> None:
    """The influence of misfits is what a solve with each of them says."""
    found = influence(placed, columns)
    cases = [LoadCase(f"{j} {d}", gaps={(j, d): 1.0}) for j, d in columns]
    solution = solve(placed, cases, "null_space")
    size = np.abs(solution.joint_forces).max()
    np.testing.assert_allclose(found.forces, solution.joint_forces, atol=1e-9 * size)


def test_default_columns_are_what_resists_in_joints_that_are_no_supports() -> None:
    placed = tripod_machine().model.place()
    columns = influence(placed).columns
    assert ("P0", "z") in columns  # a drive is held
    assert ("P0", "rz") in columns
    assert ("R0", "rz") not in columns
    assert not any(joint.startswith("support") for joint, _ in columns)


def test_misfits_of_supports_are_answered_when_they_are_asked_for() -> None:
    placed = plate_on_four(stiffness={"z": 2e6}).place()
    assert influence(placed).columns == ()
    same(placed, [(f"support c{i}", "z") for i in range(4)])


def test_misfits_of_held_drives_at_a_batch_of_poses() -> None:
    """A hexapod whose first and fourth balls have seized: three rows each too many."""
    model = stewart().model
    model.joints = [replace(j, type="fixed") if j.name in ("S0", "S3") else j for j in model.joints]
    placed = model.place()
    columns = [("P1", "z"), ("S3", "rx"), ("U0", "ry"), ("P0", "rz")]
    same(placed, columns)
    found = influence(placed, columns)
    assert found.forces.shape == (7, 18, 6, 4)
    np.testing.assert_array_equal(found.redundant, 6)
    for i in range(7):
        alone = influence(placed[i], columns)
        size = np.abs(alone.forces).max()
        np.testing.assert_allclose(found.forces[i], alone.forces, atol=1e-9 * size)
        np.testing.assert_array_equal(found[i].redundant, alone.redundant)


def test_springs_close_loops_as_joints_do() -> None:
    """Two springs to ground beside a clamp: redundant, and the clamp feels its own misfit."""
    model = Model("tool")
    model.nodes(tool=(0.4, 0.1, 0.0), root=(0, 0, 0))
    model.ground(wall=(0, 0, 0))
    model.joint("clamp", "fixed", ("wall", "root"))
    model.rigid("arm", "root", "tool")
    bare = influence(model.place())
    assert bare.redundant == 0
    assert not np.any(bare.forces)
    model.springs.append(Spring("stop", ("tool",), {"z": 3e5}))
    found = influence(model.place())
    assert found.redundant == 1
    # the clamp 1 mm too high lifts the spring by 1 mm
    force = assembly_forces(found, {("clamp", "z"): 1e-3}).forces[0]
    np.testing.assert_allclose(force, [0, 0, 300.0, 300.0 * 0.1, -300.0 * 0.4, 0], atol=1e-9)


@dataclass(frozen=True)
class Cube:
    """An element that stands for a solid: a stiffness between two nodes of one body."""

    name: str
    nodes: tuple[str, ...]

    def stiffness(self, at: PlacedStructure) -> Array:
        index = at.structure.linkage.node_index
        first, second = (at.placement.positions[..., index[n], :] for n in self.nodes)
        carry = np.concatenate(
            [-rigid_map(second - first), np.broadcast_to(np.eye(6), (*first.shape[:-1], 6, 6))], -1
        )
        own = np.diag([3e7, 2e7, 4e7, 3e5, 2e5, 5e5])
        return np.asarray(np.swapaxes(carry, -1, -2) @ own @ carry)


def test_elements_beside_beams_share_their_forces() -> None:
    """A body of a beam and an element on the same nodes, clamped at both ends."""
    model = Model("mid")
    model.nodes(a=(0, 0, 0), mid=(0.4, 0, 0), b=(0.8, 0.1, 0))
    for name in "ab":
        model.ground(**{f"g{name}": model.positions[name]})
        model.joint(name.upper(), "fixed", (f"g{name}", name))
    model.beam("left", "a", "mid", BAR)
    model.beam("right", "mid", "b", BAR)
    plain = model.structure()
    doubled = Structure(
        plain.linkage, plain.beams, elements=(Cube("cube", ("a", "mid")), Cube("top", ("mid", "b")))
    )
    found, alone = (influence(s.at(model.placement())) for s in (doubled, plain))
    assert found.redundant == alone.redundant == 6
    matrix = square(found)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-9 * np.abs(matrix).max())
    # more stiffness, more force for the same misfit
    assert np.all(np.diagonal(matrix) > np.diagonal(square(alone)))
    forces = assembly_forces(found, {("A", "z"): 1e-4, ("B", "rx"): 1e-3}).forces
    assert np.abs(unbalanced(model.place(), forces)).max() < 1e-9 * np.abs(forces).max()


def test_without_a_tool_forces_are_the_same() -> None:
    with_tool, without = (block_on_joints(7, 4, tool=t).place() for t in ("tool", None))
    # the tool's place is drawn first, so take the same model and drop it
    bare = replace(with_tool.structure.linkage, tool=None)
    dropped = Structure(bare).at(with_tool.placement)
    one, two = influence(with_tool), influence(dropped)
    np.testing.assert_allclose(two.forces, one.forces, rtol=1e-9, atol=1e-6)
    np.testing.assert_array_equal(two.tool, 0.0)
    asked = tolerance_responses(without, [Tolerance("a", "position", ("J0",), size=1e-5)])
    assert all(quantity.joint is not None for quantity in asked.quantities)


def test_one_joint_carries_nothing() -> None:
    model = Model("tool")
    model.nodes(tool=(0, 0, 1))
    model.ground(wall=(0, 0, 0))
    model.joint("clamp", "fixed", ("wall", "foot"))
    model.rigid("post", "tool", "foot")
    tolerance = Tolerance("axis", "parallelism", ("clamp",), slope=1e-3)
    worst = worst_case(tolerance_responses(model.place(), [tolerance]))
    tool = [q.joint is None for q in worst.responses.quantities]
    np.testing.assert_array_equal(worst.value[~np.array(tool)], 0.0)
    np.testing.assert_allclose(worst.value[tool], [1e-3, 1e-3, 0, 1e-3, 1e-3, 0], atol=1e-15)


def test_no_joint_at_all() -> None:
    model = Model("tool")
    model.nodes(tool=(0, 0, 1))
    model.springs.append(Spring("mount", ("tool",), every_direction(1e5)))
    found = influence(model.place())
    assert found.forces.shape == (0, 6, 0)
    assert found.tool.shape == (6, 0)
    assert found.redundant == 0
    asked = tolerance_responses(model.place(), [])
    np.testing.assert_array_equal(worst_case(asked).value, 0.0)


def test_no_pose_at_all() -> None:
    placed = block_on_joints(1).place()
    none = placed.structure.at(placed.placement[None][:0])
    found = influence(none)
    assert found.forces.shape == (0, 4, 6, 12)
    worst = worst_case(tolerance_responses(none, []))
    assert worst.value.shape == (0, 14)
    assert worst.shares.shape == (0, 14, 0)


def test_near_a_singular_pose_the_forces_stay_exactly_zero_and_the_tool_runs_away() -> None:
    """A Gough platform turned towards 90°, where its legs meet one line: no force, ever."""
    machine = gough()
    turns = np.radians([0.0, 60.0, 85.0, 89.0, 89.99])
    rotation = np.array(
        [[[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]] for t in turns]
    )
    poses = Poses(np.tile([0.0, 0.0, 0.5], (5, 1)), rotation)
    placed = Structure(machine.linkage).at(machine.place(poses))
    found = influence(placed, [("P1", "z")])
    assert not np.any(found.forces)
    moved = np.abs(found.tool).max(axis=(1, 2))
    assert np.all(np.isfinite(moved))
    assert moved[-1] > 1e3 * moved[0]


@pytest.mark.parametrize("turn", [90.0, 90.0 - 1e-8])
def test_at_a_singular_pose_the_platform_moves(turn: float) -> None:
    machine = gough()
    t = np.radians(turn)
    rotation = np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])
    placed = Structure(machine.linkage).at(machine.place(Poses(np.array([0.0, 0, 0.5]), rotation)))
    # the misfit cannot be met where the rods do not hold the platform's turn
    with pytest.raises((InconsistentConstraintsError, NumericalError), match=r"(?s)P1.*\n.+"):
        influence(placed, [("P1", "z")])


def test_a_free_motion_along_which_a_misfit_moves_the_tool_names_its_joints() -> None:
    free = four_bar(True).model
    free.joints = [replace(j, driven=(), stiffness={}) for j in free.joints]
    with pytest.raises(MechanismError, match="R1 in rz") as caught:
        influence(free.place())
    assert "mechanism" in caught.value.problem
    assert 'the tool "tool"' in caught.value.problem
    assert "Lock, drive or spring" in caught.value.remedy


def test_free_motions_change_no_force() -> None:
    """What misfits lock in across the plane does not ask whether the crank is held."""
    free, held = four_bar(True).model, four_bar(True).model
    free.tool = held.tool = None
    free.joints = [replace(j, driven=(), stiffness={}) for j in free.joints]
    columns = [("R4", "rx"), ("R2", "z"), ("R3", "x")]
    expected = influence(held.place(), columns).forces
    found = influence(free.place(), columns).forces
    assert np.abs(expected).max() > 1e3
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-7 * np.abs(expected).max())


def test_struts_that_spin_between_two_balls_are_let_pass() -> None:
    machine = gough("spherical")
    placed = Structure(machine.linkage).at(machine.place(machine.home()))
    found = influence(placed)
    assert not np.any(found.forces)
    bare = Structure(replace(machine.linkage, tool=None)).at(machine.place(machine.home()))
    assert not np.any(influence(bare).forces)


@pytest.mark.parametrize(
    ("model", "names"),
    [
        (four_bar(False).model, ("R1", "R2", "R3", "R4")),
        (bricard(False).model, ("R1", "R6")),
        (door_on_two_hinges().model, ("lower", "upper")),
    ],
    ids=["four-bar", "Bricard", "door"],
)
def test_a_loop_of_rigid_parts_takes_an_infinite_force(
    model: Model, names: tuple[str, ...]
) -> None:
    with pytest.raises(InconsistentConstraintsError, match="infinite force") as caught:
        influence(model.place())
    assert all(name in caught.value.part for name in names)
    assert "rigid loop" in caught.value.problem
    assert "stiffness" in caught.value.remedy


def test_a_loop_of_rigid_supports_takes_an_infinite_force() -> None:
    with pytest.raises(InconsistentConstraintsError, match="support c0"):
        influence(rigid_table().model.place(), [("support c0", "z")])


def test_a_tolerance_on_a_rigid_loop_names_it_too() -> None:
    tolerance = Tolerance("bore", "position", ("lower",), size=1e-5)
    with pytest.raises(InconsistentConstraintsError, match=r"lower.*rigid loop"):
        tolerance_responses(door_on_two_hinges().model.place(), [tolerance])


@pytest.mark.parametrize("column", [("J9", "x"), ("J0", "rx"), ("J0", "w")])
def test_columns_that_are_no_misfits_are_errors(column: tuple[str, str]) -> None:
    with pytest.raises(ModelError, match=column[0]) as caught:
        influence(block_on_joints(1).place(), [column])
    assert caught.value.remedy


def test_misfits_without_a_column_are_errors() -> None:
    placed = block_on_joints(1).place()
    found = influence(placed, [("J0", "x")])
    with pytest.raises(ModelError, match="joint J0: has no column for a misfit in y") as caught:
        assembly_forces(found, {("J0", "y"): 1e-5})
    assert caught.value.remedy
    sources = misfit_sources(placed, [Tolerance("a", "position", ("J1",), size=1e-5)])
    with pytest.raises(ModelError, match="joint J1: its misfit in"):
        responses(found, sources)


def test_quantities_that_are_not_there_are_errors() -> None:
    placed = block_on_joints(1).place()
    asked = tolerance_responses(placed, [Tolerance("a", "position", ("J0",), size=1e-5)])
    with pytest.raises(ModelError, match='joint J0: has no "torque"') as caught:
        asked.index("J0", "torque")
    assert "J0 radial force" in caught.value.remedy
    with pytest.raises(ModelError, match="joint K: is not in the linkage"):
        responses(asked.influence, asked.sources, [Quantity("K", "axial force", ("z",), "N")])


def test_quantities_are_what_the_joints_can_carry() -> None:
    linkage = tripod_machine().model.structure().linkage
    kinds: dict[str | None, list[str]] = {}
    for quantity in joint_quantities(linkage):
        kinds.setdefault(quantity.joint, []).append(quantity.kind)
    assert kinds["R0"] == ["radial force", "axial force", "bending moment"]
    assert kinds["S0"] == ["radial force", "axial force"]
    assert kinds["P0"] == ["radial force", "axial force", "bending moment", "torque"]
    assert quantity.unit in ("N", "N*m")


def test_results_say_what_they_are() -> None:
    found = influence(block_on_joints(1).place())
    result = assembly_forces(found, {("J0", "x"): 1e-5})
    table = result.to_dict()
    np.testing.assert_allclose(table["joint_forces"]["J0"], result.forces[0])
    np.testing.assert_allclose(table["tool"], result.tool)
    assert "4 joints, 12 misfits" in repr(found)
    assert "6 states of self-stress" in repr(redundancy(block_on_joints(1).place()))


def test_the_thesis_solver_refuses_what_it_cannot_hold() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    stiffness = np.broadcast_to(1e6 * np.eye(3), (3, 3, 3))
    with pytest.raises(MechanismError, match="free to move") as caught:
        rigid_equilibrium(RigidAssembly(points, stiffness), np.zeros((3, 3)))
    assert "six independent directions" in caught.value.remedy
    with pytest.raises(ModelError, match=r"points \(3, 3\)"):
        RigidAssembly(points, stiffness[:2])
    with pytest.raises(ModelError, match="not finite"):
        RigidAssembly(points * np.nan, stiffness)
