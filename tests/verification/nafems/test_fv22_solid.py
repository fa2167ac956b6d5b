"""NAFEMS FV22: free vibration of a clamped thick rhombic plate, with solids.

@techreport{nafems1990,
  title       = {Selected Benchmarks for Natural Frequency Analysis},
  author      = {Abbassian, F. and Dawswell, D. J. and Knowles, N. C.},
  institution = {NAFEMS},
  year        = {1990},
  note        = {Test FV22}
}

Side 10 m, thickness 1 m, skew 45 degrees: 133.95, 201.41, 265.81, 283.68, 334.45 Hz.

The targets are those of thick plates, which know no strain through the thickness. A clamped
edge of a solid can be read in two ways: all of the face held, which also keeps it from
thickening and is stiffer than the plate; or the in-plane directions of the face and the
middle line across, which lets it warp and is softer. Converged, the targets lie between.
"""

from __future__ import annotations

import numpy as np

from strutwork.fea.solid_modes import solid_modes
from strutwork.fea.solid_supports import Supports
from strutwork.meshes import hexahedral_block
from tests.solid_cases import matrices_of

TARGET = np.array([133.95, 201.41, 265.81, 283.68, 334.45])


def test_targets_lie_between_the_two_ways_to_clamp_a_solid() -> None:
    c = 10.0 * np.sqrt(0.5)
    base = np.array([[0, 0, 0], [10, 0, 0], [10 + c, c, 0], [c, c, 0]])
    mesh = hexahedral_block(np.vstack([base, base + np.array([0, 0, 1])]), (12, 12, 2))
    matrices = matrices_of(mesh)
    edge = np.unique(
        np.concatenate([matrices.nodes_of_set(side) for side in ("-x", "+x", "-y", "+y")])
    )
    middle = edge[np.abs(matrices.points[edge, 2] - 0.5) < 1e-9]
    stiff = np.sort(np.concatenate([3 * edge, 3 * edge + 1, 3 * edge + 2]))
    soft = np.sort(np.concatenate([3 * edge, 3 * edge + 1, 3 * middle + 2]))
    upper, lower = (
        solid_modes(matrices, 5, Supports(dofs, np.zeros(len(dofs)))).frequencies
        for dofs in (stiff, soft)
    )
    assert np.all(lower < TARGET)
    assert np.all(upper > TARGET)
    # held whole it is 0.9 to 2.4 % stiffer than the plate converged (18 x 18 x 2 cells), and
    # this mesh adds 0.2 to 0.5 %
    np.testing.assert_allclose(upper, TARGET, rtol=0.03)
    np.testing.assert_allclose(lower, TARGET, rtol=0.04)
