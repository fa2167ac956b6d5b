"""`strutwork move --branches`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program

EXAMPLES = Path(__file__).parents[2] / "examples" / "machines"


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
