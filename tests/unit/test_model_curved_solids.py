"""Curved parts in model files: they keep their volume, or what is lost is said with its remedy."""

from __future__ import annotations

import re
import shutil
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError, ModelWarning
from strutwork.fea import modes
from strutwork.fea.solid_modes import solid_modes
from strutwork.machines.model import Model as ModelFile
from strutwork.machines.model_file import parse_model
from strutwork.machines.model_solid_mesh import solid_mesh
from strutwork.machines.model_solid_schema import SolidTable
from strutwork.meshes import Mesh, cell_volumes, is_straight, mapped, quadratic, tube, write_mesh
from strutwork.meshes.grids import grid
from strutwork.meshes.surface_integrals import patch_area
from strutwork.msa import rod
from strutwork.reports.model_check import check_model
from tests.model_files import Content, toml
from tests.solid_cases import STEEL, bent, cells_of, in_tetrahedra, matrices_of
from tests.structures import Model

CASES = Path(__file__).parents[1] / "cases" / "step"

#: Of the shaft: m and m³.
RADIUS, LENGTH, VOLUME = 0.015, 0.1, 7.0686e-5


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Superelements of these tests stay with them."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "curved"))
        yield


def shaft(folder: Path, cell: float, order: int = 2) -> SolidTable:
    shutil.copy(CASES / "shaft.step", folder)
    return SolidTable(
        name="shaft", step="shaft.step", cell=cell, material="steel", order=order, interfaces=[]
    )


def shaft_model(folder: Path, cell: str, order: int = 2) -> ModelFile:
    """The shaft held at one end."""
    shutil.copy(CASES / "shaft.step", folder)
    flat = {"foot": 0.0, "head": LENGTH}
    content: Content = {
        "title": "Shaft",
        "materials": {
            "steel": {"youngs_modulus": "200 GPa", "poissons_ratio": 0.3, "density": 8000}
        },
        "nodes": {name: [0, 0, z] for name, z in flat.items()},
        "solids": [
            {
                "name": "shaft",
                "step": "shaft.step",
                "cell": cell,
                "order": order,
                "material": "steel",
                "interfaces": [
                    {"node": name, "box": [[-1, -1, z], [1, 1, z]]} for name, z in flat.items()
                ],
            }
        ],
        "supports": [{"node": "foot", "fixed": "all"}],
        "tool": {"tcp": "head"},
    }
    return parse_model(toml(content), folder=folder)


def beam_frequency() -> float:
    """First bending frequency of the shaft as a free Timoshenko beam, Hz."""
    model = Model()
    model.nodes(a=(0, 0, 0), b=(LENGTH, 0, 0))
    model.beam("shaft", "a", "b", rod(2 * RADIUS), material=STEEL, elements=30)
    return float(modes(model.place(), 7).frequencies[6])


def test_a_coarse_shaft_keeps_its_volume_mass_and_frequency_without_a_word(tmp_path: Path) -> None:
    pytest.importorskip("gmsh")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        coarse, fine = (shaft_model(tmp_path, cell) for cell in ("12 mm", "5 mm"))
    assert coarse.solids[0].weighed[0] == pytest.approx(8000.0 * VOLUME, rel=0.01)
    mass = check_model(coarse).mass
    assert mass is not None
    assert mass.total == pytest.approx(8000.0 * VOLUME, rel=0.01)
    found, expected = (modes(m.placed, 4).frequencies[:3] for m in (coarse, fine))
    np.testing.assert_allclose(found, expected, rtol=0.01)


def test_the_free_shaft_is_the_beam(tmp_path: Path) -> None:
    pytest.importorskip("gmsh")
    mesh = solid_mesh(shaft(tmp_path, 0.012), tmp_path)
    assert not is_straight(mesh)
    found = solid_modes(matrices_of(mesh), 9).frequencies[6:]
    assert found[0] == pytest.approx(beam_frequency(), rel=0.01)
    assert STEEL.density is not None
    torsion = np.sqrt(STEEL.shear_modulus / STEEL.density) / (2 * LENGTH)
    assert found[2] == pytest.approx(torsion, rel=0.01)


def test_of_order_1_the_size_that_is_named_reaches_one_percent(tmp_path: Path) -> None:
    pytest.importorskip("gmsh")
    words = r"solids\.shaft: .* -7\.\d % off[\s\S]*order = 2 keeps the curves"
    with pytest.warns(ModelWarning, match=words) as caught:
        coarse = solid_mesh(shaft(tmp_path, 0.012, order=1), tmp_path)
    assert coarse.blocks[0].kind == "tetra"
    assert cell_volumes(coarse).sum() < 0.94 * VOLUME
    named = re.search(r"Cells of (\S+) m should reach 1 %", str(caught[0].message))
    assert named is not None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fine = solid_mesh(shaft(tmp_path, float(named[1]), order=1), tmp_path)
    assert cell_volumes(fine).sum() == pytest.approx(VOLUME, rel=0.01)


