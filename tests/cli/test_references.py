"""Files that a command or a model file names: nothing but ordinary files is opened."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from strutwork.fea import uff_read
from strutwork.machines import model_file, part_files
from tests.cli.conftest import Program

SOLID = """
[materials.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
[nodes]
A = [0, 0, 0]
[[solids]]
name = "block"
{key} = "{name}"
{more}
material = "steel"
interfaces = [{{ node = "A", box = [[0, 0, 0], [1, 1, 1]] }}]
[[supports]]
node = "A"
fixed = "all"
"""

SPECIAL: dict[str, Callable[[Path], object]] = {
    "fifo": os.mkfifo,
    "directory": Path.mkdir,
    "device": lambda path: path.symlink_to("/dev/zero"),
    "link to a fifo": lambda path: (os.mkfifo(f"{path}-fifo"), path.symlink_to(f"{path}-fifo")),
}

SOURCES = {
    "mesh": ("part.vtu", ""),
    "step": ("part.step", 'cell = "10 mm"'),
    "surface": ("part.stl", 'cell = "10 mm"'),
}


def solid_file(folder: Path, key: str, name: str) -> Path:
    path = folder / "model.toml"
    path.write_text(SOLID.format(key=key, name=name, more=SOURCES[key][1]), encoding="utf-8")
    return path


@pytest.mark.parametrize("kind", SPECIAL)
@pytest.mark.parametrize("source", SOURCES)
def test_a_solid_is_an_ordinary_file(
    strutwork: Program, tmp_path: Path, source: str, kind: str
) -> None:
    name = SOURCES[source][0]
    SPECIAL[kind](tmp_path / name)
    run = strutwork("check", solid_file(tmp_path, source, name))
    assert run.status == 1
    assert f"solids.block.{source}" in run.err
    assert "ordinary file" in run.err


@pytest.mark.parametrize(
    "name", ["../part.vtu", "/dev/zero", "a/../../part.vtu", "..\\\\part.vtu", "C:\\\\part.vtu"]
)
@pytest.mark.parametrize("source", SOURCES)
def test_a_solid_lies_in_the_folder_of_its_model_file(
    strutwork: Program, tmp_path: Path, source: str, name: str
) -> None:
    (tmp_path / "part.vtu").write_text("no mesh", encoding="utf-8")
    folder = tmp_path / "models"
    folder.mkdir()
    run = strutwork("check", solid_file(folder, source, name))
    assert run.status == 1
    assert f"solids.block.{source}" in run.err
    assert "no mesh" not in run.err


def test_a_solid_that_is_huge_is_refused_by_its_size(strutwork: Program, tmp_path: Path) -> None:
    with (tmp_path / "part.vtu").open("wb") as file:
        # holes take no disk
        file.truncate(part_files.MAX_PART + 1_000_000)
    run = strutwork("check", solid_file(tmp_path, "mesh", "part.vtu"))
    assert run.status == 1
    assert "501 MB" in run.err


@pytest.mark.parametrize("kind", SPECIAL)
@pytest.mark.parametrize("command", ["check", "solve", "modes", "report", "tolerance"])
def test_a_model_file_is_an_ordinary_file(
    strutwork: Program, tmp_path: Path, command: str, kind: str
) -> None:
    path = tmp_path / "model.toml"
    SPECIAL[kind](path)
    run = strutwork(command, path)
    assert run.status == 1
    assert "directory" in run.err or "ordinary file" in run.err


@pytest.mark.parametrize("kind", SPECIAL)
@pytest.mark.parametrize("second", [False, True])
def test_a_universal_file_is_an_ordinary_file(
    strutwork: Program, tmp_path: Path, second: bool, kind: str
) -> None:
    path = tmp_path / "x.uff"
    SPECIAL[kind](path)
    other = Path(__file__).parents[1] / "cases" / "uff" / "computed.uff"
    run = strutwork("correlate", *((other, path) if second else (path, other)))
    assert run.status == 1
    assert str(path) in run.err
    assert "ordinary file" in run.err


def test_huge_files_are_refused_by_their_size(strutwork: Program, tmp_path: Path) -> None:
    for name, most, command in (
        ("x.toml", model_file.MAX_BYTES, ("check",)),
        ("x.uff", uff_read.MAX_BYTES, ("correlate", tmp_path / "x.uff")),
    ):
        with (tmp_path / name).open("wb") as file:
            file.truncate(most + 1_000_000)
        run = strutwork(*command, tmp_path / name)
        assert run.status == 1
        assert "MB" in run.err
