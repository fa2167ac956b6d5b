"""Superelements on disk: the same again, and damage found."""

import errno
import multiprocessing
import os
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import CacheWarning, ModelError, NumericalError
from strutwork.fea import superelement_file
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import reduce_solid
from strutwork.fea.solid import Solid
from strutwork.fea.superelement import Superelement
from strutwork.fea.superelement_file import (
    cached_superelement,
    fingerprint,
    read_superelement,
    write_superelement,
)
from strutwork.fea.tied_solid import StaticSolver
from strutwork.meshes import block
from strutwork.msa.materials import Material

Array = NDArray[Any]

STEEL = Material.isotropic(200e9, 0.3, density=7800.0, name="steel")


def make(folder: Path, length: float = 1.0) -> Superelement:
    solid = Solid(block((0.2, 0.2, length), (2, 2, 5)), {"solid": STEEL}, order=1, name="bar")
    return reduce_solid(solid, [Interface("a", "-z"), Interface("b", "+z")], modes=6, folder=folder)


def same(first: Superelement, second: Superelement) -> None:
    assert (first.name, first.nodes, first.solver) == (second.name, second.nodes, second.solver)
    for key in ("positions", "local_stiffness", "local_mass", "shapes", "fixed_frequencies"):
        np.testing.assert_array_equal(getattr(first, key), getattr(second, key))


def test_second_time_from_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = make(tmp_path)
    assert len(list(tmp_path.iterdir())) == 1

    def refuse(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr("strutwork.fea.reduce_solid.superelement", refuse)
    same(first, make(tmp_path))
    # another content is another file
    with pytest.raises(AssertionError):
        make(tmp_path, length=1.1)


@pytest.mark.parametrize("damage", ["empty", "cut", "flipped", "other"])
def test_damage_is_found_and_mended(tmp_path: Path, damage: str) -> None:
    first = make(tmp_path)
    path = next(tmp_path.iterdir())
    whole = bytearray(path.read_bytes())
    if damage == "cut":
        whole = whole[: len(whole) // 2]
    elif damage == "empty":
        whole.clear()
    elif damage == "flipped":
        whole[-200] ^= 1
    else:
        whole = bytearray(b"no superelement at all, but long enough to have a checksum in it")
    path.write_bytes(whole)
    with pytest.raises(ModelError, match="is damaged or not a superelement"):
        read_superelement(path)
    with pytest.warns(CacheWarning, match="made again"):
        same(first, make(tmp_path))
    same(first, read_superelement(path))


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"superelement file none: cannot be read"):
        read_superelement(tmp_path / "none")


def test_where_it_cannot_be_stored(tmp_path: Path) -> None:
    element = make(tmp_path)
    blocked = tmp_path / "file"
    blocked.write_text("a file where a folder should be")
    with pytest.warns(CacheWarning, match="cannot be stored"):
        same(element, cached_superelement(["x"], lambda: element, blocked / "below"))


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EACCES])
def test_a_disk_that_takes_no_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    element = make(tmp_path / "first")

    def full(*_: object) -> NoReturn:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(Path, "write_bytes", full)
    folder = tmp_path / "full"
    with pytest.warns(CacheWarning, match="XDG_CACHE_HOME") as notes:
        made = [cached_superelement([name], lambda: element, folder) for name in "xy"]
    assert made == [element, element]
    assert len(notes) == 1
    assert os.strerror(number) in str(notes[0].message)
    assert not list(folder.iterdir())


def test_without_a_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    element = make(tmp_path)
    monkeypatch.setattr(superelement_file, "user_cache", lambda: None)
    with pytest.warns(CacheWarning, match="there is no home folder") as notes:
        made = [cached_superelement([name], lambda: element) for name in "xy"]
    assert made == [element, element]
    assert len(notes) == 1


def test_a_folder_that_cannot_be_reached(tmp_path: Path) -> None:
    element = make(tmp_path)
    with pytest.warns(CacheWarning, match="File name too long"):
        same(element, cached_superelement(["x"], lambda: element, tmp_path / ("x" * 300)))


def test_other_code_makes_another_element(monkeypatch: pytest.MonkeyPatch) -> None:
    before = fingerprint(["x"])
    monkeypatch.setattr(superelement_file, "version", lambda name: f"another {name}")
    others = fingerprint(["x"])
    monkeypatch.undo()
    monkeypatch.setattr(superelement_file, "source_digest", lambda *_: "of changed sources")
    assert len({before, others, fingerprint(["x"])}) == 3


def _at_once(folder: Path, start: object, made: object) -> None:
    start.wait()  # type: ignore[attr-defined]
    element = make(folder)
    made.put((element.local_stiffness, element.local_mass))  # type: ignore[attr-defined]


def test_eight_processes_on_a_cold_cache(tmp_path: Path) -> None:
    reference = make(tmp_path / "reference")
    # forked, so that all are at the cache together instead of importing for seconds
    context = multiprocessing.get_context("fork")
    start, made = context.Barrier(8), context.Queue()
    folder = tmp_path / "shared"
    children = [context.Process(target=_at_once, args=(folder, start, made)) for _ in range(8)]
    for child in children:
        child.start()
    ends = [made.get(timeout=120) for _ in children]
    for child in children:
        child.join()
        assert child.exitcode == 0
    for stiffness, mass in ends:
        # the same code on the same numbers
        np.testing.assert_array_equal(stiffness, reference.local_stiffness)
        np.testing.assert_array_equal(mass, reference.local_mass)
    (kept,) = folder.iterdir()
    same(reference, read_superelement(kept))


def test_round_trip(tmp_path: Path) -> None:
    element = make(tmp_path)
    write_superelement(element, tmp_path / "one.superelement")
    same(element, read_superelement(tmp_path / "one.superelement"))


def test_fingerprint_sees_every_part() -> None:
    parts = [np.arange(3.0), "a", 1.5]
    marks = {
        fingerprint(parts),
        fingerprint([np.arange(3), "a", 1.5]),
        fingerprint([np.arange(3.0), "b", 1.5]),
        fingerprint([np.arange(3.0), "a", 1.6]),
        fingerprint([np.arange(3.0).reshape(1, 3), "a", 1.5]),
    }
    assert len(marks) == 5


def test_static_shapes_that_are_off_are_withheld(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    exact = StaticSolver._flexible

    def rough(self: StaticSolver, forces: Array) -> Array:
        # far below the size of stiffness times displacement, and still wrong
        return exact(self, forces) * (1.0 + 1e-4 * np.arange(len(forces))[:, None] / len(forces))

    monkeypatch.setattr(StaticSolver, "_flexible", rough)
    with pytest.raises(NumericalError, match=r"solid bar: its static solutions are accurate to"):
        make(tmp_path)
    assert not list(tmp_path.iterdir())
