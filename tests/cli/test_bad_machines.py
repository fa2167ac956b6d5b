"""Machines and motions that cannot be: what is said names the part, what is wrong, the remedy.

Each is asked of the command line with a model file, and of Python by `strutwork.load`.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import strutwork as sw
from strutwork.errors import ModelError, SingularPoseError, StrutworkError, UnreachableError
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model_poses import at_pose
from strutwork.reports.model_check import check_model
from strutwork.studies import foresee
from strutwork.studies.answers import Stiffness
from strutwork.studies.survey import survey
from strutwork.studies.trajectory import Samples, study_trajectory
from strutwork.studies.workspace import workspace
from strutwork.studies.workspace_margin import MachineMargin, interference_of
from tests.cli.conftest import Program
from tests.model_files import Content, Edit, drop, put

EXAMPLES = Path(__file__).parents[2] / "examples" / "machines"
PLANAR, HEXAPOD = EXAMPLES / "planar-3-rrr.toml", EXAMPLES / "6-ups.toml"

Write = Callable[[Content], Path]

#: Every command that reads a machine, with what it needs.
COMMANDS: dict[str, tuple[str, ...]] = {
    "check": (),
    "solve": (),
    "modes": (),
    "move": ("--pose", "x=5mm"),
    "map": (),
    "workspace": (),
    "singularities": ("--line", "x=0mm..10mm"),
    "reversals": ("--over", "x=-10mm..10mm:5,y=-10mm..10mm:5"),
    "accuracy": (),
    "trajectory": ("PATH",),
    "report": ("--out", "FOLDER"),
}

#: What is changed in the planar machine, and what the message holds.
WRONG: dict[str, tuple[list[Edit], list[str]]] = {
    "a loop that does not close at home": (
        [put("nodes.end2", ["-69.2 mm", "-40 mm", "0 mm"])],
        ["joint wrist2", '"seat2" and "end2"', "8.2e-05 m apart", "Correct the coordinates"],
    ),
    "a task direction in which the joints hold the tool": (
        [put("task.directions", ["x", "y", "z"]), drop("workspace")],
        ["task", "cannot move in z from home", "Leave this direction out"],
    ),
    "a workspace along no direction of the task": (
        [put("workspace.z", {"from": "-1 mm", "to": "1 mm", "points": 3})],
        ["workspace", "goes along z", "The task has x, y, rz"],
    ),
    "limits that exclude home": (
        [put("joints.0.limits", {"rz": ["5 deg", "50 deg"]})],
        ["joint motor1", "exclude home", "5 to 50 deg, and it is 0 deg there", "[home.motor1]"],
    ),
}


def planar(*edits: Edit) -> Content:
    """The planar machine of the examples, changed by each edit in turn."""
    content: Content = tomllib.loads(PLANAR.read_text(encoding="utf-8"))
    for edit in edits:
        edit(content)
    return content


def path_of(folder: Path, head: str, rows: list[tuple[float, ...]]) -> Path:
    """A file of a path over time."""
    file = folder / "path.csv"
    lines = [head, *(",".join(map(str, row)) for row in rows)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


@pytest.mark.parametrize("name", WRONG)
def test_every_command_and_python_say_what_is_wrong(
    name: str, strutwork: Program, write: Write, tmp_path: Path
) -> None:
    edits, expected = WRONG[name]
    file = write(planar(*edits))
    way = path_of(tmp_path, '"t, s","x, mm"', [(0, 0), (1, 1), (2, 3), (3, 4)])
    known = {"PATH": str(way), "FOLDER": str(tmp_path / "out")}
    for command, options in COMMANDS.items():
        run = strutwork(command, file, *(known.get(o, o) for o in options))
        assert (run.status, run.out) == (1, ""), command
        assert [part for part in expected if part not in run.err] == [], run.err
    with pytest.raises(ModelError) as caught:
        sw.load(str(file))
    assert [part for part in expected if part not in str(caught.value)] == []
    assert caught.value.remedy
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ("solve", PLANAR, "--pose", "z=1mm"),
        ("move", PLANAR, "--pose", "z=1mm"),
        ("map", PLANAR, "--over", "x=0..1mm:5,z=0..1mm:5"),
        ("workspace", PLANAR, "--over", "x=0..1mm:5,z=0..1mm:5"),
        ("singularities", PLANAR, "--line", "z=0..1mm"),
        ("reversals", PLANAR, "--over", "x=0..1mm:5,z=0..1mm:5"),
        ("accuracy", PLANAR, "--over", "x=0..1mm:5,z=0..1mm:5"),
    ],
)
def test_a_direction_asked_that_cannot_be_moved(
    arguments: tuple[Any, ...], strutwork: Program
) -> None:
    run = strutwork(*arguments)
    assert (run.status, run.out) == (1, "")
    assert "the tool cannot move in z from home" in run.err


def test_a_direction_asked_in_python() -> None:
    model = sw.load(str(PLANAR))
    with pytest.raises(ModelError, match="cannot move in z from home"):
        model.motion.move(task={"z": 0.001})
    with pytest.raises(ModelError, match="cannot move in rx from home"):
        survey(model, TaskGrid({"rx": np.array([0.0, 0.1])}), [Stiffness()])


def test_more_coordinates_than_freedoms(strutwork: Program) -> None:
    names = ("motor1", "motor2", "motor3", "knee1")
    words = [w for n in names for w in ("--joint", f"{n}:rz=5deg")]
    run = strutwork("move", PLANAR, *words)
    expected = "4 coordinates are given for 3 freedoms, and knee1:rz follows from the others"
    assert expected in run.out
    run = strutwork("solve", PLANAR, *words)
    assert run.status == 1
    assert expected in run.err
    model = sw.load(str(PLANAR))
    moved = model.motion.move(joints={(n, "rz"): 0.05 for n in names})
    assert expected in moved.placement.reason(())
    # those that agree are taken
    three = model.motion.move(joints={(n, "rz"): 0.05 for n in names[:3]})
    assert three.reached.all()
    angle = float(three.coordinate("knee1", "rz"))
    assert model.motion.move(
        joints={**{(n, "rz"): 0.05 for n in names[:3]}, ("knee1", "rz"): angle}
    ).reached.all()


def test_more_drives_than_freedoms(strutwork: Program, write: Write) -> None:
    file = write(planar(put("joints.1.driven", ["rz"])))
    run = strutwork("check", file)
    assert "drives in excess of the freedoms that they move" in run.out
    found = strutwork("check", file, "--json").result
    assert (found["drives"], found["surplus_drives"]) == (4, 1)
    assert any(
        {"motor1", "knee1", "motor2", "motor3"} <= set(s["joints"])
        for s in found["self_stress_states"]
    )
    checked = check_model(sw.load(str(PLANAR)))
    assert (checked.drives, checked.surplus_drives) == (3, 0)


@pytest.mark.parametrize("command", ["solve", "check", "singularities", "accuracy"])
def test_a_pose_out_of_reach_offers_one_that_is_not(command: str, strutwork: Program) -> None:
    run = strutwork(command, PLANAR, "--pose", "x=900mm")
    assert (run.status, run.out) == (1, "")
    assert "out of reach" in run.err
    near = run.err.split("home it reaches ")[1].strip().rstrip(".").replace(" ", "")
    again = strutwork("move", PLANAR, "--pose", near, "--json")
    assert again.result["reached"] == 1


def test_a_pose_out_of_reach_in_python() -> None:
    model = sw.load(str(PLANAR))
    with pytest.raises(UnreachableError, match=r"out of reach.*\nOn the path .* x = 142\.\d+ mm"):
        at_pose(model, {"x": 0.9})
    joints = {("motor1", "rz"): 1.6, ("motor2", "rz"): -1.6, ("motor3", "rz"): 3.0}
    with pytest.raises(
        UnreachableError, match=r"parallel singularity \(type 2\)[^\n]*\n.*reaches motor1:rz = \d"
    ):
        at_pose(model, None, joints)


FAR = "x=900mm..1000mm:5,y=900mm..1000mm:5"


@pytest.mark.parametrize("command", ["map", "accuracy", "reversals"])
def test_a_grid_out_of_reach_says_why(command: str, strutwork: Program) -> None:
    run = strutwork(command, PLANAR, "--over", FAR)
    assert (run.status, run.out) == (1, "")
    assert "out of reach: on the path a leg reaches the end" in run.err


def test_a_workspace_out_of_reach_says_why(strutwork: Program) -> None:
    run = strutwork("workspace", PLANAR, "--over", FAR)
    assert "0 of 25 poses of the grid are good" in run.out
    assert "25: out of reach" in run.out
    found = strutwork("workspace", PLANAR, "--over", FAR, "--json").result
    assert sum(found["dropped_by_reason"].values()) == 25


def test_a_path_through_a_singularity_says_where_and_which(
    strutwork: Program, tmp_path: Path
) -> None:
    """A path is halved between samples; `--line` finds the same angle by zeros of a minor."""
    rows = [(k / 10.0, -9.0 * k) for k in range(11)]
    way = path_of(tmp_path, '"t, s","rz, deg"', rows)
    run = strutwork("trajectory", PLANAR, way)
    assert (run.status, run.out) == (1, "")
    assert "passes through a singularity, parallel (type 2)" in run.err
    assert "Lead the path around it" in run.err
    angle = float(run.err.split("rz = ")[1].split(" deg")[0])
    line = strutwork("singularities", PLANAR, "--line", "rz=-60deg..0deg", "--json").result
    where = [np.degrees(s["at"]["rz"]) for s in line["singularities"] if s["type"] == 2]
    # shown to five digits
    assert where == pytest.approx([angle], abs=1e-3)


def test_a_path_through_a_singularity_in_python() -> None:
    times = np.linspace(0.0, 1.0, 11)
    samples = Samples(times, {("", "rz"): np.radians(-90.0 * times)})
    with pytest.raises(SingularPoseError, match=r"rz = -34\.82\d deg: .*parallel \(type 2\)"):
        study_trajectory(sw.load(str(PLANAR)), samples)


# too large for the memory of any machine, whatever its speed
LARGE = "x=-40mm..40mm:10001,y=-40mm..40mm:10001,rz=-5deg..5deg:1001"


@pytest.mark.parametrize("command", ["map", "accuracy", "workspace"])
def test_a_grid_too_large_is_foreseen(command: str, strutwork: Program) -> None:
    run = strutwork(command, PLANAR, "--over", LARGE)
    assert (run.status, run.out) == (1, "")
    said = run.err.split("workspace: ")[-1]
    assert "has 100,120,021,001 poses, " in said
    # what the coordinates alone take is refused before a pose is timed
    assert re.search(
        r"(about [\d,]+ hours and [\d.e+]+|2.4e\+03) GB( of coordinates alone\.|; at most)", said
    )
    assert "fewer points" in said


def test_a_grid_that_no_integer_counts(strutwork: Program) -> None:
    many = ",".join(f"{d}=0..1:9999999" for d in ("x", "y", "rz"))
    run = strutwork("map", PLANAR, "--over", many)
    assert (run.status, run.out) == (1, "")
    assert "has 1e+21 poses" in run.err


def test_time_and_memory_in_python(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    model = sw.load(str(PLANAR))
    grid = TaskGrid({"x": np.linspace(-0.01, 0.01, 60), "y": np.linspace(-0.01, 0.01, 60)})
    with monkeypatch.context() as patch:
        patch.setattr(foresee, "available_memory", lambda: 1e6)
        with pytest.raises(
            ModelError, match=r"3,600 poses.* GB; at most 6 hours, 0.0005 GB are allowed"
        ):
            survey(model, grid, [Stiffness()])
        # what goes on from kept chunks has no bound of time, but still one of memory
        with pytest.raises(ModelError, match=r" GB; at most 0.0005 GB are allowed"):
            survey(model, grid, [Stiffness()], folder=tmp_path)
    margin = MachineMargin(model, ("x", "y"), np.full(2, 1e-3))
    with monkeypatch.context() as patch:
        patch.setattr(foresee, "available_memory", lambda: 1e6)
        with pytest.raises(
            ModelError, match=r"3,721 poses.* GB; at most 10,000,000 poses, 2 hours"
        ):
            workspace(margin, {d: np.linspace(-0.01, 0.01, 61) for d in "xy"})


def test_foreseen_memory_is_that_of_the_arrays() -> None:
    """Two arrays of 6 and one of none: 13 numbers and one coordinate, each held four times."""
    grid = TaskGrid({"x": np.linspace(0.0, 1.0, 100)})

    def asked(task: dict[str, Any]) -> dict[str, Any]:
        n = len(task["x"])
        return {"a": np.zeros((n, 6)), "b": np.zeros((n, 2, 3)), "c": np.zeros(n)}

    found = foresee.foresee(asked, grid, 1)
    assert found.memory == 8.0 * 4.0 * (13 + 1) * 100
    assert found.poses == 100


def test_interference_at_home(strutwork: Program) -> None:
    run = strutwork("workspace", HEXAPOD, "--over", "x=-10mm..10mm:5", "--radius", "200mm")
    assert (run.status, run.out) == (1, "")
    assert "interfere at home: they overlap by " in run.err
    assert "Give a smaller radius" in run.err
    with pytest.raises(StrutworkError, match=r"ram\d and ram\d: interfere at home"):
        interference_of(sw.load(str(HEXAPOD)), 0.2)
