"""Quality numbers of known distortions, connectivity, order and refinement."""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians, sqrt

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import (
    CellBlock,
    Faces,
    Mesh,
    Patch,
    block,
    cell_volumes,
    check_connectivity,
    check_quality,
    connectivity,
    joined,
    linear,
    mapped,
    merged,
    moved,
    patch_area,
    quadratic,
    quality,
    refined,
    without_orphans,
)
from tests.mesh_cases import every_kind, five_tetrahedra, two_regions


def one(kind: str, points: object, nodes: object) -> Mesh:
    return Mesh(np.asarray(points, float), (CellBlock(kind, np.asarray(nodes), np.zeros(1, int)),))


def test_a_brick_has_a_scaled_jacobian_of_one_and_the_aspect_of_its_edges() -> None:
    found = quality(block((1.0, 2.0, 4.0), (1, 1, 1)))
    assert found.scaled_jacobian == pytest.approx([1.0])
    assert found.aspect_ratio == pytest.approx([4.0])
    assert found.volume == pytest.approx([8.0])
    assert found.centres == pytest.approx(np.array([[0.5, 1.0, 2.0]]))
    assert found.to_dict()["inverted_cells"] == 0


@pytest.mark.parametrize("angle", [30.0, 60.0, 85.0])
def test_a_sheared_brick_has_the_cosine_of_its_shear(angle: float) -> None:
    shear = np.tan(radians(angle))
    mesh = mapped(block((1.0, 1.0, 1.0), (2, 2, 2)), lambda p: p + shear * p[:, [1]] * [1, 0, 0])
    assert quality(mesh).scaled_jacobian == pytest.approx(np.full(8, cos(radians(angle))))
    assert quality(quadratic(mesh)).scaled_jacobian == pytest.approx(
        np.full(8, cos(radians(angle)))
    )


def test_a_regular_tetrahedron_is_best_and_a_corner_of_a_cube_is_not() -> None:
    regular = one("tetra", [(1, 1, 1), (-1, -1, 1), (1, -1, -1), (-1, 1, -1)], [[0, 2, 1, 3]])
    found = quality(regular)
    assert found.scaled_jacobian == pytest.approx([1.0])
    assert found.aspect_ratio == pytest.approx([1.0])
    corner = one("tetra", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [[0, 1, 2, 3]])
    # J = 1; at another corner the edges are 1, √2, √2: √2 / 2
    assert quality(corner).scaled_jacobian == pytest.approx([sqrt(2.0) / 2.0])
    # inscribed radius (3 − √3)/6: √2 / (2 √6 r)
    radius = (3.0 - sqrt(3.0)) / 6.0
    assert quality(corner).aspect_ratio == pytest.approx([sqrt(2.0) / (2 * sqrt(6.0) * radius)])


def test_inverted_cells_are_counted_and_placed() -> None:
    mesh = block((3.0, 1.0, 1.0), (3, 1, 1))
    cells = np.array(mesh.blocks[0].nodes)
    cells[1] = cells[1][[4, 5, 6, 7, 0, 1, 2, 3]]
    wrong = replace(mesh, blocks=(CellBlock("hexahedron", cells, np.zeros(3, int)),))
    assert quality(wrong).inverted.tolist() == [1]
    assert cell_volumes(wrong) == pytest.approx([1.0, -1.0, 1.0])
    with pytest.raises(
        ModelError, match=r"1 of 3 cells are inverted or flat; the worst is cell 1 at \(1.5, 0.5"
    ):
        check_quality(wrong)


def test_a_cell_inverted_at_one_corner_alone_is_found() -> None:
    mesh = block((1.0, 1.0, 1.0), (1, 1, 1))
    points = np.array(mesh.points)
    points[-1] = (0.2, 0.2, 0.9)
    assert cell_volumes(replace(mesh, points=points))[0] > 0
    with pytest.raises(ModelError, match="inverted or flat"):
        check_quality(replace(mesh, points=points))


def test_a_flat_cell_is_refused_without_a_warning() -> None:
    flat = replace(block((1.0, 1.0, 1.0), (1, 1, 1)), points=np.zeros((8, 3)))
    with pytest.raises(ModelError, match="scaled Jacobian of 0"):
        check_quality(flat)


def test_a_limit_of_the_users_is_kept() -> None:
    mesh = mapped(block((1.0, 1.0, 1.0), (2, 1, 1)), lambda p: p + 2.0 * p[:, [1]] * [1, 0, 0])
    assert len(quality(mesh).below(0.5)) == 2
    with pytest.raises(ModelError, match=r"2 of 2 cells are below a scaled Jacobian of 0.5"):
        check_quality(mesh, 0.5)


def test_two_regions_apart_are_named_with_their_place() -> None:
    left = block((1.0, 1.0, 1.0), (1, 1, 1), region="granite")
    right = block((1.0, 1.0, 1.0), (1, 1, 1), region="rail")
    apart = joined(left, moved(right, translation=(1.001, 0.0, 0.0)))
    with pytest.raises(
        ModelError,
        match=r"region 'granite' and region 'rail' have no common node.*\(1, 0, 0\) m, 0.001 m",
    ):
        check_connectivity(apart)
    assert len(connectivity(merged(apart, 0.002)).part_regions) == 1
    touching = joined(left, moved(right, translation=(1.0, 0.0, 0.0)))
    assert check_connectivity(touching).part_regions == (("granite", "rail"),)


