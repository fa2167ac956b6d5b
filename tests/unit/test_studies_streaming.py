"""Stiffness maps written region by region: the same numbers, resumed, and nothing half."""

from __future__ import annotations

import errno
import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import OutputError
from strutwork.machines import Proposed3PPRS, roll_angles
from strutwork.studies import hemisphere, stiffness_map
from strutwork.studies.check_points import CheckPoints
from strutwork.studies.region_store import RegionStore
from strutwork.studies.run import Run

pytest.importorskip("zarr")
streaming = pytest.importorskip("strutwork.studies.streaming")

MACHINE = Proposed3PPRS()
POINTS = hemisphere(MACHINE, lattice=3)
ROLLS = roll_angles(2)


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(streaming, "CHUNK", 16)


def stream(path: Path, run: Run | None = None, points: CheckPoints = POINTS) -> xr.Dataset:
    return streaming.stream_stiffness_map(MACHINE, path, points, ROLLS, run=run)


class StopError(BaseException):
    """Stands for a kill."""


def stopped_after(chunks: int) -> Run:
    def progress(done: int, total: int, /) -> None:
        if done >= min(16 * chunks, total):
            raise StopError

    return Run(workers=1, progress=progress)


def test_a_streamed_map_is_the_map(tmp_path: Path) -> None:
    whole = stiffness_map(MACHINE, POINTS, ROLLS)
    found = stream(tmp_path / "map.zarr", Run(workers=2))
    for name, variable in whole.variables.items():
        assert found[name].dims == variable.dims
        np.testing.assert_array_equal(found[name].to_numpy(), variable.to_numpy())
    for name in ("units", "long_name"):
        assert found["compliance"].attrs.get(name) == whole["compliance"].attrs.get(name)
    for name in ("candidates_kept", "points_kept", "candidates", "condition_limit"):
        assert found.attrs[name] == whole.attrs[name]
    assert json.loads(found.attrs["dropped_by_reason"]) == json.loads(
        whole.attrs["dropped_by_reason"]
    )
    assert not (tmp_path / "map.zarr.part").exists()


def test_its_arrays_stay_on_disk(tmp_path: Path) -> None:
    found = stream(tmp_path / "map.zarr")
    # nothing was read for its sake
    assert not found["compliance"].variable._in_memory


def test_an_interrupted_stream_goes_on(tmp_path: Path) -> None:
    expected = stream(tmp_path / "good.zarr").load()
    with pytest.raises(StopError):
        stream(tmp_path / "map.zarr", stopped_after(3))
    steps: list[int] = []
    found = stream(tmp_path / "map.zarr", Run(workers=1, progress=lambda d, _: steps.append(d)))
    xr.testing.assert_identical(found.load(), expected)
    # two were in their place when the third was counted
    assert steps[0] >= 32
    again: list[int] = []
    stream(tmp_path / "map.zarr", Run(progress=lambda d, _: again.append(d)))
    assert again == [len(POINTS) * len(ROLLS)]


def damaged(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 0xFF
    path.write_bytes(bytes(content))


@pytest.mark.parametrize("damage", [damaged, Path.unlink, lambda p: p.write_bytes(b"")])
def test_a_damaged_region_is_computed_again(tmp_path: Path, damage: object) -> None:
    path = tmp_path / "map.zarr"
    expected = stream(path).load()
    damage(path / "compliance" / "c" / "1" / "0" / "0")  # type: ignore[operator]
    steps: list[int] = []
    found = stream(path, Run(progress=lambda d, _: steps.append(d)))
    assert steps[0] == 16
    xr.testing.assert_identical(found.load(), expected)


def test_the_folder_of_another_study_is_refused(tmp_path: Path) -> None:
    stream(tmp_path / "map.zarr")
    with pytest.raises(OutputError, match="holds another study"):
        stream(tmp_path / "map.zarr", points=hemisphere(MACHINE, lattice=2))


def test_a_full_disk_loses_nothing_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "map.zarr"
    expected = stream(tmp_path / "good.zarr").load()
    write = RegionStore.write

    def full(self: RegionStore, number: int, *rest: object) -> None:
        if number == 2:
            with self._written():
                raise OSError(errno.ENOSPC, "No space left on device")
        write(self, number, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(RegionStore, "write", full)
    with pytest.raises(OutputError, match=r"map\.zarr: cannot be written \(No space") as caught:
        stream(path)
    assert "Free some space" in caught.value.remedy
    monkeypatch.undo()
    monkeypatch.setattr(streaming, "CHUNK", 16)
    steps: list[int] = []
    xr.testing.assert_identical(
        stream(path, Run(workers=1, progress=lambda d, _: steps.append(d))).load(), expected
    )
    assert steps[0] >= 32
