from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.machines import Proposed3PPRS, get, roll_angles
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free, tool_compliance
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.studies import hemisphere, on_plane, plane_map, read_netcdf, stiffness_map
from tests.cli.conftest import Program

FEW = ("--lattice", "1", "--rolls", "2", "--workers", "1", "--ranges", "revolute")


def test_keys_of_the_json(strutwork: Program) -> None:
    found = strutwork("map", "proposed-3pprs", *FEW, "--json").result
    assert set(found) == {
        "machine",
        "model",
        "points",
        "points_kept",
        "candidates",
        "candidates_kept",
        "dropped",
        "dropped_because",
        "first_dropped",
        "stiffness",
        "data",
    }
    # i² + j² ≤ 1 has five points on the lattice
    assert (found["machine"], found["points"], found["candidates"]) == (
        "proposed-3pprs:static",
        5,
        10,
    )
    assert "true spherical joints" in found["model"]
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
    names = ["proposed-3pprs-static-map.nc", "proposed-3pprs-static-map.csv"]
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
    apparent = strutwork("map", "proposed-3pprs:apparent", *FEW, "--json").result
    stiffer = [found["stiffness"]["free"]["z"]["statistics"]["mean"] for found in (apparent, plain)]
    # links clamped in the platform hold its rotation as well
    assert stiffer[0] > stiffer[1]


@pytest.mark.parametrize(
    ("machine", "expected"),
    [("hexapod", "neither a machine of the catalogue"), ("model.toml", "does not exist")],
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


@pytest.mark.parametrize(("name", "tilt"), [("mit-ss1", "b"), ("hexel-hexapod", "a")])
def test_planar_machine_and_hexapod_are_mapped_over_x_and_a_tilt(
    name: str, tilt: str, strutwork: Program, tmp_path: Path
) -> None:
    found = strutwork(
        "map", name, "--lattice", "1", "--workers", "1", "-o", tmp_path, "--json"
    ).result
    # three places along x with three tilts each
    assert (found["points"], found["points_kept"], found["candidates"]) == (9, 9, 9)
    assert set(found["dropped"].values()) == {0}
    machine = get(name).factory()
    study = plane_map(machine, machine.pose_grid(1), workers=1)  # type: ignore[attr-defined]
    free = study["stiffness_free"].sel(direction="x").to_numpy()
    assert found["stiffness"]["free"]["x"]["worst"]["value"] == pytest.approx(free.min(), rel=1e-12)
    file = read_netcdf(tmp_path / f"{name}-map.nc")
    assert file.attrs["tilt"] == tilt
    x, tilts, values = on_plane(file, file["stiffness_free"].sel(direction="x").to_numpy())
    assert values.shape == (3, 3)
    placed = machine.structure.at(machine.place(machine.home()))
    home = axis_stiffness_free(tool_compliance(placed))[0]
    if name == "hexel-hexapod":
        assert (x[1], tilts[1]) == (0.0, 0.0)
        assert values[1, 1] == pytest.approx(home, rel=1e-9)
    else:
        # the nominal workspace is shifted by 10 mm
        assert x[1] == pytest.approx(-0.01)
        assert values[1, 1] == pytest.approx(home, rel=0.02)


def test_vibration_is_not_mapped_where_the_hemisphere_cannot_be_reached(strutwork: Program) -> None:
    run = strutwork("map", "mit-ss1", "--vibration", "--lattice", "1")
    assert (run.status, run.out) == (1, "")
    assert "machine mit-ss1: reaches hardly any pose" in run.err
    assert "strutwork modes" in run.err
