"""Files of Gmsh in every version: text and binary, overlapping groups, numbers with gaps."""

from __future__ import annotations

import struct
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import Mesh, cell_volumes, read_mesh

#: Two unit cubes along x, numbers with a gap; the first is in two groups.
PLACES = [(x, y, z) for x in range(3) for y, z in [(0, 0), (1, 0), (1, 1), (0, 1)]]
NUMBERS = [10 * (i + 1) for i in range(12)]
CUBES = [NUMBERS[:8], NUMBERS[4:]]
SIDE = NUMBERS[:4][::-1]
NAMES = '$PhysicalNames\n4\n3 1 "all"\n3 2 "Gehäuse"\n2 3 "side"\n0 4 "tip"\n$EndPhysicalNames\n'
FORMATS = ["2.2", "4", "4.1"]


def msh(version: str, *, binary: bool, order: str = "<", parametric: bool = False) -> bytes:
    """The two cubes with a side, an edge and a tip."""
    v4 = version != "2.2"
    size = "Q" if v4 else "i"

    def pack(kinds: str, *values: float) -> bytes:
        if binary:
            return struct.pack(order + kinds, *values)
        return (" ".join(map(repr, values)) + "\n").encode()

    out = f"$MeshFormat\n{version} {int(binary)} 8\n".encode()
    out += struct.pack(order + "i", 1) + b"\n" if binary else b""
    out += b"$EndMeshFormat\n" + NAMES.encode() + b"$Comments\nmade by hand\n$EndComments\n"
    if not v4:
        out += b"$Nodes\n12\n"
        for number, place in zip(NUMBERS, PLACES, strict=True):
            out += pack("iddd", number, *map(float, place))
        rows = [(15, 4, 4, NUMBERS[11:]), (1, 0, 1, NUMBERS[:2]), (3, 3, 1, SIDE)]
        rows += [(5, 1, 1, CUBES[0]), (5, 2, 1, CUBES[0]), (5, 1, 2, CUBES[1])]
        out += f"\n$EndNodes\n$Elements\n{len(rows)}\n".encode()
        for i, (type_, group, entity, nodes) in enumerate(rows, start=1):
            if binary:
                out += pack("iii", type_, 1, 2) + pack(
                    f"{3 + len(nodes)}i", i, group, entity, *nodes
                )
            else:
                out += pack("", i, type_, 2, group, entity, *nodes)
        return out + b"\n$EndElements\n"
    old = version == "4"
    out += b"$Entities\n" + pack("4" + size, 1, 1, 1, 2)
    out += pack("i" + ("6d" if old else "3d") + size + "i", 1, *[0.0] * (6 if old else 3), 1, 4)
    out += pack("i6d" + size + size, 1, *[0.0] * 6, 0, 0)
    out += pack("i6d" + size + "i" + size, 1, *[0.0] * 6, 1, -3, 0)
    out += pack("i6d" + size + "ii" + size + "i", 1, *[0.0] * 6, 2, 1, 2, 1, 1)
    out += pack("i6d" + size + "i" + size, 2, *[0.0] * 6, 1, 1, 0)
    extra = [0.5, 0.5] if parametric else []
    dimension = 2 if parametric else 3
    head = (1, dimension) if old else (dimension, 1)
    out += b"\n$EndEntities\n$Nodes\n"
    out += pack("2" + size, 1, 12) if old else pack("4" + size, 1, 12, 10, 120)
    out += pack("iii" + size, *head, int(parametric), 12)
    if not old:
        out += pack("12" + size, *NUMBERS)
    for number, place in zip(NUMBERS, PLACES, strict=True):
        values = [*map(float, place), *extra]
        kinds = f"{len(values)}d"
        out += pack("i" + kinds, number, *values) if old else pack(kinds, *values)
    blocks = [(0, 1, 15, [NUMBERS[11:]]), (1, 1, 1, [NUMBERS[:2]]), (2, 1, 3, [SIDE])]
    blocks += [(3, 1, 5, CUBES[:1]), (3, 2, 5, CUBES[1:])]
    out += b"\n$EndNodes\n$Elements\n"
    out += pack("2" + size, 5, 5) if old else pack("4" + size, 5, 5, 1, 5)
    number = 1
    for dim, tag, type_, elements in blocks:
        out += pack("iii" + size, *((tag, dim) if old else (dim, tag)), type_, len(elements))
        for nodes in elements:
            kind = "i" if old else size
            out += pack(f"{1 + len(nodes)}{kind}", number, *nodes)
            number += 1
    return out + b"\n$EndElements\n$Periodic\n1\n0 1 1\n0\n1\n10 20\n$EndPeriodic\n"


