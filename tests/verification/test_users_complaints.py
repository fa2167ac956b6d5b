"""What users of other codes complain of in vibration, shown not to happen here.

Collected from public issue trackers and forums of structural codes: constraints that bring
frequencies of their own, a shift of zero that loses one of a pair, masses that do not add up,
results that depend on how the model lies in space.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.fea import Port, frequency_response, modes
from strutwork.fea.damping import LossFactor
from strutwork.msa import PlacedStructure, PointMass, rectangle
from strutwork.msa.mass import mass_properties
from tests.structure_cases import LIBRARY
from tests.structures import STEEL, Model

WITH_MASS = [name for name in LIBRARY if LIBRARY[name]().model.beams]


def free_square_beam(elements: int = 10) -> Model:
    model = Model()
    model.nodes(a=(0, 0, 0), b=(1.0, 0, 0))
    model.beam("beam", "a", "b", rectangle(0.03, 0.03), STEEL, elements=elements)
    return model


def chained(elements: int) -> Model:
    """The same beam in pieces that fixed joints hold together: 6 rows a piece."""
    model = Model()
    for i in range(elements):
        ends = {f"a{i}": (i / elements, 0, 0), f"b{i}": ((i + 1) / elements, 0, 0)}
        model.nodes(**ends)
        model.beam(f"piece{i}", f"a{i}", f"b{i}", rectangle(0.03, 0.03), STEEL)
        if i:
            model.joint(f"weld{i}", "fixed", (f"b{i - 1}", f"a{i}"))
    return model


@pytest.mark.parametrize("method", ["dense", "sparse"])
def test_constraints_bring_no_frequency_of_their_own(method: str) -> None:
    """Complaint 2: welds of constraint rows give just the modes of the beam in one piece."""
    whole = modes(free_square_beam().place(), 22)
    welded = modes(chained(10).place(), 22, method=method)  # type: ignore[arg-type]
    assert welded.rigid_body_modes == whole.rigid_body_modes == 6
    np.testing.assert_allclose(welded.frequencies, whole.frequencies, rtol=1e-9)


def test_constraints_leave_as_many_modes_as_coordinates() -> None:
    found = modes(chained(10).place(), 1000)
    assert len(found.frequencies) == 66
    assert found.frequencies[6] == pytest.approx(156.3, rel=0.01)
    # the highest is the axial wave of the mesh, √12 c/h/2π, and no constraint's
    wave = np.sqrt(12) * np.sqrt(205e9 / 7870.0) / 0.1 / (2 * np.pi)
    assert found.frequencies[-1] < 1.5 * wave


@pytest.mark.parametrize("method", ["dense", "sparse"])
def test_a_free_structure_keeps_both_of_every_pair(method: str) -> None:
    """Complaint 3: bending of a square bar comes in pairs."""
    found = modes(free_square_beam(30).place(), 20, method=method)  # type: ignore[arg-type]
    assert found.rigid_body_modes == 6
    sideways = np.abs(found.shapes[6:, :, 1:3]).max(axis=(1, 2))
    along = np.abs(found.shapes[6:, :, [0]]).max(axis=(1, 2))
    twist = np.abs(found.shapes[6:, :, 3]).max(axis=1) * 0.03
    bending = (sideways > along) & (sideways > twist)
    frequencies = found.frequencies[6:][bending]
    pairs = frequencies[: len(frequencies) // 2 * 2].reshape(-1, 2)
    assert len(pairs) >= 4
    np.testing.assert_allclose(pairs[:, 0], pairs[:, 1], rtol=1e-8)
    assert np.all(np.diff(pairs[:, 0]) > 1.0)


def test_masses_add_up() -> None:
    """Complaint 4: total, and effective masses of all modes of a free structure."""
    model = free_square_beam()
    inertia = ((0.02, 0.0, 0.0), (0.0, 0.03, 0.001), (0.0, 0.001, 0.04))
    model.masses.append(PointMass("b", 2.5, inertia, (0.0, 0.05, 0.0)))
    placed = model.place()
    found = modes(placed, 1000)
    by_hand = 7870.0 * 0.03**2 * 1.0 + 2.5
    assert mass_properties(placed).total == pytest.approx(by_hand, rel=1e-12)
    np.testing.assert_allclose(found.total_mass[:3], by_hand, rtol=1e-12)
    # rounding of as many squares as there are modes
    np.testing.assert_allclose(found.effective_mass.sum(axis=0), found.total_mass, rtol=1e-9)
    # a free body's translations are all in its rigid-body modes
    np.testing.assert_allclose(found.effective_mass[6:, :3], 0.0, atol=1e-9 * by_hand)


def with_mass(name: str) -> PlacedStructure:
    model = LIBRARY[name]().model
    if name == "tripod of pinned rods":
        model.masses.append(PointMass("hub", 1.0, ((0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1))))
    return model.place()


@pytest.mark.parametrize("name", WITH_MASS)
def test_held_structures_move_less_than_their_mass(name: str) -> None:
    placed = with_mass(name)
    found = modes(placed, 1000)
    assert np.all(
        found.effective_mass[..., :3].sum(axis=-2) <= found.total_mass[..., :3] * (1 + 1e-9)
    )
    assert np.all(found.total_mass[..., 0] > 0)


def test_results_do_not_depend_on_how_the_model_lies() -> None:
    """Complaint 7, for modes and responses."""
    turn = Rotation.from_euler("xyz", [0.3, -1.1, 2.0]).as_matrix()
    model = LIBRARY["offset bracket"]().model
    here, there = model.place(), model.turned(turn, (5.0, -2.0, 3.0)).place()
    first, second = modes(here, 12), modes(there, 12)
    np.testing.assert_allclose(second.frequencies, first.frequencies, rtol=1e-10)
    lines = [20.0, 90.0, 400.0]

    def response(placed: PlacedStructure, axes: np.ndarray) -> np.ndarray:
        ports = [Port("tip", (*map(float, axis), 0.0, 0.0, 0.0)) for axis in axes]
        return frequency_response(placed, ports, ports, lines, LossFactor(0.05)).receptance

    expected = response(here, np.eye(3))
    found = response(there, turn.T)
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()
