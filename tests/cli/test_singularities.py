"""`strutwork singularities`: kinds, places and what is lost, for machines and model files."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program

DELTA = "examples/machines/linear-delta.toml"


def test_the_distance_at_home_and_elsewhere(strutwork: Program) -> None:
    home = strutwork("singularities", "hexel-hexapod", "--length", "100mm", "--json").result
    assert home["length"] == pytest.approx(0.1)
    assert (home["freedoms"], home["singular"]) == (6, None)
    assert 0.0 < home["parallel_distance"] < 1.0
    assert 0.0 < home["serial_distance"] < 1.0
    near = strutwork(
        "singularities", "hexel-hexapod", "--length", "100mm", "--pose", "rx=-47deg", "--json"
    ).result
    assert near["parallel_distance"] < 0.05 * home["parallel_distance"]
    text = strutwork("singularities", "hexel-hexapod", "--pose", "rx=-47deg").out
    assert "Distance at the pose, with 565.1 mm counting as one radian" in text


def test_a_line_across_a_singular_pose(strutwork: Program, tmp_path: Path) -> None:
    arguments = ("singularities", "proposed-3pprs", "--line", "x=0..40mm:41")
    found = strutwork(*arguments, "--ranges", "none", "--json").result["singularities"]
    (one,) = found
    # s of the closed form is zero at x = R_p = 18 mm on the plane of symmetry
    assert one["at"]["x"] == pytest.approx(0.018, abs=1e-9)
    assert (one["kind"], one["type"]) == ("actuator", 2)
    # which the tool leaves at held drives
    assert one["twist"][0] == one["twist"][2] == one["twist"][4] == 0.0
    assert one["twist"][1] > 0.0
    # the ball's swing ends the line where ranges count
    run = strutwork(*arguments, "--out", tmp_path)
    assert "1 singular pose along the line, and 1 end of reach" in run.out
    assert "leg3/ball: swing of the spherical joint, 0 to 70 deg is exceeded" in run.out
    table = tmp_path / "proposed-3pprs-singularities.csv"
    rows = list(csv.DictReader(table.open(encoding="utf-8")))
    assert [row["kind"] for row in rows] == ["actuator", "limit of a joint"]
    assert float(rows[0]["x, mm"]) == pytest.approx(18.0, abs=1e-6)


def test_curves_over_a_plane(strutwork: Program, tmp_path: Path) -> None:
    arguments = ("--plane", "rx,ry", "--from", "rx=-60deg,ry=-20deg", "--to", "rx=0deg,ry=20deg")
    run = strutwork(
        "singularities", "hexel-hexapod", *arguments, "--steps", "11", "--ranges", "none",
        "--out", tmp_path, "--json",
    )  # fmt: skip
    found = run.result
    (curve,) = found["curves"]
    assert (curve["kind"], curve["type"], curve["closed"]) == ("actuator", 2, False)
    assert found["poses"] == found["reached"] == 121
    assert found["edges_missed"] == 0
    with Path(found["data"][0]).open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == curve["points"] >= 11
    # the machine is its own mirror image: rx at ry and −ry
    place = {round(float(r["ry, deg"]), 9): float(r["rx, deg"]) for r in rows}
    pairs = [(a, place[-a]) for a in place if a > 0 and -a in place]
    assert len(pairs) >= 4
    for a, other in pairs:
        assert place[a] == pytest.approx(other, abs=1e-6)
    grid = np.loadtxt(found["data"][1], delimiter=",", skiprows=1)
    assert grid.shape == (121, 4)
    assert np.all(grid[:, 2:] > 0.0)


def test_a_model_file_ends_in_a_stretched_leg(strutwork: Program) -> None:
    found = strutwork(
        "singularities", DELTA, "--line", "x=0..500mm:6", "--ranges", "none", "--json"
    ).result
    (one,) = found["singularities"]
    assert (one["kind"], one["type"]) == ("end-effector", 1)
    assert "slide1:z" in one["moving"]
    # the tool has lost the direction of the rod, which lies flat
    twist = np.array(one["twist"])
    assert np.linalg.norm(twist[:3]) == pytest.approx(1.0, abs=1e-6)
    assert abs(twist[2]) < 1e-5


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--plane", "x,y"), "has no --from"),
        (("--plane", "x,y", "--from", "x=0,y=0", "--to", "x=1mm"), "does not name exactly x,y"),
        (("--plane", "x=0..1mm"), "is not two ranges"),
        (("--line", "x=5mm"), "Give each the same number"),
        (("--line", "x=0..9mm", "--at", "x=1mm"), "names x twice"),
        (("--line", "x=0..9mm", "--length", "-1mm"), "Give a positive length"),
        (("--plane", "x,y", "--from", "x=0,y=0", "--to", "x=9mm,y=9mm", "--steps", "9999"), "GB"),
        (("--line", "z=5..9m",), "no pose of the 101 can be reached"),
    ],
)  # fmt: skip
def test_wrong_lines_and_planes(strutwork: Program, arguments: tuple[str, ...], said: str) -> None:
    run = strutwork("singularities", "hexel-hexapod", *arguments)
    assert run.status == 1
    assert said in run.err
    assert run.out == ""


def test_a_frame_without_drives_has_no_singularities(strutwork: Program) -> None:
    run = strutwork("singularities", "examples/01_cantilever.toml")
    assert run.status == 1
    assert "has no driven direction" in run.err


def test_options_that_do_not_go_together(strutwork: Program) -> None:
    for wrong in (("--line", "x=0..1mm", "--plane", "x,y"), ("--at", "x=1mm"), ("--from", "x=0")):
        assert strutwork("singularities", "hexel-hexapod", *wrong).status == 2
