"""Solids: what is refused, and matrices with the right mass, energy and rigid motions."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigvalsh

from strutwork.errors import ModelError
from strutwork.fea.elastic_terms import assembler
from strutwork.fea.elasticity import elasticity
from strutwork.fea.solid import Solid
from strutwork.fea.solid_matrices import solid_matrices
from strutwork.meshes import CellBlock, Mesh, block, joined, moved, quadratic
from strutwork.msa.materials import Material
from tests.solid_cases import (
    FIELDS,
    GRANITE,
    STEEL,
    cells_of,
    distorted,
    in_two_regions,
    matrices_of,
)

SIZE = (0.3, 0.2, 0.4)


def test_region_without_material_is_named() -> None:
    mesh = in_two_regions(block(SIZE, (2, 1, 1)))
    with pytest.raises(ModelError, match="region 'right' has no material"):
        Solid(mesh, {"left": STEEL})


def test_material_of_an_unknown_region_is_named() -> None:
    with pytest.raises(ModelError, match="no region 'sloid'"):
        Solid(block(SIZE, (1, 1, 1)), {"solid": STEEL, "sloid": STEEL})


@pytest.mark.parametrize("order", [0, 3, 1.5])
def test_order_is_one_or_two(order: int) -> None:
    with pytest.raises(ModelError, match="its order is"):
        Solid(block(SIZE, (1, 1, 1)), {"solid": STEEL}, order)


def test_linear_displacements_on_quadratic_cells_are_refused_with_what_to_do() -> None:
    with pytest.raises(ModelError, match=r"hexahedron27[\s\S]*order=2"):
        Solid(quadratic(block(SIZE, (1, 1, 1))), {"solid": STEEL}, 1)


def test_mixed_cells_are_refused() -> None:
    mixed = joined(
        cells_of("hexahedron", (1, 1, 1), (1, 1, 1)),
        moved(cells_of("tetra", (1, 1, 1), (1, 1, 1)), translation=(1, 0, 0)),
    )
    with pytest.raises(ModelError, match="mixes hexahedron and tetra"):
        Solid(mixed, dict.fromkeys(mixed.regions, STEEL))


def test_incompressible_material_is_refused() -> None:
    rubber = Material.isotropic(1e6, 0.5, 1000.0, name="rubber")
    with pytest.raises(ModelError, match=r"rubber has a Poisson's ratio of 0\.5"):
        Solid(block(SIZE, (1, 1, 1)), {"solid": rubber})


def test_inverted_cells_are_counted_and_placed() -> None:
    mesh = block((4, 1, 1), (4, 1, 1))
    nodes = mesh.blocks[0].nodes.copy()
    nodes[2] = nodes[2][[4, 5, 6, 7, 0, 1, 2, 3]]
    inverted = replace(mesh, blocks=(CellBlock("hexahedron", nodes, mesh.blocks[0].region),))
    with pytest.raises(ModelError, match=r"1 of 4 cells are inverted.*\(2\.5, 0\.5, 0\.5\) m"):
        Solid(inverted, {"solid": STEEL})


def test_regions_without_a_common_node_are_named() -> None:
    left = block((1, 1, 1), (1, 1, 1), region="base")
    right = moved(block((1, 1, 1), (1, 1, 1), region="column"), translation=(1.5, 0, 0))
    apart = joined(left, right)
    with pytest.raises(ModelError, match="'base' and region 'column' have no common node"):
        Solid(apart, {"base": STEEL, "column": GRANITE})


def test_points_without_a_cell_are_counted() -> None:
    mesh = block(SIZE, (1, 1, 1))
    more = Mesh(np.vstack([mesh.points, np.ones((2, 3))]), mesh.blocks)
    with pytest.raises(ModelError, match="2 points belong to no cell"):
        Solid(more, {"solid": STEEL})


def test_mass_without_density_is_asked_for_only_where_it_is_needed() -> None:
    light = Material.isotropic(200e9, 0.3, name="light")
    matrices = matrices_of(block(SIZE, (1, 1, 1)), 1, light)
    assert matrices.stiffness.shape == (24, 24)
    with pytest.raises(ModelError, match="'solid': its material light has no density"):
        _ = matrices.mass


@pytest.mark.parametrize(("kind", "order"), FIELDS)
def test_free_solid_has_six_rigid_motions_and_no_other_without_energy(
    kind: str, order: int
) -> None:
    # two cells: quadrature of order 3 leaves quadratic hexahedra further ones here
    matrices = matrices_of(distorted(cells_of(kind, SIZE, (2, 1, 1))), order)
    values = eigvalsh(matrices.stiffness.toarray())
    assert np.count_nonzero(np.abs(values) < 1e-9 * values[-1]) == 6
    assert values[6] > 1e-5 * values[-1]
    # round-off of sums of 81 terms
    force = matrices.stiffness @ matrices.rigid_modes()
    assert np.abs(force).max() < 1e-12 * np.abs(matrices.stiffness).max()


@pytest.mark.parametrize(("kind", "order"), FIELDS)
def test_mass_centre_and_inertia_of_a_block(kind: str, order: int) -> None:
    mass = 8000.0 * np.prod(SIZE)
    crooked = matrices_of(distorted(cells_of(kind, SIZE, (3, 3, 3))), order)
    assert crooked.total_mass == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(crooked.center_of_mass, np.array(SIZE) / 2, rtol=1e-12)
    matrices = matrices_of(cells_of(kind, SIZE, (3, 3, 3)), order)
    rigid = matrices.rigid_modes(matrices.center_of_mass)
    squares = np.array(SIZE) ** 2
    inertia = mass / 12 * (squares.sum() - squares)
    # on straight cells the quadrature integrates products of rigid motions exactly
    np.testing.assert_allclose(
        rigid.T @ matrices.mass @ rigid, np.diag([mass] * 3 + [*inertia]), atol=1e-9 * mass
    )


@pytest.mark.parametrize(("kind", "order"), FIELDS)
def test_nodes_are_those_of_the_mesh_then_middles(kind: str, order: int) -> None:
    mesh = distorted(cells_of(kind, SIZE, (2, 2, 2)))
    matrices = matrices_of(mesh, order)
    np.testing.assert_array_equal(matrices.points[: len(mesh.points)], mesh.points)
    np.testing.assert_allclose(matrices.points, assembler(matrices.solid).points, atol=1e-15)
    type_ = matrices.mesh.blocks[0].type
    for column, parents in enumerate(type_.parents):
        middle = matrices.points[matrices.cells[:, list(parents)]].mean(axis=1)
        np.testing.assert_allclose(matrices.points[matrices.cells[:, column]], middle, atol=1e-15)


@pytest.mark.parametrize(("kind", "order"), FIELDS)
def test_patch_weights_integrate_shape_functions(kind: str, order: int) -> None:
    matrices = matrices_of(cells_of(kind, SIZE, (2, 2, 2)), order)
    nodes, weights = matrices.patch("+z")
    assert weights.sum() == pytest.approx(0.06, rel=1e-13)
    np.testing.assert_allclose(weights @ matrices.points[nodes], 0.06 * np.array([0.15, 0.1, 0.4]))
    assert set(nodes) == set(matrices.nodes_of_set("+z"))
    with pytest.raises(ModelError, match="'top'"):
        matrices.patch("top")


def test_energy_of_a_linear_field_is_that_of_hooke() -> None:
    matrices = matrices_of(block(SIZE, (2, 2, 2)), 1, GRANITE)
    strain = np.array([1e-4, -2e-4, 3e-4, 5e-5, -6e-5, 7e-5])
    xx, yy, zz, xy, xz, yz = strain
    gradient = np.array([[xx, xy / 2, xz / 2], [xy / 2, yy, yz / 2], [xz / 2, yz / 2, zz]])
    u = (matrices.points @ gradient).ravel()
    lame, shear = 78e9 * 0.25 / (1.25 * 0.5), 78e9 / 2.5
    density = lame * (xx + yy + zz) ** 2 / 2 + shear * (gradient**2).sum()
    assert u @ matrices.stiffness @ u / 2 == pytest.approx(density * np.prod(SIZE), rel=1e-12)
    np.testing.assert_allclose(strain @ elasticity(GRANITE) @ strain / 2, density, rtol=1e-12)


def test_regions_have_their_own_materials() -> None:
    mesh = in_two_regions(block((2, 1, 1), (4, 2, 2)))
    solid = Solid(mesh, {"left": STEEL, "right": GRANITE}, 1)
    matrices = solid_matrices(solid)
    assert matrices.total_mass == pytest.approx(11000.0)
    assert matrices.center_of_mass[0] == pytest.approx((8 * 0.5 + 3 * 1.5) / 11)
    # stretched alike, the energy is the sum of both halves
    u = np.zeros_like(matrices.points)
    u[:, 0] = 1e-4 * matrices.points[:, 0]
    stiff = sum(elasticity(m)[0, 0] for m in (STEEL, GRANITE))
    energy = u.ravel() @ matrices.stiffness @ u.ravel()
    assert energy == pytest.approx(stiff * 1e-8, rel=1e-12)


def test_structural_damping_weighs_each_region_by_its_loss_factor() -> None:
    mesh = in_two_regions(block((2, 1, 1), (2, 1, 1)))
    dull, lively = (replace(STEEL, loss_factor=eta) for eta in (0.02, None))
    matrices = solid_matrices(Solid(mesh, {"left": dull, "right": lively}, 1))
    damping = matrices.structural_damping()
    u = np.zeros_like(matrices.points)
    u[:, 0] = 1e-4 * matrices.points[:, 0]
    half = u.ravel() @ matrices.stiffness @ u.ravel() / 2
    assert u.ravel() @ damping @ u.ravel() == pytest.approx(0.02 * half, rel=1e-12)
    same = solid_matrices(Solid(mesh, {"left": dull, "right": dull}, 1))
    assert abs(same.structural_damping() - 0.02 * same.stiffness).max() == 0.0


def test_many_groups_of_cells_give_the_same_matrices(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = block(SIZE, (3, 2, 2))
    whole = matrices_of(mesh, 2)
    monkeypatch.setattr("strutwork.fea.elastic_terms.GROUP_ENTRIES", 20_000)
    pieces = matrices_of(mesh, 2)
    assert len(assembler(pieces.solid).groups) == 4
    for one, other in ((whole.stiffness, pieces.stiffness), (whole.mass, pieces.mass)):
        assert abs(one - other).max() < 1e-14 * abs(one).max()


def test_nothing_is_printed_and_numpy_prints_as_before() -> None:
    program = (
        "import numpy as np\n"
        "before = np.get_printoptions()\n"
        "from strutwork.fea.solid import Solid\n"
        "from strutwork.fea.solid_matrices import solid_matrices\n"
        "from strutwork.meshes import block\n"
        "from strutwork.msa.materials import Material\n"
        "steel = Material.isotropic(2e11, 0.3, 8000.0)\n"
        "solid_matrices(Solid(block((1, 1, 1), (2, 2, 2)), {'solid': steel}))\n"
        "assert np.get_printoptions() == before\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False, timeout=120
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")
