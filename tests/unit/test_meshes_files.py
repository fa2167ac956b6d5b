"""Mesh files: what comes back from each format, and what is refused."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import (
    CellBlock,
    Faces,
    Mesh,
    cell_volumes,
    limits,
    patch_area,
    quadratic,
    read_mesh,
    write_mesh,
)
from strutwork.meshes.mesh_files import FORMATS
from tests.mesh_cases import every_kind, two_regions

ALL = list(FORMATS)
CASES = [
    (kind, suffix)
    for kind in every_kind()
    for suffix in ALL
    if kind != "hexahedron27" or suffix in {".msh", ".vtu"}
]
#: Nastran's large fields hold eleven digits or more; the others hold all.
DIGITS = {".bdf": 1e-9}


def renamed(name: str, suffix: str) -> str:
    return name.replace(" ", "_") if suffix == ".inp" else name


@pytest.mark.parametrize(("kind", "suffix"), CASES)
@pytest.mark.parametrize("unit", ["m", "mm"])
def test_what_is_written_comes_back(kind: str, suffix: str, unit: str, tmp_path: Path) -> None:
    mesh = every_kind()[kind]
    found = read_mesh(write_mesh(mesh, tmp_path / f"part{suffix}", unit), unit)
    assert found.name == f"part{suffix}"
    digits = DIGITS.get(suffix, 1e-14)
    assert found.points == pytest.approx(mesh.points, rel=digits, abs=digits)
    assert [b.kind for b in found.blocks] == [kind]
    assert cell_volumes(found).sum() == pytest.approx(cell_volumes(mesh).sum(), rel=10 * digits)
    assert found.regions == tuple(renamed(r, suffix) for r in mesh.regions)
    for region in mesh.regions:
        assert found.region_nodes(renamed(region, suffix)).tolist() == (
            mesh.region_nodes(region).tolist()
        )
    if suffix != ".bdf":
        sets = {renamed(name, suffix): nodes.tolist() for name, nodes in mesh.node_sets.items()}
        assert {name: nodes.tolist() for name, nodes in found.node_sets.items()} == sets
    assert set(found.patches) == {renamed(name, suffix) for name in mesh.patches}
    for name, patch in mesh.patches.items():
        back = found.patch(renamed(name, suffix))
        assert back.nodes.tolist() == patch.nodes.tolist()
        assert patch_area(found, back) == pytest.approx(patch_area(mesh, patch), rel=10 * digits)


def test_the_file_is_in_the_unit_asked_for(tmp_path: Path) -> None:
    path = write_mesh(two_regions(), tmp_path / "part.vtu", "mm")
    assert meshio.vtu.read(str(path)).points.max() == pytest.approx(2000.0)
    assert read_mesh(path).extent == pytest.approx([2000.0, 1000.0, 1000.0])
    with pytest.raises(ModelError, match=r"'inch'.*\n.*m or mm"):
        read_mesh(path, "inch")


def test_a_deck_is_one_that_calculix_accepts(tmp_path: Path) -> None:
    text = write_mesh(two_regions(), tmp_path / "part.inp").read_text()
    assert "*ELEMENT, TYPE=C3D8, ELSET=left_half\n" in text
    assert "*SURFACE, NAME=top_left, TYPE=ELEMENT\n" in text
    # CalculiX reads at most 16 numbers a line; a line that goes on ends with a comma
    deck = write_mesh(quadratic(two_regions(), serendipity=True), tmp_path / "fine.inp").read_text()
    rows = re.search(r"C3D20, ELSET=left_half\n(.*\n)(.*\n)(.*\n)", deck)
    assert rows is not None
    assert [r.count(",") for r in rows.groups()] == [8, 8, 4]
    assert rows[1].startswith("1, ")


def test_surfaces_of_a_foreign_deck_are_found_by_number_and_by_set(tmp_path: Path) -> None:
    path = tmp_path / "foreign.inp"
    path.write_text(
        "*HEADING\nby hand\n*NODE\n"
        "10, 0., 0., 0.\n11, 1., 0., 0.\n12, 1., 1., 0.\n13, 0., 1., 0.\n"
        "20, 0., 0., 1.\n21, 1., 0., 1.\n22, 1., 1., 1.\n23, 0., 1., 1.\n"
        "*ELEMENT, TYPE=C3D8R, ELSET=EALL\n77, 10, 11, 12, 13, 20, 21, 22, 23\n"
        "*ELSET, ELSET=ONE\n77\n"
        "*SURFACE, NAME=BOTTOM\n77, S1\n*SURFACE, NAME=TOP, TYPE=ELEMENT\nONE, S2\n"
        "*SURFACE, NAME=CLOUD, TYPE=NODE\n10\n"
    )
    mesh = read_mesh(path, "mm")
    assert mesh.patch("BOTTOM").faces[0].nodes.tolist() == [[0, 3, 2, 1]]
    assert mesh.patch("TOP").faces[0].nodes.tolist() == [[4, 5, 6, 7]]
    assert list(mesh.patches) == ["BOTTOM", "TOP"]
    assert mesh.extent == pytest.approx([1e-3, 1e-3, 1e-3])


def test_a_vtu_of_another_program_has_regions_by_number(tmp_path: Path) -> None:
    mesh = two_regions()
    cells = [("hexahedron", mesh.blocks[0].nodes)]
    data = {"mat_id": [mesh.blocks[0].region + 4]}
    meshio.vtu.write(str(tmp_path / "m.vtu"), meshio.Mesh(mesh.points, cells, cell_data=data))
    assert read_mesh(tmp_path / "m.vtu").regions == ("region 4", "region 5")


@pytest.mark.parametrize("kind", ["hexahedron", "hexahedron20", "tetra", "tetra10"])
def test_a_med_file_has_the_node_order_of_salome_and_that_of_meshio_is_read(
    kind: str, tmp_path: Path
) -> None:
    mesh = every_kind()[kind]
    own = h5py.File(write_mesh(mesh, tmp_path / "own.med"))
    code = {"hexahedron": "HE8", "hexahedron20": "H20", "tetra": "TE4", "tetra10": "T10"}[kind]
    step = next(iter(own["ENS_MAA/mesh"].values()))
    nodes = step[f"MAI/{code}/NOD"][()].reshape(-1, mesh.cell_count).T - 1
    # SMDS: a hexahedron 0 3 2 1 4 7 6 5, a tetrahedron 0 2 1 3
    corners = [0, 3, 2, 1, 4, 7, 6, 5] if kind.startswith("hex") else [0, 2, 1, 3]
    wanted = np.concatenate([b.nodes for b in mesh.blocks])[:, corners]
    key = np.lexsort(np.sort(wanted, axis=1).T)
    got = nodes[:, : len(corners)]
    assert got[np.lexsort(np.sort(got, axis=1).T)].tolist() == wanted[key].tolist()
    plain = meshio.Mesh(mesh.points, [(kind, mesh.blocks[0].nodes)])
    meshio.med.write(str(tmp_path / "plain.med"), plain)
    assert read_mesh(tmp_path / "plain.med").blocks[0].nodes.tolist() == (
        mesh.blocks[0].nodes.tolist()
    )


@pytest.mark.parametrize("suffix", ALL)
@pytest.mark.parametrize("share", [0.05, 0.3, 0.6, 0.9])
def test_a_file_cut_short_is_refused_and_named(
    suffix: str, share: float, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = write_mesh(two_regions(), tmp_path / f"part{suffix}")
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * share)])
    # what a deck lacks after its elements are sets alone, which no format lets one tell
    lacks_sets_alone = suffix == ".inp" and share > 0.5
    if lacks_sets_alone:
        content = content[: content.index(b"*ELEMENT") + 200]
        path.write_bytes(content)
    with pytest.raises(ModelError, match=rf"part\{suffix}.*\n.*xport") as caught:
        read_mesh(path)
    if suffix in {".inp", ".bdf"}:
        assert re.search(r"line \d+", str(caught.value))
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("suffix", ALL)
@pytest.mark.parametrize("content", [b"", b"\n", b"this is no mesh\n" * 20, bytes(range(256)) * 9])
def test_what_is_no_mesh_is_refused(
    suffix: str, content: bytes, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"part{suffix}"
    path.write_bytes(content)
    with pytest.raises(ModelError, match=re.escape(str(path))):
        read_mesh(path)
    assert capfd.readouterr() == ("", "")


def test_a_missing_file_and_an_unknown_suffix_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no such file"):
        read_mesh(tmp_path / "none.msh")
    with pytest.raises(ModelError, match=r"suffix '.stp'.*\n.*\.msh.*surfaces"):
        read_mesh(tmp_path / "part.stp")
    with pytest.raises(ModelError, match=r"suffix ''"):
        write_mesh(two_regions(), tmp_path / "part")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", ALL)
def test_a_file_beyond_the_limits_is_refused(
    suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_mesh(two_regions(), tmp_path / f"part{suffix}")
    with monkeypatch.context() as patched:
        patched.setattr(limits, "MOST_POINTS", 10)
        with pytest.raises(ModelError, match=r"; \d+ is the limit"):
            read_mesh(path)
    with monkeypatch.context() as patched:
        patched.setattr(limits, "MOST_CELLS", 5)
        with pytest.raises(ModelError, match=r" cells; 5 is the limit"):
            read_mesh(path)
    monkeypatch.setattr(limits, "LARGEST_FILE", 100)
    with pytest.raises(ModelError, match="MB is the limit"):
        read_mesh(path)


def test_cells_that_cannot_be_used_are_named(tmp_path: Path) -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)], float)
    path = tmp_path / "part.vtu"
    meshio.vtu.write(str(path), meshio.Mesh(points, [("wedge", [[0, 1, 2, 3, 4, 5]])]))
    with pytest.raises(ModelError, match=r"part.vtu.*a wedge .pentahedron., which cannot be used"):
        read_mesh(path)
    meshio.vtu.write(str(path), meshio.Mesh(points, [("triangle", [[0, 1, 2]])]))
    with pytest.raises(ModelError, match=r"part.vtu.*no solid cells"):
        read_mesh(path)


def test_inverted_cells_of_a_file_are_counted_and_placed(tmp_path: Path) -> None:
    mesh = two_regions()
    nodes = np.array(mesh.blocks[0].nodes)
    nodes[3] = nodes[3][[4, 5, 6, 7, 0, 1, 2, 3]]
    wrong = Mesh(
        mesh.points, (CellBlock("hexahedron", nodes, mesh.blocks[0].region),), mesh.regions
    )
    path = write_mesh(wrong, tmp_path / "part.msh")
    with pytest.raises(ModelError, match=r"part.msh: 1 of 16 cells are inverted or flat.*at \("):
        read_mesh(path)
    assert read_mesh(path, check=False).cell_count == 16


@pytest.mark.parametrize(
    ("suffix", "name", "words"),
    [
        (".msh", 'a"b', "Gmsh cannot store the name"),
        (".med", "λ", "MED cannot store the name"),
        (".med", "a/b", "MED cannot store the name"),
        (".msh", "top", "used by two of a region, a patch and a node set"),
    ],
)
def test_names_that_a_format_cannot_hold_leave_no_file(
    suffix: str, name: str, words: str, tmp_path: Path
) -> None:
    mesh = replace(two_regions(), regions=(name, "right"))
    with pytest.raises(ModelError, match=words):
        write_mesh(mesh, tmp_path / f"part{suffix}")
    assert list(tmp_path.iterdir()) == []


def test_a_deck_refuses_names_that_become_one_and_faces_of_no_cell(tmp_path: Path) -> None:
    mesh = two_regions()
    with pytest.raises(ModelError, match="two names become one"):
        write_mesh(replace(mesh, regions=("A b", "a_b")), tmp_path / "part.inp")
    inwards = Faces("quad", mesh.patch("end").faces[0].nodes[:, ::-1])
    turned = replace(mesh, patches={"end": replace(mesh.patch("end"), faces=(inwards,))})
    with pytest.raises(ModelError, match=r"patch 'end'.*outer side of no cell"):
        write_mesh(turned, tmp_path / "part.inp")


def test_cells_that_a_format_cannot_hold_leave_no_file(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"cannot hold cells of type hexahedron27, quad9"):
        write_mesh(every_kind()["hexahedron27"], tmp_path / "part.med")
    assert list(tmp_path.iterdir()) == []
