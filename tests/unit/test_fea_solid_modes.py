"""Modes of solids: rigid motions, multiplicity, orthogonality, bad questions."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.solid_matrices import SolidMatrices
from strutwork.fea.solid_modes import solid_modes
from strutwork.meshes import block, joined, merged, moved, node_set
from tests.solid_cases import FIELDS, cells_of, matrices_of


@pytest.fixture(scope="module")
def cube() -> SolidMatrices:
    return matrices_of(node_set(block((1, 1, 1), (2, 2, 2)), "corner", (0, 0, 0), (0, 0, 0)))


@pytest.mark.parametrize(("kind", "order"), FIELDS)
@pytest.mark.parametrize("held", [{}, {"-x": "xyz"}, {"-z": "z"}], ids=["free", "held", "slides"])
def test_dense_eigenvalues(kind: str, order: int, held: dict[str, str]) -> None:
    matrices = matrices_of(cells_of(kind, (1.0, 0.7, 0.5), (2, 2, 2)), order)
    found = solid_modes(matrices, 9, held)
    dofs = [3 * n + "xyz".index(c) for s, d in held.items() for n in matrices.nodes_of_set(s)
            for c in d]  # fmt: skip
    free = np.setdiff1d(np.arange(matrices.size), dofs)
    K, M = (m[free][:, free].toarray() for m in (matrices.stiffness, matrices.mass))
    exact = eigh(K, M, eigvals_only=True, subset_by_index=[0, 8])
    rigid = found.rigid_body_modes
    assert rigid == {"": 6, "-x": 0, "-z": 3}["".join(held)]
    assert np.all(found.frequencies[:rigid] == 0.0)
    np.testing.assert_allclose(
        (2 * np.pi * found.frequencies[rigid:]) ** 2, exact[rigid:], rtol=1e-8
    )


def test_shapes_are_orthonormal_and_keep_supports(cube: SolidMatrices) -> None:
    found = solid_modes(cube, 12, {"-x": "xyz"})
    np.testing.assert_allclose(found.shapes.T @ cube.mass @ found.shapes, np.eye(12), atol=1e-9)
    assert not found.shape(3)[cube.nodes_of_set("-x")].any()
    # what the eigen-solver admits
    assert found.residual < 1e-7


def test_copies_of_an_equal_frequency_are_kept(cube: SolidMatrices) -> None:
    found = solid_modes(cube, 14)
    flexible = found.frequencies[found.rigid_body_modes :]
    # a cube twists in a pair, then has triples; as its dense eigenvalues
    exact = eigh(cube.stiffness.toarray(), cube.mass.toarray(), eigvals_only=True)[6:14]
    np.testing.assert_allclose((2 * np.pi * flexible) ** 2, exact, rtol=1e-8)
    assert np.count_nonzero(np.diff(flexible) < 1e-6 * flexible[0]) >= 3


def test_effective_masses_add_up_to_the_mass(cube: SolidMatrices) -> None:
    found = solid_modes(cube, 100, {"-x": "xyz"})
    total = found.effective_mass[:, :3].sum(axis=0)
    # a third of the modes hold nearly all
    assert np.all(total < cube.total_mass)
    assert np.all(total > 0.85 * cube.total_mass)
    rigid = solid_modes(cube, 6).effective_mass
    np.testing.assert_allclose(rigid[:, :3].sum(axis=0), cube.total_mass, rtol=1e-9)


@pytest.mark.parametrize("count", [0, 1000])
def test_number_of_modes(cube: SolidMatrices, count: int) -> None:
    with pytest.raises(ModelError, match=f"{count} modes are requested of 375"):
        solid_modes(cube, count)


def test_displaced_supports_are_refused(cube: SolidMatrices) -> None:
    with pytest.raises(ModelError, match="supports are displaced"):
        solid_modes(cube, 3, {"-x": {"x": 1e-3}})


def test_result_tells_its_numbers(cube: SolidMatrices) -> None:
    found = solid_modes(cube, 8)
    assert "6 rigid-body modes" in repr(found)
    assert found.to_dict()["rigid_body_modes"] == 6
    only = solid_modes(cube, 4)
    assert only.rigid_body_modes == 4
    assert only.shapes.shape == (cube.size, 4)


def test_parts_that_meet_along_an_edge_are_told() -> None:
    left = block((1, 1, 1), (2, 2, 2))
    hinged = merged(joined(left, moved(left, translation=(1, 1, 0))))
    with pytest.raises(NumericalError, match=r"7 modes have no stiffness, but 6 rigid motions"):
        solid_modes(matrices_of(hinged, 1), 10)