def read(tmp_path: Path, content: bytes) -> Mesh:
    path = tmp_path / "part.msh"
    path.write_bytes(content)
    return read_mesh(path)


@pytest.mark.parametrize("version", FORMATS)
@pytest.mark.parametrize("how", ["text", "binary", "other byte order", "Windows", "Latin-1"])
def test_each_version_gives_its_cells_and_groups(version: str, how: str, tmp_path: Path) -> None:
    order = ">" if how == "other byte order" else "<"
    content = msh(version, binary=how in {"binary", "other byte order"}, order=order)
    if how == "Windows":
        content = content.replace(b"\n", b"\r\n")
    if how == "Latin-1":
        content = content.decode().encode("latin-1")
    mesh = read(tmp_path, content)
    assert cell_volumes(mesh) == pytest.approx(np.ones(2))
    assert set(mesh.regions) == {"all", "Gehäuse"}
    # the first cube is in both groups, and its material is that of the smaller
    assert mesh.region_cells("all").tolist() == [0, 1]
    assert [mesh.regions[i] for i in mesh.cell_regions] == ["Gehäuse", "all"]
    assert mesh.patch("side").faces[0].nodes.tolist() in ([[0, 3, 2, 1]], [[3, 2, 1, 0]])
    assert mesh.node_set("tip").tolist() == [11]
    assert len(mesh.points) == 12


@pytest.mark.parametrize("version", ["4", "4.1"])
@pytest.mark.parametrize("binary", [False, True])
def test_parameters_of_nodes_are_passed_over(version: str, binary: bool, tmp_path: Path) -> None:
    mesh = read(tmp_path, msh(version, binary=binary, parametric=True))
    assert cell_volumes(mesh) == pytest.approx(np.ones(2))


def test_elements_of_no_group_are_read_and_doubles_of_one_group_kept(tmp_path: Path) -> None:
    text = msh("2.2", binary=False).decode()
    loose = text.replace("6 5 2 1 2 ", "6 5 2 0 2 ")
    mesh = read(tmp_path, loose.encode())
    assert [mesh.regions[i] for i in mesh.cell_regions][1] == "solid"
    doubled = text.replace("5 5 2 2 1 ", "5 5 2 1 1 ")
    assert read(tmp_path, doubled.encode()).cell_count == 3


@pytest.mark.parametrize("version", FORMATS)
@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("share", [0.3, 0.5, 0.7, 0.95])
def test_what_is_cut_short_is_refused(
    version: str,
    binary: bool,
    share: float,
    tmp_path: Path,
) -> None:
    content = msh(version, binary=binary)
    content = content[: content.rindex(b"$EndElements")]
    with pytest.raises(ModelError, match=r"part\.msh.*\n.*xport"):
        read(tmp_path, content[: int(len(content) * share)])


