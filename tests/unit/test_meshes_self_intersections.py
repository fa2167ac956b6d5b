"""Surfaces that cross themselves, numbers that are none, and cells that are inside out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import (
    Mesh,
    block,
    boundary,
    read_mesh,
    surface_of,
    tetrahedra,
    tube,
    write_mesh,
)
from strutwork.meshes.self_intersections import TOGETHER, check_simple
from strutwork.meshes.surfaces import Surface, check_closed, check_one_body, read_surface, welded
from tests.unit.test_meshes_surface_cases import CORNERS, SIDES


def skin(mesh: Mesh) -> Surface:
    return surface_of(mesh, boundary(mesh))


def pushed_through(depth: float) -> Surface:
    """A cube of 1 m; the middle of its top is pushed down by `depth`."""
    surface = skin(block((1, 1, 1), (4, 4, 4)))
    points = surface.points.copy()
    middle = np.flatnonzero(np.linalg.norm(points - (0.5, 0.5, 1.0), axis=1) < 1e-9)
    points[middle, 2] -= depth
    return replace(surface, points=points)


@pytest.mark.parametrize("depth", [0.0, 0.5, 0.999])
def test_a_surface_that_does_not_cross_itself_passes(depth: float) -> None:
    check_simple(pushed_through(depth))


def test_a_shell_pushed_through_itself_is_refused_with_the_place() -> None:
    surface = pushed_through(1.4)
    # nothing else is wrong with it
    check_closed(surface)
    check_one_body(surface)
    with pytest.raises(ModelError, match=r"crosses itself: \d+ triangles") as raised:
        check_simple(surface)
    # its sides cross the bottom near the middle
    assert "0) m, all between (0." in str(raised.value)
    with pytest.raises(ModelError, match="crosses itself"):
        tetrahedra(surface, 0.1)


@pytest.mark.parametrize("shift", [0.5, 0.37])
def test_cubes_that_overlap_cross_at_any_place(shift: float) -> None:
    one = skin(block((1, 1, 1), (1, 1, 1)))
    moved = one.points + np.full(3, shift)
    both = Surface(
        np.concatenate([one.points, moved]),
        np.concatenate([one.triangles, one.triangles + len(one.points)]),
    )
    with pytest.raises(ModelError, match="crosses itself"):
        check_simple(both)
    apart = np.concatenate([one.points, one.points + np.array([1.0 + shift, 0, 0])])
    check_simple(replace(both, points=apart))


def test_cells_with_a_cavity_and_long_thin_triangles_pass() -> None:
    check_simple(skin(tube(0.03, 0.08, 2.0, (1, 48, 1))))


def test_all_pairs_agree_with_a_search_without_a_tree() -> None:
    """On random triangles; each pair was compared with every other."""
    from strutwork.meshes.self_intersections import _crossings, _overlapping  # noqa: PLC0415

    generator = np.random.default_rng(3)
    centres = generator.random((300, 1, 3))
    points = (centres + 0.1 * generator.normal(size=(300, 3, 3))).reshape(-1, 3)
    surface = Surface(points, np.arange(900).reshape(-1, 3))
    every = np.stack(np.triu_indices(300, 1), axis=1)
    wanted = {tuple(sorted(p)) for p in _crossings(surface, every)[0].tolist()}
    found = {
        tuple(sorted(p))
        for pairs in _overlapping(surface)
        for p in _crossings(surface, pairs)[0].tolist()
    }
    assert found == wanted
    assert len(wanted) > 100


def test_a_large_surface_is_searched_in_pieces() -> None:
    surface = skin(block((1, 1, 1), (60, 60, 60)))
    # the pairs of neighbours alone are more than are looked at together
    assert 10 * len(surface.triangles) > TOGETHER
    check_simple(surface)


@pytest.mark.parametrize("word", ["nan", "NaN", "inf", "-inf", "1e999"])
def test_an_obj_with_a_number_that_is_none_is_refused(word: str, tmp_path: Path) -> None:
    path = tmp_path / "part.obj"
    lines = ["v {} {} {}".format(*corner) for corner in CORNERS]
    lines[2] = f"v 0 {word} 0"
    lines += ["f {} {} {}".format(*(i + 1 for i in side)) for side in SIDES]
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(ModelError, match=r"points that are not finite|cannot be read") as raised:
        read_surface(path)
    assert "part.obj" in str(raised.value)


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".med", ".inp", ".bdf"])
def test_inverted_cells_of_a_file_are_named_with_their_place(suffix: str, tmp_path: Path) -> None:
    mesh = block((3, 1, 1), (3, 1, 1))
    first = mesh.blocks[0].nodes.copy()
    # top and bottom of the second cell change places
    first[1] = first[1][[4, 5, 6, 7, 0, 1, 2, 3]]
    wrong = replace(mesh, blocks=(replace(mesh.blocks[0], nodes=first),), patches={}, node_sets={})
    path = write_mesh(wrong, tmp_path / f"part{suffix}")
    with pytest.raises(ModelError, match=r"1 of 3 cells are inverted or flat; the worst is") as bad:
        read_mesh(path)
    assert "(1.5, 0.5, 0.5) m" in str(bad.value)


def test_a_legacy_vtk_file_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "part.vtk"
    path.write_text("# vtk DataFile Version 3.0\n")
    with pytest.raises(ModelError, match=r"legacy file of VTK.*\n.*\.vtu"):
        read_mesh(path)


def test_welding_keeps_what_crosses() -> None:
    with pytest.raises(ModelError, match="crosses itself"):
        check_simple(welded(pushed_through(1.4)))
