"""NAFEMS FV12: free vibration of a thin square plate, with solids.

@techreport{nafems1990,
  title       = {Selected Benchmarks for Natural Frequency Analysis},
  author      = {Abbassian, F. and Dawswell, D. J. and Knowles, N. C.},
  institution = {NAFEMS},
  year        = {1990},
  note        = {Test FV12}
}

10 x 10 x 0.05 m, free but for the in-plane directions, which solids have held in the middle
plane only: held through the thickness they could not bend. Modes 1 to 3 are rigid. Modes 4 to
10: 1.622, 2.360, 2.922, 4.233 (2), 7.416 (2) Hz. The targets of 4.233 and 7.416 are those of a
mesh of eight by eight shells; converged sources give 4.190 and 7.356.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.fea.solid_modes import SolidModes, solid_modes
from strutwork.fea.solid_supports import Supports
from strutwork.meshes import block
from tests.solid_cases import matrices_of

TARGET = np.array([1.622, 2.360, 2.922, 4.233, 4.233, 7.416, 7.416])
CONVERGED = np.array([1.622, 2.360, 2.922, 4.190, 4.190, 7.356, 7.356])


def plate(cells: int) -> SolidModes:
    matrices = matrices_of(block((10.0, 10.0, 0.05), (cells, cells, 1)))
    middle = np.flatnonzero(np.abs(matrices.points[:, 2] - 0.025) < 1e-9)
    dofs = np.sort(np.concatenate([3 * middle, 3 * middle + 1]))
    return solid_modes(matrices, 10, Supports(dofs, np.zeros(len(dofs))))


def test_targets_with_twelve_cells_a_side() -> None:
    found = plate(12)
    assert found.rigid_body_modes == 3
    flexible = found.frequencies[3:]
    # the targets' own error is 1 % (their converged values below)
    np.testing.assert_allclose(flexible, TARGET, rtol=0.01)
    # pairs stay pairs on a mesh with the symmetry of the square, to the rounding of a plate 200
    # times as wide as thick
    np.testing.assert_allclose(flexible[[3, 5]], flexible[[4, 6]], rtol=1e-7)


@pytest.mark.slow
def test_converged_values() -> None:
    coarse, fine = (plate(n).frequencies[3:] for n in (12, 24))
    # from above, as displacement elements must
    assert np.all(fine < coarse)
    # four digits are printed; at cells 8 times as wide as thick the mesh leaves 0.4 %
    np.testing.assert_allclose(fine, CONVERGED, rtol=4e-3)
