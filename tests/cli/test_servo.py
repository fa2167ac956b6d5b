"""`strutwork servo`: closed loops of a machine's drives, and what is refused."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines.model_file import parse_model
from tests.cli.conftest import Program
from tests.drives import SLIDE, SPRING

SCREW = """
[damping]
modal_ratio = 0.01
[[servos]]
joint = "slide"
direction = "z"
position_gain = "50 1/s"
motor_velocity_gain = "0.1 N*m*s/rad"
integral_time = "20 ms"
pitch = "20 mm"
motor_inertia = "3 kg*cm^2"
"""


def written(folder: Path, more: str = SCREW, *, elastic: bool = True) -> Path:
    lines = f"stiffness = {{ z = {SPRING} }}" if elastic else ""
    path = folder / "slide.toml"
    path.write_text(SLIDE.format(elastic=lines, more=more), encoding="utf-8")
    return path


def test_poles_margins_and_stiffness_are_printed_and_written(
    strutwork: Program, tmp_path: Path
) -> None:
    file = written(tmp_path)
    found = strutwork("servo", file, "--json", "-o", tmp_path / "out").result
    assert found["stable"]
    # J (2π/h)² and K_p (2π/h)²
    turn = (2.0 * np.pi / 0.02) ** 2
    inertia, gain = 3e-4 * turn, 0.1 * turn
    lowest = found["poles"][0]
    assert lowest["part"] == "drive slide:z"
    (drive,) = found["drives"]
    assert drive["static_stiffness"] is None
    assert drive["following_error_per_speed"] == pytest.approx(1.0 / 50.0)
    assert 0.0 < drive["velocity_loop"]["phase_margin"] < np.pi
    # below the resonance motor and carriage are one mass: the gain is one near K_p / (J + m)
    rigid = gain / (inertia + 40.0) / (2.0 * np.pi)
    assert drive["velocity_loop"]["crossover"] == pytest.approx(rigid, rel=0.1)
    (stiffness,) = found["dynamic_stiffness"]
    assert stiffness["port"] == "carriage:x"
    assert stiffness["with_servos"]["value"] < stiffness["with_servos"]["static"]
    assert stiffness["drives_locked"]["value"] == pytest.approx(
        SPRING * 2 * 0.01 * np.sqrt(1 - 1e-4), rel=1e-6
    )
    assert [Path(p).name for p in found["data"]] == [
        *("slide-servo-poles.csv", "slide-servo-margins.csv", "slide-servo-response.csv")
    ]
    with Path(found["data"][2]).open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    largest = max(float(r["receptance at carriage:x, with servos [SI]"]) for r in rows)
    assert 1.0 / largest == pytest.approx(stiffness["with_servos"]["value"], rel=1e-9)
    printed = strutwork("servo", file)
    assert printed.status == 0
    assert "The closed loop is stable" in printed.out
    assert "drive slide:z" in printed.out


def test_a_file_beside_the_model_and_another_pose(strutwork: Program, tmp_path: Path) -> None:
    plain = strutwork("servo", written(tmp_path), "--json").result
    servos = tmp_path / "servos.toml"
    servos.write_text(SCREW[SCREW.index("[[servos]]") :], encoding="utf-8")
    head = SCREW[: SCREW.index("[[servos]]")]
    beside = written(tmp_path, head)
    assert strutwork("servo", beside, "--servos", servos, "--json").result == plain
    over = strutwork("servo", beside, "--servos", servos, "--over", "x=0mm..100mm:2", "--json")
    extremes = over.result["over"]["extremes"]
    both = extremes["carriage:x, with servos"]
    expected = plain["dynamic_stiffness"][0]["with_servos"]["value"]
    assert both["least"]["value"] == pytest.approx(expected, rel=1e-6)
    assert over.result["over"]["unstable"] == 0
    run = strutwork("servo", beside, "--servos", beside)
    assert run.status == 1
    assert "is a model file" in run.err
    run = strutwork("servo", beside)
    assert run.status == 1
    assert "Add [[servos]]" in run.err


def test_an_unstable_loop_is_said_and_has_no_number(strutwork: Program, tmp_path: Path) -> None:
    wild = SCREW.replace('integral_time = "20 ms"', 'delay = "20 ms"')
    file = written(tmp_path, wild)
    found = strutwork("servo", file, "--json").result
    assert not found["stable"]
    assert found["dynamic_stiffness"][0]["with_servos"] is None
    assert found["dynamic_stiffness"][0]["drives_locked"]["value"] > 0
    assert any(not pole["stable"] for pole in found["poles"])
    printed = strutwork("servo", file, "--over", "x=0mm..100mm:2")
    assert "UNSTABLE" in printed.out
    assert "unstable at 2 of the poses" in printed.out.lower()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('joint = "slide"', 'joint = "slid"', 'unknown joint "slid"'),
        ('direction = "z"', 'direction = "x"', "not driven"),
        ('position_gain = "50 1/s"', 'position_gain = "-50 1/s"', "position_gain"),
        ('position_gain = "50 1/s"', 'position_gain = "50 N/um"', "a rate"),
        ('pitch = "20 mm"', "", "Give velocity_gain"),
        ('pitch = "20 mm"', 'pitch = "20 mm"\nratio = 3', "gives ratio"),
        ('pitch = "20 mm"', 'pitch = "20 mm"\nmotor_mass = 3', "gives motor_mass"),
        ('motor_velocity_gain = "0.1 N*m*s/rad"', "", "no motor_velocity_gain"),
        ('joint = "slide"', 'joint = "slide"\njoints = ["slide"]', "both joint and joints"),
        ('joint = "slide"', 'joints = ["slide", "slide"]', "twice"),
    ],
)
def test_tables_that_are_refused(old: str, new: str, words: str) -> None:
    assert old in SCREW
    text = SLIDE.format(elastic="", more=SCREW.replace(old, new, 1))
    with pytest.raises(ModelError) as raised:
        parse_model(text)
    assert words in str(raised.value)


def test_a_rotary_drive_and_a_linear_motor() -> None:
    turning = SLIDE.replace("prismatic", "revolute").replace('["z"]', '["rz"]')
    table = """
