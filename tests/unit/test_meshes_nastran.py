"""Bulk data of Nastran as programs and people write them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import Mesh, cell_volumes, face_normals, read_mesh, write_mesh
from strutwork.meshes.format_nastran import sixteen
from strutwork.meshes.nastran_cards import real
from tests.mesh_cases import every_kind

PLACES = [(x, y, z) for x in range(5) for y, z in [(0, 0), (1, 0), (1, 1), (0, 1)]]
GRIDS = "".join(f"GRID,{i},,{x}.,{y}.,{z}.\n" for i, (x, y, z) in enumerate(PLACES, start=1))
HEXA = "".join(
    f"CHEXA,{c + 1},{1 + c // 2}," + ",".join(str(4 * c + i) for i in range(1, 7))
    + f",+\n+,{4 * c + 7},{4 * c + 8}\n"
    for c in range(4)
)  # fmt: skip
PROPERTIES = "PSOLID,1,1\nPSOLID,2,2\nMAT1,1,2.1+11,,.3,7850.\nMAT1,2,7.+10,,.33,2700.\n"
ROW = "BEGIN BULK\n" + GRIDS + HEXA + PROPERTIES + "ENDDATA\n"


def bulk(tmp_path: Path, text: str | bytes, name: str = "part.bdf") -> Mesh:
    path = tmp_path / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_mesh(path)


FIXED = "".join(
    f"GRID    {i:<8}{'':8}{x:<8.1f}{y:<8.1f}{z:<8.1f}\n"
    for i, (x, y, z) in enumerate(PLACES, start=1)
)
LARGE = "".join(
    f"GRID*   {i:>16}{'':16}{x:>16.4f}{y:>16.4f}*G{i}\n*G{i:<6}{z:>16.4f}{0:>16}\n"
    for i, (x, y, z) in enumerate(PLACES, start=1)
)
LARGE_FREE = "".join(
    f"GRID*,{i},,{x}.,{y}.,*\n*,{z}.\n" for i, (x, y, z) in enumerate(PLACES, start=1)
)


@pytest.mark.parametrize(
    "text",
    [
        ROW.replace("\n", "\r\n"),
        "\ufeff" + ROW,
        "SOL 103\nCEND\nTITLE = GRID,1,,2.\nSUBCASE 1\n  LOAD = 1\n" + ROW,
        ROW.removeprefix("BEGIN BULK\n"),
        "SOL 103\nCEND\n" + ROW.removeprefix("BEGIN BULK\n"),
        ROW.replace("BEGIN BULK", "begin bulk").lower(),
        ROW.replace("ENDDATA\n", ""),
        ROW.replace("+,", ","),
        ROW.replace(",+\n+,", "\n,"),
        ROW.replace(",+\n+,", ",+E\n+E,"),
        ROW.replace("\nCHEXA,1,", "\n$ comment, with commas\n\nCHEXA, 1 , "),
        ROW.replace("PSOLID,1,1", "PSOLID,1,1 $ steel"),
        ROW.replace("PSOLID,1,1", "CONM2,900,20,0,12.5\nRBE2,901,1,123456,5\nCELAS2,902,1.+6,20,3"),
        ROW.replace(GRIDS, FIXED),
        ROW.replace(GRIDS, LARGE),
        ROW.replace(GRIDS, LARGE_FREE),
        ROW.replace(",1.,", ",1.0,").replace(",2.,", ",20.-1,").replace(",3.,", ",.3D+1,"),
        ROW.replace("ENDDATA", "ENDDATA\nGRID,1,,9.,9.,9.\nno card at all"),
        ROW.replace("ENDDATA", "GRID,99,,9.,9.,9.\nENDDATA"),
        ROW.replace("ENDDATA", "GRID,1,,0.,0.,0.\nENDDATA"),
        ROW.replace("ENDDATA", "CBAR,91,1,1,2,0.,0.,1.\nPLOTEL,92,1,2\nSPC1,1,123,1\nENDDATA"),
    ],
)
def test_a_row_of_cubes_is_four_cubes(text: str, tmp_path: Path) -> None:
    mesh = bulk(tmp_path, text)
    assert cell_volumes(mesh) == pytest.approx(np.ones(4))
    assert mesh.regions == ("region 1", "region 2")
    assert np.bincount(mesh.cell_regions).tolist() == [2, 2]
    assert len(mesh.points) == 20


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1.5-3", 1.5e-3), ("1.5+3", 1.5e3), ("-1.5-3", -1.5e-3), ("1.D-2", 1e-2), ("1.E2", 100.0),
        (".5", 0.5), ("7", 7.0), ("", 0.0), ("1.5d3", 1500.0), ("+2.-1", 0.2),
    ],
)  # fmt: skip
def test_numbers_without_an_e_are_read(text: str, value: float) -> None:
    assert real(text) == value


@pytest.mark.parametrize(
    "value",
    [0.0, 1.0, -1.0 / 3.0, 1e-300, -1.2345678901234567e-12, 2.0**70, 1e22, -123456.789012345],
)
def test_a_number_in_sixteen_characters_keeps_its_digits(value: float) -> None:
    assert len(sixteen(value)) <= 16
    assert "." in sixteen(value)
    assert real(sixteen(value)) == pytest.approx(value, rel=1e-9, abs=0.0)


RING = {
    "C": (lambda r, a: (r, a, 0.0), lambda r, a: (r, a, 1.0)),
    "S": (
        lambda r, a: (r, 90.0, a),
        lambda r, a: ((r * r + 1) ** 0.5, np.degrees(np.arctan(r)), a),
    ),
}


@pytest.mark.parametrize("shape", ["C", "S"])
@pytest.mark.parametrize(
    ("card", "move"),
    [
        ("CORD2{s},5,,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\n", (0, 0, 0)),
        ("CORD2{s},5,7,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\nCORD2R,7,,3.,0.,0.,3.,0.,1.,+\n+,4.,0.,0.\n",
         (3, 0, 0)),
        ("CORD1{s},8,91,92,93,5,94,95,96\n" + "".join(
            f"GRID,{90 + i},,{p}\n" for i, p in enumerate(
                ["0.,0.,0.", "0.,0.,0.", "0.,0.,1.", "1.,0.,0.", "0.,2.,0.", "0.,2.,1.", "1.,2.,0."]
            ) if i), (0, 2, 0)),
    ],
)  # fmt: skip
def test_grid_points_in_other_systems(
    shape: str, card: str, move: tuple[float, ...], tmp_path: Path
) -> None:
    low, high = RING[shape]
    plan = [(1.0, 0.0), (2.0, 0.0), (2.0, 60.0), (1.0, 60.0)]
    places = [low(r, a) for r, a in plan] + [high(r, a) for r, a in plan]
    grids = "".join(
        f"GRID,{i},5,{x!r},{float(y)!r},{z!r}\n" for i, (x, y, z) in enumerate(places, start=1)
    )
    mesh = bulk(tmp_path, card.format(s=shape) + grids + "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n")
    angles = np.radians([a for _, a in plan])
    flat = np.array([r for r, _ in plan])[:, None] * np.stack(
        [np.cos(angles), np.sin(angles), 0 * angles], axis=1
    )
    wanted = np.concatenate([flat, flat + np.array([0, 0, 1])]) + move
    assert mesh.points == pytest.approx(wanted, abs=1e-12)


def test_the_system_of_grdset_counts_for_grids_without_one(tmp_path: Path) -> None:
    card = "GRDSET,,5\nCORD2R,5,,0.,0.,3.,0.,0.,4.,+\n+,1.,0.,3.\n"
    mesh = bulk(tmp_path, ROW.replace("PSOLID,1,1\n", card))
    assert mesh.bounds == pytest.approx(np.array([[0, 0, 3], [4, 1, 4]]))


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10"])
def test_middle_nodes_that_are_left_out_stand_half_way(kind: str, tmp_path: Path) -> None:
    mesh = every_kind()[kind]
    path = write_mesh(mesh, tmp_path / "part.bdf")
    lines = path.read_text().splitlines()[1:]
    start = next(i for i, line in enumerate(lines) if line.startswith("C"))
    # the last middle node of the first element: its neighbours may give it, or nobody
    last = start + (2 if kind == "hexahedron20" else 1)
    lines[last] = lines[last][:-8]
    path.write_text("\n".join(lines))
    found = read_mesh(path)
    assert [b.kind for b in found.blocks] == [kind]
    assert cell_volumes(found) == pytest.approx(cell_volumes(mesh))
    assert len(np.unique(np.concatenate([b.nodes.ravel() for b in found.blocks]))) == len(
        np.unique(np.concatenate([b.nodes.ravel() for b in mesh.blocks]))
    )


def test_shells_are_patches_turned_outwards(tmp_path: Path) -> None:
    mesh = bulk(tmp_path, ROW.replace("ENDDATA", "CQUAD4,91,7,1,2,3,4\nPSHELL,7,1,.1\nENDDATA"))
    normals = face_normals(mesh.points, mesh.patch("patch 7").faces[0])
    assert normals[0] == pytest.approx([-1.0, 0.0, 0.0])


def test_an_include_is_read_in_its_place(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "grids.bdf").write_text(GRIDS)
    for line in ("INCLUDE 'sub/grids.bdf'", "include sub/grids.bdf", 'INCLUDE "sub/\ngrids.bdf"',
                 "INCLUDE 'sub\\grids.bdf'"):  # fmt: skip
        mesh = bulk(tmp_path, ROW.replace(GRIDS, line + "\n"))
        assert cell_volumes(mesh).sum() == pytest.approx(4.0)


FIRST = "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8"
WRONG = [
    (ROW.replace(FIRST, "CPENTA,1,1,1,2,3,5,6,7"), "line 22.*CPENTA.*wedge"),
    (ROW.replace(FIRST, "CPYRAM,1,1,1,2,3,4,5"), "CPYRAM.*pyramid"),
    (ROW.replace("+,7,8\n", ""), "line 22 holds a CHEXA with 6 of 8 corners"),
    (ROW.replace("+,19,20\n", "+,19,99\n"), r"element 4 \(CHEXA\) has the grid point 99"),
    (ROW.replace("GRID,2,,", "GRID,2,5,"), "names the coordinate system 5, which the"),
    (ROW.replace("GRID,2,,", "GRID,two,,"), "line 3 holds a GRID card with a field that"),
    (ROW.replace("CHEXA,2", "CHEAX,2"), "line 24 holds the card CHEAX.*\n.*CHEXA"),
    (ROW.replace("CHEXA,2,", "CHEXA,1,"), "element 1 is given twice"),
    (ROW.replace("ENDDATA", "GRID,1,,9.,9.,9.\nENDDATA"), "grid point 1 is given twice"),
    (ROW.replace("PSOLID,1,1", "CORD2C,5,5,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\nGRID,99,5,1."),
     "line 30 defines the coordinate system 5 by itself"),
    (ROW.replace("PSOLID,1,1", "CORD2C,5,0,0.,0.,0.,0.,0.,1.,+\n+,0.,0.,2.\nGRID,99,5,1."),
     "line 30 gives the coordinate system 5 by points on one line"),
    (ROW.replace("PSOLID,1,1", "CORD3G,5"), "line 30 holds a CORD3G"),
    (ROW.replace("PSOLID,1,1", "- - -"), "line 30 holds '- - -', which is not a card"),
    (ROW.replace(",+\n+,7,8", ",+A\n+B,7,8"), "line 23 goes on with '\\+B'"),
    ("BEGIN SUPER = 1\n" + ROW, "line 1 begins the data of a superelement"),
    ("+,1,2\n" + GRIDS, "line 1 goes on with no card"),
    (ROW.replace("PSOLID,1,1", "INCLUDE '../x'"), "line 30 includes '../x', which leads out"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "words"), WRONG, ids=[words for _, words in WRONG])
def test_what_is_not_understood_is_named_with_its_line(
    text: str, words: str, tmp_path: Path
) -> None:
    with pytest.raises(ModelError, match=words):
        bulk(tmp_path, text)
