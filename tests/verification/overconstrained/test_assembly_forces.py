"""Influence of misfits on joint forces against closed forms and the thesis's own solver.

@phdthesis{son2002,
  author = {Son, Seung-Kil},
  title  = {A Hybrid Type Small 5-Axis {CNC} Milling Machine},
  school = {Massachusetts Institute of Technology},
  year   = {2002}
}
@article{pellegrino1993,
  author  = {Pellegrino, Sergio},
  title   = {Structural computations with the singular value decomposition of the equilibrium
             matrix},
  journal = {International Journal of Solids and Structures},
  volume  = {30}, number = {21}, pages = {3025--3035}, year = {1993},
}

Exact. What is left is the round-off of a solve, 1e-10 of the largest force; where states of
self-stress are found by a null space beside it, 1e-9.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import null_space

from strutwork.kinematics import Poses, mobility
from strutwork.msa import PlacedStructure, Structure
from strutwork.overconstraint import (
    Influence,
    RigidAssembly,
    Tolerance,
    assembly_forces,
    influence,
    redundancy,
    rigid_equilibrium,
    tolerance_responses,
    worst_case,
)
from tests.assemblies import block_on_joints, square
from tests.linkages import gough
from tests.structure_cases import Example, bricard, four_bar, plate_on_four, stewart
from tests.structures import Model
from tests.verification.overconstrained.test_self_stress import softened


@pytest.mark.parametrize("leg", range(4))
def test_square_plate_on_four_equal_springs_one_longer(leg: int) -> None:
    """± k d/4, alternating around the plate: S = k/4 s sᵀ with s = (1, −1, 1, −1)."""
    k, d = 2e6, 1e-3
    placed = plate_on_four(stiffness={"z": k}).place()
    legs = [(f"support c{i}", "z") for i in range(4)]
    found = influence(placed, legs)
    assert found.redundant == 1
    signs = np.array([1.0, -1.0, 1.0, -1.0])
    np.testing.assert_allclose(square(found), k / 4 * np.outer(signs, signs), rtol=1e-12)
    forces = assembly_forces(found, {legs[leg]: d}).forces[:4, 2]
    np.testing.assert_allclose(forces, k * d / 4 * signs * signs[leg], rtol=1e-12)


def test_square_plate_at_worst() -> None:
    """Four legs each within ± d: k d in every one, and the sign pattern of the self-stress."""
    k, d = 2e6, 1e-3
    model = plate_on_four()
    model.joints = []
    for i in range(4):
        model.joint(f"leg{i}", "bushing", (f"c{i}.ground", f"c{i}"), stiffness={"z": k})
    tolerances = [Tolerance(f"length {i}", "length", (f"leg{i}",), size=d) for i in range(4)]
    asked = tolerance_responses(model.place(), tolerances)
    worst = worst_case(asked)
    for i in range(4):
        q = asked.index(f"leg{i}", "axial force")
        assert worst.value[q] == pytest.approx(k * d, rel=1e-12)
        np.testing.assert_allclose(np.abs(worst.misfits(q)), d, rtol=1e-12)
        np.testing.assert_allclose(worst.shares[q], 0.25, rtol=1e-12)


@pytest.mark.parametrize("count", [7, 9, 12])
def test_struts_beyond_six_follow_the_self_stress_formula(count: int) -> None:
    """A rigid platform on elastic struts: t = −S (Sᵀ F S)⁻¹ Sᵀ e, S from the struts' lines."""
    rng = np.random.default_rng(count)
    feet = rng.uniform(-1, 1, (count, 3)) * [1, 1, 0.2]
    heads = rng.uniform(-0.5, 0.5, (count, 3)) + np.array([0, 0, 1.0])
    stiffness = rng.uniform(1e7, 9e7, count)
    along = (heads - feet) / np.linalg.norm(heads - feet, axis=1)[:, None]
    model = Model("tool")
    model.nodes(tool=(0, 0, 1))
    for i in range(count):
        model.ground(**{f"base{i}": heads[i]})
        model.nodes(**{f"plate{i}": heads[i]})
        model.joint(
            f"strut{i}", "bushing", (f"base{i}", f"plate{i}"), along[i],
            stiffness={"z": stiffness[i]},
        )  # fmt: skip
    model.rigid("platform", "tool", *(f"plate{i}" for i in range(count)))
    found = influence(model.place())
    states = null_space(np.concatenate([along, np.cross(heads, along)], axis=1).T)
    assert found.redundant == states.shape[1] == count - 6
    flexibility = np.diag(1 / stiffness)
    # a gap closes a strut, an error lengthens it: the tension of a longer strut is negative
    tension_per_error = -states @ np.linalg.solve(states.T @ flexibility @ states, states.T)
    size = np.abs(tension_per_error).max()
    np.testing.assert_allclose(square(found), -tension_per_error, atol=1e-9 * size)


