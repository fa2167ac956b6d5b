"""`strutwork bearings`, and what `solve` says of bearings."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Program

SPINDLE = Path(__file__).parents[2] / "examples/bearings/spindle.toml"


def test_the_entries_of_a_machine(strutwork: Program) -> None:
    found = strutwork("bearings", SPINDLE, "--json").result
    assert found["joints"] == {"front bearings": "front-pair", "rear bearing": "rear"}
    assert found["bearings"]["front-pair"]["held"] == ["x", "y", "z", "rx", "ry"]
    assert "assumed" in found["bearings"]["rear"]["source"]


def test_lost_preload_is_an_error_that_names_the_bearing(
    strutwork: Program, tmp_path: Path
) -> None:
    file = tmp_path / "mine.toml"
    text = SPINDLE.read_text(encoding="utf-8")
    file.write_text(text.replace('"1200 N"', '"1600 N"'), encoding="utf-8")
    run = strutwork("solve", file)
    assert run.status == 1
    assert "bearing front-pair of the joint front bearings: loses its preload" in run.err
    file.write_text(text.replace('source = "Typical of a sp', 'note = "'), encoding="utf-8")
    run = strutwork("check", file)
    assert run.status == 1
    assert "bearings.front-pair.source: is missing" in run.err


@pytest.mark.filterwarnings("ignore:tool. does not move:strutwork.errors.ModelWarning")
def test_a_rigid_direction_beside_a_bearing(strutwork: Program, tmp_path: Path) -> None:
    file = tmp_path / "guide.toml"
    file.write_text(
        """
[nodes]
rail = [0, 0, 0]
table = [0, 0, 0]
[[supports]]
node = "rail"
fixed = "all"
[[joints]]
name = "guide"
type = "prismatic"
between = ["rail", "table"]
bearing = "rail-contacts"
driven = ["z"]
[[loads]]
node = "table"
force = [0, "-300 N", 0]
[tool]
tcp = "table"
""",
        encoding="utf-8",
    )
    run = strutwork("solve", file)
    assert run.status == 0
    assert "infinite in z" in run.out
    assert "│ guide │ rail-contacts │" in run.out
