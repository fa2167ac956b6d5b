from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from machines import Proposed3PPRS, roll_angles
from msa import axis_stiffness_blocked
from studies import AS_IN_AZULAY, hemisphere, read_netcdf, stiffness_map
from tests.cli.conftest import Program

FEW = ("--lattice", "1", "--rolls", "2", "--workers", "1", "--ranges", "revolute")


def test_keys_of_the_json(strutwork: Program) -> None:
    found = strutwork("map", "proposed-3pprs", *FEW, "--json").result
    assert set(found) == {
        "machine",
        "points",
        "points_kept",
        "candidates",
        "candidates_kept",
        "dropped",
        "dropped_because",
        "stiffness",
        "data",
    }
    # i² + j² ≤ 1 has five points on the lattice
    assert (found["machine"], found["points"], found["candidates"]) == ("proposed-3pprs", 5, 10)
    assert found["candidates_kept"] + sum(found["dropped"].values()) == 10
    assert found["data"] == []
    for meaning in ("blocked", "free"):
        assert set(found["stiffness"][meaning]) == {"x", "y", "z"}
        for axis in found["stiffness"][meaning].values():
            assert axis["worst"]["value"] <= axis["statistics"]["mean"] <= axis["best"]["value"]


def test_numbers_are_those_of_the_study_and_land_in_files(
    strutwork: Program, tmp_path: Path
) -> None:
    found = strutwork("map", "proposed-3pprs", *FEW, "-o", tmp_path / "maps", "--json").result
    names = ["proposed-3pprs-map.nc", "proposed-3pprs-map.csv"]
    assert found["data"] == [str(tmp_path / "maps" / name) for name in names]
    machine = Proposed3PPRS()
    study = stiffness_map(machine, hemisphere(machine, lattice=1), roll_angles(2), AS_IN_AZULAY)
    blocked = axis_stiffness_blocked(study["compliance"].to_numpy())
    mean = found["stiffness"]["blocked"]["x"]["statistics"]["mean"]
    assert mean == pytest.approx(blocked[:, 0].mean(), rel=1e-12)
    file = read_netcdf(tmp_path / "maps" / names[0])
    assert np.array_equal(file["compliance"], study["compliance"])


def test_apparent_joint_model_is_another(strutwork: Program) -> None:
    plain = strutwork("map", "proposed-3pprs", *FEW, "--json").result
    apparent = strutwork("map", "proposed-3pprs", *FEW, "--apparent", "--json").result
    stiffer = [found["stiffness"]["free"]["z"]["statistics"]["mean"] for found in (apparent, plain)]
    # links clamped in the platform hold its rotation as well
    assert stiffer[0] > stiffer[1]


@pytest.mark.parametrize(
    ("machine", "expected"),
    [("hexapod", "not in the catalogue"), ("model.toml", "one configuration")],
)
def test_no_machine_of_the_catalogue(machine: str, expected: str, strutwork: Program) -> None:
    run = strutwork("map", machine, "--json")
    assert (run.status, run.out) == (1, "")
    assert machine in run.err
    assert expected in run.err


def test_wrong_option(strutwork: Program) -> None:
    for option in (("--lattice", "0"), ("--ranges", "some"), ("--rolls", "x")):
        assert strutwork("map", "proposed-3pprs", *option).status == 2


def test_table_for_people(strutwork: Program) -> None:
    run = strutwork("map", "proposed-3pprs", *FEW)
    assert run.status == 0
    assert "Stiffness in N/µm, other directions blocked" in run.out
    assert "5 points" in run.out
