"""Damped modes against roots of characteristic polynomials."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import LossFactor, ModalRatio, PartDamping, Rayleigh, complex_modes, modes
from tests.structures import Model
from tests.vibration import heavy, oscillators

PARTS = PartDamping(materials=False)


def with_dashpots(model: Model, *values: float) -> Model:
    model.joints = [
        replace(joint, damping={"z": c}) if c else joint
        for joint, c in zip(model.joints, values, strict=True)
    ]
    return model


def upper(roots: np.ndarray) -> np.ndarray:
    chosen = roots[roots.imag >= 0]
    return chosen[np.argsort(np.abs(chosen), kind="stable")]


def test_two_masses_with_a_dashpot_on_one() -> None:
    """det(s²M + sC + K): the dashpot couples the undamped modes."""
    k1, m1, k2, m2, c = 2e5, 3.0, 9e4, 1.0, 120.0
    placed = with_dashpots(oscillators((k1, m1), (k2, m2)), 0.0, c).place()
    found = complex_modes(placed, PARTS)
    first = np.poly1d([m1, c, k1 + k2])
    second = np.poly1d([m2, c, k2])
    between = np.poly1d([c, k2])
    roots = upper((first * second - between**2).roots)
    # roots of a polynomial of fourth degree, conditioned to about 1e-13
    np.testing.assert_allclose(found.eigenvalues, roots, rtol=1e-10)
    np.testing.assert_allclose(found.frequencies, np.abs(roots) / (2 * np.pi), rtol=1e-10)
    np.testing.assert_allclose(found.damping_ratios, -roots.real / np.abs(roots), rtol=1e-9)
    # the second row of the problem: x1 : x2 = (m2 s² + c s + k2) : (c s + k2)
    index = placed.structure.mesh_index
    ratio = found.shapes[:, index["m1"], 0] / found.shapes[:, index["m2"], 0]
    np.testing.assert_allclose(ratio, second(roots) / between(roots), rtol=1e-9)
    assert np.abs(ratio.imag).max() > 1e-2
    np.testing.assert_allclose(np.abs(found.shapes).reshape(2, -1).max(axis=1), 1.0)


def test_beyond_critical_there_are_two_decays() -> None:
    k, m, c = 100.0, 1.0, 50.0
    found = complex_modes(with_dashpots(oscillators((k, m)), c).place(), PARTS)
    roots = np.roots([m, c, k])
    np.testing.assert_allclose(np.sort(found.eigenvalues.real), np.sort(roots), rtol=1e-12)
    assert not np.any(found.eigenvalues.imag)
    np.testing.assert_allclose(found.damping_ratios, 1.0)


def test_critical_damping() -> None:
    found = complex_modes(with_dashpots(oscillators((100.0, 1.0)), 20.0).place(), PARTS)
    # a double root moves by the square root of rounding
    np.testing.assert_allclose(found.eigenvalues, -10.0, rtol=1e-6)
    np.testing.assert_allclose(found.damping_ratios, 1.0, rtol=1e-6)


@pytest.mark.parametrize("stiffness", [1e3, 1e12])
def test_a_rigid_body_mode_is_one_mode_at_zero(stiffness: float) -> None:
    """However stiff the rest: no slow mode is taken for a rigid one, and none the other way."""
    model = with_dashpots(oscillators((0.0, 2.0), (0.5, 3.0), (stiffness, 1.0)), 0.0, 0.1, 0.0)
    found = complex_modes(model.place(), PARTS)
    assert found.eigenvalues[0] == 0.0
    assert found.frequencies[0] == found.damping_ratios[0] == 0.0
    assert len(found.frequencies) == 3
    # m1 against m2 and m3 together, 2 and 4 kg, where the last spring is rigid beside the other
    reduced = 2.0 * 4.0 / 6.0
    slow = upper(np.roots([reduced, 0.1, 0.5]))[0]
    np.testing.assert_allclose(found.eigenvalues[1], slow, rtol=2e-3 if stiffness == 1e3 else 1e-6)
    shape = found.shapes[0][[placed_index(model, f"m{i}") for i in (1, 2, 3)], 0]
    np.testing.assert_allclose(shape, 1.0, rtol=1e-9)


def placed_index(model: Model, node: str) -> int:
    return model.structure().mesh_index[node]


def test_a_body_that_a_dashpot_drags_creeps_to_rest() -> None:
    model = with_dashpots(oscillators((0.0, 4.0)), 10.0)
    found = complex_modes(model.place(), PARTS)
    np.testing.assert_allclose(found.eigenvalues, [0.0, -2.5], atol=1e-12)
    np.testing.assert_allclose(found.damping_ratios, [0.0, 1.0], atol=1e-12)


def test_a_dragged_body_on_a_spring_and_a_dashpot() -> None:
    c1, m1, k, c2, m2 = 30.0, 2.0, 5e3, 4.0, 1.0
    model = with_dashpots(oscillators((0.0, m1), (k, m2)), c1, c2)
    found = complex_modes(model.place(), PARTS)
    first, second = np.poly1d([m1, c1 + c2, k]), np.poly1d([m2, c2, k])
    roots = (first * second - np.poly1d([c2, k]) ** 2).roots
    roots = upper(roots[np.abs(roots) > 1e-6])
    np.testing.assert_allclose(found.eigenvalues, [0.0, *roots], rtol=1e-9, atol=1e-12)


def test_a_dashpot_on_a_part_without_mass() -> None:
    """Spring and dashpot side by side, then a spring: m s² + k2 (k1 + c s)/(k1 + k2 + c s) = 0."""
    k1, k2, c, m = 3e4, 5e4, 200.0, 2.0
    model = with_dashpots(oscillators((k1, 0.0), (k2, m)), c, 0.0)
    found = complex_modes(model.place(), PARTS)
    roots = upper(np.roots([m * c, m * (k1 + k2), k2 * c, k2 * k1]))
    np.testing.assert_allclose(found.eigenvalues, roots, rtol=1e-9)
    # and without the dashpot it follows statically: two springs in series
    still = complex_modes(oscillators((k1, 0.0), (k2, m)).place(), LossFactor(0.1))
    series = np.sqrt(k1 * k2 / (k1 + k2) / m * (1 + 0.1j))
    np.testing.assert_allclose(still.eigenvalues, [1j * series], rtol=1e-10)


def test_a_loss_factor_turns_the_stiffness() -> None:
    """s = i ω √(1 + iη), the root that decays."""
    placed = heavy("hexapod").place()[0]
    plain = modes(placed, 6)
    found = complex_modes(placed, LossFactor(0.2), 6)
    expected = 2j * np.pi * plain.frequencies * np.sqrt(1 + 0.2j)
    np.testing.assert_allclose(found.eigenvalues, expected, rtol=1e-8)
    assert np.all(found.eigenvalues.real < 0)
    np.testing.assert_allclose(found.damping_ratios, np.sin(np.arctan(0.2) / 2), rtol=1e-8)


@pytest.mark.parametrize("name", ["hexapod", "floating frame", "three-legged frame"])
def test_proportional_damping_leaves_the_undamped_modes(name: str) -> None:
    placed = heavy(name).place()
    placed = placed[(0,) * len(placed.batch)]
    plain = modes(placed, 12)
    found = complex_modes(placed, ModalRatio(0.05), 12)
    flexible = plain.frequencies > 0
    np.testing.assert_allclose(found.frequencies[flexible], plain.frequencies[flexible], rtol=1e-8)
    np.testing.assert_allclose(found.damping_ratios[flexible], 0.05, rtol=1e-7)
    assert np.all(found.eigenvalues[~flexible] == 0.0)


def test_rayleigh_damping() -> None:
    placed = heavy("hexapod").place()[0]
    omega = 2 * np.pi * modes(placed, 6).frequencies
    found = complex_modes(placed, Rayleigh(3.0, 1e-5), 6)
    np.testing.assert_allclose(found.damping_ratios, 1.5 / omega + 0.5e-5 * omega, rtol=1e-7)
    # mass-proportional damping drags a free body: v' = −α v
    free = complex_modes(oscillators((0.0, 2.0)).place(), Rayleigh(3.0, 0.0))
    np.testing.assert_allclose(free.eigenvalues, [0.0, -3.0])


def test_the_count_asked_for() -> None:
    placed = heavy("hexapod").place()[0]
    assert len(complex_modes(placed, ModalRatio(0.01), 4).frequencies) == 4
    assert "4 modes, Hz" in repr(complex_modes(placed, ModalRatio(0.01), 4))


def test_bad_input() -> None:
    placed = heavy("hexapod").place()
    with pytest.raises(ModelError, match="of 7 poses"):
        complex_modes(placed, ModalRatio(0.01))
    with pytest.raises(ModelError, match="0 asked for"):
        complex_modes(placed[0], ModalRatio(0.01), 0)
    with pytest.raises(ModelError, match="has no mass"):
        complex_modes(oscillators((1e4, 0.0)).place(), ModalRatio(0.01))
