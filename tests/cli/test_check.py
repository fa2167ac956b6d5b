from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program
from tests.model_files import EXAMPLES, SAMPLE, Content, drop, put, sample, toml
from tests.shaped_arm import SHAPE, TEXT, written

EXAMPLE = {path.stem: path for path in EXAMPLES}

#: Degrees of freedom, mobility, mobility with drives held, redundant constraints.
COUNTS = {
    # one free node
    "01_cantilever": (6, 0, 0, 0),
    # 9 mesh nodes of 6 less 13 fixed directions; 13 directions where 6 hold one rigid body
    "02_space_frame": (41, 0, 0, 7),
    # Grübler is right for the tripod: 7 bodies, 3 (5 + 5 + 3) rows, three drives
    "03_tripod": (39, 3, 0, 0),
    # a planar four-bar in space has mobility 1, Grübler −2: three constraints are redundant
    "04_four_bar": (15, 1, 0, 3),
    # root held, one tube in four elements, platform held to it in 4 locked and driven directions
    "05_two_link_leg": (25, 1, 0, 0),
    # a table held by four blocks in two directions each and by a screw in one: 9 − 6
    "06_table_on_two_rails": (6, 0, 0, 3),
    # 15 free nodes; four mounts hold three directions each of one body: 12 − 6
    "08_column_on_mounts": (90, 0, 0, 6),
    # 4 bodies; bearings, motor, guide 5 rows each, threads 5, belts 1: 20 + 10 + 2 = 32 of rank 23
    # three bodies, and four flexures that count as locked in six directions each: 24 − 18
    "09_flexure_stage": (18, 0, 0, 6),
    "10_screws_and_belt": (27, 1, 0, 9),
}


def test_shapes_are_named(tmp_path: Path, strutwork: Program) -> None:
    heavy = TEXT.replace("[sections.rod]", 'density = "7850 kg/m^3"\n\n[sections.rod]')
    text = strutwork("check", written(tmp_path, heavy + SHAPE)).out
    assert "Shapes that must not interfere: post (12 triangles)." in text
    assert "Shapes" not in strutwork("check", EXAMPLE["03_tripod"]).out


@pytest.mark.parametrize("name", COUNTS)
def test_counts_of_the_examples(name: str, strutwork: Program) -> None:
    found = strutwork("check", EXAMPLE[name], "--json").result
    keys = ("degrees_of_freedom", "mobility", "mobility_locked", "redundant_constraints")
    assert tuple(found[key] for key in keys) == COUNTS[name]
    assert len(found["self_stress_states"]) == found["redundant_constraints"]
    assert len(found["mechanisms"]) == found["mobility_locked"]
    assert len(found["driven_motions"]) == found["mobility"]


def test_keys_of_the_json(strutwork: Program) -> None:
    found = strutwork("check", EXAMPLE["04_four_bar"], "--json").result
    assert set(found) == {
        "degrees_of_freedom",
        "mobility",
        "mobility_locked",
        "redundant_constraints",
        "drives",
        "surplus_drives",
        "mechanisms",
        "driven_motions",
        "self_stress_states",
        "near_mechanisms",
        "mass",
        "solids",
    }
    nodes = ["G1", "A1", "A2", "B1", "B2", "C1", "C2", "G2"]
    (motion,) = found["driven_motions"]
    assert list(motion["motion"]) == nodes
    assert all(len(twist) == 6 for twist in motion["motion"].values())
    assert "R1 in rz" in motion["description"]
    for state in found["self_stress_states"]:
        assert set(state["joints"]) <= {"R1", "R2", "R3", "R4", "support G1", "support G2"}
        assert list(state["forces"]) == state["joints"]
    assert "(ground)" not in str(found)


def test_four_bar_moves_as_its_closure_says(strutwork: Program) -> None:
    found = strutwork("check", EXAMPLE["04_four_bar"], "--json").result
    motion = {n: np.array(u) for n, u in found["driven_motions"][0]["motion"].items()}
    crank, coupler, rocker = (motion[n][5] for n in ("A1", "B1", "C1"))
    # the velocities about the four pivots add to nothing (loop closure of a planar linkage)
    pivots = np.array([[0, 0], [0.06, 0.09], [0.3, 0.16], [0.26, 0]])
    rates = np.array([crank, coupler - crank, rocker - coupler, -rocker])
    assert abs(rates).max() > 0.1
    # round-off of a null vector of size one
    assert rates.sum() == pytest.approx(0.0, abs=1e-12)
    assert rates @ pivots == pytest.approx(np.zeros(2), abs=1e-12)
    assert all(u[2:5] == pytest.approx(np.zeros(3), abs=1e-12) for u in motion.values())
    assert motion["G1"] == pytest.approx(np.zeros(6), abs=0.0)


def test_self_stress_is_in_balance(strutwork: Program) -> None:
    found = strutwork("check", EXAMPLE["04_four_bar"], "--json").result
    for state in found["self_stress_states"]:
        # the frame feels the same force through both pivots of the crank
        grounded, moving = np.array(state["forces"]["support G1"]), state["forces"]["R1"]
        assert grounded == pytest.approx(np.array(moving), abs=1e-9)


