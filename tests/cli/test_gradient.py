"""`strutwork gradient`: tables, JSON, files, and what is wrong."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from tests.cli.conftest import Program

HEAD = "examples/machines/3-rps.toml"
BAR = "examples/01_cantilever.toml"


def test_the_largest_effect_stands_first(strutwork: Program) -> None:
    run = strutwork("gradient", BAR, "--of", "stiffness_z")
    assert run.status == 0, run.err
    rows = [line for line in run.out.splitlines() if line.startswith("│")]
    assert "sections.bar.height_z" in rows[0]
    # 3EI/L³ with a little shear: nearly the third power
    assert "+29.9" in rows[0] or "+30.0" in rows[0]
    assert "Effect of 10 % more, linear" in run.out
    assert "Without influence" in run.out
    assert "materials.steel.density" in run.out


def test_json_has_values_gradients_and_units(strutwork: Program) -> None:
    options = ["--of", "stiffness_z", "--by", "nodes.tip.x", "--by", "sections.bar.height_z"]
    found = strutwork("gradient", BAR, *options, "--json").result
    stiffness = found["quantities"]["stiffness_z"]
    tip = stiffness["gradient"]["nodes.tip.x"]
    assert tip["unit"] == "N/m per m"
    assert tip["elasticity"] == pytest.approx(-2.99, abs=0.01)
    assert tip["gradient"] == pytest.approx(tip["elasticity"] * stiffness["value"] / 0.4)
    assert found["parameters"]["sections.bar.height_z"] == {"value": 0.03, "unit": "m"}


def test_at_the_worst_pose_and_in_a_file(strutwork: Program, tmp_path: Path) -> None:
    out = tmp_path / "new" / "gradient.csv"
    run = strutwork("gradient", HEAD, "--worst", "--of", "stiffness_z", "-o", str(out))
    assert run.status == 0, run.err
    assert "z = 720 mm" in run.out
    assert "joints.drive*.stiffness.z (3)" in run.out
    rows = list(csv.DictReader(out.read_text(encoding="utf-8").splitlines()))
    ram = next(r for r in rows if r["parameter"] == "sections.ram.diameter")
    assert float(ram["share_of_ten_percent_more"]) == pytest.approx(
        0.1 * float(ram["gradient"]) * 0.04 / float(ram["value"])
    )


def test_nodes_of_a_joint_move_together(strutwork: Program) -> None:
    pose = ["--pose", "z=690mm"]
    run = strutwork("gradient", HEAD, *pose, "--by", "nodes.base1.y+nodes.foot1.y")
    assert run.status == 0, run.err
    assert "nodes.base1.y+nodes.foot1.y" in run.out
    alone = strutwork("gradient", HEAD, *pose, "--by", "nodes.base1.y")
    assert alone.status == 1
    assert "nodes.base1.y: " in alone.err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--of", "stiffnes_z"], "no quantity that has a gradient"),
        (["--by", "sections.ram.diametre"], 'Did you mean "sections.ram.diameter"'),
        (["--worst", "--pose", "z=690mm"], "--worst: cannot stand beside --pose"),
        (["--modal-ratio", "0.1", "--loss-factor", "0.1"], "given twice"),
        (["--of", "joint_force:drive1:z@nothing"], 'unknown load case "nothing"'),
        (["--pose", "z=5m"], "cannot be reached"),
    ],
)
def test_what_is_wrong_is_named(strutwork: Program, options: list[str], words: str) -> None:
    run = strutwork("gradient", HEAD, *options)
    assert (run.status, run.out) == (1, "")
    assert words in run.err


def test_no_workspace_has_no_worst_pose(strutwork: Program) -> None:
    run = strutwork("gradient", BAR, "--worst")
    assert run.status == 1
    assert "workspace: is not given" in run.err


def test_a_machine_of_the_literature(strutwork: Program) -> None:
    options = ["--of", "stiffness_z", "--of", "least_dynamic_stiffness_z", "--modal-ratio", "0.02"]
    found = strutwork("gradient", "mit-ss1", *options, "--json").result
    assert set(found["quantities"]) == {"stiffness_z", "least_dynamic_stiffness_z"}
    assert found["quantities"]["stiffness_z"]["gradient"]["radial_stiffness"]["elasticity"] > 0.8
