"""Tetrahedra through Gmsh; where it is not installed, the words of the refusal."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import (
    block,
    boundary,
    check_connectivity,
    mass_properties,
    patch_area,
    quality,
    read_mesh,
    surface_of,
    tetrahedra,
    tube,
    write_mesh,
)
from strutwork.meshes.surfaces import Surface

CASES = Path(__file__).parents[1] / "cases" / "step"


def cylinder() -> Surface:
    mesh = tube(0.03, 0.08, 0.2, (1, 24, 4), name="ring")
    return surface_of(mesh, boundary(mesh))


@pytest.fixture(autouse=True)
def require_gmsh() -> None:
    """What is said without Gmsh has tests of its own, which hide it."""
    if importlib.util.find_spec("gmsh") is None:
        pytest.fail("Gmsh is missing. These tests need the extra `cad`: pip install -e '.[cad]'.")


def write_step(path: Path, draw: Callable[[Any], object]) -> Path:
    """A STEP file in millimetres, as Gmsh writes it."""
    import gmsh  # noqa: PLC0415 - an extra

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path


@pytest.mark.parametrize("order", [1, 2])
def test_a_closed_surface_is_filled(order: int) -> None:
    surface = cylinder()
    mesh = tetrahedra(surface, 0.03, order=order)
    assert [b.kind for b in mesh.blocks] == [["tetra"], ["tetra10"]][order - 1]
    ring = tube(0.03, 0.08, 0.2, (1, 24, 4))
    # the surface is meshed anew: a curve is cut by other chords
    assert quality(mesh).volume.sum() == pytest.approx(quality(ring).volume.sum(), rel=0.03)
    assert len(check_connectivity(mesh).part_regions) == 1
    total = sum(patch_area(mesh, patch) for patch in mesh.patches.values())
    assert total == pytest.approx(patch_area(mesh, boundary(mesh)), rel=1e-9)


def test_a_plane_surface_keeps_its_volume_and_its_inertia() -> None:
    brick = block((0.3, 0.2, 0.1), (3, 2, 1), name="brick")
    surface = surface_of(brick, boundary(brick))
    mesh = tetrahedra(surface, 0.05, order=2)
    found, wanted = mass_properties(mesh, 7850.0), mass_properties(brick, 7850.0)
    # Gmsh places points on the planes to its own tolerance of 1e-8 or so
    assert found.mass == pytest.approx(wanted.mass, rel=1e-6)
    assert found.centre == pytest.approx(wanted.centre, rel=1e-6)
    assert found.inertia == pytest.approx(wanted.inertia, rel=1e-5, abs=1e-8)


def test_a_step_file_of_two_bodies_is_meshed_in_metres_as_one(tmp_path: Path) -> None:
    def draw(occ: Any) -> None:
        occ.addBox(0, 0, 0, 100, 200, 300)
        occ.addBox(100, 0, 0, 50, 50, 50)

    path = tmp_path / "two.step"
    write_step(path, draw)
    mesh = tetrahedra(path, 0.04)
    assert mesh.extent == pytest.approx([0.15, 0.2, 0.3])
    assert mesh.regions == ("body 1", "body 2")
    check_connectivity(mesh)
    masses = mass_properties(mesh, {"body 1": 1000.0, "body 2": 2000.0})
    assert masses.mass == pytest.approx(6.0 + 0.25, rel=1e-9)
    areas = sorted(patch_area(mesh, patch) for patch in mesh.patches.values())
    assert areas[-1] == pytest.approx(0.2 * 0.3)
    assert np.sum(np.isclose(areas, 0.05**2)) == 6
    # what Gmsh made goes through a file as any other mesh
    back = read_mesh(write_mesh(mesh, tmp_path / "two.med"))
    assert back.regions == mesh.regions


def test_quadratic_tetrahedra_follow_the_curved_faces_of_a_step_file(tmp_path: Path) -> None:
    path = tmp_path / "rod.step"
    write_step(path, lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 100, 20))
    curved = tetrahedra(path, 0.01)
    with pytest.warns(UserWarning, match="its volume .* quadratic cells"):
        straight = tetrahedra(path, 0.01, order=1)
    exact = np.pi * 0.02**2 * 0.1
    # chords of about half a radius: 1 − sin(0.5)/0.5 = 4 %, parabolas some 0.1 %
    errors = [1.0 - quality(m).volume.sum() / exact for m in (straight, curved)]
    assert 0.01 < errors[0] < 0.06
    assert abs(errors[1]) < 0.002


def test_a_step_file_without_a_body_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "sheet.stp"
    write_step(tmp_path / "sheet.step", lambda occ: occ.addRectangle(0, 0, 0, 1, 1)).rename(path)
    with pytest.raises(ModelError, match=r"sheet.stp: holds no solid body"):
        tetrahedra(path, 0.1)
    path.write_text("ISO-10303-21;\nHEADER;\nnonsense\nEND-ISO-10303-21;\n")
    with pytest.raises(ModelError, match=r"sheet.stp: "):
        tetrahedra(path, 0.1)


def test_a_missing_gmsh_is_named_with_its_licence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gmsh", None)
    with pytest.raises(ModelError, match=r"ring: needs Gmsh.*\n.*\[cad\].*GPL-2.0-or-later"):
        tetrahedra(cylinder(), 0.1)


def test_a_gmsh_without_its_libraries_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    def load(_: str) -> ModuleType:
        raise OSError("libGLU.so.1: cannot open shared object file")

    monkeypatch.setattr("strutwork.meshes.gmsh_volumes.import_module", load)
    with pytest.raises(ModelError, match=r"libGLU.so.1.*\n.*libglu1-mesa"):
        tetrahedra(cylinder(), 0.1)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("part.stl", b"", "not that of STEP"),
        ("part.step", None, "no such file"),
        ("part.step", b"", "cut short"),
        ("part.step", b"ISO-10303-21;\nHEADER;\n", "cut short"),
    ],
)
def test_what_is_no_step_file_is_refused(
    name: str, content: bytes | None, words: str, tmp_path: Path
) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(ModelError, match=words):
        tetrahedra(tmp_path / name, 0.1)


def test_open_surfaces_and_wrong_sizes_are_refused() -> None:
    surface = cylinder()
    opened = Surface(surface.points, surface.triangles[1:], "ring")
    with pytest.raises(ModelError, match="ring: is not watertight: 3 open edges"):
        tetrahedra(opened, 0.1)
    with pytest.raises(ModelError, match=r"cells of 0.0 m of order 1"):
        tetrahedra(surface, 0.0)
    with pytest.raises(ModelError, match=r"of order 3"):
        tetrahedra(surface, 0.1, order=3)


def test_a_mesh_that_would_fill_the_memory_is_foreseen() -> None:
    with pytest.raises(ModelError, match=r"ring: cells of 1e-05 m in .* is the limit"):
        tetrahedra(cylinder(), 1e-5)


@pytest.mark.parametrize(
    ("name", "size", "volume", "near"),
    # six digits in the file, and parabolas for circles; a cavity stays a cavity
    [("shaft", 0.012, 7.0686e-5, 0.01), ("cavity", 0.02, 0.000784, 1e-6)],
)
def test_a_step_file_keeps_its_volume(name: str, size: float, volume: float, near: float) -> None:
    mesh = tetrahedra(CASES / f"{name}.step", size)
    assert quality(mesh).volume.sum() == pytest.approx(volume, rel=near)


def test_the_size_that_is_named_for_lost_volume_reaches_it() -> None:
    path = CASES / "shaft.step"
    with pytest.warns(UserWarning, match=r"-7\.\d % off the exact") as caught:
        tetrahedra(path, 0.012, order=1)
    named = re.search(r"Cells of (\S+) m", str(caught[0].message))
    assert named is not None
    finer = tetrahedra(path, float(named[1]), order=1)
    assert quality(finer).volume.sum() == pytest.approx(7.0686e-5, rel=0.01)
