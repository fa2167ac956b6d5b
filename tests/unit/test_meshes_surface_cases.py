"""Surfaces that others write: read, meshed, or refused for what they are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import quality, tetrahedra
from strutwork.meshes.surfaces import Surface, check_closed, read_surface, surface_properties

CASES = Path(__file__).parents[1] / "cases" / "surface"

#: A tetrahedron of volume 1/6.
CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
SIDES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


def stl_text() -> str:
    lines = ["solid part"]
    for side in SIDES:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {} {} {}".format(*CORNERS[i]) for i in side]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid part"]) + "\n"


@pytest.mark.parametrize(
    "content",
    [
        stl_text().encode(),
        stl_text().upper().encode(),
        b"\xef\xbb\xbf" + stl_text().encode(),
        b"\n" + stl_text().encode(),
        b"\xef\xbb\xbf\r\n" + stl_text().upper().replace("\n", "\r\n").encode() + b"\r\n \r\n",
    ],
    ids=["plain", "capitals", "mark", "blank line", "all of them"],
)
def test_a_text_stl_is_read_however_it_is_written(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "part.stl").write_bytes(content)
    found = surface_properties(read_surface(tmp_path / "part.stl"), 6.0)
    assert found.mass == pytest.approx(1.0, rel=1e-6)


def test_edges_of_more_than_two_triangles_are_refused() -> None:
    surface = read_surface(CASES / "joined_tetrahedra.obj")
    with pytest.raises(ModelError, match="edges with more than two triangles"):
        check_closed(surface)
    with pytest.raises(ModelError, match="edges with more than two triangles"):
        tetrahedra(surface, 0.1)


def test_double_faces_and_a_third_flap_are_refused() -> None:
    points = np.array(CORNERS, dtype=float)
    for more in ([[1, 2, 3]], [[1, 2, 3], [3, 2, 1]]):
        with pytest.raises(ModelError, match="edges with more than two triangles"):
            check_closed(Surface(points, np.array([*SIDES, *more])))


def test_a_cavity_stays_and_bodies_apart_are_named() -> None:
    pytest.importorskip("gmsh")
    hollow = read_surface(CASES / "hollow_cube.stl", "mm")
    assert quality(tetrahedra(hollow, 0.03)).volume.sum() == pytest.approx(0.000784, rel=1e-6)
    apart = read_surface(CASES / "two_cubes_apart.stl", "mm")
    with pytest.raises(ModelError, match="2 separate bodies") as raised:
        tetrahedra(apart, 0.03)
    assert "another size" not in str(raised.value)
