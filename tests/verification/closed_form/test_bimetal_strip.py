"""A bimetal strip of two solid layers against Timoshenko's closed form.

@article{timoshenko1925,
  author  = {Timoshenko, S.},
  title   = {Analysis of Bi-Metal Thermostats},
  journal = {Journal of the Optical Society of America},
  volume  = {11},
  number  = {3},
  pages   = {233--255},
  year    = {1925}
}

Two layers of the same thickness and modulus bend with κ = 3 Δα ΔT / (2 h), h being that of both.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from strutwork.fea.solid import Solid
from strutwork.fea.solid_heat import HeatedSolid
from strutwork.meshes.grids import grid
from strutwork.meshes.mesh import CellBlock
from tests.heated_solids import ENDS, free_end, material, reduced


def test_a_bimetal_strip_bends_as_timoshenko_has_it() -> None:
    """What the ends do is in the difference of two lengths no more.

    With ν = 0, the layers share no strain across the strip; the rotation of a longer strip beyond
    that of a shorter one is then κ times the difference.
    """
    turns = []
    for cells in (8, 16):
        lines = (np.linspace(0, 0.02 * cells, cells + 1), [0, 0.01], [0, 0.01, 0.02])
        mesh = grid(*(np.array(line) for line in lines), name="strip")
        block = mesh.blocks[0]
        high = mesh.points[block.nodes].mean(axis=1)[:, 2] > 0.01
        mesh = replace(
            mesh,
            blocks=(CellBlock(block.kind, block.nodes, high.astype(int)),),
            regions=("low", "high"),
        )
        solid = Solid(mesh, {"low": material(0.0), "high": material(0.0)}, 2)
        element, heated = reduced(solid), HeatedSolid(solid, ENDS)
        changes = np.full(len(heated.points), 10.0)
        load = heated.load(element, changes, {"low": 2e-6, "high": 12e-6})
        turns.append(free_end(element, load)[4])
    # the upper layer grows more: the strip bends down, and its end turns about +y
    curvature = 1.5 * 1e-5 * 10.0 / 0.02
    # what the ends do decays within a few thicknesses, and the layers are exact in quadratic cells
    np.testing.assert_allclose(turns[1] - turns[0], curvature * 0.16, rtol=1e-5)