TEXT = {version: msh(version, binary=False).decode() for version in FORMATS}
WRONG = [
    (TEXT["2.2"].replace("2.2 0 8", "1 0 8"), "version 1, which is not read"),
    (TEXT["2.2"].replace("2.2 0 8", "5.0 0 8"), "version 5.0, which is not read"),
    ("$NOD\n1\n1 0 0 0\n$ENDNOD\n", "is of version 1"),
    (TEXT["2.2"].replace("$Nodes\n12\n", "$Nodes\n13\n"), "counts 13 nodes"),
    (TEXT["2.2"].replace("$Elements\n6\n", "$Elements\n5\n"), "counts 5 elements"),
    (TEXT["2.2"].replace("$Elements\n6\n", "$Elements\n7\n"), "cut short"),
    (TEXT["4.1"].replace("5 5 1 5\n", "5 6 1 5\n"), "counts 6 elements and holds 5"),
    (TEXT["4.1"].replace("1 12 10 120\n", "1 13 10 120\n"), "counts 13 nodes and holds 12"),
    (TEXT["2.2"].replace(" 90 100 110 120\n", " 90 100 110 999\n"), "element 6 has the node 999"),
    (TEXT["2.2"].replace("120 2.0 0.0 1.0", "120 2.0 O.0 1.0"), "line 27: 'O.0'"),
    (
        TEXT["2.2"].replace("6 5 2 1 2 50 60 70 80 90 100 110 120", "6 6 2 1 2 10 20 30 50 60 70"),
        "element 6 is a wedge",
    ),
    (TEXT["2.2"].replace("6 5 2 1 2 50 60 70 80 90 100 110 120", "6 29 2 1 2 1 2 3"), "type 29"),
    (TEXT["4.1"].replace("$Entities", "$PartitionedEntities"), "in partitions"),
    (TEXT["2.2"].replace("120 2.0 0.0 1.0", "110 2.0 0.0 1.0"), "has the node 110 twice"),
]


@pytest.mark.parametrize(("text", "words"), WRONG, ids=[words for _, words in WRONG])
def test_what_is_not_understood_is_named(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=words):
        read(tmp_path, text.encode())


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("kind", ["tetrahedra", "hexahedra"])
def test_what_gmsh_writes_in_each_version_is_the_same_mesh(
    order: int, kind: str, tmp_path: Path
) -> None:
    import gmsh  # noqa: PLC0415 - the extra `cad`, which the tests need

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        factory = gmsh.model.occ
        first = factory.addBox(0, 0, 0, 1, 1, 1)
        second = factory.addBox(1, 0, 0, 1, 1, 1)
        factory.fragment([(3, first)], [(3, second)])
        factory.synchronize()
        if kind == "hexahedra":
            for _, tag in gmsh.model.getEntities(1):
                gmsh.model.mesh.setTransfiniteCurve(tag, 3)
            for _, tag in gmsh.model.getEntities(2):
                gmsh.model.mesh.setTransfiniteSurface(tag)
                gmsh.model.mesh.setRecombine(2, tag)
            for _, tag in gmsh.model.getEntities(3):
                gmsh.model.mesh.setTransfiniteVolume(tag)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
        gmsh.model.addPhysicalGroup(3, [1, 2], name="all")
        gmsh.model.addPhysicalGroup(3, [1], name="Gehäuse")
        gmsh.model.addPhysicalGroup(2, [1], name="side")
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(order)
        for version, *options in product((2.2, 4.0, 4.1), (0, 1), (0, 1), (0, 1)):
            if version == 4.0 and options[0]:
                continue  # Gmsh writes it as text alone
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            for option, value in zip(("Binary", "SaveAll", "SaveParametric"), options, strict=True):
                gmsh.option.setNumber(f"Mesh.{option}", value)
            gmsh.write(str(tmp_path / f"{version}{''.join(map(str, options))}.msh"))
    finally:
        gmsh.finalize()
    for path in sorted(tmp_path.glob("*.msh")):
        mesh = read_mesh(path)
        volumes = cell_volumes(mesh)
        assert volumes.sum() == pytest.approx(2.0), path.name
        if path.name.startswith("2.2") and path.stem[4] == "1":
            # Gmsh saves all elements of version 2 without their groups
            assert mesh.regions == ("solid",)
            continue
        assert volumes[mesh.region_cells("all")].sum() == pytest.approx(2.0), path.name
        assert volumes[mesh.region_cells("Gehäuse")].sum() == pytest.approx(1.0), path.name
        assert mesh.patch("side").nodes.size > 3
