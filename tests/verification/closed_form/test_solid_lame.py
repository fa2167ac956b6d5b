"""Thick cylinder under inner pressure, of curved tetrahedra, against Lamé.

@book{timoshenko1970,
  author    = {Timoshenko, S. P. and Goodier, J. N.},
  title     = {Theory of Elasticity},
  edition   = {3rd},
  publisher = {McGraw-Hill},
  year      = {1970},
  note      = {article 28: stress distribution symmetrical about an axis},
}
"""

from __future__ import annotations

import numpy as np

from strutwork.fea.solid_loads import pressure_load
from strutwork.fea.solid_static import SolidStatic, solve_solid
from strutwork.fea.solid_stress import nodal_stresses
from strutwork.meshes import Mesh, linear, quadratic
from strutwork.meshes.grids import grid
from strutwork.meshes.transform import mapped
from tests.solid_cases import STEEL, in_tetrahedra, matrices_of

INNER, OUTER, LENGTH, PRESSURE = 0.05, 0.1, 0.04, 10e6
PLANE = {"-y": "y", "+y": "x", "-z": "z", "+z": "z"}


def quarter(divisions: int) -> Mesh:
    """A quarter of the cylinder in plane strain, of tetrahedra with edges on the circles."""
    straight = in_tetrahedra(
        grid(
            np.linspace(INNER, OUTER, divisions + 1),
            np.linspace(0.0, np.pi / 2, 2 * divisions + 1),
            np.linspace(0.0, LENGTH, 2),
        )
    )

    def rolled(points: np.ndarray) -> np.ndarray:
        r, angle, z = points.T
        return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)

    return mapped(quadratic(straight), rolled)


def solved(mesh: Mesh) -> SolidStatic:
    matrices = matrices_of(mesh)
    return solve_solid(matrices, pressure_load(matrices, "-x", PRESSURE), PLANE)


def radial(static: SolidStatic) -> float:
    """Mean radial displacement of the bore, m."""
    nodes, areas = static.matrices.patch("-x")
    places = static.matrices.points[nodes]
    outwards = places * [1, 1, 0] / np.linalg.norm(places[:, :2], axis=1)[:, None]
    return float(areas @ (static.at_nodes()[nodes] * outwards).sum(axis=1) / areas.sum())


def exact() -> float:
    """Radial displacement of the bore, plane strain, m."""
    E, nu = STEEL.youngs_modulus, STEEL.poissons_ratio
    a2, b2 = INNER**2, OUTER**2
    inside = (1.0 - 2.0 * nu) * INNER + b2 / INNER
    return float((1.0 + nu) / E * PRESSURE * a2 / (b2 - a2) * inside)


def test_the_bore_widens_as_lame_says() -> None:
    errors = [abs(radial(solved(quarter(n))) / exact() - 1.0) for n in (2, 4)]
    # energy, and so the displacement under the load, converges with the fourth power of the
    # size: 16 in the limit, and half of it is asked on the way there
    assert errors[0] / errors[1] > 8.0
    # (size / radius)⁴ of 1/4 is 0.4 %; the constants are below one
    assert errors[1] < 5e-4


def test_the_hoop_stress_at_the_bore() -> None:
    static = solved(quarter(4))
    stress = nodal_stresses(static.matrices, static.displacements[:, 0]).at_nodes()
    points = static.matrices.points
    along_x = (np.abs(points[:, 1]) < 1e-9) & (np.abs(points[:, 0] - INNER) < 1e-9)
    hoop = PRESSURE * (OUTER**2 + INNER**2) / (OUTER**2 - INNER**2)
    # stresses converge with the square of the size; (1/4)² is 6 %
    np.testing.assert_allclose(stress[along_x, 1], hoop, rtol=0.06)


def test_straight_edges_are_far_off() -> None:
    """Chords of 22.5° take the load's lever and the wall's section: the test can tell."""
    curved = solved(quarter(2))
    straight = solved(linear(quarter(2)))
    off = abs(radial(straight) / exact() - 1.0)
    assert off > 3.0 * abs(radial(curved) / exact() - 1.0)