[[servos]]
joint = "slide"
direction = "rz"
position_gain = 30
motor_velocity_gain = 2
ratio = 5
motor_inertia = 0.01
encoder = "load"
pade_order = 3
delay = "1 ms"
"""
    (servo,) = parse_model(turning.format(elastic="", more=table)).servos
    assert (servo.velocity_gain, servo.inertia, servo.encoder) == (50.0, 0.25, "load")
    linear = SCREW.replace("motor_velocity_gain", "velocity_gain").replace("N*m*s/rad", "N*s/mm")
    linear = linear.replace('pitch = "20 mm"\n', "").replace(
        'motor_inertia = "3 kg*cm^2"', 'motor_mass = "3 kg"'
    )
    (servo,) = parse_model(SLIDE.format(elastic="", more=linear)).servos
    assert servo.velocity_gain == pytest.approx(100.0)
    assert servo.inertia == 3.0


def test_a_rigid_machine_has_nothing_to_lock(strutwork: Program, tmp_path: Path) -> None:
    found = strutwork("servo", written(tmp_path, elastic=False), "--json").result
    (stiffness,) = found["dynamic_stiffness"]
    assert stiffness["drives_locked"] is None
    assert stiffness["with_servos"]["value"] > 0


def test_a_missing_mass_and_usage(strutwork: Program, tmp_path: Path) -> None:
    file = written(tmp_path)
    file.write_text(
        file.read_text(encoding="utf-8").replace('motor_inertia = "3 kg*cm^2"\n', ""),
        encoding="utf-8",
    )
    run = strutwork("servo", file)
    assert run.status == 1
    assert "no inertia" in run.err
    assert strutwork("servo", file, "--from", "3").status == 2
    assert strutwork("servo", file, "--from", "30", "--to", "3").status == 1
