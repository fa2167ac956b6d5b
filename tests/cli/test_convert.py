"""`strutwork convert`: files that it writes, what it says, and what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Program
from tests.robots import EXAMPLES

ARM = str(EXAMPLES / "arm.urdf")


def test_a_robot_becomes_a_model_file_that_commands_read(
    strutwork: Program, tmp_path: Path
) -> None:
    out = tmp_path / "new" / "arm.toml"
    run = strutwork("convert", ARM, str(out), "--drive", "A1", "--drive", "A2")
    assert "Written: " in run.out
    text = out.read_text(encoding="utf-8")
    assert text.startswith("#:schema ./strutwork-model.schema.json\n# From arm.urdf.\n")
    found = strutwork("check", str(out), "--json").result
    assert found["drives"] == 2
    assert found["mobility"] == 2 + found["mobility_locked"]
    assert found["mass"]["total"] == pytest.approx(174)


def test_json_says_what_is_left_out(strutwork: Program, tmp_path: Path) -> None:
    out = tmp_path / "six.urdf"
    run = strutwork("convert", "examples/machines/6-ups.toml", str(out), "--json")
    assert run.result["data"] == [str(out)]
    assert run.result["links"] == 13
    assert run.result["mass"]["total"] == pytest.approx(183.924, abs=1e-3)
    assert any("Elastic directions" in note for note in run.result["notes"])
    assert "urdfdom#264" in out.read_text(encoding="utf-8")


def test_a_file_is_not_replaced_and_none_is_left_by_an_error(
    strutwork: Program, tmp_path: Path
) -> None:
    out = tmp_path / "arm.toml"
    out.write_text("mine", encoding="utf-8")
    run = strutwork("convert", ARM, str(out))
    assert run.status == 1
    assert "exists." in run.err
    assert out.read_text(encoding="utf-8") == "mine"
    other = tmp_path / "arm.step"
    assert "no robot format" in strutwork("convert", ARM, str(other)).err
    assert not other.exists()
    run = strutwork("convert", "mit-ss1", str(tmp_path / "a.sdf"), "--tool", "x")
    assert "is no robot file" in run.err


def test_a_robot_file_is_a_machine_of_other_commands(strutwork: Program) -> None:
    run = strutwork("check", str(EXAMPLES / "four_bar.sdf"), "--json")
    assert run.result["mobility"] == 1
    assert run.result["redundant_constraints"] == 3
