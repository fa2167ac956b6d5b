"""The same structure in another frame gives the same physics.

Displacements and forces of a random frame and of the library's structures, turned and shifted.
Tolerance: turning a frame by a matrix good to 1e-16 changes a solution of condition 1e5 to 1e8
by 1e-11 to 1e-8 of its largest part.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from strutwork.msa import solve, tool_compliance
from tests.random_frames import random_frame, random_load
from tests.structure_cases import LIBRARY, Example, by_length
from tests.structures import turned_case

TOLERANCE = 1e-8
seeds = st.integers(0, 2**32 - 1)
TURNABLE = [
    name for name in LIBRARY if name not in ("beam on springs", "elastic table", "rigid table")
]


def assert_same_in_another_frame(example: Example, turn: Rotation, shift: np.ndarray) -> None:
    rotation = turn.as_matrix()
    here = example.model.place()
    there = example.model.turned(rotation, shift).place()
    one = solve(here, example.cases)
    other = solve(there, [turned_case(case, rotation) for case in example.cases])
    back = other.displacements.reshape(*other.displacements.shape[:-2], 2, 3, -1)
    back = np.einsum("ji,...kjm->...kim", rotation, back).reshape(other.displacements.shape)
    scale = example.length
    for found, expected in (
        (by_length(back, scale), by_length(one.displacements, scale)),
        # in joint and beam axes, which turn too
        (by_length(other.joint_forces, 1 / scale), by_length(one.joint_forces, 1 / scale)),
        (by_length(other.beam_forces, 1 / scale), by_length(one.beam_forces, 1 / scale)),
        (other.strain_energy, one.strain_energy),
    ):
        largest = np.abs(expected).max(initial=0.0)
        assert np.abs(found - expected).max(initial=0.0) <= TOLERANCE * largest


@pytest.mark.parametrize("name", TURNABLE)
def test_structures_of_the_library_turned(name: str) -> None:
    turn = Rotation.from_rotvec([1.2, -0.7, 2.1])
    assert_same_in_another_frame(LIBRARY[name](), turn, np.array([0.7, -1.3, 0.4]))


@pytest.mark.parametrize("quarter", range(1, 4))
@pytest.mark.parametrize("axis", "xyz")
def test_quarter_turns_pass_through_the_default_orientations(axis: str, quarter: int) -> None:
    turn = Rotation.from_euler(axis, 90 * quarter, degrees=True)
    assert_same_in_another_frame(LIBRARY["portal frame"](), turn, np.zeros(3))
    assert_same_in_another_frame(LIBRARY["cantilever"](), turn, np.zeros(3))


@given(
    seeds,
    st.lists(st.floats(-3, 3), min_size=3, max_size=3),
    st.lists(st.floats(-10, 10), min_size=3, max_size=3),
    st.booleans(),
)
def test_random_frames_turned_and_shifted(
    seed: int, turn: list[float], shift: list[float], joints: bool
) -> None:
    model = random_frame(seed, joints=joints)
    example = Example(model, (random_load(seed, model),), length=1.0)
    assert_same_in_another_frame(example, Rotation.from_rotvec(turn), np.asarray(shift))


@given(seeds, st.lists(st.floats(-3, 3), min_size=3, max_size=3))
def test_tool_compliance_turns_as_a_tensor(seed: int, turn: list[float]) -> None:
    rotation = Rotation.from_rotvec(turn).as_matrix()
    model = random_frame(seed, nodes=4, joints=True)
    six = np.kron(np.eye(2), rotation)
    expected = six @ tool_compliance(model.place()) @ six.T
    for method in ("saddle_point", "compiled"):
        found = tool_compliance(model.turned(rotation, (1.0, 2.0, 3.0)).place(), method)  # type: ignore[arg-type]
        assert np.abs(found - expected).max() <= TOLERANCE * np.abs(expected).max()


@given(seeds, st.floats(1e-2, 1e2))
def test_frames_of_another_size_follow_the_scaling_of_bending(seed: int, factor: float) -> None:
    """All lengths times s, forces times s², moments times s³: displacements times s."""
    model = random_frame(seed, nodes=4, shear=False)
    load = random_load(seed, model)
    plain = solve(model.place(), [load])
    model.positions = {n: p * factor for n, p in model.positions.items()}
    model.beams = [
        replace(
            b,
            section=replace(
                b.section,
                area=b.section.area * factor**2,
                second_moment_y=b.section.second_moment_y * factor**4,
                second_moment_z=b.section.second_moment_z * factor**4,
                torsion_constant=b.section.torsion_constant * factor**4,
            ),
        )
        for b in model.beams
    ]
    weight = np.repeat([factor**2, factor**3], 3)
    scaled = replace(
        load, wrenches=tuple((n, tuple((weight * six).tolist())) for n, six in load.wrenches)
    )
    found = solve(model.place(), [scaled])
    expected = by_length(plain.displacements, 1.0) * np.repeat([factor, 1.0], 3)[:, None]
    gap = by_length(found.displacements - expected, factor)
    assert np.abs(gap).max() <= TOLERANCE * np.abs(by_length(expected, factor)).max()
