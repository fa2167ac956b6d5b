"""`strutwork move`: poses to joint coordinates and back, for machines and model files."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.kinematics import Poses, drive_values
from strutwork.machines import HexelHexapod
from tests.cli.conftest import Program

FOUR_BAR = "examples/04_four_bar.toml"
ROOT = Path(__file__).parents[2]


def test_a_pose_as_the_closed_form_takes_it(strutwork: Program) -> None:
    found = strutwork("move", "hexel-hexapod", "--pose", "x=20mm,rz=5deg", "--json").result
    machine = HexelHexapod()
    pose = Poses.of([0.02, 0.0, 0.4], Rotation.from_euler("z", 5, degrees=True).as_matrix())
    wanted = 1e3 * drive_values(machine, machine.place(pose))
    rams = [found["columns"][f"leg{i}/ram:z, mm"][0] for i in range(1, 7)]
    # joints are closed to 1e-11 of the machine's size
    assert rams == pytest.approx(wanted, abs=1e-6)
    # y, z and the other turns stay as they are not named
    assert [found["columns"][c][0] for c in ("y, mm", "z, mm", "rx, deg")] == pytest.approx(
        [0.0, 400.0, 0.0], abs=1e-8
    )
    assert (found["targets"], found["reached"], found["status"]) == (1, 1, [None])


def test_there_and_back_through_files(strutwork: Program, tmp_path: Path) -> None:
    poses, there, back = (tmp_path / name for name in ("poses.csv", "there.csv", "back.csv"))
    poses.write_text('"x, mm","rx, deg",remark\n10,0,first\n-15,8,second\n0,-12,third\n')
    run = strutwork("move", "hexel-hexapod", "--targets", poses, "-o", there)
    assert "3 of 3 targets reached" in run.out
    rows = list(csv.DictReader(there.open(encoding="utf-8")))
    assert [row["status"] for row in rows] == ["reached"] * 3
    rams = [name for name in rows[0] if "/ram:" in name]
    drives = tmp_path / "drives.csv"
    with drives.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, rams, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    assert strutwork("move", "hexel-hexapod", "--targets", drives, "-o", back).status == 0
    for here, again in zip(rows, csv.DictReader(back.open(encoding="utf-8")), strict=True):
        for column in ("x, mm", "y, mm", "z, mm", "rx, deg", "ry, deg", "rz, deg"):
            assert float(again[column]) == pytest.approx(float(here[column]), abs=1e-7)


def test_a_model_file_moves(strutwork: Program) -> None:
    home = strutwork("move", FOUR_BAR, "--json").result["columns"]
    assert all(v == [0.0] for v in home.values())
    run = strutwork("move", FOUR_BAR, "--joint", "R1:rz=30deg", "--json")
    assert run.result["columns"]["R1:rz, deg"] == pytest.approx([30.0])
    # the rocker's angle leads back to the crank's
    rocker = run.result["columns"]["R4:rz, deg"][0]
    back = strutwork("move", FOUR_BAR, "--joint", f"R4:rz={rocker!r}deg", "--json").result
    assert back["columns"]["R1:rz, deg"] == pytest.approx([30.0], abs=1e-6)
    shown = strutwork("move", FOUR_BAR, "--joint", "R1:rz=30deg").out
    assert "1 of 1 targets reached" in shown


def test_what_cannot_be_reached_is_told(strutwork: Program) -> None:
    run = strutwork("move", "proposed-3pprs", "--pose", "z=500mm")
    assert run.status == 0
    assert "0 of 1 targets reached" in run.out
    assert "out of reach" in run.out
    assert "% of the way" in run.out
    far = strutwork("move", "proposed-3pprs", "--pose", "z=20mm", "--json").result
    assert "is exceeded" in far["status"][0]
    assert np.isfinite(far["columns"]["leg1/hinge:rz, deg"]).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("mit-ss1", "--pose", "y=3mm"), "the tool cannot move in y from home"),
        (("hexel-hexapod", "--pose", "q=3mm"), 'unknown direction "q"'),
        (("hexel-hexapod", "--pose", "x"), '"x" gives no value'),
        (("hexel-hexapod", "--pose", "x=3deg"), "not a length"),
        (("hexel-hexapod", "--pose", "x=1mm,x=2mm"), "gives x twice"),
        (("hexel-hexapod", "--joint", "leg1/rma:z=1mm"), 'unknown joint "leg1/rma"'),
        (("hexel-hexapod", "--pose", "leg1/ram:z=1mm"), "Use --joint for it"),
        (("hexel-hexapod", "--targets", "no.csv"), "cannot be read"),
        (("no-such.toml", "--pose", "x=1mm"), "no-such.toml"),
    ],
)
def test_wrong_targets(strutwork: Program, arguments: tuple[str, ...], message: str) -> None:
    run = strutwork("move", *arguments)
    assert run.status == 1
    assert message in run.err
    assert run.out == ""


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no row of numbers"),
        ('"x, mm"\n', "has no row of numbers"),
        ("remark\nfirst\n", "has no column that names a coordinate"),
        ('"x, mm"\nten\n', "has no number in line 2 under x, mm"),
        ('"x, mm"\nnan\n', "x of target 0 is not finite"),
        ('"y, mm","x, mm"\n1\n', "has no number in line 2 under x, mm"),
    ],
)
def test_wrong_files(strutwork: Program, tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "targets.csv"
    path.write_text(text, encoding="utf-8")
    run = strutwork("move", "hexel-hexapod", "--targets", path)
    assert run.status == 1
    assert message in run.err
