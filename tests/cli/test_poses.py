"""Commands take any machine, at home or elsewhere."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program

MACHINES = Path(__file__).parents[2] / "examples/machines"
HEAD = str(MACHINES / "3-rps.toml")


def answer(strutwork: Program, *words: str) -> dict:
    run = strutwork(*words, "--json")
    assert run.status == 0, run.err
    return json.loads(run.out)


@pytest.mark.parametrize("target", [HEAD, "hexel-hexapod"])
def test_solve_takes_a_pose(strutwork: Program, target: str) -> None:
    home = answer(strutwork, "solve", target)["tcp"]["compliance"]
    there = answer(strutwork, "solve", target, "--pose", "rx=5deg")["tcp"]["compliance"]
    assert not np.allclose(home, there, rtol=1e-3)
    assert np.allclose(
        home, answer(strutwork, "solve", target, "--pose", "rx=0")["tcp"]["compliance"], rtol=1e-6
    )


def test_a_joint_and_the_pose_it_leads_to_are_one_place(strutwork: Program) -> None:
    moved = answer(strutwork, "move", HEAD, "--pose", "rx=4deg")["columns"]
    words = [f"{j}:z={moved[f'{j}:z, mm'][0]!r}mm" for j in ("drive1", "drive2", "drive3")]
    joints = [w for word in words for w in ("--joint", word)]
    one = answer(strutwork, "solve", HEAD, "--pose", "rx=4deg")["tcp"]["compliance"]
    other = answer(strutwork, "solve", HEAD, *joints)["tcp"]["compliance"]
    assert np.allclose(one, other, rtol=1e-6, atol=1e-12)


def test_modes_frf_tolerance_and_check_take_a_pose(strutwork: Program) -> None:
    pose = ("--pose", "rx=5deg")
    modes = [answer(strutwork, "modes", HEAD, "-n", "2", *p)["frequencies"] for p in ((), pose)]
    assert abs(modes[1][0] / modes[0][0] - 1) > 1e-3
    frf = ("frf", HEAD, "--input", "TCP:x", "--lines", "20")
    static = [answer(strutwork, *frf, *p)["static_stiffness"] for p in ((), pose)]
    assert abs(static[1] / static[0] - 1) > 1e-3
    forces = ("tolerance", HEAD, "--samples", "0")
    worst = [answer(strutwork, *forces, *p)["quantities"] for p in ((), pose)]
    assert worst[0] != worst[1]
    assert answer(strutwork, "check", "eclipse-3pprs", *pose)["mobility"] == 6


def test_scale_takes_any_machine(strutwork: Program) -> None:
    found = answer(strutwork, "scale", HEAD, "--from", "0.5", "--to", "2", "--lengths", "3")
    assert found["factors"] == [0.5, 1.0, 2.0]
    similar = next(law for law in found["laws"] if law["name"] == "similar joints")
    np.testing.assert_allclose(similar["stiffness_exponents"][:3], 1.0, atol=1e-6)
    np.testing.assert_allclose(similar["frequency_exponents"], -1.0, atol=1e-6)
    run = strutwork("scale", HEAD, "--from", "2", "--to", "1")
    assert (run.status, run.out) == (1, "")
    assert "goes from 2 to 1" in run.err


def test_a_map_over_a_grid(strutwork: Program, tmp_path: Path) -> None:
    over = ("--over", "z=660mm..700mm:2,rx=-5deg..5deg:3")
    found = answer(strutwork, "map", HEAD, *over, "-o", str(tmp_path))
    assert found["poses"] == found["poses_kept"] == 6
    assert {Path(p).suffix for p in found["data"]} == {".nc", ".csv"}
    least = found["extremes"]["stiffness_free_x"]["least"]
    assert set(least["at"]) == {"z", "rx"}
    there = [f"{d}={v!r}" for d, v in least["at"].items()]
    one = answer(strutwork, "solve", HEAD, "--pose", ",".join(there))["tcp"]["compliance"]
    assert 1.0 / one[0][0] == pytest.approx(least["value"], rel=1e-9)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("solve", HEAD, "--pose", "z=900mm"), "On the path from home it reaches z = "),
        (("solve", HEAD, "--pose", "drive1:z=1"), "Use --joint for it"),
        (("solve", HEAD, "--joint", "z=1"), "names no joint for z"),
        (("solve", HEAD, "--pose", "rz=1deg"), "task: the tool cannot move in rz from home"),
        (
            ("solve", "prototype-3ppprs", "--joint", "leg1/guide:rz=1deg"),
            "own formulas choose leg1/guide:rz by themselves",
        ),
        (("map", HEAD, "--over", "z=1..0"), "has no extent"),
        (("map", HEAD, "--over", "z=0..1:1"), "fewer than two points"),
        (("map", HEAD, "--over", "z=0..1:x"), "has no number of points"),
        (("map", HEAD, "--over", "z=5..6:2"), "no pose of the 2 can be taken"),
        (("report", "azulay-2014", "--pose", "x=1"), "has no pose"),
    ],
)
def test_what_is_wrong_is_named(strutwork: Program, words: tuple[str, ...], said: str) -> None:
    run = strutwork(*words)
    assert (run.status, run.out) == (1, "")
    assert said in run.err


def test_new_writes_a_file_that_checks_and_never_over_another(
    strutwork: Program, tmp_path: Path
) -> None:
    name = str(tmp_path / "mine")
    assert strutwork("new", name, "--like", "3-RPS").status == 0
    assert answer(strutwork, "check", f"{name}.toml")["mobility"] == 3
    again = strutwork("new", name, "--like", "3-RPS")
    assert (again.status, again.out) == (1, "")
    assert "exists" in again.err
