"""Rates of convergence of solids against a manufactured solution.

@book{strang1973,
  title     = {An Analysis of the Finite Element Method},
  author    = {Strang, Gilbert and Fix, George J.},
  publisher = {Prentice-Hall},
  year      = {1973}
}

Theorem 3.7 and its corollaries: with elements of degree p the error falls as h^p in the energy
norm, h^(p+1) in the mean square of the displacement, and h^(2p) in an eigenvalue.

The solution is u = U sin(k·x + φ), with the body force that makes it one.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.fea.elasticity import elasticity
from strutwork.fea.solid_matrices import SolidMatrices
from strutwork.fea.solid_modes import solid_modes
from strutwork.fea.solid_static import solve_solid
from strutwork.fea.solid_supports import Supports
from strutwork.meshes import boundary
from tests.solid_cases import FIELDS, STEEL, cells_of, matrices_of

U, K, PHASE = np.array([1.0, -0.5, 0.7]) * 1e-3, np.array([1.8, 1.2, -1.5]), 0.4
SHEAR = STEEL.shear_modulus
LAME = elasticity(STEEL)[0, 1]


def displacement(x: np.ndarray) -> np.ndarray:
    return U * np.sin(x @ K + PHASE)[..., None]


def gradient(x: np.ndarray) -> np.ndarray:
    return np.outer(U, K) * np.cos(x @ K + PHASE)[..., None, None]


def body_force(x: np.ndarray) -> np.ndarray:
    amplitude = (LAME + SHEAR) * (U @ K) * K + SHEAR * (K @ K) * U
    return amplitude * np.sin(x @ K + PHASE)[..., None]


def errors(matrices: SolidMatrices) -> tuple[float, float]:
    """Mean square of the displacement's error, and energy of the strain's, by quadrature."""
    type_ = matrices.mesh.blocks[0].type
    at, weights = type_.quadrature(6)
    shape, slope = type_.shape(at), type_.gradient(at)
    places = matrices.points[matrices.cells]
    x = np.einsum("qn,enc->eqc", shape, places)
    jacobian = np.einsum("qnd,enc->eqdc", slope, places)
    volume = np.linalg.det(jacobian) * weights
    # the consistent load of the body force
    force = np.zeros_like(matrices.points)
    np.add.at(force, matrices.cells, np.einsum("eq,qn,eqc->enc", volume, shape, body_force(x)))
    outer = boundary(matrices.mesh).nodes
    dofs = (3 * outer[:, None] + np.arange(3)).ravel()
    known = Supports(dofs, displacement(matrices.points[outer]).ravel())
    found = solve_solid(matrices, force.ravel(), known).at_nodes()[matrices.cells]
    off = np.einsum("qn,enc->eqc", shape, found) - displacement(x)
    turned = np.linalg.solve(jacobian, slope.transpose(0, 2, 1)[None])
    G = np.einsum("eqjn,eni->eqij", turned, found) - gradient(x)
    E = (G + np.swapaxes(G, -1, -2)) / 2
    density = LAME * np.trace(E, axis1=-2, axis2=-1) ** 2 + 2 * SHEAR * (E**2).sum(axis=(-2, -1))
    return float(np.sqrt((volume[..., None] * off**2).sum())), float(
        np.sqrt((volume * density).sum())
    )


@pytest.mark.parametrize(("kind", "order"), FIELDS)
def test_static_rates(kind: str, order: int) -> None:
    found = np.array(
        [errors(matrices_of(cells_of(kind, (1, 1, 1), (n, n, n)), order)) for n in (3, 6)]
    )
    rates = np.log2(found[0] / found[1])
    # 3 and 6 cells a side are not yet the limit of fine meshes
    np.testing.assert_allclose(rates, [order + 1, order], atol=0.15)


@pytest.mark.parametrize(("order", "divisions"), [(1, (4, 8, 16)), (2, (2, 4, 8))])
def test_eigenvalue_rates(order: int, divisions: tuple[int, ...]) -> None:
    # a bar sliding between smooth walls: u = sin(π x / 2), ω = (π / 2) √(E_constrained / ρ)
    exact = (np.pi / 2) * np.sqrt(elasticity(STEEL)[0, 0] / 8000.0) / (2 * np.pi)
    held = {"-x": "x", "-y": "y", "+y": "y", "-z": "z", "+z": "z"}
    error = []
    for n in divisions:
        matrices = matrices_of(cells_of("hexahedron", (1.0, 0.05, 0.05), (n, 1, 1)), order)
        found = solid_modes(matrices, 1, held)
        error.append((found.frequencies[0] / exact) ** 2 - 1)
    assert min(error) > 0
    rates = np.log2(np.array(error[:-1]) / error[1:])
    np.testing.assert_allclose(rates, 2 * order, atol=0.05)
