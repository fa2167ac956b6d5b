"""What is wrong with a solid of a model file is named by its field."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from strutwork.errors import ModelError, StrutworkError
from strutwork.machines import part_files
from strutwork.meshes import (
    block,
    write_mesh,
)
from tests.model_files import Edit, add, drop, put
from tests.solid_models import brick, from_file, model_of


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Superelements of these tests stay with them; equal solids are reduced once."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "superelements"))
        yield


HEAD = "solids.0.interfaces.1"
TOP = [[0, 0, 0.6], [0.2, 0.15, 0.6]]

#: What is changed in the column, and what the message must hold.
WRONG: dict[str, tuple[list[Edit], list[str]]] = {
    "no mesh": ([drop("solids.0.shape")], ["solids.column", "has no mesh", "exactly one"]),
    "two sources": ([put("solids.0.mesh", "a.msh")], ["solids.column", "mesh and shape"]),
    "no cell": ([drop("solids.0.cell")], ["solids.column.cell", "missing", "block"]),
    "key of another shape": (
        [put("solids.0.plate", 0.1)],
        ["solids.column.plate", "not a key of a block", "size, cell"],
    ),
    "unknown shape": ([put("solids.0.shape", "ball")], ["solids.column.shape", '"ball"']),
    "unknown key": ([put("solids.0.modess", 6)], ["solids.column.modess", '"modes"']),
    "unknown key of an interface": (
        [put(f"{HEAD}.ptch", "x")],
        ["solids.column.interfaces[1].ptch", '"patch"'],
    ),
    "unknown kind": ([put(f"{HEAD}.kind", "glued")], ["interfaces[1].kind", '"glued"', "rigid"]),
    "cell of another dimension": (
        [put("solids.0.cell", "160 kg")],
        ["solids.column.cell", '"160 kg"', "a length"],
    ),
    "cutoff of another dimension": (
        [put("solids.0.cutoff", "800 mm")],
        ["solids.column.cutoff", "a frequency"],
    ),
    "cutoff below zero": ([put("solids.0.cutoff", "-1 Hz")], ["solids.column.cutoff", "above 0"]),
    "cutoff and modes": ([put("solids.0.cutoff", "800 Hz")], ["solids.column", "cutoff and modes"]),
    "order three": ([put("solids.0.order", 3)], ["solids.column.order", "3"]),
    "no modes": ([put("solids.0.modes", 0)], ["solids.column.modes", "0"]),
    "more modes than the solid has": (
        [put("solids.0.modes", 600), put("solids.0.order", 1)],
        ["solids.column", "600 modes are too many"],
    ),
    "a mesh too coarse for its modes": (
        [from_file("coarse.msh"), put("solids.0.modes", 36), put(f"{HEAD}.box", TOP)],
        ["solids.column", "Choose smaller cells, or retain fewer modes"],
    ),
    "no material": ([drop("solids.0.material")], ["solids.column", "neither material"]),
    "unknown material": (
        [put("solids.0.material", "tin")],
        ["solids.column.material", '"tin"', "granite"],
    ),
    "unknown region": (
        [drop("solids.0.material"), put("solids.0.materials", {"rock": "granite"})],
        ["solids.column", "'solid' has no material"],
    ),
    "no density": (
        [drop("materials.granite.density")],
        ["solids.column.material", "density", "materials.granite"],
    ),
    "is incompressible": (
        [put("materials.granite.poissons_ratio", 0.5)],
        ["solids.column", "Poisson's ratio"],
    ),
    "no interface": (
        [put("solids.0.interfaces", []), drop("joints"), drop("nodes.foot")],
        ["solids.column.interfaces", "none", "[[solids.interfaces]]"],
    ),
    "interface without place": ([drop(f"{HEAD}.box")], ["interfaces[1]", "neither patch nor box"]),
    "interface with two places": ([put(f"{HEAD}.patch", "+z")], ["interfaces[1]", "both patch"]),
    "normal without a box": (
        [put("solids.0.interfaces.0.normal", [0, 0, 1])],
        ["solids.column.interfaces[0].normal", "box"],
    ),
    "unknown patch": (
        [put("solids.0.interfaces.0.patch", "top")],
        ["solids.column.interfaces[0].patch", "'top'", "'+z'"],
    ),
    "empty box": (
        [put(f"{HEAD}.box", [[0, 0, 0.7], [0.2, 0.15, 0.7]])],
        ["solids.column.interfaces[1].box", "no face"],
    ),
    "box upside down": (
        [put(f"{HEAD}.box", [[0.2, 0, 0.6], [0, 0.15, 0.6]])],
        ["solids.column.interfaces[1].box", "lowest corner first"],
    ),
    "box turned inwards": ([put(f"{HEAD}.normal", [0, 0, -1])], ["interfaces[1].box", "no face"]),
    "normal of zero length": ([put(f"{HEAD}.normal", [0, 0, 0])], ["interfaces[1].box", "normal"]),
    "unknown node": (
        [put(f"{HEAD}.node", "Q")],
        ["solids.column.interfaces[1].node", '"Q"', "ground, foot"],
    ),
    "node tied twice": (
        [put(f"{HEAD}.node", "foot"), drop("beams"), put("masses", []), put("loads", []),
         drop("tool"), drop("nodes.head"), drop("nodes.tip")],
        ["solids.column.interfaces", '"foot"', "twice"],
    ),
    "node elsewhere": (
        [put("nodes.head", [0.1, 0.075, 0.7])],
        ["solids.column.interfaces[1].node", '"head"', "100 mm", "rigid body"],
    ),
    "solid placed elsewhere": (
        [put("solids.0.position", [0.5, 0, 0])],
        ["solids.column.interfaces[0].node", '"foot"', "500 mm"],
    ),
    "axis of zero length": ([put("solids.0.axis", [0, 0, 0])], ["solids.column", "zero length"]),
    "two solids of one name": (
        [lambda c: c["solids"].append(c["solids"][0])],
        ["solid column", "twice"],
    ),
    "name of a beam": ([put("solids.0.name", "arm")], ["solid arm", "beam"]),
    "node with the name of a monitor": (
        [put("nodes.column/1", [0, 0, 0]),
         add("springs", {"node": "column/1", "stiffness": {"x": 1.0}})],
        ["node column/1", "inside the solid column"],
    ),
    "too many cells": ([put("solids.0.cell", "1 mm")], ["solids.column", "1.8e+07 cells"]),
    "file outside": (
        [from_file("../part.msh")],
        ["solids.column.mesh", "leads out of the folder", "link"],
    ),
    "absolute file": ([from_file("/etc/passwd")], ["solids.column.mesh", "leads out"]),
    "file of another system": ([from_file("C:\\part.msh")], ["solids.column.mesh", "leads out"]),
    "missing file": ([from_file("part.msh")], ["solids.column.mesh", '"part.msh"', "no file"]),
    "a folder": ([from_file("folder.msh")], ["solids.column.mesh", "not an ordinary file"]),
    "unknown suffix": ([from_file("text.txt")], ["solids.column.mesh", "'.txt'", ".msh"]),
    "cut short": ([from_file("short.msh")], ["solids.column.mesh", "short.msh", "cut short"]),
    "empty file": ([from_file("empty.msh")], ["solids.column.mesh", "empty"]),
    "inverted cells": ([from_file("inverted.msh")], ["solids.column.mesh", "16 of 16 cells"]),
    "unknown unit": ([from_file("part.msh", unit="inch")], ["solids.column.unit", '"inch"']),
    "unit of a block": ([put("solids.0.unit", "mm")], ["solids.column.unit", "not a key of a"]),
}  # fmt: skip


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Parts that cannot be used."""
    folder = tmp_path_factory.mktemp("parts")
    whole = write_mesh(brick(), folder / "whole.msh").read_bytes()
    (folder / "short.msh").write_bytes(whole[: len(whole) // 2])
    write_mesh(brick((2, 2, 4)), folder / "coarse.msh")
    (folder / "empty.msh").write_bytes(b"")
    (folder / "text.txt").write_text("no mesh", encoding="utf-8")
    (folder / "folder.msh").mkdir()
    mesh = block((0.2, 0.15, 0.6), (2, 2, 4))
    cells = mesh.blocks[0].nodes[:, [4, 5, 6, 7, 0, 1, 2, 3]]
    inverted = replace(mesh, blocks=(replace(mesh.blocks[0], nodes=cells),))
    write_mesh(inverted, folder / "inverted.msh")
    return folder


@pytest.mark.parametrize("what", WRONG)
def test_what_is_wrong_is_named_by_its_field(what: str, parts: Path) -> None:
    edits, words = WRONG[what]
    with pytest.raises(StrutworkError) as caught:
        model_of(*edits, folder=parts)
    message = str(caught.value)
    for word in words:
        assert word in message
    # part, problem and, on a line of its own, the remedy
    assert "\n" in message


def test_parts_have_a_largest_size(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_mesh(brick(), tmp_path / "part.msh")
    monkeypatch.setattr(part_files, "MAX_PART", 1000)
    with pytest.raises(ModelError, match=r"solids\.column\.mesh: .* MB, more than"):
        model_of(from_file("part.msh"), folder=tmp_path)


def test_a_wrong_load_is_found_before_anything_is_meshed(tmp_path: Path) -> None:
    wrong = add("misfits", {"joint": "none", "gap": {"x": 1e-5}})
    with pytest.raises(ModelError, match=r"misfits\[0\]"):
        model_of(wrong, put("solids.0.shape", "tube"), folder=tmp_path)
