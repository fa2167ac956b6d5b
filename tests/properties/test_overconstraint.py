"""Laws of assembly forces: reciprocity, energy, balance, one answer in every frame and order."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.kinematics import DIRECTIONS, JOINT_TYPES
from strutwork.msa import LoadCase, PlacedStructure, Structure, solve
from strutwork.overconstraint import (
    Influence,
    MisfitSources,
    RigidAssembly,
    Tolerance,
    assembly_forces,
    influence,
    misfit_sources,
    redundancy,
    rigid_equilibrium,
    tolerance_responses,
    worst_case,
)
from tests.assemblies import block_on_joints, inside, random_machine, square, unbalanced
from tests.structures import Model, vector

Array = NDArray[Any]

seeds = st.integers(0, 2**32 - 1)
counts = st.integers(3, 8)
# solutions of condition 1e5 to 1e8 with one step of refinement
SOLVED = 1e-9


def random_gap(seed: int, found: Influence) -> Array:
    rng = np.random.default_rng(seed + 1)
    return np.asarray(rng.normal(size=len(found.columns)) * 1e-4)


def in_metres(found: Influence) -> Array:
    """S with turns measured by what they move at 0.5 m, all of it in N/m."""
    scale = np.array([2.0 if d.startswith("r") else 1.0 for _, d in found.columns])
    return np.asarray(square(found) * scale * scale[:, None])


@given(seeds)
@settings(max_examples=60)
def test_s_is_symmetric_semidefinite_and_of_the_redundancy_rank(seed: int) -> None:
    placed = random_machine(seed).place()
    found = influence(placed)
    unit = in_metres(found)
    assert np.abs(unit - unit.T).max() <= SOLVED * np.abs(unit).max()
    sizes = np.linalg.eigvalsh((unit + unit.T) / 2)
    assert sizes.min() >= -SOLVED * sizes.max()
    count = int(redundancy(placed).count)
    assert count > 0
    assert np.count_nonzero(sizes > SOLVED * sizes.max()) == count


@given(seeds)
@settings(max_examples=60)
def test_energy_tool_and_forces_are_those_of_a_solve_with_the_same_gaps(seed: int) -> None:
    placed = random_machine(seed).place()
    found = influence(placed)
    gap = random_gap(seed, found)
    case = LoadCase("misfits", gaps=dict(zip(found.columns, gap.tolist(), strict=True)))
    solution = solve(placed, [case], "null_space")
    mine = assembly_forces(found, gap)
    energy = solution.strain_energy[0]
    # reciprocity is the energy's: what the gaps' springs store and what the forces do on them
    assert abs(0.5 * gap @ square(found) @ gap - energy) <= SOLVED * energy
    size = np.abs(solution.joint_forces).max()
    assert np.abs(mine.forces - solution.joint_forces[..., 0]).max() <= SOLVED * size
    tool = solution.displacement("tool", "misfits")
    assert np.abs(mine.tool - tool).max() <= SOLVED * np.abs(tool).max()


@given(seeds)
@settings(max_examples=60)
def test_forces_are_in_balance_on_every_body(seed: int) -> None:
    placed = random_machine(seed, 4).place()
    found = influence(placed)
    forces = assembly_forces(found, random_gap(seed, found)).forces
    assert np.abs(unbalanced(placed, forces)).max() <= 1e-8 * np.abs(forces).max()


@given(seeds, st.floats(-1e3, 1e3))
def test_forces_are_linear_in_misfits(seed: int, factor: float) -> None:
    placed = block_on_joints(seed).place()
    found = influence(placed)
    one, two = random_gap(seed, found), random_gap(seed + 1, found)
    names = found.columns
    whole = solve(
        placed,
        [
            LoadCase("one", gaps=dict(zip(names, one.tolist(), strict=True))),
            LoadCase("sum", gaps=dict(zip(names, (one + factor * two).tolist(), strict=True))),
        ],
    )
    second = assembly_forces(found, two).forces
    expected = whole.joint_forces[..., 0] + factor * second
    size = np.abs(whole.joint_forces[..., 0]).max() + abs(factor) * np.abs(second).max()
    assert np.abs(whole.joint_forces[..., 1] - expected).max() <= SOLVED * size


@given(seeds, counts)
def test_thesis_solver_equals_the_general_one(seed: int, joints: int) -> None:
    """Son 2002, equations 54 to 63, for any block on elastic joints."""
    model = block_on_joints(seed, joints)
    placed = model.place()
    frames, linkage = placed.placement.frames, placed.structure.linkage
    diagonal = np.array([[joint.stiffness[d] for d in "xyz"] for joint in linkage.joints])
    stiffness = frames @ (diagonal[:, :, None] * np.swapaxes(frames, -1, -2))
    points = np.array([model.positions[f"p{i}"] for i in range(joints)])
    errors = np.random.default_rng(seed).normal(size=(joints, 3)) * 1e-4
    thesis = rigid_equilibrium(RigidAssembly(points, stiffness), errors, points.mean(axis=0))
    sign = np.where(np.arange(joints) % 2 == 0, 1.0, -1.0)[:, None]
    local = np.einsum("jab,ja->jb", frames, errors) * sign
    found = influence(placed)
    general = assembly_forces(
        found, np.array([local[int(j[1:]), "xyz".index(d)] for j, d in found.columns])
    )
    on_block = np.einsum("jab,jb->ja", frames, general.forces[:, :3]) * sign
    size = np.abs(stiffness @ errors[..., None]).max()
    assert np.abs(on_block + thesis.forces).max() <= 1e-10 * size


@given(seeds, st.booleans())
@settings(max_examples=60)
def test_forces_do_not_depend_on_the_frame(seed: int, machine: bool) -> None:
    """The same in joint axes; the tool turns with the model."""
    model = random_machine(seed) if machine else block_on_joints(seed)
    turn = Rotation.random(random_state=seed % 2**31).as_matrix()
    other = influence(model.turned(turn, (1.0, -2.0, 0.5)).place())
    found = influence(model.place())
    assert other.columns == found.columns
    gap = random_gap(seed, found)
    one, two = assembly_forces(found, gap), assembly_forces(other, gap)
    assert np.abs(two.forces - one.forces).max() <= SOLVED * np.abs(one.forces).max()
    tool = (one.tool.reshape(2, 3) @ turn.T).ravel()
    assert np.abs(two.tool - tool).max() <= SOLVED * np.abs(tool).max()


@given(seeds)
@settings(max_examples=60)
def test_forces_do_not_depend_on_the_order_of_joints_and_nodes(seed: int) -> None:
    placed = random_machine(seed).place()
    order = np.random.default_rng(seed).permutation(len(placed.structure.linkage.joints))
    nodes = np.random.default_rng(seed + 1).permutation(len(placed.structure.linkage.nodes))
    linkage = placed.structure.linkage
    shuffled = replace(
        linkage,
        joints=tuple(linkage.joints[i] for i in order),
        nodes=tuple(linkage.nodes[i] for i in nodes),
    )
    placement = replace(
        placed.placement,
        positions=placed.placement.positions[nodes],
        frames=placed.placement.frames[order],
    )
    found, other = (
        influence(placed),
        influence(replace(placed.structure, linkage=shuffled).at(placement)),
    )
    gap = dict(zip(found.columns, random_gap(seed, found).tolist(), strict=True))
    one, two = assembly_forces(found, gap), assembly_forces(other, gap)
    assert np.abs(two.forces - one.forces[order]).max() <= SOLVED * np.abs(one.forces).max()
    assert np.abs(two.tool - one.tool).max() <= SOLVED * np.abs(one.tool).max()


@given(seeds)
def test_a_joint_seen_from_its_other_side_carries_the_same(seed: int) -> None:
    """Sides swapped: the misfit and the force change sign, in the same axes."""
    model = block_on_joints(seed)
    found = influence(model.place())
    model.joints = [replace(j, between=j.between[::-1]) for j in model.joints]
    other = influence(model.place())
    size = np.abs(found.forces).max()
    assert np.abs(other.forces - found.forces).max() <= SOLVED * size
    assert np.abs(other.tool + found.tool).max() <= SOLVED * np.abs(found.tool).max()


@given(seeds)
def test_misfits_that_a_motion_of_the_block_can_meet_cost_nothing(seed: int) -> None:
    """The ground's sides moved as one rigid body: the block follows."""
    model = block_on_joints(seed)
    placed = model.place()
    found = influence(placed)
    twist = np.random.default_rng(seed).normal(size=6) * 1e-4
    gap = []
    for joint, d in found.columns:
        j = int(joint[1:])
        moved = twist[:3] + np.cross(twist[3:], model.positions[f"p{j}"])
        axis = placed.placement.frames[j][:, "xyz".index(d)]
        gap.append((1.0 if j % 2 == 0 else -1.0) * float(axis @ moved))
    result = assembly_forces(found, np.array(gap))
    assert np.abs(result.forces).max() <= SOLVED * np.abs(found.forces).max() * np.abs(gap).max()
    tool = np.array([*(twist[:3] + np.cross(twist[3:], model.positions["tool"])), *twist[3:]])
    assert np.abs(result.tool - tool).max() <= SOLVED * np.abs(tool).max()


