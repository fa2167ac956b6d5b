"""Laws of solids whose cells are bent: constant strain is exact, turning changes no frequency."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from strutwork.fea.elasticity import elasticity
from strutwork.fea.solid_modes import solid_modes
from strutwork.fea.solid_static import solve_solid
from strutwork.fea.solid_stress import cell_stresses, nodal_stresses
from strutwork.fea.solid_supports import Supports
from strutwork.meshes import boundary, cell_volumes, moved
from strutwork.meshes.cells import CELL_TYPES
from tests.solid_cases import CURVED, STEEL, bent, cells_of, matrices_of

numbers = st.floats(-1.0, 1.0).map(lambda v: round(v, 3))


@pytest.mark.parametrize("kind", CURVED)
@settings(max_examples=6, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    gradient=st.lists(numbers, min_size=9, max_size=9),
    turn=st.integers(0, 1000),
)
def test_constant_strain_is_exact(kind: str, seed: int, gradient: list[float], turn: int) -> None:
    mesh = bent(
        cells_of(CELL_TYPES[kind].linear_kind, (1.0, 0.8, 1.2), (2, 2, 2)), kind, 0.04, seed
    )
    mesh = moved(mesh, Rotation.random(rng=turn).as_matrix(), (0.3, -2.0, 0.7))
    matrices = matrices_of(mesh)
    # an amplitude that keeps the least number from being lost beside the largest
    G = 1e-4 * (np.reshape(gradient, (3, 3)) + np.diag([1.0, 2.0, 3.0]))
    exact = matrices.points @ G.T + [1e-4, -2e-4, 3e-4]
    outer = boundary(matrices.mesh).nodes
    dofs = (3 * outer[:, None] + np.arange(3)).ravel()
    found = solve_solid(matrices, np.zeros(matrices.size), Supports(dofs, exact[outer].ravel()))
    assert len(outer) < len(exact)
    np.testing.assert_allclose(found.at_nodes(), exact, atol=1e-11 * np.abs(exact).max())
    E = (G + G.T) / 2
    strain = np.array([*np.diag(E), *(2 * E[[0, 0, 1], [1, 2, 2]])])
    stress = elasticity(STEEL) @ strain
    bound = 1e-9 * np.abs(stress).max()
    column = found.displacements[:, 0]
    for values in (cell_stresses(matrices, column), nodal_stresses(matrices, column).at_nodes()):
        np.testing.assert_allclose(values, np.tile(stress, (len(values), 1)), atol=bound)
    # half the strain energy density times the volume of the bent cells
    energy = stress @ strain / 2 * cell_volumes(mesh).sum()
    assert found.strain_energy[0] == pytest.approx(energy, rel=1e-9)


@settings(max_examples=6, deadline=None)
@given(seed=st.integers(0, 10_000), turn=st.integers(0, 1000))
def test_turning_the_mesh_leaves_the_frequencies(seed: int, turn: int) -> None:
    mesh = bent(cells_of("tetra", (1.0, 0.2, 0.3), (4, 1, 1)), share=0.04, seed=seed)
    turned = moved(mesh, Rotation.random(rng=turn).as_matrix(), (3.0, -2.0, 5.0))
    one, other = (solid_modes(matrices_of(m), 12) for m in (mesh, turned))
    assert one.rigid_body_modes == other.rigid_body_modes == 6
    # rounding of the stiffness, 1e-16 of its largest value, which is some 1e4 of the lowest mode's
    np.testing.assert_allclose(other.frequencies[6:], one.frequencies[6:], rtol=1e-8)
