"""Boundary, areas and their shares at nodes, selection by place."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import (
    block,
    boundary,
    face_areas,
    face_normals,
    in_box,
    nodal_area_vectors,
    nodal_areas,
    node_set,
    patch,
    patch_area,
    quadratic,
    tube,
)
from tests.mesh_cases import every_kind, five_tetrahedra, two_regions

EVERY = pytest.mark.parametrize(
    "kind", ["hexahedron", "hexahedron20", "hexahedron27", "tetra", "tetra10"]
)


@EVERY
def test_the_boundary_is_closed_and_points_outwards(kind: str) -> None:
    mesh = every_kind()[kind]
    outer = boundary(mesh)
    nodes, vectors = nodal_area_vectors(mesh, outer)
    assert vectors.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-13)
    # divergence theorem: three times the volume of the skewed solid, of determinant 1.1705
    skew = np.linalg.det([[1.0, 0.1, 0.0], [0.2, 1.0, 0.1], [0.0, 0.3, 1.2]])
    volume = (6.0 if kind.startswith("tetra") else 2.0) * skew
    assert np.sum(mesh.points[nodes] * vectors) / 3.0 == pytest.approx(volume, rel=1e-12)


def test_a_region_has_a_boundary_of_its_own() -> None:
    mesh = two_regions()
    assert patch_area(mesh, boundary(mesh)) == pytest.approx(10.0)
    assert patch_area(mesh, boundary(mesh, "right")) == pytest.approx(6.0)
    with pytest.raises(ModelError, match=r"no region 'middle'.*\n.*'left half', 'right'"):
        boundary(mesh, "middle")


@EVERY
def test_nodal_areas_add_up_and_balance_about_the_centroid(kind: str) -> None:
    mesh = every_kind()[kind]
    chosen = mesh.patch("bottom" if kind.startswith("tetra") else "top")
    nodes, areas = nodal_areas(mesh, chosen)
    assert areas.sum() == pytest.approx(patch_area(mesh, chosen), rel=1e-12)
    # a plane parallelogram: consistent shares have their mean at its middle
    corners = mesh.points[nodes]
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2.0
    assert areas @ corners / areas.sum() == pytest.approx(middle, rel=1e-12)


def test_nodal_areas_of_one_face_are_those_of_the_textbook() -> None:
    one = block((1.0, 1.0, 1.0), (1, 1, 1))
    assert nodal_areas(one, one.patch("+z"))[1] == pytest.approx(np.full(4, 1 / 4))
    for serendipity, corner, edge in ((True, -1 / 12, 1 / 3), (False, 1 / 36, 1 / 9)):
        fine = quadratic(one, serendipity=serendipity)
        nodes, areas = nodal_areas(fine, fine.patch("+z"))
        at_corner = (fine.points[nodes, :2] % 1.0 == 0.0).all(axis=1)
        at_edge = (fine.points[nodes, :2] == 0.5).sum(axis=1) == 1
        assert areas[at_corner] == pytest.approx(np.full(4, corner))
        assert areas[at_edge] == pytest.approx(np.full(4, edge))
    tetra = quadratic(five_tetrahedra((1.0, 1.0, 1.0)))
    nodes, areas = nodal_areas(tetra, tetra.patch("bottom"))
    # two triangles of half a square metre each: nothing at corners, a third at each edge
    assert np.sort(areas) == pytest.approx([0, 0, 0, 0, 1 / 6, 1 / 6, 1 / 6, 1 / 6, 1 / 3])


def test_areas_and_normals_of_faces() -> None:
    mesh = block((1.0, 2.0, 3.0), (1, 1, 1))
    faces = mesh.patch("-y").faces[0]
    assert face_areas(mesh.points, faces) == pytest.approx([3.0])
    assert face_normals(mesh.points, faces) == pytest.approx(np.array([[0.0, -1.0, 0.0]]))


def test_a_patch_is_chosen_by_box_by_direction_and_by_rule() -> None:
    mesh = tube(0.5, 1.0, 1.0, (1, 16, 2))
    up = patch(mesh, "up", normal=(0, 0, 2)).patch("up")
    assert patch_area(mesh, up) == pytest.approx(patch_area(mesh, mesh.patch("+z")))
    half = patch(mesh, "half", (None, None, 1.0), where=lambda centre: centre[:, 0] > 0).patch(
        "half"
    )
    assert patch_area(mesh, half) == pytest.approx(patch_area(mesh, up) / 2.0)
    assert len(patch(mesh, "all").patch("all")) == len(boundary(mesh))
    assert repr(up) == "Patch(16 quad, 32 nodes)"


def test_nodes_are_chosen_by_box() -> None:
    mesh = block((1.0, 1.0, 1.0), (2, 2, 2))
    assert len(in_box(mesh, (1.0, None, None))) == 9
    assert node_set(mesh, "edge", (1.0, 1.0, None)).node_set("edge").tolist() == [24, 25, 26]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"low": (2.0, None, None)}, "patch 'p': holds no face"),
        ({"low": (0.5, 0.5, 0.5), "high": (0.5, 0.5, 0.5)}, "holds no face"),
        ({"normal": (1, 1, 1)}, "holds no face"),
        ({"normal": (0, 0, 0)}, r"its normal is \[0.0, 0.0, 0.0\]"),
    ],
)
def test_an_empty_patch_is_refused(arguments: dict[str, tuple[float, ...]], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        patch(block((1.0, 1.0, 1.0), (2, 2, 2)), "p", **arguments)  # type: ignore[arg-type]


def test_names_that_are_not_there_are_answered_with_those_that_are() -> None:
    mesh = two_regions()
    with pytest.raises(ModelError, match=r"no patch 'tip'.*\n.*'top', 'top left', 'end'"):
        mesh.patch("tip")
    with pytest.raises(ModelError, match=r"no node set 'tip'.*\n.*'everything', 'corner'"):
        mesh.node_set("tip")
    with pytest.raises(ModelError, match="'none': holds no node"):
        node_set(mesh, "none", low=(5.0, None, None))
