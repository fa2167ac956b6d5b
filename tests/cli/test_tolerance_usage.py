"""`strutwork tolerance`: machines of the catalogue, and wrong usage."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tests.cli.conftest import Program
from tests.model_files import Content

ROOT = Path(__file__).parents[2]
RAILS = ROOT / "examples" / "06_table_on_two_rails.toml"
QUICK = ("--samples", "0", "--json")

Write = Callable[[Content], Path]


def test_a_machine_of_the_catalogue(strutwork: Program) -> None:
    found = strutwork("tolerance", "mit-ss1", *QUICK).result
    assert found["title"] == "MIT-SS-1"
    assert found["poses"][0] == "home"
    assert len(found["poses"]) > 10
    largest = max(q["worst"] for q in found["quantities"] if q["unit"] == "N")
    assert 1e3 < largest < 1e5
    assert any("calibrated" in note for note in found["notes"])
    run = strutwork("tolerance", "glozman-3prrs", *QUICK)
    assert (run.status, run.out) == (1, "")
    assert "mit-ss1" in run.err


def test_wrong_usage(strutwork: Program) -> None:
    for arguments in (
        ("--quantile", "0.99"),
        ("--allocate", "cheap"),
        ("--samples", "-1"),
        ("--allocate", "uniform", "--quantile", "1.5"),
    ):
        run = strutwork("tolerance", RAILS, *arguments)
        assert (run.status, run.out) == (2, "")
