"""Solids of quadratic cells: their matrices, their volume, and the cells that are refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

from strutwork.errors import ModelError
from strutwork.fea.curved_terms import CurvedAssembler
from strutwork.fea.elastic_terms import StraightAssembler, assembler
from strutwork.fea.interface import Interface
from strutwork.fea.memory import ROW_ENTRIES, solid_dofs
from strutwork.fea.reduce_solid import tied
from strutwork.fea.solid import Solid
from strutwork.fea.solid_fields import surface_field, write_fields
from strutwork.fea.solid_loads import gravity_load, pressure_load
from strutwork.fea.solid_matrices import SolidMatrices, solid_matrices
from strutwork.fea.superelement import superelement
from strutwork.meshes import (
    boundary,
    cell_volumes,
    joined,
    mass_properties,
    merged,
    moved,
    read_mesh,
    tube,
)
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.curves import unbent
from strutwork.meshes.mesh import CellBlock, Mesh
from strutwork.meshes.order import linear, quadratic
from strutwork.meshes.quality import check_quality, quality
from tests.solid_cases import CURVED, GRANITE, STEEL, bent, cells_of, distorted, in_two_regions
from tests.solid_cases import matrices_of as of

SIZE = (0.3, 0.2, 0.4)
#: Middle nodes of the slanted face of a tetra10.
SLANTED = (5, 8, 9)


def by_place(matrices: SolidMatrices, wanted: sp.csc_array) -> np.ndarray:
    """A matrix with its nodes in the order of their places."""
    order = np.lexsort(np.round(matrices.points, 9).T)
    dofs = (3 * order[:, None] + np.arange(3)).ravel()
    return np.asarray(wanted.toarray()[np.ix_(dofs, dofs)])


def one_tetrahedron(shift: np.ndarray, far: bool = False) -> Mesh:
    """A tetra10 of edge 1 m with its middle nodes displaced, alone or beside a sound one."""
    points = CELL_TYPES["tetra10"].reference.copy()
    points[4:] += shift
    own = Mesh(points, (CellBlock("tetra10", np.arange(10)[None], np.zeros(1, int)),), name="bad")
    if not far:
        return own
    good = quadratic(linear(one_tetrahedron(np.zeros((6, 3)))))
    return replace(merged(joined(moved(good, translation=(-1.0, 0.0, 0.0)), own)), name="pair")


@pytest.mark.parametrize("kind", ["tetra", "hexahedron"])
def test_flat_quadratic_cells_have_the_matrices_of_sfepy(kind: str) -> None:
    mesh = cells_of(kind, SIZE, (2, 2, 3))
    # parallel edges keep both quadratures exact: tetrahedra may be distorted besides
    mesh = distorted(mesh) if kind == "tetra" else mesh
    straight, curved = of(mesh), of(quadratic(mesh))
    assert isinstance(assembler(straight.solid), StraightAssembler)
    assert isinstance(assembler(curved.solid), CurvedAssembler)
    for name in ("stiffness", "mass"):
        one, other = (by_place(m, getattr(m, name)) for m in (straight, curved))
        # sums of some hundred products in another order
        np.testing.assert_allclose(other, one, rtol=0.0, atol=1e-12 * np.abs(one).max())


@pytest.mark.parametrize("kind", CURVED)
def test_mass_is_density_times_the_volume_of_the_bent_cells(kind: str) -> None:
    mesh = bent(cells_of(CELL_TYPES[kind].linear_kind, SIZE, (2, 2, 2)), kind)
    matrices = of(mesh)
    volume = cell_volumes(mesh).sum()
    # the bent faces move the volume by far more than the tolerance
    assert abs(volume / np.prod(SIZE) - 1.0) > 1e-4
    assert matrices.total_mass == pytest.approx(8000.0 * volume, rel=1e-12)
    # the whole tensor, since the quadrature is exact for products of rigid motions
    exact = mass_properties(mesh, 8000.0)
    np.testing.assert_allclose(matrices.center_of_mass, exact.centre, rtol=1e-11)
    rigid = matrices.rigid_modes(exact.centre)
    tensor = np.zeros((6, 6))
    tensor[:3, :3], tensor[3:, 3:] = exact.mass * np.eye(3), exact.inertia
    np.testing.assert_allclose(rigid.T @ matrices.mass @ rigid, tensor, atol=1e-11 * exact.mass)
    weight = gravity_load(matrices).reshape(-1, 3).sum(axis=0)
    np.testing.assert_allclose(weight, [0.0, 0.0, -9.80665 * exact.mass], atol=1e-9 * exact.mass)


@pytest.mark.parametrize("kind", CURVED)
def test_six_rigid_motions_and_no_other_cost_nothing(kind: str) -> None:
    mesh = bent(cells_of(CELL_TYPES[kind].linear_kind, SIZE, (1, 1, 2)), kind)
    matrices = of(mesh)
    dense = matrices.stiffness.toarray()
    values = np.linalg.eigvalsh((dense + dense.T) / 2)
    assert np.abs(values[:6]).max() < 1e-12 * values[-1]
    assert values[6] > 1e-7 * values[-1]
    rigid = matrices.rigid_modes(matrices.center_of_mass)
    assert np.abs(dense @ rigid).max() < 1e-12 * values[-1]
    assert np.abs(dense - dense.T).max() < 1e-14 * values[-1]


def test_pressure_all_around_a_bent_solid_has_no_resultant() -> None:
    mesh = bent(cells_of("tetra", SIZE, (2, 2, 2)))
    mesh = replace(mesh, patches={"all": boundary(mesh)})
    matrices = of(mesh)
    load = pressure_load(matrices, "all", 1e5)
    area = matrices.patch("all")[1].sum()
    total = matrices.rigid_modes(matrices.center_of_mass).T @ load
    # the integrands are polynomials of degree 4, and of 6 for moments: the rule is exact
    assert np.abs(total).max() < 1e-12 * 1e5 * area
    # the divergence of the place is 3
    assert -(load[:, 0] @ matrices.points.ravel()) / 3e5 == pytest.approx(
        cell_volumes(mesh).sum(), rel=1e-12
    )


def test_regions_have_their_own_material_and_loss_factor() -> None:
    straight = in_two_regions(cells_of("tetra", (2, 1, 1), (2, 1, 1)))
    mesh = bent(straight)
    volumes = [cell_volumes(mesh)[mesh.region_cells(r)].sum() for r in mesh.regions]
    dull = replace(STEEL, loss_factor=0.02)
    matrices = solid_matrices(Solid(mesh, {"left": dull, "right": GRANITE}))
    assert matrices.total_mass == pytest.approx(8000.0 * volumes[0] + 3000.0 * volumes[1])
    alone = solid_matrices(Solid(mesh, {"left": dull, "right": replace(GRANITE, loss_factor=0.02)}))
    assert abs(alone.structural_damping() - 0.02 * matrices.stiffness).max() == 0.0
    # stretched alike, the damping is that of the left half alone
    u = np.zeros_like(matrices.points)
    u[:, 0] = 1e-4 * matrices.points[:, 0]
    found = u.ravel() @ matrices.structural_damping() @ u.ravel()
    lame = 200e9 * 0.3 / (1.3 * 0.4)
    law = lame + 200e9 / 1.3
    assert found == pytest.approx(0.02 * law * 1e-8 * volumes[0], rel=1e-11)


def test_many_groups_of_cells_give_the_same_matrices(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = bent(cells_of("tetra", SIZE, (3, 2, 2)))
    whole = of(mesh)
    # seven cells at a time, the last time fewer
    monkeypatch.setattr("strutwork.fea.curved_terms.CHUNK_ENTRIES", 7 * 900)
    pieces = of(mesh)
    for one, other in ((whole.stiffness, pieces.stiffness), (whole.mass, pieces.mass)):
        assert abs(one - other).max() < 1e-14 * abs(one).max()


@pytest.mark.parametrize("kind", CURVED)
def test_memory_is_foreseen_from_the_points_and_the_entries_of_a_row(kind: str) -> None:
    mesh = quadratic(
        cells_of(CELL_TYPES[kind].linear_kind, SIZE, (7, 7, 7)),
        serendipity=kind == "hexahedron20",
    )
    matrices = of(mesh)
    assert solid_dofs(kind, 2, len(mesh.points), mesh.cell_count) == matrices.size
    # the surface has shorter rows, and a seventh of the cells' layers lies on it
    assert 0.75 < matrices.stiffness.nnz / matrices.size / ROW_ENTRIES[kind, 2] < 1.0


def test_a_curved_tube_has_the_volume_and_area_of_the_ring() -> None:
    matrices = of(tube(0.03, 0.05, 0.2, (1, 12, 2), order=2))
    # parabolas on arcs of the angle θ = π/6 lack θ⁴/480 of the area between them, and err by θ⁴
    # in length with a smaller factor; chords would lack 4.5 %
    lack = (np.pi / 6) ** 4 / 480
    ring = np.pi * (0.05**2 - 0.03**2) * 0.2
    assert matrices.total_mass == pytest.approx(8000.0 * ring * (1.0 - lack), rel=5e-6)
    assert matrices.patch("outer")[1].sum() == pytest.approx(2 * np.pi * 0.05 * 0.2, rel=lack)


def test_a_cell_that_is_inverted_at_a_node_is_named() -> None:
    shift = np.zeros((6, 3))
    shift[0] = [0.45, 0.0, 0.0]
    with pytest.raises(ModelError, match=r"pair: 1 of 2 cells.* cell 1 at \(0\.25, 0\.25, 0\.25\) m"
                       r"[\s\S]*middle nodes nearer to the middle of their edges"):  # fmt: skip
        Solid(one_tetrahedron(shift, far=True), {"solid": STEEL})


#: Displacements of the middle nodes, m, that turn a cell inside out at integration points of the
#: mass alone; found by trying.
MASS_ALONE = [
    *([0.17, 0.07, 0.13], [-0.05, -0.16, 0.14], [-0.2, -0.19, 0.14]),
    *([-0.24, -0.17, 0.07], [0.01, 0.11, -0.1], [0.16, 0.11, 0.02]),
]


def pressed_in() -> np.ndarray:
    """A face pressed in until it is inside out in its middle, and at no node."""
    shift = np.zeros((6, 3))
    for node in SLANTED:
        shift[node - 4] = -0.4 * CELL_TYPES["tetra10"].reference[node]
    return shift


@pytest.mark.parametrize("shift", [pressed_in(), np.array(MASS_ALONE)])
def test_a_cell_that_is_inverted_between_its_nodes_alone_is_named(shift: np.ndarray) -> None:
    mesh = one_tetrahedron(shift, far=True)
    type_ = CELL_TYPES["tetra10"]
    places = mesh.points[mesh.blocks[-1].nodes[-1]]
    jacobians = np.einsum("qnd,nc->qdc", type_.gradient(type_.reference), places)
    assert np.linalg.det(jacobians).min() > 0.01
    with pytest.raises(ModelError, match=r"1 of 2 cells are inverted .* cell 1 at \(0\.25"):
        Solid(mesh, {"solid": STEEL})
    # the sound cell keeps its curves, and a name tells which did not
    made, cells = unbent(mesh)
    check_quality(made)
    assert cells.tolist() == [1]
    np.testing.assert_array_equal(
        made.points[made.blocks[0].nodes[0]], mesh.points[mesh.blocks[0].nodes[0]]
    )


def test_cells_bent_within_bounds_keep_their_quality() -> None:
    mesh = one_tetrahedron(0.8 * pressed_in())
    found = quality(mesh)
    assert found.scaled_jacobian[0] > 0.05
    assert len(found.inverted) == 0


def test_pictures_and_files_show_the_curved_faces(tmp_path: Path) -> None:
    matrices = of(tube(0.03, 0.05, 0.2, (1, 12, 2), order=2))
    field = surface_field(matrices, np.ones(len(matrices.points)))
    radii = np.linalg.norm(field.points[:, :2], axis=1)
    # the middle nodes on the circles too; chords would reach in to cos(π/12) of the radius
    assert np.isclose(radii, 0.05, rtol=1e-12).sum() == 24 * 5
    assert np.abs(np.linalg.norm(field.displacement, axis=1)).max() == 0.0
    path = write_fields(matrices, tmp_path / "tube.vtu", {"one": np.ones(len(matrices.points))})
    back = read_mesh(path)
    assert back.blocks[0].kind == "hexahedron27"
    np.testing.assert_allclose(cell_volumes(back), cell_volumes(matrices.mesh), rtol=1e-12)


def test_a_reduced_curved_rod_is_as_stiff_as_its_section() -> None:
    inner, outer, length = 0.03, 0.05, 0.3
    solid = Solid(tube(inner, outer, length, (1, 12, 3), order=2), {"tube": STEEL})
    element = superelement(
        tied(solid, [Interface("foot", "-z"), Interface("head", "+z")]), solid.cells, modes=6
    )
    inside = slice(12, None)
    stiffness = element.local_stiffness
    held = np.linalg.solve(stiffness[inside, inside], stiffness[inside, :12])
    condensed = stiffness[:12, :12] - stiffness[:12, inside] @ held
    # average interfaces spread a pull evenly and a twist with the radius, as Hooke's rod and
    # Saint-Venant's round shaft have it: what is left is the section, 2e-4 short in area and
    # twice that in polar moment
    area, polar = np.pi * (outer**2 - inner**2), np.pi / 2 * (outer**4 - inner**4)
    assert condensed[8, 8] == pytest.approx(200e9 * area / length, rel=5e-4)
    assert condensed[11, 11] == pytest.approx(STEEL.shear_modulus * polar / length, rel=1e-3)
