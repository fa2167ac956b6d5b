"""Superelements on disk: the same again, and damage found."""

from pathlib import Path

import numpy as np
import pytest

from fea.interface import Interface
from fea.reduce_solid import reduce_solid
from fea.solid import Solid
from fea.superelement import Superelement
from fea.superelement_file import (
    cached_superelement,
    fingerprint,
    read_superelement,
    write_superelement,
)
from meshes import block
from msa.materials import Material
from strutwork.errors import CacheWarning, ModelError

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

    monkeypatch.setattr("fea.reduce_solid.superelement", refuse)
    same(first, make(tmp_path))
    # another content is another file
    with pytest.raises(AssertionError):
        make(tmp_path, length=1.1)


@pytest.mark.parametrize("damage", ["cut", "flipped", "other"])
def test_damage_is_found_and_mended(tmp_path: Path, damage: str) -> None:
    first = make(tmp_path)
    path = next(tmp_path.iterdir())
    whole = bytearray(path.read_bytes())
    if damage == "cut":
        whole = whole[: len(whole) // 2]
    elif damage == "flipped":
        whole[-200] ^= 1
    else:
        whole = bytearray(b"no superelement at all, but long enough to have a checksum in it")
    path.write_bytes(whole)
    with pytest.raises(ModelError, match="is damaged or no superelement"):
        read_superelement(path)
    with pytest.warns(CacheWarning, match="made anew"):
        same(first, make(tmp_path))
    same(first, read_superelement(path))


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"superelement file none: cannot be read"):
        read_superelement(tmp_path / "none")


def test_where_it_cannot_be_stored(tmp_path: Path) -> None:
    element = make(tmp_path)
    blocked = tmp_path / "file"
    blocked.write_text("a file where a folder should be")
    with pytest.warns(CacheWarning, match="cannot be kept"):
        same(element, cached_superelement(["x"], lambda: element, blocked / "below"))


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