@pytest.mark.parametrize(
    ("example", "redundant"), [(four_bar(False), 3), (bricard(False), 1)], ids=["four-bar", "A04"]
)
def test_linkages_that_gruebler_counts_wrong(example: Example, redundant: int) -> None:
    """Four-bar in space: three redundant. Bricard (IFToMM A04): one. S has just their range."""
    stiff = example.model.place()
    assert redundancy(stiff).count == redundant
    soft = softened(stiff, np.random.default_rng(5))
    found = influence(soft)
    assert found.redundant == redundant
    states = np.array(
        [
            [state.forces.get(name, 0.0) for name in found.columns]
            for state in mobility(stiff.structure.linkage, stiff.placement).self_stress
        ]
    ).T
    assert states.shape[1] == redundant
    joints = {joint.name: joint for joint in soft.structure.linkage.joints}
    flexibility = np.diag([1 / joints[j].stiffness[d] for j, d in found.columns])
    expected = states @ np.linalg.solve(states.T @ flexibility @ states, states.T)
    matrix = square(found)
    # mixed N/m and N·m/rad, of like size for bars of half a metre
    np.testing.assert_allclose(matrix, expected, atol=1e-8 * np.abs(expected).max())
    sizes = np.linalg.svd(matrix, compute_uv=False)
    assert np.count_nonzero(sizes > 1e-10 * sizes[0]) == redundant


def legs_of(placed: PlacedStructure) -> Influence:
    return influence(placed, [(f"P{i}", "z") for i in range(6)])


@pytest.mark.parametrize("flexible", [False, True], ids=["rigid legs", "flexible legs"])
@pytest.mark.parametrize("lower", ["universal", "spherical"])
def test_six_ups_has_no_assembly_force_at_all(flexible: bool, lower: str) -> None:
    """No redundant constraint: zero to the last bit, for any error of any joint."""
    placed = stewart(lower, flexible).model.place()
    found = influence(placed)
    assert not np.any(found.redundant)
    assert not np.any(found.forces)
    # the platform moves all the same, by the inverse of the legs' Jacobian
    assert np.abs(legs_of(placed).tool).max() > 0.5


def test_six_ups_tool_moves_as_its_jacobian_says() -> None:
    """A leg longer by e moves the platform by x with aᵢ·x = e, aᵢ the leg's line."""
    machine = gough()
    poses = Poses.of([0.03, -0.02, 0.5])
    placement = machine.place(poses)
    model = Structure(machine.linkage).at(placement)
    found = influence(model, [(f"P{i}", "z") for i in range(1, 7)])
    index = machine.linkage.node_index
    heads = np.array([placement.positions[index[f"plate{i}"]] for i in range(1, 7)])
    feet = np.array([placement.positions[index[f"base{i}"]] for i in range(1, 7)])
    along = (heads - feet) / np.linalg.norm(heads - feet, axis=1)[:, None]
    arms = heads - placement.positions[index["tool"]]
    lines = np.concatenate([along, np.cross(arms, along)], axis=1)
    np.testing.assert_allclose(lines @ found.tool, np.eye(6), atol=1e-10)
    assert not np.any(found.forces)


