"""`strutwork move --branches`."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program

EXAMPLES = Path(__file__).parents[2] / "examples" / "machines"

#: Joints of a leg from the base, and the sense in which each turns the plate.
LEG = (("motor", 1.0), ("knee", 1.0), ("wrist", -1.0))


def test_the_command_lists_both_kinds(strutwork: Program) -> None:
    file = str(EXAMPLES / "planar-3-rrr.toml")
    run = strutwork("move", file, "--pose", "x=10mm", "--branches", "--json")
    assert run.status == 0, run.err
    found = json.loads(run.out)
    assert found["every"] is False
    assert len(found["working_modes"]) == 8
    first = found["assembly_modes"][0]
    assert first[0] == pytest.approx(0.01, abs=1e-9)
    own = {
        name: np.radians(found["columns"][f"{name}, deg"][0]) for name in found["working_modes"][0]
    }
    assert found["working_modes"][0] == pytest.approx(own, abs=1e-9)


def test_many_targets_have_no_branches(strutwork: Program, tmp_path: Path) -> None:
    targets = tmp_path / "targets.csv"
    targets.write_text('"x, mm"\n0\n5\n')
    file = str(EXAMPLES / "planar-3-rrr.toml")
    run = strutwork("move", file, "--targets", str(targets), "--branches")
    assert run.status == 1
    assert "--branches: needs one target" in run.err


def test_the_file_holds_them_too(strutwork: Program, tmp_path: Path) -> None:
    """Of the planar machine: every working mode is a way that `move` can be led to and closes."""
    out = tmp_path / "ways.csv"
    file = str(EXAMPLES / "planar-3-rrr.toml")
    run = strutwork("move", file, "--pose", "x=10mm", "--branches", "-o", str(out), "--json")
    found = json.loads(run.out)
    with out.open(encoding="utf-8") as text:
        first, *ways = list(csv.DictReader(text))
    assert first["status"] == "reached"
    kinds = [row["status"].rpartition(" ")[0] for row in ways]
    assert kinds.count("assembly mode") == len(found["assembly_modes"])
    assert kinds.count("working mode") == len(found["working_modes"]) == 8
    for row, mode in zip(ways, found["assembly_modes"], strict=False):
        assert float(row["x, mm"]) == pytest.approx(1e3 * mode[0], abs=1e-9)
        assert row["motor1:rz, deg"] == first["motor1:rz, deg"]
        assert row["knee1:rz, deg"] == ""
    for row, drives in zip(ways[-8:], found["working_modes"], strict=True):
        assert float(row["x, mm"]) == pytest.approx(10.0, abs=1e-9)
        for name, value in drives.items():
            assert np.radians(float(row[f"{name}, deg"])) == pytest.approx(value, abs=1e-12)
        # the three angles of a leg turn the plate by nothing
        for k in (1, 2, 3):
            turn = sum(float(row[f"{j}{k}:rz, deg"]) * s for j, s in LEG)
            assert np.cos(np.radians(turn)) == pytest.approx(1.0, abs=1e-12)
