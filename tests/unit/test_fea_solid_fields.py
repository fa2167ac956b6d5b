"""Fields of solids in files, surfaces and pictures."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea.solid_fields import (
    mode_fields,
    static_fields,
    surface_field,
    write_fields,
    write_scene,
)
from strutwork.fea.solid_loads import force_load
from strutwork.fea.solid_modes import solid_modes
from strutwork.fea.solid_static import SolidStatic, solve_solid
from strutwork.fea.solid_stress import cell_stresses
from strutwork.meshes import block
from tests.solid_cases import FIELDS, cells_of, in_two_regions, matrices_of

SIZE = (1.0, 0.2, 0.3)
PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture(scope="module")
def bent() -> SolidStatic:
    matrices = matrices_of(block(SIZE, (4, 1, 2)))
    return solve_solid(matrices, force_load(matrices, "+x", [0, 0, 1e4]), {"-x": "xyz"})


@pytest.mark.parametrize(("kind", "order"), FIELDS)
def test_file_holds_mesh_and_fields(tmp_path: Path, kind: str, order: int) -> None:
    matrices = matrices_of(in_two_regions(cells_of(kind, SIZE, (2, 1, 1))), order)
    values = np.arange(matrices.size, dtype=float).reshape(-1, 3)
    path = write_fields(matrices, tmp_path / "a.vtu", {"displacement (m)": values})
    found = meshio.read(path)
    np.testing.assert_allclose(found.points, matrices.points)
    assert found.cells[0].type == matrices.mesh.blocks[0].kind
    np.testing.assert_array_equal(found.cells[0].data, matrices.cells)
    np.testing.assert_allclose(found.point_data["displacement (m)"], values)
    np.testing.assert_array_equal(found.cell_data["region"][0], matrices.solid.cell_regions)


def test_static_fields(tmp_path: Path, bent: SolidStatic) -> None:
    fields = static_fields(bent)
    np.testing.assert_array_equal(fields["displacement (m)"], bent.at_nodes())
    cells = {"stress (Pa)": cell_stresses(bent.matrices, bent.displacements[:, 0])}
    path = write_fields(bent.matrices, tmp_path / "bent.vtu", fields, cells)
    found = meshio.read(path)
    # VTK's order of a symmetric tensor is xx, yy, zz, xy, yz, xz
    ours = fields["stress (Pa)"][:, [0, 1, 2, 3, 5, 4]]
    np.testing.assert_allclose(found.point_data["stress (Pa)"], ours)
    np.testing.assert_allclose(
        found.cell_data["stress (Pa)"][0], cells["stress (Pa)"][:, [0, 1, 2, 3, 5, 4]]
    )


def test_modes_are_named_with_their_frequencies(bent: SolidStatic) -> None:
    modes = solid_modes(bent.matrices, 3, {"-x": "xyz"})
    fields = mode_fields(modes)
    assert next(iter(fields)) == f"mode 1: {modes.frequencies[0]:.6g} Hz"
    for shape in fields.values():
        assert np.linalg.norm(shape, axis=1).max() == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["a.vtk", "a"])
def test_other_suffixes_are_refused(tmp_path: Path, bent: SolidStatic, name: str) -> None:
    with pytest.raises(ModelError, match=r"Name it \.vtu"):
        write_fields(bent.matrices, tmp_path / name, {})
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("size", "value"), [(3, 0.0), (135, np.nan)])
def test_fields_of_another_size_or_not_finite_are_refused(
    tmp_path: Path, bent: SolidStatic, size: int, value: float
) -> None:
    assert len(bent.matrices.points) == 135
    array = np.full(size, value)
    with pytest.raises(ModelError, match="field 'heat'"):
        write_fields(bent.matrices, tmp_path / "a.vtu", {"heat": array})
    assert not list(tmp_path.iterdir())
    with pytest.raises(ModelError, match="field 'heat'"):
        surface_field(bent.matrices, array, name="heat")


@pytest.mark.parametrize(("kind", "order"), FIELDS)
@pytest.mark.parametrize("fine", [False, True])
def test_surface_is_the_outer_one(kind: str, order: int, fine: bool) -> None:
    matrices = matrices_of(cells_of(kind, SIZE, (3, 2, 2)), order)
    u = matrices.points * [0.0, 1e-3, 0.0]
    field = surface_field(matrices, displacement=u.ravel(), fine=fine)
    corners = field.points[field.triangles]
    # closed, outward: the volume by the divergence theorem
    volume = np.einsum("ti,ti->t", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(np.prod(SIZE))
    # 2 x (3 x 2 + 3 x 2 + 2 x 2) faces of two triangles
    finer = 4 if fine and order == 2 else 1
    assert len(field.triangles) == 64 * finer
    np.testing.assert_allclose(field.values, 1e-3 * field.points[:, 1])
    assert field.colours.shape == field.points.shape
    assert field.drawing_scale * 2e-4 == pytest.approx(0.08 * np.linalg.norm(SIZE))


def test_nothing_moves() -> None:
    matrices = matrices_of(block(SIZE, (1, 1, 1)), 1)
    field = surface_field(matrices)
    assert np.isfinite(field.drawing_scale)
    assert np.isfinite(field.colours).all()


def test_scene_swings(tmp_path: Path, bent: SolidStatic) -> None:
    field = surface_field(bent.matrices, displacement=bent.at_nodes())
    content = write_scene(field, tmp_path / "bent.glb").read_bytes()
    assert content[:4] == b"glTF"
    length = int.from_bytes(content[12:16], "little")
    document = json.loads(content[20 : 20 + length])
    primitive = document["meshes"][0]["primitives"][0]
    assert primitive["targets"]
    assert "COLOR_0" in primitive["attributes"]
    assert document["animations"]


def test_picture_without_a_display(tmp_path: Path, bent: SolidStatic) -> None:
    field = surface_field(bent.matrices, displacement=bent.at_nodes(), name="displacement (m)")
    np.savez(tmp_path / "field.npz", **{k: getattr(field, k) for k in
             ("points", "triangles", "values", "displacement")})  # fmt: skip
    program = (
        "import sys, numpy as np\n"
        "from strutwork.fea.solid_fields import SurfaceField\n"
        "from strutwork.fea.solid_picture import write_picture\n"
        "data = np.load('field.npz')\n"
        "write_picture(SurfaceField(**data, name='displacement (m)'), 'a.png', size=(300, 240))\n"
    )
    environment = {k: v for k, v in os.environ.items() if k not in {"DISPLAY", "WAYLAND_DISPLAY"}}
    environment["PYTHONPATH"] = str(Path(__file__).parents[2])
    run = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, env=environment, capture_output=True,
        text=True, check=False, timeout=300,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert (run.stdout, run.stderr) == ("", "")
    content = (tmp_path / "a.png").read_bytes()
    assert content[:8] == PNG
    assert (int.from_bytes(content[16:20]), int.from_bytes(content[20:24])) == (300, 240)
    # something is drawn: a white picture takes less than a kilobyte
    assert len(content) > 4000
