"""Bathe and Wilson's plane frame: ten bays, nine storeys, lumped masses.

@article{bathe1973,
  title   = {Solution Methods for Eigenvalue Problems in Structural Mechanics},
  author  = {Bathe, Klaus-J{\\"u}rgen and Wilson, Edward L.},
  journal = {International Journal for Numerical Methods in Engineering},
  volume  = {6},
  pages   = {213--226},
  year    = {1973}
}

Bays of 20 ft, storeys of 10 ft, A = 3, I = 1, E = 432000, mass 3 per length, in the source's
units; ω² = 0.589541, 5.52695, 16.5878. Lumped masses leave every rotation without mass.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.fea import modes
from strutwork.msa import Material, PlacedStructure, Section
from tests.structures import Model

PUBLISHED = [0.589541, 5.52695, 16.5878]
MATERIAL = Material(432000.0, 432000.0 / 2.6, density=1.0)
SECTION = Section(3.0, 1.0, 1.0, 1.0)


def frame() -> PlacedStructure:
    model = Model()
    for i in range(11):
        for j in range(10):
            here = f"n{i}.{j}"
            model.nodes(**{here: (20.0 * i, 10.0 * j, 0.0)})
            model.support(here, *(("z", "rx", "ry") if j else ()))
            beside = [f"n{i}.{j - 1}"] if j else []
            beside += [f"n{i - 1}.{j}"] if i and j else []
            for other in beside:
                model.beam(
                    f"{other} {here}", other, here, SECTION, MATERIAL, shear=False, mass="lumped"
                )
    return model.place()


@pytest.mark.parametrize("method", ["dense", "sparse"])
def test_three_lowest_eigenvalues(method: str) -> None:
    found = modes(frame(), 3, method=method)  # type: ignore[arg-type]
    # published to six digits, cut and not rounded: one unit of the last
    gap = (2 * np.pi * found.frequencies) ** 2 - PUBLISHED
    assert np.all(np.abs(gap) < [1e-6, 1e-5, 1e-4])


def test_rotations_without_mass_have_no_frequency() -> None:
    found = modes(frame(), 1000)
    # 99 free nodes with two translations each
    assert len(found.frequencies) == 198
    assert "198 exist" in found.note
