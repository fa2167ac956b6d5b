"""`strutwork map --vibration`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.machines import dynamic_machine, roll_angles
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.studies import dynamic_map, hemisphere, read_netcdf
from tests.cli.conftest import Program

FEW = ("--lattice", "1", "--rolls", "2", "--workers", "1", "--ranges", "revolute", "--vibration")


def test_numbers_are_those_of_the_study_and_land_in_files(
    strutwork: Program, tmp_path: Path
) -> None:
    found = strutwork("map", "proposed-3pprs:calibrated", *FEW, "-o", tmp_path, "--json").result
    machine = dynamic_machine("proposed-3pprs", "calibrated")
    study = dynamic_map(machine, hemisphere(machine, lattice=1), roll_angles(2), AS_IN_AZULAY)
    assert found["machine"] == "proposed-3pprs:calibrated"
    assert "fitted to Table 5" in found["model"]
    assert found["points"] == 5
    least = study["minimum_dynamic_stiffness"].sel(axis="x").to_numpy()
    # the same numbers through JSON, which keeps every digit
    assert found["minimum_dynamic_stiffness"]["x"]["worst"] == pytest.approx(least.min(), rel=1e-12)
    first = study["natural_frequency"].isel(mode=0).to_numpy()
    assert found["first_frequency"]["mean"] == pytest.approx(first.mean(), rel=1e-12)
    file = read_netcdf(tmp_path / "proposed-3pprs-calibrated-vibration-map.nc")
    assert file["natural_frequency"].attrs["units"] == "Hz"
    assert found["data"] == [
        str(tmp_path / f"proposed-3pprs-calibrated-vibration-map.{e}") for e in ("nc", "csv")
    ]


@pytest.mark.parametrize("which", ["", ":static", ":apparent"])
def test_a_model_for_statics_is_refused(strutwork: Program, which: str) -> None:
    """One name is one machine: what cannot vibrate is not replaced in silence."""
    for command in (("map", *FEW), ("modes",)):
        run = strutwork(command[0], f"proposed-3pprs{which}", *command[1:], "--json")
        assert run.status == 1
        assert run.out == ""
        assert "is a model for statics" in run.err
        assert "proposed-3pprs:calibrated, proposed-3pprs:blind" in run.err


def test_a_name_is_one_structure_for_every_command(strutwork: Program, tmp_path: Path) -> None:
    name = "proposed-3pprs:blind"
    frf = ("--input", "tool:x", "--from", "1", "--to", "400", "--modal-ratio", "0.01", "--json")
    static = strutwork("frf", name, *frf).result["static_stiffness"]
    level = ("-o", tmp_path, "--lattice", "1", "--rolls", "1", "--ranges", "none", "--json")
    found = strutwork("map", name, *level).result
    assert found["machine"] == name
    # the pole, level, is home
    mapped = read_netcdf(tmp_path / "proposed-3pprs-blind-map.nc")["compliance"].to_numpy()
    assert np.abs(1.0 / mapped[:, 0, 0] / static - 1.0).min() < 1e-6


def test_an_unknown_variant_lists_those_there_are(strutwork: Program) -> None:
    run = strutwork("map", "proposed-3pprs:nothing", *FEW)
    assert run.status == 1
    assert "Variants: proposed-3pprs:static" in run.err