@given(seeds)
@settings(max_examples=30)
def test_a_batch_of_poses_equals_pose_by_pose(seed: int) -> None:
    model = block_on_joints(seed, 3, "all")
    placed = model.place()
    turns = Rotation.random(4, random_state=seed % 2**31).as_matrix()
    moved = [model.turned(turn).placement() for turn in turns]
    # another frame of each joint at each pose, by no motion of the model alone
    spins = Rotation.random(4 * 3, random_state=seed % 2**31).as_matrix().reshape(4, 3, 3, 3)
    placement = replace(
        placed.placement,
        positions=np.stack([m.positions for m in moved]),
        frames=np.stack([m.frames for m in moved]) @ spins,
        values=np.zeros((4, 0)),
        status=np.zeros(4, dtype=np.int8),
    )
    batch = placed.structure.at(placement)
    tolerances = zones("J0", "J1", "J2")
    together = worst_case(tolerance_responses(batch, tolerances))
    for i in range(4):
        alone = worst_case(tolerance_responses(batch[i], tolerances))
        size = alone.value.max()
        assert np.abs(together.value[i] - alone.value).max() <= 1e-8 * size
        assert np.abs(together.shares[i] - alone.shares).max() <= 1e-6


def zones(first: str, second: str, third: str) -> list[Tolerance]:
    """A tolerance of every kind on three joints."""
    return [
        Tolerance("tilt", "parallelism", (first, second), slope=3e-4),
        Tolerance("square", "perpendicularity", (third,), size=2e-5, length=0.2),
        Tolerance("place", "position", (second,), size=3e-5),
        Tolerance("bore", "coaxiality", (second, third), size=3e-5, length=0.3),
        Tolerance("centre", "point_position", (third,), size=3e-5),
        Tolerance("face", "location", (second,), size=2e-5, length=0.3, width=0.1),
        Tolerance("seats", "flatness", (first, second, third), size=1e-5),
        Tolerance("long", "length", (first,), limits=(-1e-5, 3e-5)),
    ]


