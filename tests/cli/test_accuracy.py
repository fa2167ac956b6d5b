"""`strutwork accuracy`: what errors do to the tool, at a pose and over a grid."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.kinematics import jacobians
from strutwork.machines import HexelHexapod
from tests.cli.conftest import Program

DELTA = "examples/machines/linear-delta.toml"


def test_drive_errors_go_through_the_jacobian(strutwork: Program) -> None:
    found = strutwork(
        "accuracy", "hexel-hexapod", "--pose", "x=20mm", "--drive-error", "5um", "--json"
    ).result
    machine = HexelHexapod()
    forward = jacobians(machine.linkage, machine.place(machine.poses(0.02))).forward
    wanted = 5e-6 * np.abs(forward).sum(axis=-1)
    assert list(found["worst_case"].values()) == pytest.approx(wanted, rel=1e-6)
    assert (found["by"], found["drives_without_error"]) == ("rows", [])


def test_resolutions_tolerances_and_play_of_a_file(strutwork: Program, tmp_path: Path) -> None:
    found = strutwork(
        "accuracy", DELTA, "--play", "lower1a:x=10um", "--json", "-o", tmp_path
    ).result
    # nine tolerances, three drives of 1 µm resolution, one play
    assert len(found["sources"]) == 13
    parts = found["contributions"]
    for direction, worst in found["worst_case"].items():
        assert sum(p[direction] for p in parts.values()) == pytest.approx(worst, rel=1e-12)
    assert sum(parts[s]["z"] for s in parts if s.startswith("drive")) == pytest.approx(0.5e-6)
    alone = strutwork("accuracy", DELTA, "--no-tolerances", "--json").result
    assert len(alone["sources"]) == 3
    (path,) = found["data"]
    assert "length of rod 2a" in Path(path).read_text(encoding="utf-8")


def test_over_a_grid(strutwork: Program, tmp_path: Path) -> None:
    found = strutwork(
        "accuracy", DELTA, "--over", "x=-100mm..100mm:3,y=-100mm..100mm:3", "--json",
        "-o", tmp_path,
    ).result  # fmt: skip
    assert found["poses_kept"] == 9
    dataset = xr.load_dataset(found["data"][0])
    worst = dataset["worst_case"].sel(direction="y")
    assert found["largest_over_poses"]["worst_case_y"]["value"] == pytest.approx(float(worst.max()))
    most = found["largest"]
    assert sum(most["contributions"].values()) == pytest.approx(most["length"], rel=1e-9)
    # the same machine standing there says the same
    pose = ",".join(f"{d}={1e3 * v:.9g}mm" for d, v in most["at"].items())
    one = strutwork("accuracy", DELTA, "--pose", pose, "--json").result
    assert one["largest"]["length"] == pytest.approx(most["length"], rel=1e-4)
    run = strutwork("accuracy", DELTA, "--over", "x=-100mm..100mm:2")
    assert "Its largest contributors" in run.out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "finds no source of error in"),
        (("--drive-error", "5kg"), "is neither a length nor an angle"),
        (("--drive-error", "5um", "--drive-error", "6um"), "gives two lengths"),
        (("--play", "x=5um"), "names no joint for x"),
        (("--play", "leg1/ball:rx=5urad"), "is in a direction that is free"),
        (("--pose", "x=1mm", "--over", "x=1mm..2mm"), "is given both a pose and a grid"),
    ],
)
def test_what_is_wrong_is_said(strutwork: Program, words: tuple[str, ...], said: str) -> None:
    run = strutwork("accuracy", "hexel-hexapod", *words)
    assert run.status == 1
    assert said in run.err


GANTRY, ERRORS = "examples/machines/gantry.toml", "examples/errors/gantry.toml"


def test_an_errors_file_prints_the_sheet(strutwork: Program, tmp_path: Path) -> None:
    run = strutwork("accuracy", GANTRY, "--errors", ERRORS, "--json", "-o", tmp_path)
    total = np.array(run.result["total"]["worst_case"])
    known = sum(np.array(row["mean"]) for row in run.result["rows"])
    half = sum(np.array(row["half_range"]) for row in run.result["rows"])
    np.testing.assert_allclose(total, np.abs(known) + half, rtol=1e-9)
    assert {"gravity", "thermal", "ground"} < set(run.result["causes"])
    (path,) = run.result["data"]
    rows = Path(path).read_text(encoding="utf-8").splitlines()
    assert len(rows) == 1 + len(run.result["rows"]) + 6 + 1
    said = strutwork("accuracy", GANTRY, "--errors", ERRORS)
    assert "Thermal drift" in said.out
    assert "force under gravity" in said.out


def test_errors_along_an_axis_have_their_names(strutwork: Program, tmp_path: Path) -> None:
    words = ("accuracy", GANTRY, "--errors", ERRORS, "--axis", "y=-100mm..100mm:3")
    (axis,) = strutwork(*words, "--json", "-o", tmp_path).result["axes"]
    assert list(axis["errors"]) == ["EXY", "EYY", "EZY", "EAY", "EBY", "ECY"]
    assert axis["errors"]["EYY"][0] == 0.0
    assert (tmp_path / "gantry-errors-along-y.csv").exists()


def test_the_sheet_over_a_workspace_has_its_worst_pose(strutwork: Program) -> None:
    words = ("accuracy", GANTRY, "--errors", ERRORS, "--over", "x=-200mm..200mm:2", "--json")
    found = strutwork(*words).result
    assert found["poses_kept"] == 2
    assert set(found["largest"]["causes"]) == {
        *("geometry", "gravity", "thermal", "cutting", "drives", "ground")
    }


def test_a_spectrum_that_ends_too_low_is_said(strutwork: Program, tmp_path: Path) -> None:
    file = tmp_path / "low.toml"
    file.write_text('[[ground]]\ndirection = "x"\nfrequencies = [1, 5]\ndensity = [1e-6, 1e-6]\n')
    run = strutwork("accuracy", GANTRY, "--errors", file)
    assert "below the first mode" in " ".join(run.out.split())


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (("--errors", "none.toml"), 1, "does not exist"),
        (("--errors", ERRORS, "--drive-error", "5um"), 2, "--errors"),
        (("--axis", "x=0..1mm:3"), 2, "--axis belongs to --errors"),
        (("--errors", ERRORS, "--axis", "x=0..1mm:3,y=0..1mm:3"), 1, "names 2 directions"),
        (("--errors", ERRORS, "--axis", "x=0..9m:3"), 1, "cannot be followed"),
        (("--errors", ERRORS, "--pose", "x=1mm", "--over", "x=0..1mm:2"), 1, "Choose one"),
    ],
)
def test_what_does_not_go_with_an_errors_file(
    strutwork: Program, words: tuple[str, ...], status: int, said: str
) -> None:
    run = strutwork("accuracy", GANTRY, *words)
    assert run.status == status
    assert said in " ".join(run.err.replace("│", " ").split())
