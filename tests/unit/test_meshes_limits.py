"""A mesh file reaches nothing outside its folder, and takes no more memory than is stated."""

from __future__ import annotations

import os
from pathlib import Path

import h5py
import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import block, limits, read_mesh, write_mesh
from strutwork.meshes.deck_lines import DeckLines

INCLUDES = {".inp": "*INCLUDE, INPUT={}\n", ".bdf": "BEGIN BULK\nINCLUDE '{}'\n"}
SUFFIXES = list(INCLUDES)


def including(folder: Path, suffix: str, name: str) -> Path:
    path = folder / f"part{suffix}"
    path.write_text(INCLUDES[suffix].format(name))
    return path


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize(
    "name",
    ["/etc/passwd", "/dev/zero", "../other", "sub/../../other", "C:\\x.inp", "\\\\host\\x", ""],
)
def test_an_include_that_leads_out_of_the_folder_is_refused(
    suffix: str, name: str, tmp_path: Path
) -> None:
    (tmp_path / "other").write_text("*NODE\n")
    (tmp_path / "in").mkdir()
    with pytest.raises(ModelError, match=r"line \d+ includes .*leads out of the folder"):
        read_mesh(including(tmp_path / "in", suffix, name))


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("target", ["../secret", "/dev/zero"])
def test_a_link_out_of_the_folder_is_refused(suffix: str, target: str, tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("*NODE\n1, 0., 0., 0.\n")
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "link").symlink_to(target)
    with pytest.raises(ModelError, match="a link that leads out of the folder"):
        read_mesh(including(tmp_path / "in", suffix, "link"))


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_pipe_and_a_folder_are_refused_at_once(suffix: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    for name in ("pipe", "folder"):
        with pytest.raises(ModelError, match="is not an ordinary file"):
            read_mesh(including(tmp_path, suffix, name))


@pytest.mark.parametrize("suffix", [".inp", ".bdf", ".msh", ".vtu", ".med"])
def test_a_mesh_file_that_is_a_pipe_is_refused_at_once(suffix: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / f"part{suffix}")
    with pytest.raises(ModelError, match="is not an ordinary file"):
        read_mesh(tmp_path / f"part{suffix}")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_files_that_include_each_other_are_refused(suffix: str, tmp_path: Path) -> None:
    line = INCLUDES[suffix].splitlines()[-1]
    (tmp_path / "b").write_text(line.format(f"part{suffix}") + "\n")
    with pytest.raises(ModelError, match="which is being read"):
        read_mesh(including(tmp_path, suffix, "b"))


def test_includes_share_one_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "b.inc").write_text("** " + "x" * 500 + "\n")
    path = tmp_path / "part.inp"
    path.write_text("*INCLUDE, INPUT=b.inc\n" * 10)
    monkeypatch.setattr(limits, "LARGEST_FILE", 2000)
    with pytest.raises(ModelError, match=r"line 4 includes 'b.inc': the file has .* is the limit"):
        read_mesh(path)
    monkeypatch.setattr(limits, "LARGEST_FILE", 10**6)
    monkeypatch.setattr("strutwork.meshes.deck_lines.MOST_INCLUDES", 5)
    with pytest.raises(ModelError, match="line 6 is include 6; 5 is the limit"):
        read_mesh(path)


def test_a_line_without_end_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "part.inp"
    path.write_text("*NODE\n" + "1," * 60_000)
    with pytest.raises(ModelError, match="line 2 has 120000 characters"):
        read_mesh(path)


def test_an_include_of_an_include_is_named_with_its_line(tmp_path: Path) -> None:
    (tmp_path / "a.inc").write_text("** one\n** two\n")
    path = tmp_path / "part.inp"
    path.write_text("*INCLUDE, INPUT=a.inc\n** three\n")
    lines = DeckLines(path)
    places = []
    for line in lines:
        places.append((line, lines.where))
        if line.startswith("*INCLUDE"):
            lines.include("a.inc")
    assert places == [
        ("*INCLUDE, INPUT=a.inc", "line 1"), ("** one", "a.inc, line 1"),
        ("** two", "a.inc, line 2"), ("** three", "line 2"),
    ]  # fmt: skip


def med(tmp_path: Path) -> Path:
    return write_mesh(block((1.0, 1.0, 1.0), (2, 2, 2)), tmp_path / "part.med")


def nodes(file: h5py.File) -> h5py.Group:
    return next(iter(file["ENS_MAA/mesh"].values()))["NOE"]


def test_a_med_file_that_unpacks_to_more_than_the_limit_is_refused_before(tmp_path: Path) -> None:
    path = med(tmp_path)
    with h5py.File(path, "a") as file:
        del nodes(file)["COO"]
        size = 3 * 200_000_000
        nodes(file).create_dataset("COO", (size,), "f8", chunks=(2**20,), compression="gzip")
    assert path.stat().st_size < 100_000
    with pytest.raises(ModelError, match="unpacks to 4800 MB; 2000 MB is the limit"):
        read_mesh(path)
    with h5py.File(path, "a") as file:
        del nodes(file)["COO"]
        size = 3 * 6_000_000
        nodes(file).create_dataset("COO", (size,), "f8", chunks=(2**20,), compression="gzip")
    with pytest.raises(ModelError, match="'COO' of 18000000 numbers; 15000000 is the limit"):
        read_mesh(path)


def test_a_med_file_reads_no_other_file(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_bytes(np.zeros(81).tobytes())
    path = med(tmp_path)
    with h5py.File(path, "a") as file:
        del nodes(file)["COO"]
        nodes(file).create_dataset("COO", (81,), "f8", external=[(str(secret), 0, 648)])
    with pytest.raises(ModelError, match="keeps the array 'COO' in other files"):
        read_mesh(path)
    path = med(tmp_path)
    other = med(tmp_path).rename(tmp_path / "other.med")
    path = med(tmp_path)
    with h5py.File(path, "a") as file:
        place = nodes(file).name
        del nodes(file)["COO"]
        nodes(file)["COO"] = h5py.ExternalLink(str(other), f"{place}/COO")
    with pytest.raises(ModelError, match="holds 'COO' as a link, which is not followed"):
        read_mesh(path)


def test_a_med_file_of_two_meshes_is_refused(tmp_path: Path) -> None:
    path = med(tmp_path)
    with h5py.File(path, "a") as file:
        file.copy("ENS_MAA/mesh", "ENS_MAA/second")
    with pytest.raises(ModelError, match="holds 2 meshes"):
        read_mesh(path)


def test_a_wedge_of_a_med_file_is_named(tmp_path: Path) -> None:
    path = med(tmp_path)
    with h5py.File(path, "a") as file:
        cells = next(iter(file["ENS_MAA/mesh"].values()))["MAI"]
        group = cells.create_group("PE6")
        group["NOD"] = np.arange(1, 7)
        del cells["HE8"]
    with pytest.raises(ModelError, match="each is a wedge"):
        read_mesh(path)