@given(seeds)
@settings(max_examples=50)
def test_no_combination_exceeds_the_worst_and_one_reaches_it(seed: int) -> None:
    placed = block_on_joints(seed, 5, "all").place()
    # features on ground and on the block, by the joints' first sides
    tolerances = zones("J0", "J2", "J4") + [
        replace(t, name=f"block {t.name}") for t in zones("J1", "J3", "J0")[2:5]
    ]
    asked = tolerance_responses(placed, tolerances)
    worst = worst_case(asked)
    rng = np.random.default_rng(seed)
    uniform = rng.random((2000, asked.sources.parameters))
    for edge in (False, True):
        z = inside(asked.sources, uniform, edge)
        force = np.linalg.norm(asked.mean + np.einsum("qik,sk->sqi", asked.gain, z), axis=-1)
        assert np.all(force <= worst.bound * (1 + 1e-12))
    reached = asked.mean + np.einsum("qik,qk->qi", asked.gain, worst.parameters)
    np.testing.assert_allclose(np.linalg.norm(reached, axis=-1), worst.value, rtol=1e-8)
    assert np.all(worst.bound >= worst.value)
    assert np.all(worst.bound <= worst.value * (1 + 1e-8))
    # by the forces of the misfits themselves
    for q in (0, 4, len(asked.quantities) - 1):
        quantity = asked.quantities[q]
        got = assembly_forces(asked.influence, _in_columns(asked.sources, worst.misfits(q)))
        six = got.tool if quantity.joint is None else got.forces[int(quantity.joint[1:])]
        parts = [six[("x", "y", "z", "rx", "ry", "rz").index(d)] for d in quantity.directions]
        np.testing.assert_allclose(np.linalg.norm(parts), worst.value[q], rtol=1e-8)


