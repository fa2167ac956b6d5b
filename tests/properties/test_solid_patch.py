"""Patch test of solids: a field of constant strain comes out exactly on any mesh."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from strutwork.fea.elasticity import elasticity
from strutwork.fea.solid_static import solve_solid
from strutwork.fea.solid_stress import cell_strains, cell_stresses, nodal_stresses
from strutwork.fea.solid_supports import Supports
from strutwork.meshes import boundary, moved
from tests.solid_cases import FIELDS, STEEL, cells_of, distorted, matrices_of

numbers = st.floats(-1.0, 1.0).map(lambda v: round(v, 3))


@pytest.mark.parametrize(("kind", "order"), FIELDS)
@settings(max_examples=8, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    gradient=st.lists(numbers, min_size=9, max_size=9),
    turn=st.integers(0, 1000),
)
def test_constant_strain_is_exact(
    kind: str, order: int, seed: int, gradient: list[float], turn: int
) -> None:
    mesh = distorted(cells_of(kind, (1.0, 0.8, 1.2), (2, 2, 2)), 0.15, seed)
    mesh = moved(mesh, Rotation.random(rng=turn).as_matrix(), (0.3, -2.0, 0.7))
    matrices = matrices_of(mesh, order)
    # an amplitude that keeps the least number from being lost beside the largest
    G = 1e-4 * (np.reshape(gradient, (3, 3)) + np.diag([1.0, 2.0, 3.0]))
    exact = matrices.points @ G.T + [1e-4, -2e-4, 3e-4]
    outer = boundary(matrices.mesh).nodes
    dofs = (3 * outer[:, None] + np.arange(3)).ravel()
    found = solve_solid(matrices, np.zeros(matrices.size), Supports(dofs, exact[outer].ravel()))
    scale = np.abs(exact).max()
    np.testing.assert_allclose(found.at_nodes(), exact, atol=1e-11 * scale)
    E = (G + G.T) / 2
    strain = np.array([*np.diag(E), *(2 * E[[0, 0, 1], [1, 2, 2]])])
    column = found.displacements[:, 0]
    bound = 1e-9 * np.abs(strain).max()
    np.testing.assert_allclose(
        cell_strains(matrices, column), np.tile(strain, (mesh.cell_count, 1)), atol=bound
    )
    stress = elasticity(STEEL) @ strain
    bound = 1e-9 * np.abs(stress).max()
    for values in (cell_stresses(matrices, column), nodal_stresses(matrices, column).at_nodes()):
        np.testing.assert_allclose(values, np.tile(stress, (len(values), 1)), atol=bound)
    # half the strain energy density times the volume
    assert found.strain_energy[0] == pytest.approx(stress @ strain / 2 * 0.96, rel=1e-9)
