"""Stress of solids: bending, regions, invariants."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea.solid import Solid
from strutwork.fea.solid_matrices import solid_matrices
from strutwork.fea.solid_static import solve_solid
from strutwork.fea.solid_stress import (
    cell_stresses,
    nodal_stresses,
    principal_stresses,
    von_mises,
)
from strutwork.meshes import block
from tests.solid_cases import GRANITE, STEEL, in_tetrahedra, in_two_regions, matrices_of


@pytest.mark.parametrize("tetrahedra", [False, True])
def test_pure_bending_is_exact_with_quadratic_cells(tetrahedra: bool) -> None:
    mesh = block((1.0, 0.1, 0.2), (4, 1, 2))
    matrices = matrices_of(in_tetrahedra(mesh) if tetrahedra else mesh)
    # Saint-Venant: u = (x z, -ν y z, -(x² + ν (z² - y²)) / 2) κ, stress xx = E κ z
    x, y, z = matrices.points.T
    nu, curvature = 0.3, 1e-3
    u = curvature * np.stack([x * z, -nu * y * z, -(x**2 + nu * (z**2 - y**2)) / 2], axis=1)
    exact = np.zeros((len(u), 6))
    exact[:, 0] = 200e9 * curvature * z
    found = nodal_stresses(matrices, u.ravel()).at_nodes()
    np.testing.assert_allclose(found, exact, atol=1e-9 * exact.max())
    centres = matrices.points[matrices.cells].mean(axis=1)
    at_centres = cell_stresses(matrices, u.ravel())
    np.testing.assert_allclose(at_centres[:, 0], 200e9 * curvature * centres[:, 2], atol=1.0)


def test_stress_jumps_between_regions_and_each_keeps_its_own() -> None:
    # two bars side by side, stretched alike: each has its own E
    mesh = in_two_regions(block((2.0, 1.0, 1.0), (2, 2, 2)))
    matrices = solid_matrices(Solid(mesh, {"left": STEEL, "right": GRANITE}))
    u = np.zeros_like(matrices.points)
    u[:, 2] = 1e-4 * matrices.points[:, 2]
    found = nodal_stresses(matrices, u.ravel())
    constrained = {
        name: m.youngs_modulus * (1 - m.poissons_ratio)
        / ((1 + m.poissons_ratio) * (1 - 2 * m.poissons_ratio))
        for name, m in matrices.solid.materials.items()
    }  # fmt: skip
    for name, (nodes, stress) in found.regions.items():
        np.testing.assert_allclose(stress[:, 2], 1e-4 * constrained[name], rtol=1e-10)
        np.testing.assert_array_equal(nodes, matrices.mesh.region_nodes(name))
    shared = np.intersect1d(*(nodes for nodes, _ in found.regions.values()))
    assert len(shared)
    np.testing.assert_allclose(found.at_nodes()[shared, 2], 1e-4 * constrained["left"])


def test_load_cases_come_first() -> None:
    matrices = matrices_of(block((1, 1, 1), (2, 1, 1)), 1)
    loads = np.zeros((matrices.size, 2))
    loads[0, 1] = loads[-3, 1] = 1e3
    found = solve_solid(matrices, loads, {"-x": "xyz"})
    assert cell_stresses(matrices, found.displacements).shape == (2, 2, 6)
    nodal = nodal_stresses(matrices, found.displacements)
    assert nodal.at_nodes().shape == (2, 12, 6)
    assert not nodal.at_nodes()[0].any()
    one = nodal_stresses(matrices, found.displacements[:, 1]).at_nodes()
    np.testing.assert_allclose(nodal.at_nodes()[1], one)
    assert "von Mises" in repr(nodal)


def test_chunks_make_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    matrices = matrices_of(block((1, 1, 1), (3, 3, 2)))
    u = np.random.default_rng(0).normal(size=matrices.size)
    whole = cell_stresses(matrices, u)
    monkeypatch.setattr("strutwork.fea.solid_stress.CHUNK", 5)
    np.testing.assert_allclose(cell_stresses(matrices, u), whole, rtol=1e-12)


def test_invariants() -> None:
    uniaxial, shear = np.array([5.0, 0, 0, 0, 0, 0]), np.array([0, 0, 0, 2.0, 0, 0])
    pressure = np.array([3.0, 3, 3, 0, 0, 0])
    np.testing.assert_allclose(
        von_mises(np.stack([uniaxial, shear, pressure])), [5.0, 2 * np.sqrt(3), 0.0], atol=1e-15
    )
    np.testing.assert_allclose(
        principal_stresses(np.stack([uniaxial, shear])), [[5, 0, 0], [2, 0, -2]], atol=1e-15
    )
    order = principal_stresses([0.0, 0, 0, 0, 0, 4.0])
    np.testing.assert_allclose(order, [4, 0, -4], atol=1e-15)


def test_displacements_of_another_size_are_refused() -> None:
    matrices = matrices_of(block((1, 1, 1), (1, 1, 1)), 1)
    with pytest.raises(ModelError, match="Give 24 displacements"):
        cell_stresses(matrices, np.zeros(23))
    with pytest.raises(ModelError, match="not finite"):
        nodal_stresses(matrices, np.full(24, np.nan))
