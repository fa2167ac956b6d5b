"""Files written whole or not at all: kills, limits, devices, links."""

from __future__ import annotations

import errno
import os
import resource
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import OutputError
from strutwork.files import write_text, write_whole
from strutwork.meshes import Surface
from strutwork.meshes.surfaces import write_surface
from strutwork.staging import PREFIX, clean, staging
from strutwork.studies.chunks import ChunkStore
from strutwork.studies.dataset_files import read_netcdf, write_csv, write_json, write_netcdf
from tests.kills import killed_before

#: Smaller than any of the files below, bytes.
LIMIT = 1000


def dataset() -> xr.Dataset:
    return xr.Dataset({"stiffness": ("pose", np.linspace(0.0, 1.0, 500), {"units": "N/m"})})


@pytest.fixture
def small_files() -> Iterator[None]:
    """No file can grow over LIMIT; Python ignores the signal, so that the write fails."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (LIMIT, hard))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def _surface(path: Path) -> Path:
    points = np.random.default_rng(1).random((60, 3))
    return write_surface(Surface(points, np.arange(60).reshape(-1, 3), "s"), path)


WRITERS: dict[str, Callable[[Path], object]] = {
    "a.nc": lambda path: write_netcdf(path, dataset()),
    "a.csv": lambda path: write_csv(path, dataset()),
    "a.json": lambda path: write_json(path, dataset()),
    "a.stl": _surface,
    "a.txt": lambda path: write_text(path, "x" * 2 * LIMIT),
    "chunk": lambda path: ChunkStore(path, "key").write(0, {"a": np.zeros(LIMIT)}),
}


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.usefixtures("small_files")
def test_a_disk_that_takes_no_more(tmp_path: Path, name: str) -> None:
    old = tmp_path / name
    if name != "chunk":
        old.write_text("old")
    with pytest.raises(OutputError, match="File too large") as caught:
        WRITERS[name](old)
    assert "ulimit" in caught.value.remedy
    left = [p for p in tmp_path.rglob("*") if p.is_file()]
    assert left == ([] if name == "chunk" else [old])
    assert name == "chunk" or old.read_text() == "old"
    assert not list(tmp_path.rglob(f"{PREFIX}*"))


@pytest.mark.parametrize("name", WRITERS)
def test_the_same_files_without_the_limit(tmp_path: Path, name: str) -> None:
    WRITERS[name](tmp_path / name)
    assert max(p.stat().st_size for p in tmp_path.rglob("*") if p.is_file()) > LIMIT


@pytest.mark.parametrize(
    ("number", "remedy"),
    [(errno.ENOSPC, "Free some space"), (errno.EDQUOT, "quota"), (errno.EROFS, "may write")],
)
def test_an_error_of_the_disk_names_its_remedy(tmp_path: Path, number: int, remedy: str) -> None:
    def fails(_: Path) -> None:
        raise OSError(number, os.strerror(number))

    with pytest.raises(OutputError) as caught:
        write_whole(tmp_path / "a", fails)
    assert remedy in caught.value.remedy
    assert str(tmp_path / "a") in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_killed_before_any_file_operation(tmp_path: Path) -> None:
    number, seen = 0, set()
    while True:
        folder = tmp_path / str(number)
        folder.mkdir()
        path = folder / "a.txt"
        path.write_text("old")
        killed = killed_before(number, lambda path=path: write_text(path, "new"))  # type: ignore[misc]
        seen.add(path.read_text())
        write_text(path, "new")
        assert [p.name for p in folder.iterdir()] == ["a.txt"]
        assert path.read_text() == "new"
        if not killed:
            break
        number += 1
    assert number > 5
    assert seen == {"old", "new"}


def test_a_living_staging_folder_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / f"{PREFIX}left").mkdir()
    with staging(tmp_path) as made:
        assert not (tmp_path / f"{PREFIX}left").exists()
        assert clean(tmp_path) == 0
        assert made.is_dir()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("path", ["/dev/full", "/dev/null", "."])
def test_a_device_is_no_file(path: str) -> None:
    with pytest.raises(OutputError, match="ordinary file"):
        write_text(Path(path), "text")
    assert not Path(path).is_file()


def test_a_link_is_followed_and_stays(tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "real")
    write_text(link, "text")
    assert link.is_symlink()
    assert (tmp_path / "real").read_text() == "text"


def test_netcdf_is_the_same_twice_and_reads_back(tmp_path: Path) -> None:
    first, second = (write_netcdf(tmp_path / n, dataset()).read_bytes() for n in ("a.nc", "b.nc"))
    assert first == second
    xr.testing.assert_identical(read_netcdf(tmp_path / "a.nc"), dataset())
