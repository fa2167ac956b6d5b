"""NAFEMS FV32: free vibration of a cantilevered tapered membrane, with solids.

@techreport{nafems1990,
  title       = {Selected Benchmarks for Natural Frequency Analysis},
  author      = {Abbassian, F. and Dawswell, D. J. and Knowles, N. C.},
  institution = {NAFEMS},
  year        = {1990},
  note        = {Test FV32}
}

Length 10 m, 5 m wide at the root and 1 m at the tip, 0.05 m thick, plane stress: 44.623,
130.03, 162.70, 246.05, 379.90, 391.44 Hz. With solids one face is held across, the other is
free to thin; the root is held in the plane only.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.fea.solid_modes import solid_modes
from strutwork.meshes import hexahedral_block
from tests.solid_cases import matrices_of

TARGET = np.array([44.623, 130.03, 162.70, 246.05, 379.90, 391.44])


@pytest.mark.parametrize(
    ("divisions", "order", "tolerance"),
    [
        # the target's own five digits
        ((16, 8, 1), 2, 1e-4),
        # half the cells: fourth order in the size, 0.5 % at the fifth mode
        ((8, 4, 1), 2, 6e-3),
        # linear cells bend too stiffly: 1.2 % at the fifth mode, a quarter for half the size
        ((32, 16, 1), 1, 0.012),
    ],
)
def test_targets(divisions: tuple[int, int, int], order: int, tolerance: float) -> None:
    base = np.array([[0, -2.5, 0], [10, -0.5, 0], [10, 0.5, 0], [0, 2.5, 0]])
    mesh = hexahedral_block(np.vstack([base, base + np.array([0, 0, 0.05])]), divisions)
    found = solid_modes(matrices_of(mesh, order), 6, {"-x": "xy", "-z": "z"})
    assert found.rigid_body_modes == 0
    np.testing.assert_allclose(found.frequencies, TARGET, rtol=tolerance)
