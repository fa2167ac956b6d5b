"""Every structure of the library through every solver: they agree to 1e-9.

Compared are displacements with rotations times the example's length, and forces with moments
over it, both relative to the largest of all load cases: a joint that carries nothing has only
round-off to show. 1e-9 is asked by the project; the agreement seen is 1e-10 and better.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork import msa
from strutwork.errors import MechanismError, ModelError
from strutwork.kinematics import mobility
from strutwork.msa import PlacedStructure, StaticSolution, solve, system_of, tool_compliance
from strutwork.msa.compiled import compiled_compliance, program_of
from tests.structure_cases import LIBRARY, Example, by_length

TOLERANCE = 1e-9
names = pytest.mark.parametrize("name", LIBRARY)


def assert_close(found: NDArray[np.float64], expected: NDArray[np.float64]) -> None:
    largest = np.abs(expected).max(initial=0.0)
    assert np.abs(found - expected).max(initial=0.0) <= TOLERANCE * largest


def assert_same(found: StaticSolution, expected: StaticSolution, length: float) -> None:
    assert np.abs(expected.displacements).max() > 0.0
    for field, scale in (
        ("displacements", length),
        ("joint_forces", 1.0 / length),
        ("beam_forces", 1.0 / length),
    ):
        assert_close(
            by_length(getattr(found, field), scale), by_length(getattr(expected, field), scale)
        )
    assert_close(found.strain_energy, expected.strain_energy)


def placed(example: Example) -> PlacedStructure:
    result = example.model.place()
    assert result.batch in {(), (5,), (6,), (7,)}
    return result


@names
@pytest.mark.parametrize("method", ["null_space", "condensed"])
def test_stacked_solvers_agree_with_the_saddle_point_system(name: str, method: str) -> None:
    example = LIBRARY[name]()
    structure = placed(example)
    expected = solve(structure, example.cases, "saddle_point")
    found = solve(structure, example.cases, method)  # type: ignore[arg-type]
    assert (found.method, expected.method) == (method, "saddle_point")
    assert_same(found, expected, example.length)


@names
def test_the_sparse_solver_agrees_pose_by_pose(name: str) -> None:
    example = LIBRARY[name]()
    structure = placed(example)
    expected = solve(structure, example.cases, "saddle_point")
    for pose in np.ndindex(*structure.batch):
        found = solve(structure[pose], example.cases, "sparse")
        scale = example.length
        assert_close(
            by_length(found.displacements, scale), by_length(expected.displacements[pose], scale)
        )
        gap = by_length(found.joint_forces - expected.joint_forces[pose], 1 / scale)
        largest = np.abs(by_length(expected.joint_forces, 1 / scale)).max(initial=0.0)
        assert np.abs(gap).max(initial=0.0) <= TOLERANCE * largest


@names
def test_a_batch_gives_what_its_poses_give_alone(name: str) -> None:
    example = LIBRARY[name]()
    structure = placed(example)
    together = solve(structure, example.cases)
    for pose in np.ndindex(*structure.batch):
        alone = solve(structure[pose], example.cases, "saddle_point")
        assert alone.displacements.shape == together.displacements[pose].shape
        assert_close(
            by_length(alone.displacements, example.length),
            by_length(together.displacements[pose], example.length),
        )


@names
def test_tool_compliance_is_the_same_by_every_method(name: str) -> None:
    example = LIBRARY[name]()
    structure = placed(example)
    program = program_of(system_of(structure))
    # a coordinate that follows another is no direction of one frame: the kernel leaves it
    tied = bool(structure.structure.linkage.ties)
    assert (program is None) == tied
    methods = ("null_space", "condensed", *(() if tied else ("compiled",)))
    if program is not None:
        assert (len(program.loops.joint) > 0) == example.loops
    if not example.held:
        for method in ("saddle_point", *methods):
            with pytest.raises(MechanismError, match="mechanism under its load"):
                tool_compliance(structure, method)
        return
    weight = np.repeat([1.0, 1.0 / example.length], 3)
    expected = tool_compliance(structure, "saddle_point") * weight[:, None] * weight
    assert np.linalg.eigvalsh(expected).min() >= -1e-12 * np.abs(expected).max()
    for method in methods:
        found = tool_compliance(structure, method) * weight[:, None] * weight
        assert_close(found, expected)
    # the kernel itself vouches for every pose: none is left to another solver
    if program is not None:
        alone, again = compiled_compliance(system_of(structure), program)
        assert not again.any()
        assert_close(alone * weight[:, None] * weight, expected.reshape(-1, 6, 6))
    for pose in np.ndindex(*structure.batch):
        found = tool_compliance(structure[pose], "sparse") * weight[:, None] * weight
        assert_close(found, expected[pose])


def test_the_three_legged_frame_has_84_degrees_of_freedom_in_20_elements() -> None:
    structure = LIBRARY["three-legged frame"]().model.structure()
    held = 3
    assert len(structure.segments) == 20
    assert 6 * (structure.vertex_count - held) == 84


def test_redundant_rows_of_the_library_are_counted_by_rank() -> None:
    counts = {
        name: mobility(
            (structure := LIBRARY[name]().model.place()).structure.linkage,
            structure.placement[(0,) * len(structure.batch)],
        ).redundant
        for name in LIBRARY
    }
    assert counts["four-bar, rigid"] == 3
    assert counts["Bricard, rigid"] == 1
    assert counts["rigid table"] == 1
    assert counts["door on two hinges"] == 5
    assert counts["hexapod, rigid struts"] == counts["hexapod, rigid spinning struts"] == 0


@names
def test_joint_forces_hold_every_body_in_balance(name: str) -> None:
    """Newton's third law and statics alone: no stiffness enters this check."""
    example = LIBRARY[name]()
    structure = placed(example)
    linkage = structure.structure.linkage
    found = solve(structure, example.cases)
    positions, frames = structure.placement.positions, structure.placement.frames
    ends = [[linkage.node_index[n] for n in joint.between] for joint in linkage.joints]
    largest = np.abs(by_length(found.joint_forces, 1 / example.length)).max(initial=1.0)
    for m, case in enumerate(example.cases):
        if case.gravity is not None or case.line_loads:
            continue
        force = np.zeros((*structure.batch, len(linkage.nodes), 6))
        for node, six in case.wrenches:
            force[..., linkage.node_index[node], :] += six
        carried = found.joint_forces[..., m].copy()
        for tie in linkage.ties:
            # a coupling turns back on the joint that leads, whose own force it is not
            if tie.other_joint != tie.joint:
                back = tie.ratio * found.joint_forces[..., tie.joint, tie.direction, m]
                carried[..., tie.other_joint, tie.other_direction] -= back
        for j, (first, second) in enumerate(ends):
            six = carried[..., j, :].reshape(*structure.batch, 2, 3)
            turned = np.einsum("...ij,...kj->...ki", frames[..., j, :, :], six)
            for node, sign in ((first, -1.0), (second, 1.0)):
                force[..., node, :] += sign * turned.reshape(*structure.batch, 6)
        for spring in structure.structure.springs:
            index = [linkage.node_index[n] for n in spring.nodes]
            u = found.displacements[..., index, :, m]
            pull = spring.diagonal * (u[..., -1, :] - (u[..., 0, :] if len(index) == 2 else 0.0))
            for node, sign in zip(reversed(index), (-1.0, 1.0), strict=False):
                force[..., node, :] += sign * pull
        for b in range(len(linkage.body_names)):
            members = np.flatnonzero(linkage.body_of_node == b)
            total = force[..., members, :3].sum(axis=-2)
            moments = force[..., 3:] + np.cross(positions, force[..., :3])
            moment = moments[..., members, :].sum(axis=-2)
            # the residual of the equilibrium is refined to about 1e-12 of the largest force
            assert np.abs(total).max() <= 1e-8 * largest
            assert np.abs(moment).max() <= 1e-8 * largest


def test_methods_are_named() -> None:
    assert set(msa.METHODS) == {"saddle_point", "null_space", "condensed", "sparse"}
    example = LIBRARY["cantilever"]()
    with pytest.raises(ModelError, match='unknown method "magic"'):
        solve(example.model.place(), example.cases, "magic")  # type: ignore[arg-type]
    with pytest.raises(ModelError, match='unknown method "magic"'):
        tool_compliance(example.model.place(), "magic")  # type: ignore[arg-type]
    frame = LIBRARY["three-legged frame"]()
    # the sparse solver takes one pose: a batch is solved pose by pose
    one_by_one = solve(frame.model.place(), frame.cases, "sparse")
    together = solve(frame.model.place(), frame.cases, "saddle_point")
    np.testing.assert_allclose(
        one_by_one.displacements, together.displacements, rtol=1e-7, atol=1e-15
    )