@pytest.mark.parametrize("joints", [3, 6, 11])
@pytest.mark.parametrize("seed", range(4))
def test_the_thesis_solver_and_the_general_one_agree(joints: int, seed: int) -> None:
    """Equations 54 to 63 against the saddle-point system: forces, energy, place of the body."""
    model = block_on_joints(seed, joints)
    placed = model.place()
    linkage, placement = placed.structure.linkage, placed.placement
    found = influence(placed)
    frames = placement.frames
    stiffness = np.array([[joint.stiffness[d] for d in "xyz"] for joint in linkage.joints])
    points = np.array([model.positions[f"p{i}"] for i in range(joints)])
    rng = np.random.default_rng(seed)
    errors = rng.normal(size=(joints, 3)) * 1e-4
    # the error displaces the ground's side; the joint's own sign says which side that is
    sign = np.array([1.0 if i % 2 == 0 else -1.0 for i in range(joints)])
    local = np.einsum("jab,ja->jb", frames, errors) * sign[:, None]
    gaps = {(f"J{j}", d): local[j, i] for j in range(joints) for i, d in enumerate("xyz")}
    general = assembly_forces(found, gaps)
    tool = model.positions["tool"]
    thesis = rigid_equilibrium(
        RigidAssembly(points, frames @ (stiffness[:, :, None] * np.swapaxes(frames, -1, -2))),
        errors,
        tool,
    )
    on_second = np.einsum("jab,jb->ja", frames, general.forces[:, :3]) * sign[:, None]
    size = np.abs(thesis.forces).max()
    np.testing.assert_allclose(on_second, -thesis.forces, atol=1e-10 * size)
    moved = np.concatenate([thesis.translation, thesis.rotation])
    np.testing.assert_allclose(general.tool, moved, atol=1e-10 * np.abs(moved).max())
    vector = np.array([gaps[c] for c in found.columns])
    assert 0.5 * vector @ square(found) @ vector == pytest.approx(thesis.energy, rel=1e-9)


def test_the_thesis_solver_does_not_depend_on_its_reference_joint() -> None:
    rng = np.random.default_rng(3)
    points, errors = rng.uniform(-1, 1, (6, 3)), rng.normal(size=(6, 3)) * 1e-4
    assembly = RigidAssembly(points, rng.uniform(1e6, 9e6, (6, 3))[:, :, None] * np.eye(3))
    ways = [rigid_equilibrium(assembly, errors, points[i]) for i in range(6)]
    for way in ways[1:]:
        size = np.abs(ways[0].forces).max()
        np.testing.assert_allclose(way.forces, ways[0].forces, atol=1e-10 * size)
        np.testing.assert_allclose(way.rotation, ways[0].rotation, atol=1e-14)
    # the reference moves with the body
    apart = points[3] - points[0]
    np.testing.assert_allclose(
        ways[3].translation, ways[0].translation + np.cross(ways[0].rotation, apart), atol=1e-14
    )


def test_thesis_batch_equals_one_by_one() -> None:
    rng = np.random.default_rng(4)
    points, errors = rng.uniform(-1, 1, (5, 4, 3)), rng.normal(size=(5, 4, 3)) * 1e-4
    stiffness = rng.uniform(1e6, 9e6, (5, 4, 3))[..., None] * np.eye(3)
    batch = rigid_equilibrium(RigidAssembly(points, stiffness), errors)
    for i in range(5):
        one = rigid_equilibrium(RigidAssembly(points[i], stiffness[i]), errors[i])
        np.testing.assert_allclose(batch.forces[i], one.forces, atol=1e-12 * abs(one.forces).max())
        assert batch.energy[i] == pytest.approx(one.energy, rel=1e-12)