def test_doubles_orphans_and_collapsed_cells_are_found() -> None:
    mesh = block((2.0, 1.0, 1.0), (2, 1, 1))
    cells = mesh.blocks[0].nodes
    points = np.concatenate([mesh.points, [[9.0, 9.0, 9.0], [0.0, 0.0, 0.0]]])
    loose = Mesh(points, mesh.blocks)
    found = connectivity(loose)
    assert found.orphans.tolist() == [12, 13]
    assert found.coincident.tolist() == [13]
    with pytest.raises(ModelError, match="2 points belong to no cell, the first is 12"):
        check_connectivity(loose)
    assert without_orphans(loose).points.tolist() == mesh.points.tolist()
    twice = np.concatenate([cells, cells[:1]])
    with pytest.raises(ModelError, match="1 cells have the nodes of another, the first is 2"):
        check_connectivity(Mesh(mesh.points, (CellBlock("hexahedron", twice, np.zeros(3, int)),)))
    bent = np.array(cells)
    bent[0, 1] = bent[0, 0]
    with pytest.raises(ModelError, match="1 cells use a node twice, the first is 0"):
        check_connectivity(Mesh(mesh.points, (CellBlock("hexahedron", bent, np.zeros(2, int)),)))


def test_a_merge_that_collapses_cells_is_refused() -> None:
    with pytest.raises(ModelError, match="collapses 4 cells of type hexahedron"):
        merged(block((1.0, 1.0, 0.01), (2, 2, 1)), 0.02)


def test_joined_meshes_share_names_and_nodes() -> None:
    mesh = two_regions()
    assert len(mesh.points) == 5 * 3 * 3
    assert mesh.regions == ("left half", "right")
    assert len(mesh.region_nodes("right")) == 27
    assert len(mesh.patch("top")) == 8


@pytest.mark.parametrize("serendipity", [False, True])
def test_raised_and_lowered_meshes_are_the_same_body(serendipity: bool) -> None:
    mesh = mapped(two_regions(), lambda p: p + 0.1 * p[:, [1, 2, 0]] ** 2)
    high = quadratic(mesh, serendipity=serendipity)
    assert len(high.node_set("everything")) == len(high.points)
    assert high.node_set("corner").tolist() == [0]
    back = linear(high)
    assert back.points.tolist() == mesh.points.tolist()
    assert back.blocks[0].nodes.tolist() == mesh.blocks[0].nodes.tolist()
    assert cell_volumes(high).sum() == pytest.approx(cell_volumes(mesh).sum(), rel=1e-12)
    assert patch_area(high, high.patch("top left")) == pytest.approx(
        patch_area(mesh, mesh.patch("top left")), rel=1e-9
    )


def test_refinement_makes_eight_cells_of_one_and_four_faces_of_one() -> None:
    for mesh, label in ((two_regions(), "top left"), (five_tetrahedra(), "bottom")):
        fine = refined(mesh)
        assert fine.cell_count == 8 * mesh.cell_count
        assert len(fine.patch(label)) == 4 * len(mesh.patch(label))
        assert patch_area(fine, fine.patch(label)) == pytest.approx(
            patch_area(mesh, mesh.patch(label)), rel=1e-12
        )
        check_quality(fine)
        check_connectivity(fine)


def test_quadratic_cells_are_not_raised_again() -> None:
    for kind in ("hexahedron27", "tetra10"):
        with pytest.raises(ModelError, match="quadratic already"):
            refined(every_kind()[kind])


CUBE = block((1.0, 1.0, 1.0), (1, 1, 1))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: replace(CUBE, points=CUBE.points[:, :2]), r"points of shape \(8, 2\)"),
        (lambda: replace(CUBE, points=CUBE.points * np.nan), "point 0 is not finite"),
        (lambda: replace(CUBE, points=CUBE.points[:5]), "refers to node 7; there are 5"),
        (lambda: replace(CUBE, blocks=()), "no solid cells"),
        (lambda: replace(CUBE, regions=("a", "a")), "two regions of one name"),
        (lambda: replace(CUBE, node_sets={"s": np.array([-1])}), "node set 's': refers to node -1"),
        (
            lambda: replace(CUBE, patches={"p": Patch((Faces("quad", np.array([[0, 1, 2, 9]])),))}),
            "patch 'p': refers to node 9",
        ),
        (lambda: CellBlock("hexahedron", np.zeros((1, 6), int), np.zeros(1)), "Give 8 nodes"),
        (lambda: CellBlock("hexahedron", np.zeros((1, 8), int), np.zeros(2)), "1 cells but"),
        (lambda: CellBlock("quad", np.zeros((1, 4), int), np.zeros(1)), "not a solid cell"),
        (lambda: Faces("tetra", np.zeros((1, 4), int)), "not a face"),
        (lambda: mapped(CUBE, lambda p: -p), "1 of 1 cells are inverted"),
        (lambda: mapped(CUBE, lambda p: p[:3]), r"its map returns the shape \(3, 3\)"),
        (lambda: moved(CUBE, -np.eye(3)), "not a rotation"),
        (joined, "joins nothing"),
        (lambda: merged(CUBE, -1.0), "tolerance is -1"),
    ],
)
def test_a_mesh_that_cannot_be_is_refused(make: object, words: str) -> None:
    assert callable(make)
    with pytest.raises(ModelError, match=words):
        make()


def test_a_mesh_cannot_be_written_through() -> None:
    with pytest.raises(ValueError, match="read-only"):
        CUBE.points[0, 0] = 1.0