@pytest.mark.filterwarnings("default::strutwork.machines.model.ModelWarning")
def test_mechanism_left_with_drives_held(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    free = sample(put("joints.0.driven", []), drop("joints.0.stiffness"), drop("joints.1"))
    run = strutwork("check", write(free), "--json")
    found = run.result
    # without the joint that is left out its two ends stand at one place
    assert "nodes D of body plate and F of beam strut are at one place" in run.err
    assert (found["mobility"], found["mobility_locked"]) == (3, 3)
    descriptions = " ".join(m["description"] for m in found["mechanisms"])
    assert "hinge in rz" in descriptions
    # the hinge turns about the global y axis through B
    turning = next(m["motion"] for m in found["mechanisms"] if "hinge" in m["description"])
    omega, tool = turning["TCP"][4], np.array(turning["TCP"][:3])
    assert tool == pytest.approx(omega * np.array([0.1, 0.0, 0.0]), abs=1e-12)


def test_springs_are_absent_and_elastic_directions_locked(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    with_spring = strutwork("check", write(SAMPLE), "--json").result
    without = strutwork("check", write(sample(drop("springs"))), "--json").result
    assert with_spring == without
    stiff = put("joints.1", {**SAMPLE["joints"][1], "type": "spherical", "stiffness": {}})
    locked = strutwork("check", write(sample(stiff)), "--json").result
    assert locked["mobility"] == with_spring["mobility"]
    assert locked["redundant_constraints"] == with_spring["redundant_constraints"]


def test_mass_and_centre(strutwork: Program, write: Callable[[Content], Path]) -> None:
    found = strutwork("check", write(SAMPLE), "--json").result["mass"]
    # tube and bar by hand, plate of 2 kg at the mean of its nodes, 0.2 kg at B
    tube = 7850 * np.pi / 4 * (0.04**2 - 0.03**2) * 0.3
    bar = 7850 * 0.02 * 0.03 * 0.3
    total = tube + bar + 2.2
    moment = (
        tube * np.array([0.15, 0, 0])
        + bar * np.array([0.45, 0.2, 0.05])
        + 2.0 * np.array([0.3, 0.1, 0.05])
        + 0.2 * np.array([0.3, 0, 0])
    )
    assert found["total"] == pytest.approx(total, rel=1e-12)
    assert found["center"] == pytest.approx(moment / total, rel=1e-12)


def test_missing_density_leaves_no_mass_and_warns(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(toml(sample(drop("materials.steel.density"))), encoding="utf-8")
    program = "from strutwork.reports.cli import main; main()"
    run = subprocess.run(
        [sys.executable, "-c", program, "check", str(path), "--json"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert '"mass": null' in run.stdout
    # a busy machine may make the program say how long it has worked
    said = [line for line in run.stderr.splitlines() if not line.endswith("so far")]
    assert said == ["Warning: material steel: has no density, so the mass is not known."]


def test_no_mass_has_no_centre(strutwork: Program, write: Callable[[Content], Path]) -> None:
    content = {
        "nodes": {"A": [0, 0, 0], "B": [1, 0, 0]},
        "bodies": [{"name": "bar", "nodes": ["A", "B"]}],
    }
    found = strutwork("check", write(content), "--json").result
    assert found["mass"] == {"total": 0.0, "center": None}
    assert (found["degrees_of_freedom"], found["mobility"]) == (6, 6)


def test_table_for_people(strutwork: Program) -> None:
    run = strutwork("check", EXAMPLE["04_four_bar"])
    assert (run.status, run.err) == (0, "")
    assert re.search(r"mobility of the rigid linkage, drives free\W+1\b", run.out)
    assert re.search(r"redundant constraints, drives held\W+3\b", run.out)
    assert "R1, R2, R3, R4" in run.out


@pytest.mark.filterwarnings("default::strutwork.errors.ProportionWarning")
def test_lengths_out_of_proportion_are_warned_of(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    """A tube of 19 m and 14 m: millimetres without their unit."""
    content = sample()
    content["sections"] = {
        "tube": {"shape": "tube", "outer_diameter": 19.0, "inner_diameter": 14.0}
    }
    for beam in content["beams"]:
        beam["section"] = "tube"
    for command in ("check", "solve", "modes"):
        done = strutwork(command, write(content), "--json")
        assert done.status == 0
        assert "19 m deep" in done.err
        assert "in metres" in done.err


def test_a_drive_in_a_locked_direction_is_no_mobility(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    content = sample()
    joint = content["joints"][0]
    locked = {"type": "prismatic", "driven": ["x"], "stiffness": {}}
    done = strutwork("check", write({**content, "joints": [joint | locked]}), "--json")
    assert done.status == 1
    assert f"joint {joint['name']}: drives x, which a prismatic joint locks" in done.err
    assert "z can be driven" in done.err
