"""Closed loops in the compiled kernel: right values, and doubt where they are not sure."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import MechanismError
from strutwork.machines import HexelHexapod
from strutwork.machines.model_file import read_model
from strutwork.msa import PlacedStructure, compliance_and_outcome, system_of, tool_compliance
from strutwork.msa.compiled import compiled_compliance, program_of
from tests.structure_cases import stewart
from tests.structures import Model

#: Asked by the project.
TOLERANCE = 1e-9

Array = NDArray[np.float64]

CASES = Path(__file__).parents[1] / "cases" / "models"


def rotations_as(length: float) -> Array:
    weight = np.repeat([1.0, 1.0 / length], 3)
    return np.asarray(weight[:, None] * weight)


def assert_vouched(placed: PlacedStructure, length: float = 0.3, share: float = 1.0) -> None:
    """The kernel vouches for this share of the poses, and agrees with the saddle point there."""
    system = system_of(placed)
    program = program_of(system)
    assert program is not None
    found, again = compiled_compliance(system, program)
    assert (~again).mean() >= share
    expected = tool_compliance(placed, "saddle_point").reshape(-1, 6, 6)
    error = np.abs((found - expected) * rotations_as(length)).max(axis=(1, 2))
    size = np.abs(expected * rotations_as(length)).max(axis=(1, 2))
    assert np.all(error[~again] <= TOLERANCE * size[~again])


def hexapod(count: int, **options: float) -> PlacedStructure:
    random = np.random.default_rng(4)
    machine = HexelHexapod(**options)
    poses = machine.poses(random.uniform(-0.1, 0.1, count), random.uniform(-0.6, 0.6, count))
    return machine.structure.at(machine.place(poses))


def test_a_hexapod_of_rods_at_many_poses() -> None:
    assert_vouched(hexapod(300))


@pytest.mark.parametrize("lower", ["universal", "spherical"])
@pytest.mark.parametrize("flexible", [True, False])
def test_hexapods_of_beams_and_of_rigid_struts_with_and_without_idle_spins(
    lower: str, flexible: bool
) -> None:
    assert_vouched(stewart(lower, flexible, poses=60).model.place())


def aligned_struts(**ram: object) -> Model:
    """Six struts on balls whose axes run along the struts: pure spins are coordinates."""
    model = Model("tool")
    model.nodes(tool=(0.02, 0.01, 0.5))
    for i in range(6):
        a, b = np.radians([60 * i + 20 * (-1) ** i, 60 * i - 15 * (-1) ** i])
        foot = np.array([0.4 * np.cos(a), 0.4 * np.sin(a), 0.0])
        head = np.array([0.2 * np.cos(b) + 0.02, 0.2 * np.sin(b) + 0.01, 0.48])
        model.ground(**{f"base{i}": foot})
        model.nodes(**{f"plate{i}": head, f"slide{i}": (foot + head) / 2})
        model.joint(f"A{i}", "spherical", (f"base{i}", f"foot{i}"), head - foot)
        options = {"driven": ("z",), "stiffness": {"z": 3e7}} if i or not ram else ram
        model.joint(f"P{i}", "prismatic", (f"slide{i}", f"rod{i}"), head - foot, **options)
        model.joint(f"B{i}", "spherical", (f"head{i}", f"plate{i}"), head - foot)
        model.rigid(f"cylinder{i}", f"foot{i}", f"slide{i}")
        model.rigid(f"piston{i}", f"rod{i}", f"head{i}")
    model.rigid("platform", "tool", *(f"plate{i}" for i in range(6)))
    return model


def test_spins_along_the_joints_axes_are_idle_and_leave_the_stiffness() -> None:
    assert_vouched(aligned_struts().place())


def test_bushings_between_rods_and_platform() -> None:
    model = Model("tool")
    model.nodes(tool=(0.0, 0.0, 0.5))
    soft = {"x": 3e6, "y": 4e6, "z": 9e7}
    for i in range(6):
        a, b = np.radians([60 * i + 20 * (-1) ** i, 60 * i - 15 * (-1) ** i])
        foot = np.array([0.4 * np.cos(a), 0.4 * np.sin(a), 0.0])
        head = np.array([0.2 * np.cos(b), 0.2 * np.sin(b), 0.48])
        model.ground(**{f"base{i}": foot})
        model.nodes(**{f"plate{i}": head})
        model.joint(f"A{i}", "spherical", (f"base{i}", f"foot{i}"), head - foot)
        model.joint(f"B{i}", "bushing", (f"head{i}", f"plate{i}"), head - foot, stiffness=soft)
        model.rigid(f"rod{i}", f"foot{i}", f"head{i}")
    model.rigid("platform", "tool", *(f"plate{i}" for i in range(6)))
    assert_vouched(model.place())


def test_a_loop_with_a_drive_that_nothing_holds_is_a_mechanism() -> None:
    placed = aligned_struts(driven=()).place()
    for method in ("saddle_point", "compiled"):
        with pytest.raises(MechanismError, match="mechanism under its load"):
            tool_compliance(placed, method)  # type: ignore[arg-type]


def test_locked_drives_leave_a_tool_that_does_not_move() -> None:
    machine = HexelHexapod(leg_stiffness=None)
    random = np.random.default_rng(1)
    poses = machine.poses(random.uniform(-0.1, 0.1, 300), random.uniform(-0.5, 0.5, 300))
    found = tool_compliance(machine.structure.at(machine.place(poses)), "compiled")
    assert np.abs(found).max() <= 1e-20


@pytest.mark.parametrize(
    "name",
    ["f3c_door_4_digits", "f4_frame_on_2Hz_mounts", "f4d_slender_300", "f6_400_joints"],
)
def test_a_structure_that_costs_digits_is_left_to_the_refined_solution(name: str) -> None:
    """Without it the kernel is off by 6e-6, 2e-8, 1e-8 and 2e-9."""
    placed = read_model(CASES / f"{name}.toml").placed
    found = tool_compliance(placed, "compiled")
    expected = tool_compliance(placed)
    assert np.abs(found - expected).max() <= TOLERANCE * np.abs(expected).max()


def parallelogram(angle: Array) -> PlacedStructure:
    """Two cranks of 0.3 m and a coupler of 0.5 m; singular where all lie in line."""
    model = Model("tool")
    turn = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
    left, right = np.zeros(3), np.array([0.5, 0.0, 0.0])
    model.ground(left=left, right=right)
    model.nodes(top=left + 0.3 * turn, other=right + 0.3 * turn, tool=0.3 * turn + 0.5 * right)
    model.joint("A", "revolute", ("left", "a"), driven=("rz",), stiffness={"rz": 5e3})
    model.joint("B", "revolute", ("top", "b"))
    model.joint("C", "revolute", ("other", "c"))
    model.joint("D", "revolute", ("right", "d"))
    model.rigid("crank", "a", "top")
    model.rigid("coupler", "b", "c", "tool")
    model.rigid("follower", "d", "other")
    return model.place()


def test_a_loop_is_solved_again_where_it_is_singular() -> None:
    placed = parallelogram(np.linspace(-1.0, 1.0, 9))
    system = system_of(placed)
    program = program_of(system)
    assert program is not None
    _, again = compiled_compliance(system, program)
    assert again.tolist() == [False] * 4 + [True] + [False] * 4
    # in line the follower is free to turn against the crank: more motion than the loop has
    found, outcome = compliance_and_outcome(placed, "compiled")
    expected, same = compliance_and_outcome(placed, "saddle_point")
    assert outcome.solved.tolist() == same.solved.tolist()
    np.testing.assert_allclose(
        found[outcome.solved], expected[outcome.solved], rtol=1e-7, atol=1e-15
    )


def test_a_choice_made_on_singular_poses_is_made_again() -> None:
    structure = parallelogram(np.zeros(300)).structure
    for angle, share in ((np.zeros(300), 0.0), (np.linspace(0.2, 1.0, 300), 1.0)):
        placed = replace(parallelogram(angle), structure=structure)
        compliance_and_outcome(placed, "compiled")
        system = system_of(placed)
        program = program_of(system)
        assert program is not None
        _, again = compiled_compliance(system, program)
        assert (~again).mean() == share
