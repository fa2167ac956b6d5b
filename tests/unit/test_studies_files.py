"""Datasets as files, and the CSV of published numbers."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import ModelError
from strutwork.machines import Proposed3PPRS
from strutwork.papers.published_rows import PublishedRow
from strutwork.papers.tables import write_published
from strutwork.studies import (
    hemisphere,
    read_netcdf,
    stiffness_map,
    sweep,
    write_csv,
    write_json,
    write_netcdf,
)

COLUMNS = (
    *("row", "quantity", "unit", "published", "computed"),
    *("difference_percent", "status", "note"),
)


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    machine = Proposed3PPRS()
    home = machine.home().position
    return sweep(machine, [home, home + np.array([0, 0, 0.2])], workers=1)


def test_a_map_comes_back_from_netcdf(tmp_path: Path) -> None:
    machine = Proposed3PPRS()
    made = stiffness_map(machine, hemisphere(machine, lattice=2), [0.0, 0.5], workers=1)
    path = write_netcdf(tmp_path / "deep" / "map.nc", made)
    back = read_netcdf(path)
    xr.testing.assert_equal(back, made)
    assert back["stiffness_blocked"].attrs == made["stiffness_blocked"].attrs
    assert json.loads(back.attrs["parameters"])["link_length"] == 0.216
    assert back["status"].dtype == np.int8


def test_a_sweep_comes_back_from_netcdf(found: xr.Dataset, tmp_path: Path) -> None:
    xr.testing.assert_equal(read_netcdf(write_netcdf(tmp_path / "sweep.nc", found)), found)


def test_a_file_that_is_no_netcdf_is_named(tmp_path: Path) -> None:
    path = tmp_path / "map.nc"
    path.write_text("not a map", encoding="utf-8")
    with pytest.raises(ModelError, match=r"map\.nc"):
        read_netcdf(path)


def test_csv_has_a_row_a_pose_and_units_in_its_header(found: xr.Dataset, tmp_path: Path) -> None:
    with write_csv(tmp_path / "sweep.csv", found).open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2
    assert [row["status"] for row in rows] == ["good", "unreachable"]
    stiffness = found["stiffness_blocked"].to_numpy()
    assert float(rows[0]["stiffness_blocked_x [N/m]"]) == stiffness[0, 0]
    assert float(rows[0]["stiffness_blocked_rz [N m/rad]"]) == stiffness[0, 5]
    assert rows[1]["stiffness_blocked_x [N/m]"] == ""
    assert float(rows[0]["position_z [m]"]) == 0.126
    assert not any(name.startswith("compliance") for name in rows[0])


def test_json_has_null_where_a_number_is_missing(found: xr.Dataset, tmp_path: Path) -> None:
    text = write_json(tmp_path / "sweep.json", found).read_text(encoding="utf-8")
    content = json.loads(text, parse_constant=lambda word: pytest.fail(f"JSON holds {word}"))
    stiffness = content["variables"]["stiffness_free"]
    assert stiffness["dimensions"] == ["pose", "direction"]
    assert stiffness["values"][0] == found["stiffness_free"].to_numpy()[0].tolist()
    assert stiffness["values"][1] == [None] * 6
    assert content["coordinates"]["direction"] == ["x", "y", "z", "rx", "ry", "rz"]


def test_nothing_is_left_of_a_file_that_failed(found: xr.Dataset, tmp_path: Path) -> None:
    bad = found.assign_attrs(unwritable=object())
    with pytest.raises(TypeError):
        write_netcdf(tmp_path / "map.nc", bad)
    assert list(tmp_path.iterdir()) == []


def test_a_dataset_without_poses_has_no_csv(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no poses"):
        write_csv(tmp_path / "x.csv", xr.Dataset())


def test_published_rows_as_csv(tmp_path: Path) -> None:
    rows = [
        PublishedRow("some machine", "Kxx mean", "N/um", 4.0, 5.0, "calibrated", 'a "note", here'),
        PublishedRow("some machine", "Kzz mean", "N/um", -2.0, -1.5, "predicted"),
    ]
    path = write_published(tmp_path, "paper-table-4", rows)
    assert path.name == "published-paper-table-4.csv"
    with path.open(encoding="utf-8") as file:
        read = list(csv.reader(file))
    assert read == [
        list(COLUMNS),
        ["some machine", "Kxx mean", "N/um", "4.0", "5.0", "25.0", "calibrated", 'a "note", here'],
        ["some machine", "Kzz mean", "N/um", "-2.0", "-1.5", "-25.0", "predicted", ""],
    ]


def test_no_percentage_of_zero() -> None:
    with pytest.raises(ModelError, match="zero"):
        _ = PublishedRow("m", "q", "N", 0.0, 1.0, "predicted").difference_percent