def rod_of_tetrahedra() -> Mesh:
    """A half ring of curved tetrahedra with patches."""
    flat = grid(np.linspace(0.03, 0.05, 2), np.linspace(0.0, np.pi, 7), np.linspace(0.0, 0.1, 3))

    def rolled(points: np.ndarray) -> np.ndarray:
        r, angle, z = points.T
        return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)

    return mapped(quadratic(in_tetrahedra(flat)), rolled)


@pytest.mark.parametrize("suffix", ["inp", "bdf", "msh", "vtu", "med"])
def test_a_mesh_file_keeps_its_curves(suffix: str, tmp_path: Path) -> None:
    made = rod_of_tetrahedra()
    write_mesh(made, tmp_path / f"ring.{suffix}")
    table = SolidTable(name="ring", mesh=f"ring.{suffix}", material="steel", interfaces=[])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = solid_mesh(table, tmp_path)
    assert {b.kind for b in found.blocks} == {"tetra10"}
    # decks have ten figures or so
    assert cell_volumes(found).sum() == pytest.approx(cell_volumes(made).sum(), rel=1e-6)
    assert cell_volumes(found).sum() == pytest.approx(np.pi / 2 * 0.0016 * 0.1, rel=2e-4)
    assert matrices_of(found).total_mass == pytest.approx(800 * np.pi / 2 * 0.0016, rel=2e-4)


@pytest.mark.parametrize("kind", ["hexahedron20", "hexahedron27"])
def test_hexahedra_of_a_mesh_file_keep_their_curves(kind: str, tmp_path: Path) -> None:
    made = bent(cells_of("hexahedron", (0.3, 0.2, 0.4), (2, 1, 2)), kind)
    write_mesh(made, tmp_path / "block.vtu")
    table = SolidTable(name="block", mesh="block.vtu", material="steel", interfaces=[])
    found = solid_mesh(table, tmp_path)
    np.testing.assert_allclose(cell_volumes(found), cell_volumes(made), rtol=1e-12)
    assert found.blocks[0].kind == kind


def test_a_mesh_file_of_straight_quadratic_cells_is_one_of_their_corners(tmp_path: Path) -> None:
    made = quadratic(cells_of("tetra", (0.3, 0.2, 0.4), (2, 1, 2)))
    write_mesh(made, tmp_path / "block.vtu")
    table = SolidTable(name="block", mesh="block.vtu", material="steel", interfaces=[])
    assert solid_mesh(table, tmp_path).blocks[0].kind == "tetra"


def test_a_mesh_file_of_curved_cells_and_order_1_is_said_to_become_straight(
    tmp_path: Path,
) -> None:
    write_mesh(tube(0.03, 0.08, 0.2, (1, 8, 2), order=2), tmp_path / "ring.vtu")
    table = SolidTable(name="ring", mesh="ring.vtu", material="steel", order=1, interfaces=[])
    with pytest.warns(ModelWarning, match=r"solids\.ring: .* % off.*\n?.*times finer to reach"):
        solid_mesh(table, tmp_path)


def test_an_inverted_curved_cell_of_a_file_is_named_with_its_field(tmp_path: Path) -> None:
    made = rod_of_tetrahedra()
    points = made.points.copy()
    cell = made.blocks[0].nodes[7]
    # an edge's middle node beyond the opposite corner
    points[cell[4]] = 2.0 * points[cell[3]] - points[cell[4]]
    bad = Mesh(points, made.blocks, made.regions, name="bad")
    write_mesh(bad, tmp_path / "bad.vtu")
    table = SolidTable(name="ring", mesh="bad.vtu", material="steel", interfaces=[])
    with pytest.raises(
        ModelError, match=r"solids\.ring\.mesh: [\s\S]*worst is cell \d+ at \(.*\) m"
    ):
        solid_mesh(table, tmp_path)


def test_of_order_1_an_inverted_curve_does_not_matter(tmp_path: Path) -> None:
    made = rod_of_tetrahedra()
    points = made.points.copy()
    cell = made.blocks[0].nodes[7]
    points[cell[4]] = 2.0 * points[cell[3]] - points[cell[4]]
    write_mesh(Mesh(points, made.blocks, made.regions), tmp_path / "bad.vtu")
    table = SolidTable(name="ring", mesh="bad.vtu", material="steel", order=1, interfaces=[])
    with warnings.catch_warnings():
        # what the wild curve holds is no volume to compare with
        warnings.simplefilter("ignore", ModelWarning)
        found = solid_mesh(table, tmp_path)
    assert cell_volumes(found).min() > 0.0


@pytest.mark.parametrize(("order", "lack"), [(1, 0.01), (2, 1e-4)])
def test_a_generated_tube_lacks_less_than_one_percent(order: int, lack: float) -> None:
    table = SolidTable(
        name="tube", shape="tube", inner_diameter=0.12, outer_diameter=0.2, length=0.6,
        cell=0.1, material="steel", order=order, interfaces=[],
    )  # fmt: skip
    mesh = solid_mesh(table, Path())
    ring = np.pi / 4 * (0.2**2 - 0.12**2)
    volume = cell_volumes(mesh).sum()
    assert ring * 0.6 * (1.0 - lack) < volume < ring * 0.6
    assert patch_area(mesh, mesh.patch("-z")) == pytest.approx(volume / 0.6, rel=1e-9)
