"""Models whose tool cannot move in some direction, through the program."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program
from tests.model_files import Content

#: Printed on standard error by the program.
pytestmark = pytest.mark.filterwarnings("always::strutwork.machines.model.ModelWarning")

CASES = Path(__file__).parents[1] / "cases"

#: Stiffness along x y z rx ry rz as `solve` prints it, others free and others blocked.
RIGHT = {
    "models/skew_guide": (["133.3", "400", *["infinite"] * 4], ["infinite"] * 6),
    "models/skew_guide2": (["155.6", "350", "1400", *["infinite"] * 3], ["infinite"] * 6),
    "models/f1_three_axis_rigid_slides": (["100", "50", "200", *["infinite"] * 3],) * 2,
    "models/f1b_rotary_table": (
        ["10", "1.111", "infinite", "infinite", "infinite", "100"],
        ["infinite"] * 6,
    ),
    "models/locked_tool": (["140", "35", "15.56"] * 2, ["infinite"] * 6),
    "robustness/straight_guide": (["100", *["infinite"] * 5],) * 2,
}


@pytest.mark.parametrize("name", RIGHT)
def test_solve_prints_infinite_and_no_rounding(name: str, strutwork: Program) -> None:
    run = strutwork("solve", CASES / f"{name}.toml")
    assert run.status == 0
    assert "does not move at all" in run.err
    rows = re.findall(r"│ (r?[xyz]) +│ \S+ +│ +(\S+) │ +(\S+) │", run.out)
    assert [axis for axis, _, _ in rows] == ["x", "y", "z", "rx", "ry", "rz"]
    free, blocked = RIGHT[name]
    assert [row[1] for row in rows] == free
    assert [row[2] for row in rows] == blocked


@pytest.mark.parametrize("name", [*RIGHT, "models/skew_hexa"])
def test_json_has_a_null_stiffness_and_a_warning(name: str, strutwork: Program) -> None:
    run = strutwork("solve", CASES / f"{name}.toml", "--json")
    tcp = run.result["tcp"]
    assert tcp["stiffness"] is None
    values = np.linalg.eigvalsh(np.array(tcp["compliance"]))
    # rounding of the eigenvalues themselves is all that may be negative
    assert values[0] > -1e-15 * values[-1]
    assert run.err.count("Warning") == 1


@pytest.mark.parametrize("name", [*RIGHT, "models/skew_hexa"])
def test_report_of_a_locked_tool(name: str, strutwork: Program, tmp_path: Path) -> None:
    run = strutwork("report", CASES / f"{name}.toml", "-o", tmp_path, "--json")
    assert run.status == 0, run.err
    tool = json.loads((tmp_path / "tool.json").read_text(encoding="utf-8"))
    # null stands for infinite
    for key in ("axis_stiffness_free", "axis_stiffness_blocked"):
        assert all(value is None or value > 0 for value in tool[key])
    assert None in tool["axis_stiffness_blocked"]
    assert tool["stiffness"] is None
    assert "infinite" in (tmp_path / "report.html").read_text(encoding="utf-8")


def pushed(force: list[float]) -> Content:
    """A table on a guide at 30 degrees to x, with a force on it."""
    return {
        "nodes": {"rail": [0, 0, 0], "block": [0, 0, 0], "TCP": [0, 0, 0.1]},
        "bodies": [{"name": "table", "nodes": ["block", "TCP"]}],
        "supports": [{"node": "rail", "fixed": "all"}],
        "joints": [
            {
                "name": "guide",
                "type": "prismatic",
                "between": ["rail", "block"],
                "axis": [0.8660254037844387, 0.5, 0],
                "driven": ["z"],
                "stiffness": {"z": 1e8},
            }
        ],
        "loads": [{"case": "push", "node": "TCP", "force": force}],
    }


def test_what_a_rigid_guide_takes_alone_moves_nothing(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    across = write(pushed([-50.0, 86.60254037844387, 0.0]))
    run = strutwork("solve", across)
    assert run.status == 0
    table = run.out.split("Displacements")[1].split("Reactions")[0]
    assert set(re.findall(r"-?\d[\d.]*(?:e-?\d+)?", table.split("┡")[1])) == {"0"}
    # the numbers themselves stay unrounded, as a program wants them
    found = strutwork("solve", across, "--json").result["cases"]["push"]["displacements"]["TCP"]
    assert np.abs(found).max() < 1e-20


def test_a_force_that_cancels_is_nothing_beside_the_load(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    run = strutwork("solve", write(pushed([100.0, 0.0, 0.0])))
    joints = run.out.split("Joint forces")[1]
    row = re.findall(r"│ guide +│(.*)│", joints)[0]
    numbers = [float(v) for v in row.replace("│", " ").split()]
    # across the guide 50 N, along it 86.6 N, and the arm of 0.1 m
    assert sorted(np.round(np.abs(numbers), 3)) == [0.0, 0.0, 5.0, 8.66, 50.0, 86.6]
