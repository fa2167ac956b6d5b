"""VTU files in every encoding, in pieces, with what is not read named."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

from strutwork.errors import ModelError
from strutwork.meshes import Mesh, cell_volumes, limits, read_mesh, write_mesh
from tests.mesh_cases import every_kind, two_regions

NUMBER = {"hexahedron": 12, "hexahedron20": 25, "hexahedron27": 29, "tetra": 10, "tetra10": 24}


def grid(mesh: Mesh) -> vtkUnstructuredGrid:
    made, points, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(mesh.points), deep=True))
    made.SetPoints(points)
    types = []
    for block in mesh.blocks:
        for row in block.nodes.tolist():
            cells.InsertNextCell(len(row), row)
            types.append(NUMBER[block.kind])
    made.SetCells(types, cells)
    tags = numpy_to_vtk(mesh.cell_regions + 1, deep=True)
    tags.SetName("MaterialIds")
    made.GetCellData().AddArray(tags)
    return made


def written(mesh: Mesh, path: Path, *settings: str, block: int = 512) -> Path:
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid(mesh))
    writer.SetFileName(str(path))
    writer.SetBlockSize(block)
    for setting in settings:
        name, _, value = setting.partition("=")
        getattr(writer, name)(*([int(value)] if value else []))
    writer.Write()
    return path


@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended"])
@pytest.mark.parametrize("compressor", ["None", "ZLib", "LZMA"])
@pytest.mark.parametrize("raw", [0, 1])
@pytest.mark.parametrize("words", ["UInt32", "UInt64"])
@pytest.mark.parametrize("order", ["Little", "Big"])
def test_what_vtk_writes_is_read(
    mode: str, compressor: str, raw: int, words: str, order: str, tmp_path: Path
) -> None:
    mesh = two_regions()
    path = written(
        *(mesh, tmp_path / "part.vtu", f"SetDataModeTo{mode}", f"SetCompressorTypeTo{compressor}"),
        *(
            f"SetEncodeAppendedData={1 - raw}",
            f"SetHeaderTypeTo{words}",
            f"SetByteOrderTo{order}Endian",
        ),
    )
    found = read_mesh(path)
    assert found.points == pytest.approx(mesh.points)
    assert found.blocks[0].nodes.tolist() == mesh.blocks[0].nodes.tolist()
    assert np.bincount(found.cell_regions).tolist() == [8, 8]
    assert found.regions == ("region 1", "region 2")


@pytest.mark.parametrize("kind", list(NUMBER))
def test_each_kind_has_vtks_order_of_nodes(kind: str, tmp_path: Path) -> None:
    mesh = every_kind()[kind]
    found = read_mesh(written(mesh, tmp_path / "part.vtu"))
    assert found.blocks[0].nodes.tolist() == mesh.blocks[0].nodes.tolist()


def test_every_piece_is_read(tmp_path: Path) -> None:
    path = written(
        two_regions(), tmp_path / "part.vtu", "SetDataModeToAscii", "SetCompressorTypeToNone"
    )
    text = path.read_text()
    piece = text[text.index("<Piece") : text.index("</Piece>") + len("</Piece>")]
    path.write_text(text.replace(piece, piece + piece))
    found = read_mesh(path)
    assert (found.cell_count, len(found.points)) == (32, 90)
    assert cell_volumes(found).sum() == pytest.approx(4.0)


def ascii_text(tmp_path: Path) -> str:
    path = tmp_path / "plain.vtu"
    written(two_regions(), path, "SetDataModeToAscii", "SetCompressorTypeToNone")
    return path.read_text()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('NumberOfCells="16"', 'NumberOfCells="17"', "counts 17 values in the array 'types'"),
        ('NumberOfPoints="45"', 'NumberOfPoints="44"', "counts 132 values in the array 'Points'"),
        ('NumberOfPoints="45"', 'NumberOfPoints="-1"', "NumberOfPoints='-1'"),
        ('NumberOfPoints="45"', 'NumberOfPoints="99999999999"', "99999999999 points; 5000000"),
        ('type="UnstructuredGrid"', 'type="PolyData"', "is of type 'PolyData'"),
        ("<VTKFile", '<!DOCTYPE x [<!ENTITY a "b">]><VTKFile', "declares entities"),
        ('Name="types"', 'Name="kinds"', "without types"),
        ('Name="offsets" ', 'Name="offsets" format="binary" ', "cannot be read as .vtu"),
        ("</Piece>", "", "cannot be read as .vtu"),
    ],
)
def test_what_is_not_understood_is_named(old: str, new: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "part.vtu"
    path.write_text(ascii_text(tmp_path).replace(old, new))
    with pytest.raises(ModelError, match=re.escape(words)):
        read_mesh(path)


@pytest.mark.parametrize(
    ("number", "words"),
    [
        *((11, "voxel"), (13, "wedge"), (14, "pyramid"), (42, "polyhedron")),
        *((72, "higher order"), (99, "VTK type 99")),
    ],
)
def test_solids_that_cannot_be_used_are_named(number: int, words: str, tmp_path: Path) -> None:
    text = ascii_text(tmp_path)
    start = text.index('Name="types"')
    path = tmp_path / "part.vtu"
    path.write_text(text[:start] + text[start:].replace("12 12", f"12 {number}", 1))
    with pytest.raises(ModelError, match=words) as caught:
        read_mesh(path)
    assert "cut short" not in str(caught.value)


@pytest.mark.parametrize("compressor", ["ZLib", "LZMA"])
def test_what_unpacks_to_more_than_the_limit_is_refused_before(
    compressor: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = written(
        *(two_regions(), tmp_path / "part.vtu", f"SetCompressorTypeTo{compressor}"), block=32768
    )
    monkeypatch.setattr(limits, "LARGEST_CONTENT", 1500)
    with pytest.raises(ModelError, match=r"unpacks to .* MB; 0.0015 MB is the limit"):
        read_mesh(path)


def test_a_block_that_unpacks_to_more_than_it_says_is_refused(tmp_path: Path) -> None:
    path = written(
        *(two_regions(), tmp_path / "part.vtu", "SetCompressorTypeToZLib"),
        *("SetDataModeToAppended", "SetEncodeAppendedData=0", "SetHeaderTypeToUInt32"),
        block=32768,
    )
    content = path.read_bytes()
    start = content.index(b"_", content.index(b"<AppendedData")) + 1
    arrays = re.findall(rb'Name="(\w+)".*?offset="(\d+)"', content)
    at = start + next(int(o) for name, o in arrays if name == b"Points")
    # number of blocks, size of a block, size of the last
    count, _, last = np.frombuffer(content, "<u4", 3, at)
    assert (count, last) == (1, 45 * 3 * 8)
    less = content[: at + 8] + np.array([24], "<u4").tobytes() + content[at + 12 :]
    path.write_bytes(less)
    with pytest.raises(ModelError, match="a block of 24 bytes unpacks to others"):
        read_mesh(path)


def test_sets_that_overlap_come_back(tmp_path: Path) -> None:
    mesh = Mesh(**{**two_regions().__dict__, "cell_sets": {"all": np.arange(16), "some": [7, 8]}})
    back = read_mesh(write_mesh(mesh, tmp_path / "part.vtu"))
    assert back.region_cells("all").tolist() == list(range(16))
    assert back.region_cells("some").tolist() == [7, 8]
    assert back.cell_regions.tolist() == mesh.cell_regions.tolist()
