from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from strutwork.kinematics import axes_frame
from strutwork.machines.model import ModelWarning
from strutwork.machines.model_file import parse_model
from strutwork.reports.model_solution import solve_model
from tests.cli.conftest import Program
from tests.model_files import EXAMPLES, SAMPLE, Content, add, drop, put, sample, toml

EXAMPLE = {path.stem: path for path in EXAMPLES}


def test_keys_of_the_json(strutwork: Program, write: Callable[[Content], Path]) -> None:
    found = strutwork("solve", write(SAMPLE), "--json").result
    beside = {"undetermined_joint_forces", "undetermined_reactions", "near_mechanisms"}
    assert set(found) == {"cases", "tcp", *beside}
    assert set(found["tcp"]) == {"compliance", "stiffness"}
    assert np.shape(found["tcp"]["compliance"]) == (6, 6)
    assert np.shape(found["tcp"]["stiffness"]) == (6, 6)
    assert list(found["cases"]) == ["gravity", "cutting", "wind", "settle", "assembly"]
    for case in found["cases"].values():
        assert set(case) == {
            "displacements",
            "reactions",
            "joint_forces",
            "spring_forces",
            "beam_forces",
            "strain_energy",
        }
        assert list(case["displacements"]) == ["A", "B", "C", "D", "TCP", "F", "G"]
        assert list(case["reactions"]) == ["A", "G"]
        assert list(case["joint_forces"]) == ["hinge", "mount"]
        assert list(case["spring_forces"]) == ["B"]
        assert list(case["beam_forces"]) == ["arm", "strut"]
        assert set(case["beam_forces"]["arm"]) == {"from", "to"}
        assert isinstance(case["strain_energy"], float)
        six = [
            *case["displacements"].values(),
            *case["reactions"].values(),
            *case["joint_forces"].values(),
            *case["beam_forces"]["arm"].values(),
        ]
        assert {len(entry) for entry in six} == {6}


def test_cantilever(strutwork: Program) -> None:
    found = strutwork("solve", EXAMPLE["01_cantilever"], "--json").result
    case = found["cases"]["load"]
    # P L³ / 3 E Iy + P L / (κ G A), Cowper's κ for a rectangle; Gere, Mechanics of Materials
    e, nu, length, force, area = 210e9, 0.3, 0.4, -100.0, 0.02 * 0.03
    inertia = 0.02 * 0.03**3 / 12
    kappa = 10 * (1 + nu) / (12 + 11 * nu)
    shear = force * length / (kappa * e / (2 * (1 + nu)) * area)
    tip = case["displacements"]["tip"]
    assert tip[2] == pytest.approx(force * length**3 / (3 * e * inertia) + shear, rel=1e-9)
    assert tip[4] == pytest.approx(-force * length**2 / (2 * e * inertia), rel=1e-9)
    assert case["displacements"]["root"] == [0.0] * 6
    # reactions act on the structure; all six, the idle ones zero
    assert case["reactions"]["root"] == pytest.approx([0, 0, 100, 0, -40, 0], abs=1e-9)
    # end forces act on the beam in its own axes
    assert case["beam_forces"]["arm"]["from"] == pytest.approx([0, 0, 100, 0, -40, 0], abs=1e-9)
    assert case["beam_forces"]["arm"]["to"] == pytest.approx([0, 0, -100, 0, 0, 0], abs=1e-9)
    assert case["strain_energy"] == pytest.approx(0.5 * force * tip[2], rel=1e-9)
    compliance = np.array(found["tcp"]["compliance"])
    assert compliance[2, 2] == pytest.approx(tip[2] / force, rel=1e-9)
    assert compliance @ np.array(found["tcp"]["stiffness"]) == pytest.approx(np.eye(6), abs=1e-6)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_reactions_and_springs_carry_the_loads(path: Path, strutwork: Program) -> None:
    found = strutwork("solve", path, "--json").result
    checked = strutwork("check", path, "--json").result
    every: dict[str, dict[str, list[float]]] = {
        "01_cantilever": {"load": [0, 0, -100]},
        # wind: 85 N/m on average over 1.8 m, 120 N/m over 1.5 m
        "02_space_frame": {"wind": [85 * 1.8 + 120 * 1.5, 0, 0], "sinking foot": [0, 0, 0]},
        "03_tripod": {"cutting": [200, -50, -400]},
        "04_four_bar": {"resistance": [20, 0, 0], "assembly": [0, 0, 0]},
        "05_two_link_leg": {
            "cutting": [100, 0, 0],
            "wind": [0, 0, -100 * np.hypot(0.216, 0.1)],
            "settle": [0, 0, 0],
            "assembly": [0, 0, 0],
        },
        "06_table_on_two_rails": {},
        "08_column_on_mounts": {"cutting": [200, 100, -150]},
        "09_flexure_stage": {"push": [10, 0, 0]},
        "10_screws_and_belt": {"push": [0, 0, -1000]},
    }
    applied = every[path.stem]
    if "gravity" in found["cases"]:
        applied["gravity"] = [0, 0, -9.80665 * checked["mass"]["total"]]
    assert set(applied) == set(found["cases"])
    for name, load in applied.items():
        case = found["cases"][name]
        carried = [*case["reactions"].values(), *case["spring_forces"].values()]
        total = np.sum(carried, axis=0)[:3] + load
        # round-off of forces of some thousand newtons
        assert total == pytest.approx(np.zeros(3), abs=1e-6)