def _in_columns(sources: MisfitSources, misfits: Array) -> dict[tuple[str, str], float]:
    return dict(zip(sources.columns, misfits.tolist(), strict=True))


@given(seeds)
@settings(max_examples=50)
def test_worst_cases_do_not_depend_on_the_frame(seed: int) -> None:
    """Axes and directions of the zones turn with the model, their parameters may not."""
    model = block_on_joints(seed, 4, "all")
    tolerances = [
        replace(t, along=vector(np.random.default_rng(seed).normal(size=3)))
        for t in zones("J0", "J2", "J1")
    ]
    turn = Rotation.random(random_state=seed % 2**31).as_matrix()
    other = [replace(t, along=vector(turn @ np.asarray(t.along))) for t in tolerances]
    one = tolerance_responses(model.place(), tolerances)
    two = tolerance_responses(model.turned(turn, (0.3, 2.0, -1.0)).place(), other)
    joints = [i for i, q in enumerate(one.quantities) if q.joint is not None]
    first, second = worst_case(one), worst_case(two)
    np.testing.assert_allclose(
        second.value[joints], first.value[joints], rtol=1e-7, atol=1e-9 * first.value[joints].max()
    )


@given(seeds, st.floats(0.1, 10.0))
@settings(max_examples=50)
def test_worst_cases_scale_with_the_tolerances(seed: int, factor: float) -> None:
    placed = block_on_joints(seed, 4, "all").place()
    one = [t for t in zones("J0", "J2", "J1") if t.kind != "length"]
    two = [
        replace(t, slope=t.slope * factor) if t.slope else replace(t, size=(t.size or 0) * factor)
        for t in one
    ]
    first, second = (worst_case(tolerance_responses(placed, t)) for t in (one, two))
    np.testing.assert_allclose(second.value, factor * first.value, rtol=1e-8)
    np.testing.assert_allclose(second.shares, first.shares, atol=1e-4)
    np.testing.assert_allclose(first.shares.sum(axis=-1), 1.0, rtol=1e-8)


@given(seeds)
@settings(max_examples=30)
def test_joints_of_a_tree_carry_nothing(seed: int) -> None:
    """Without the bushings the machine is a tree: no redundancy, no force, to the last bit."""
    model = random_machine(seed)
    model.joints = [
        replace(j, driven=tuple(d for d in DIRECTIONS if d not in JOINT_TYPES[j.type]))
        for j in model.joints
        if j.name.startswith("T")
    ]
    placed: PlacedStructure = model.place()
    assert isinstance(placed.structure, Structure)
    found = influence(placed)
    assert found.redundant == 0
    assert not np.any(found.forces)
    assert np.any(found.tool)


def test_sources_are_the_same_at_every_pose_of_one_geometry() -> None:
    model: Model = block_on_joints(1, 3, "all")
    placed = model.place()
    twice = placed.structure.at(placed.placement[None])
    one, two = (misfit_sources(p, zones("J0", "J2", "J1")) for p in (placed, twice))
    np.testing.assert_array_equal(two.map[0], one.map)
    assert two.columns == one.columns
