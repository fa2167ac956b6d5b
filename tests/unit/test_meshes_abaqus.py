"""Decks of Abaqus and CalculiX as programs and people write them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import (
    Mesh,
    cell_volumes,
    face_normals,
    patch_area,
    quadratic,
    read_mesh,
    write_mesh,
)
from tests.mesh_cases import every_kind

#: Four unit cubes in a row along x.
NODES = "*NODE\n" + "".join(
    f"{4 * x + i + 1}, {x}., {y}., {z}.\n"
    for x in range(5)
    for i, (y, z) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)])
)
ROWS = [f"{c + 1}, " + ", ".join(str(4 * c + i) for i in range(1, 9)) for c in range(4)]
CELLS = "*ELEMENT, TYPE=C3D8, ELSET=EALL\n" + "\n".join(ROWS) + "\n"
ROW = NODES + CELLS


def deck(tmp_path: Path, text: str | bytes, name: str = "part.inp") -> Mesh:
    path = tmp_path / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_mesh(path)


def shares(mesh: Mesh) -> dict[str, int]:
    """Cells of each region, each cell counted once."""
    return dict(zip(mesh.regions, np.bincount(mesh.cell_regions).tolist(), strict=True))


def volume(mesh: Mesh, name: str) -> float:
    return float(cell_volumes(mesh)[mesh.region_cells(name)].sum())


@pytest.mark.parametrize(
    "text",
    [
        ROW.replace("\n", "\r\n"),
        ROW.replace("\n", "\r"),
        "\ufeff" + ROW,
        ROW.replace("*ELEMENT, TYPE=C3D8", "*Element , type = C3D8"),
        ROW.replace("*ELEMENT, TYPE=C3D8,", "*ELEMENT, TYPE=C3D8,\n"),
        ROW.replace("*NODE\n", "* NODE\n"),
        ROW.replace("1, 1, 2, 3, 4, ", "1, 1, 2, 3, 4,\n"),
        ROW.replace(", ", "  ,\t"),
        ROW.replace("1., ", "1.D0, ").replace("2., ", "0.2E+1, "),
        ROW.replace("C3D8", "C3D8R"),
        ROW.replace("C3D8", "c3d8i"),
        "*HEADING\nfour cubes, in m\n1, 2, 3\n" + ROW,
        "\n\n** comment\n" + ROW.replace("\n", "\n\n"),
        ROW + "*STEP\n*STATIC\n1., 1.\n*NODE PRINT, NSET=NONE\nU\n*NODE FILE\nU\n*END STEP\n",
        ROW + "*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850.,\n",
        NODES + "*NODE\n1, 0., 0., 0.\n" + CELLS,
        ROW + "*ELEMENT, TYPE=S4, ELSET=SKIN\n91, 1, 2, 3, 4\n",
        ROW + "*ELEMENT, TYPE=T3D2, ELSET=BAR\n91, 1, 2\n*ELEMENT, TYPE=CONN3D2\n92, , 2\n",
        ROW + "*ELEMENT, TYPE=SPRINGA\n91, 1, 2\n*NSET, NSET=FAR\n1, 2\n",
        NODES + "77, 5., 5., 5.\n" + CELLS,
    ],
)
def test_a_row_of_cubes_is_four_cubes(text: str, tmp_path: Path) -> None:
    mesh = deck(tmp_path, text)
    assert cell_volumes(mesh) == pytest.approx(np.ones(4))
    assert mesh.regions == ("EALL",)
    assert len(mesh.points) == 20


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16", "utf-16-le"])
def test_names_are_read_in_any_encoding(encoding: str, tmp_path: Path) -> None:
    text = ROW.replace("EALL", "Gehäuse") + "*NSET, NSET=Füße\n1, 2\n"
    mesh = deck(tmp_path, text.encode(encoding))
    assert mesh.regions == ("Gehäuse",)
    assert mesh.node_set("Füße").tolist() == [0, 1]


def test_sets_of_sets_ranges_and_elements(tmp_path: Path) -> None:
    mesh = deck(
        tmp_path,
        ROW + "*ELSET, ELSET=ODD, GENERATE\n1, 4, 2\n*ELSET, ELSET=last\n4\n"
        "*ELSET, ELSET=BOTH\nOdd, LAST\n"
        "*NSET, NSET=RANGES, GENERATE\n1, 4\n17, 20, 1\n*NSET, NSET=NESTED\nranges, 9\n"
        "*NSET, NSET=OF_CELLS, ELSET=LAST\n*NSET, NSET=GAPS, GENERATE\n18, 90\n",
    )
    assert {k: v.tolist() for k, v in mesh.cell_sets.items()} == {
        "EALL": [0, 1, 2, 3], "BOTH": [0, 2, 3],
    }  # fmt: skip
    # the smallest set that holds a cell is its region
    assert shares(mesh) == {"EALL": 1, "ODD": 2, "last": 1}
    assert volume(mesh, "EALL") == pytest.approx(4.0)
    assert mesh.node_set("NESTED").tolist() == [0, 1, 2, 3, 8, 16, 17, 18, 19]
    assert mesh.node_set("OF_CELLS").tolist() == list(range(12, 20))
    assert mesh.node_set("GAPS").tolist() == [17, 18, 19]


def test_sections_say_which_cells_are_of_which_material(tmp_path: Path) -> None:
    mesh = deck(
        tmp_path,
        ROW + "*ELSET, ELSET=LOADED\n1\n*ELSET, ELSET=A\n1, 2\n*ELSET, ELSET=B\n3, 4\n"
        "*SOLID SECTION, ELSET=A, MATERIAL=STEEL\n,\n*SOLIDSECTION, ELSET=b, MATERIAL=ALU\n",
    )
    assert {r: volume(mesh, r) for r in mesh.regions} == {"A": 2.0, "B": 2.0}
    assert mesh.region_cells("LOADED").tolist() == [0]
    assert mesh.holders("A") == ("A", "EALL")


def test_of_equal_sets_the_last_names_the_region(tmp_path: Path) -> None:
    mesh = deck(tmp_path, ROW + "*ELSET, ELSET=body, GENERATE\n1, 4\n")
    assert mesh.regions == ("body",)
    assert mesh.holders("body") == ("body", "EALL")


def test_cells_of_two_sets_that_cross_are_a_region_of_both(tmp_path: Path) -> None:
    mesh = deck(tmp_path, ROW + "*ELSET, ELSET=A\n1, 2, 3\n*ELSET, ELSET=B\n3, 4\n")
    assert shares(mesh) == {"A": 2, "B": 1, "A and B": 1}
    assert mesh.holders("A and B") == ("A and B", "B", "A", "EALL")
    assert (volume(mesh, "EALL"), len(mesh.cell_sets["A"]), len(mesh.cell_sets["B"])) == (4.0, 3, 2)
    for suffix in (".msh", ".vtu", ".inp", ".med"):
        back = read_mesh(write_mesh(mesh, tmp_path / f"back{suffix}"))
        label = "A and B".replace(" ", "_") if suffix == ".inp" else "A and B"
        assert volume(back, label) == pytest.approx(1.0)
        for name, cells in mesh.cell_sets.items():
            assert volume(back, name) == pytest.approx(len(cells))


def test_surfaces_by_side_by_shell_and_by_what_is_exposed(tmp_path: Path) -> None:
    mesh = deck(
        tmp_path,
        ROW + "*ELEMENT, TYPE=S4R, ELSET=SKIN\n91, 1, 2, 3, 4\n*ELSET, ELSET=ENDS\n1, 4\n"
        "*SURFACE, NAME=MIXED, TYPE=ELEMENT\nENDS, S5\n 2, S3\nSKIN, SPOS\n"
        "*SURFACE, NAME=FREE\nENDS,\n*SURFACE, NAME=CLOUD, TYPE=NODE\n1, 1.\nEND\n"
        "*NSET, NSET=END\n17, 18\n",
    )
    assert len(mesh.patch("MIXED")) == 4
    assert patch_area(mesh, mesh.patch("FREE")) == pytest.approx(10.0)
    assert mesh.node_set("CLOUD").tolist() == [0, 16, 17]
    # a shell's side is turned outwards
    assert face_normals(mesh.points, mesh.patch("SKIN").faces[0])[0] == pytest.approx([-1, 0, 0])


PLACED = (
    "*PART, NAME=P\n" + ROW + "*NSET, NSET=START\n1, 2\n*END PART\n*PART, NAME=EMPTY\n*END PART\n"
    "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n{rows}*END INSTANCE\n"
    "*NODE\n1, 9., 9., 9.\n*NSET, NSET=REFERENCE\n1\n*NSET, NSET=FIRST, INSTANCE=P-1\n1\n"
    "*NSET, NSET=LABELS\nP-1.1, P-1.START\n*ELSET, ELSET=HALF, INSTANCE=P-1, GENERATE\n1, 2\n"
    "*SURFACE, NAME=TOP, TYPE=ELEMENT\nHALF, S3\n*END ASSEMBLY\n"
)


def test_an_instance_stands_where_its_lines_put_it(tmp_path: Path) -> None:
    mesh = deck(tmp_path, PLACED.format(rows="0., 0., 5.\n0., 0., 0., 0., 0., 1., 90.\n"))
    assert mesh.bounds == pytest.approx(np.array([[-1, 0, 5], [0, 4, 6]]))
    assert mesh.node_set("FIRST").tolist() == [0]
    assert mesh.node_set("LABELS").tolist() == [0, 1]
    assert mesh.node_set("REFERENCE").tolist() == []
    assert len(mesh.patch("TOP")) == 2
    assert mesh.regions == ("EALL",)
    only_moved = deck(tmp_path, PLACED.format(rows="1., 2., 3.\n"))
    assert only_moved.bounds[0] == pytest.approx([1, 2, 3])


def test_systems_of_nodes(tmp_path: Path) -> None:
    cells = "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
    ring = "".join(
        f"{i + 1}, {r}, {a}, {z}\n"
        for i, (z, a, r) in enumerate(
            (z, a, r) for z in (0, 1) for a, r in ((0, 1), (0, 2), (90, 2), (90, 1))
        )
    )
    mesh = deck(tmp_path, "*NODE, SYSTEM=C\n" + ring + cells)
    assert mesh.points[2] == pytest.approx([0, 2, 0])
    shifted = deck(
        tmp_path, "*SYSTEM\n0., 0., 5., 0., 1., 5.\n-1., 0., 5.\n*NODE, SYSTEM=C\n" + ring + cells
    )
    assert shifted.points[:3] == pytest.approx(np.array([[0, 1, 5], [0, 2, 5], [-2, 0, 5]]))
    assert shifted.points[4] == pytest.approx([0, 1, 6])


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10", "hexahedron27"])
def test_quadratic_elements(kind: str, tmp_path: Path) -> None:
    mesh = every_kind()[kind]
    if kind != "hexahedron27":
        found = read_mesh(write_mesh(mesh, tmp_path / "part.inp"))
        assert cell_volumes(found).sum() == pytest.approx(cell_volumes(mesh).sum())
        return
    # Abaqus: the middle first, then the middles of the sides S1 to S6
    cells = quadratic(read_mesh_of(tmp_path))
    order = [*range(20), 26, 24, 25, 22, 21, 23, 20]
    rows = [", ".join(map(str, (row[order] + 1).tolist())) for row in cells.blocks[0].nodes]
    text = "*NODE\n" + "".join(
        f"{i}, {x}, {y}, {z}\n" for i, (x, y, z) in enumerate(cells.points.tolist(), start=1)
    )
    lines = [
        f"{i}, " + ", ".join(row.split(", ")[:14]) + ",\n" + ", ".join(row.split(", ")[14:]) + "\n"
        for i, row in enumerate(rows, start=1)
    ]
    found = deck(tmp_path, text + "*ELEMENT, TYPE=C3D27\n" + "".join(lines))
    assert found.blocks[0].nodes.tolist() == cells.blocks[0].nodes.tolist()


def read_mesh_of(tmp_path: Path) -> Mesh:
    return deck(tmp_path, ROW, "row.inp")


WRONG = [
    ("*PART, NAME=A\n" + ROW + "*END PART\n*PART, NAME=B\n" + ROW + "*END PART\n", "2 parts"),
    (
        PLACED.format(rows="").replace(
            "*END ASSEMBLY", "*INSTANCE, NAME=P-2, PART=P\n*END INSTANCE\n*END ASSEMBLY"
        ),
        "2 instances of parts.*'P-1', 'P-2'",
    ),
    (PLACED.format(rows="1.\n1., 2.\n"), "line 34 is placed by lines that are not a translation"),
    (PLACED.format(rows="").replace("PART=P\n", "PART=Q\n"), "part 'Q', which the file does not"),
    (ROW.replace("C3D8,", "C3D6,"), "line 22.*'C3D6'.*wedge"),
    (ROW.replace("C3D8,", "C3D5,"), "pyramid"),
    (ROW.replace("C3D8,", "COH3D8,"), "line 22 begins elements of type 'COH3D8'.*unknown"),
    (ROW.replace("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7"), "element 1 with 16"),
    (ROW.replace("13, 14, 15, 16, 17, 18, 19, 20", "13, 14, 15"), "line 22.*4, has 3 of 8"),
    (ROW.replace("17, 18, 19, 20", "17, 18, 19, 99"), "line 22.* 4 has the node 99"),
    (ROW + "*NSET, NSET=N\n99\n", "line 27 begins a set with node 99"),
    (ROW + "*ELSET, ELSET=N\n99\n", "line 27 begins a set with element 99"),
    (ROW + "*ELSET, ELSET=N\nOTHER\n", "line 27.*'OTHER', which is not among the element sets"),
    (ROW + "*ELSET, ELSET=N, GENERATE\n91, 99\n", "line 27.*elements 91 to 99"),
    (ROW + "*ELSET, ELSET=N, GENERATE\n4, 1\n", "line 28 .*an ascending range"),
    (ROW + "*ELSET, ELSET=A\nB\n*ELSET, ELSET=B\nA\n", "a set that holds itself"),
    (ROW + "*SURFACE, NAME=T\nEALL, S7\n", "line 28 names the side S7"),
    (ROW + "*SURFACE, NAME=T\nEALL, TOP\n", "line 28 names the side 'TOP'"),
    (ROW + "*SURFACE, NAME=T\nNONE, S1\n", "line 28 names the element set 'NONE'"),
    (ROW + "*SOLID SECTION, ELSET=X\n", "line 27 names the element set 'X'"),
    (ROW + "*NGEN\n1, 5, 1\n", r"line 27 holds \*NGEN"),
    (ROW.replace("*ELEMENT", "*ELMENT"), r"line 22 holds the keyword \*ELMENT.*\n.*\*ELEMENT"),
    (NODES + "1, 0., 0., 9.\n" + CELLS, "node 1 is given twice"),
    (ROW + CELLS, "element 1 is given twice"),
    (ROW.replace("3., 1., 0.", "3., one, 0."), "line 15 holds '14, 3., one, 0.'"),
    (NODES.replace("*NODE", "*NODE, SYSTEM=S") + CELLS, "line 1 gives nodes in the system 'S'"),
    ("1, 2, 3\n" + ROW, "line 1 contains '1, 2, 3' before the first keyword"),
    (ROW + "*INCLUDE, INPUT=none.inc\n", "line 27 includes 'none.inc'; there is no such file"),
    ("*SYSTEM\n0., 0., 0., 0., 0., 0.\n" + ROW, "line 1 begins a system whose points"),
    (ROW + "*SURFACE, NAME=T, COMBINE=UNION\nA, B\n", "line 27 makes the surface 'T' of others"),
]


@pytest.mark.parametrize(("text", "words"), WRONG, ids=[words for _, words in WRONG])
def test_what_is_not_understood_is_named_with_its_line(
    text: str, words: str, tmp_path: Path
) -> None:
    with pytest.raises(ModelError, match=words):
        deck(tmp_path, text)