def test_joint_force_acts_on_the_second_node_in_joint_axes(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    # the plate hangs on the hinge alone: the hinge carries the whole load from B to C
    content = sample(
        drop("joints.1"),
        drop("gravity"),
        drop("beams.1"),
        drop("nodes.F"),
        drop("nodes.G"),
        drop("supports.1"),
    )
    case = strutwork("solve", write(content), "--json").result["cases"]["cutting"]
    frame = axes_frame([0.0, 1.0, 0.0])
    arm = np.array([0.0, 0.1, 0.1])
    force = np.array([-100.0, 0.0, 0.0])
    expected = [*(force @ frame), *(np.cross(arm, force) @ frame)]
    assert case["joint_forces"]["hinge"] == pytest.approx(expected, abs=1e-9)


def test_settlement_and_misfit_by_hand(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    content = {
        "materials": {"m": {"youngs_modulus": 2e11, "poissons_ratio": 0.25}},
        "sections": {"s": {"shape": "rod", "diameter": "20 mm"}},
        "nodes": {"A": [0, 0, 0], "B": [0.5, 0, 0], "C": [0.5, 0, 0], "D": [1.5, 0, 0]},
        "beams": [
            {"name": "left", "from": "A", "to": "B", "material": "m", "section": "s"},
            {"name": "right", "from": "C", "to": "D", "material": "m", "section": "s"},
        ],
        "joints": [
            {"name": "weld", "type": "fixed", "between": ["B", "C"], "axis": [1, 0, 0]},
        ],
        "supports": [{"node": "A", "fixed": "all"}, {"node": "D", "fixed": "all"}],
        "settlements": [{"case": "move", "node": "D", "displacement": {"x": "0.2 mm"}}],
        "misfits": [{"case": "gap", "joint": "weld", "gap": {"z": "0.3 mm"}}],
    }
    found = strutwork("solve", write(content), "--json").result["cases"]
    stiffness = 2e11 * np.pi / 4 * 0.02**2 / 1.0
    # a bar of 1.5 m stretched by 0.2 mm: tension, so the ground pulls D outwards
    tension = stiffness / 1.5 * 0.2e-3
    assert found["move"]["reactions"]["D"][0] == pytest.approx(tension, rel=1e-9)
    assert found["move"]["reactions"]["A"][0] == pytest.approx(-tension, rel=1e-9)
    # a gap that puts C 0.3 mm beyond B, along the joint's z axis, compresses the bars
    push = stiffness / 1.5 * 0.3e-3
    gap = found["gap"]
    closed = gap["displacements"]["C"][0] - gap["displacements"]["B"][0]
    assert closed == pytest.approx(0.3e-3, rel=1e-9)
    assert gap["joint_forces"]["weld"][2] == pytest.approx(push, rel=1e-9)
    assert gap["beam_forces"]["right"]["from"][0] == pytest.approx(push, rel=1e-9)
    assert gap["strain_energy"] == pytest.approx(0.5 * push * 0.3e-3, rel=1e-9)


def test_file_without_tool_has_no_stiffness(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    found = strutwork("solve", write(sample(drop("tool"))), "--json").result
    assert found["tcp"] is None


def test_file_with_a_tool_alone(strutwork: Program, write: Callable[[Content], Path]) -> None:
    tables = ("gravity", "loads", "line_loads", "settlements", "misfits")
    found = strutwork("solve", write(sample(*map(drop, tables))), "--json").result
    assert found["cases"] == {}
    whole = strutwork("solve", write(SAMPLE), "--json").result
    assert found["tcp"] == whole["tcp"]


def test_tool_that_spins_freely_leaves_the_cases(tmp_path: Path) -> None:
    # the plate hangs by a ball: the cases hold it, a moment at the tool does not
    content = sample(
        put("joints.0", {"name": "ball", "type": "spherical", "between": ["B", "C"]}),
        put("loads.0", {"node": "B", "force": [0, 0, 1]}),
        drop("joints.1"),
        drop("gravity"),
        drop("misfits"),
        drop("beams.1"),
        drop("nodes.F"),
        drop("nodes.G"),
        drop("supports.1"),
    )
    with pytest.warns(ModelWarning, match=r"ball in rx"):
        found = solve_model(parse_model(toml(content), str(tmp_path))).to_dict()
    assert found["tcp"] is None
    assert found["cases"]["load"]["displacements"]["B"][2] > 0


def test_tool_on_a_support_has_no_stiffness_in_its_direction() -> None:
    content = sample(put("tool.tcp", "G"))
    with pytest.warns(ModelWarning, match="infinite"):
        found = solve_model(parse_model(toml(content))).to_dict()
    assert found["tcp"]["stiffness"] is None
    assert np.array(found["tcp"]["compliance"])[:3] == pytest.approx(np.zeros((3, 6)), abs=1e-15)


def test_loads_of_one_case_add_up(strutwork: Program, write: Callable[[Content], Path]) -> None:
    doubled = add("loads", {"case": "cutting", "node": "TCP", "force": ["100 N", 0, 0]})
    single = strutwork("solve", write(SAMPLE), "--json").result["cases"]["cutting"]
    double = strutwork("solve", write(sample(doubled)), "--json").result["cases"]["cutting"]
    for node, moved in single["displacements"].items():
        assert double["displacements"][node] == pytest.approx(
            2 * np.array(moved), rel=1e-9, abs=1e-18
        )


def test_table_for_people(strutwork: Program) -> None:
    run = strutwork("solve", EXAMPLE["01_cantilever"])
    assert (run.status, run.err) == (0, "")
    assert 'Case "load"' in run.out
    assert "-0.2267" in run.out
    assert "Stiffness at the tool tip" in run.out
