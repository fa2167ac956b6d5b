"""`strutwork map --vibration`."""

from __future__ import annotations

from pathlib import Path

import pytest

from machines import dynamic_machine, roll_angles
from studies import AS_IN_AZULAY, dynamic_map, hemisphere, read_netcdf
from tests.cli.conftest import Program

FEW = ("--lattice", "1", "--rolls", "2", "--workers", "1", "--ranges", "revolute", "--vibration")


def test_numbers_are_those_of_the_study_and_land_in_files(
    strutwork: Program, tmp_path: Path
) -> None:
    found = strutwork("map", "proposed-3pprs", *FEW, "-o", tmp_path, "--json").result
    machine = dynamic_machine("proposed-3pprs", "calibrated")
    study = dynamic_map(machine, hemisphere(machine, lattice=1), roll_angles(2), AS_IN_AZULAY)
    assert found["model"] == "calibrated"
    assert found["points"] == 5
    least = study["minimum_dynamic_stiffness"].sel(axis="x").to_numpy()
    # the same numbers through JSON, which keeps every digit
    assert found["minimum_dynamic_stiffness"]["x"]["worst"] == pytest.approx(least.min(), rel=1e-12)
    first = study["natural_frequency"].isel(mode=0).to_numpy()
    assert found["first_frequency"]["mean"] == pytest.approx(first.mean(), rel=1e-12)
    file = read_netcdf(tmp_path / "proposed-3pprs-vibration-map.nc")
    assert file["natural_frequency"].attrs["units"] == "Hz"
    assert found["data"] == [
        str(tmp_path / f"proposed-3pprs-vibration-map.{e}") for e in ("nc", "csv")
    ]


def test_the_apparent_model_is_refused(strutwork: Program) -> None:
    run = strutwork("map", "proposed-3pprs", *FEW, "--apparent", "--json")
    assert run.status == 2
    assert run.out == ""
