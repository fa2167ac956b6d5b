"""`strutwork trajectory`: what a path asks of drives, what it exceeds, and what is refused."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError, UnitError
from strutwork.reports.cli.drive_limits import drive_limits
from strutwork.reports.trajectory_table import read_samples
from tests.cli.conftest import Program

CIRCLE = "examples/09_circle.csv"

LIFT = """
gravity = [0, 0, -9.81]

[nodes]
wall = [0, 0, 0]
rail = [0, 0, 0]
root = [0, 0, 0]
tip = [0, 0, 0.5]

[[bodies]]
name = "frame"
nodes = ["wall", "rail"]

[[bodies]]
name = "slide"
nodes = ["root", "tip"]

[[supports]]
node = "wall"
fixed = "all"

[[masses]]
node = "tip"
mass = 3.0
[[joints]]
name = "ram"
type = "prismatic"
between = ["rail", "root"]
axis = [0, 0, 1]
driven = ["z"]
limits = { z = ["-10 mm", "150 mm"] }
[[drives]]
joint = "ram"
direction = "z"
speed = "0.3 m/s"
force = "35 N"
[tool]
tcp = "tip"
"""


def lift(folder: Path) -> Path:
    """A mass of 3 kg on a vertical ram that states what it can do."""
    file = folder / "lift.toml"
    file.write_text(LIFT, encoding="utf-8")
    return file


def written(folder: Path, text: str) -> Path:
    file = folder / "path.csv"
    file.write_text(text, encoding="utf-8")
    return file


def rise(folder: Path, height: float = 200.0, rows: int = 41) -> Path:
    """200 mm up in a second by a quintic, of which the tool stands at 500 mm."""
    u = np.linspace(0, 1, rows)
    z = 500 + height * u**3 * (10 - 15 * u + 6 * u**2)
    lines = [f"{t!r},{v!r}" for t, v in zip(u.tolist(), z.tolist(), strict=True)]
    return written(folder, '"t, s","z, mm"\n' + "\n".join(lines) + "\n")


def test_a_lift(strutwork: Program, tmp_path: Path) -> None:
    out = tmp_path / "out"
    run = strutwork(
        "trajectory", lift(tmp_path), rise(tmp_path), "--reactions", "-o", out, "--json"
    )
    found = run.result
    (ram,) = found["drives"]
    assert ram["drive"] == "ram:z"
    # the quintic: 15/8 of the mean speed in the middle, 10/√3 of the mean acceleration before it
    assert ram["speed"]["value"] == pytest.approx(0.2 * 15 / 8, rel=1e-9)
    assert ram["speed"]["time"] == pytest.approx(0.5, abs=1e-9)
    largest = 0.2 * 10 / np.sqrt(3)
    # looked at six times to an interval of 25 ms
    assert ram["acceleration"]["value"] == pytest.approx(largest, rel=2e-4)
    assert ram["force"]["value"] == pytest.approx(3.0 * (9.81 + largest), rel=1e-4)
    assert ram["force"]["time"] == pytest.approx((1 - 1 / np.sqrt(3)) / 2, abs=0.01)
    # mean square of g + a, and of the quintic's acceleration: 120/7
    square = 9.0 * (9.81**2 + 0.2**2 * 120 / 7)
    assert ram["rms_force"] == pytest.approx(np.sqrt(square), rel=1e-8)
    assert found["work"] == pytest.approx(3.0 * 9.81 * 0.2, rel=1e-9)
    assert found["imbalance"] < 1e-9
    assert found["gravity"] == [0, 0, -9.81]
    assert found["moving_mass"] == pytest.approx(3.0)
    assert [ram[q]["exceeded"] for q in ("speed", "acceleration", "force", "power")] == [
        True,
        False,
        False,
        False,
    ]
    assert ram["force"]["limit"] == 35.0
    (beyond,) = found["out_of_range"]
    assert beyond["coordinate"] == "ram:z"
    assert (beyond["value"], beyond["bound"]) == pytest.approx((0.2, 0.15))
    assert beyond["time"] == pytest.approx(1.0)
    assert 0.5 < beyond["first"] < 1.0
    reactions = found["reactions"]
    bearing = {name: value for name, value in reactions.items() if name.startswith("ram:")}
    assert bearing == pytest.approx(
        dict.fromkeys(("ram:x", "ram:y", "ram:rx", "ram:ry", "ram:rz"), 0.0), abs=1e-9
    )
    # the wall bears what the ram does, and no more
    (wall,) = [value for name, value in reactions.items() if value > 1e-9]
    assert wall == pytest.approx(ram["force"]["value"], rel=1e-9)
    assert found["data"] == [str(out / "trajectory.csv"), str(out / "reactions.csv")]
    rows = list(csv.DictReader((out / "trajectory.csv").open(encoding="utf-8")))
    assert len(rows) == 201
    assert float(rows[-1]["ram:z drive, mm"]) == pytest.approx(200.0)
    assert float(rows[0]["ram:z drive force, N"]) == pytest.approx(3 * 9.81, abs=1e-3)
    energies = [float(rows[k]["potential energy, J"]) for k in (0, -1)]
    assert np.diff(energies) == pytest.approx(3.0 * 9.81 * 0.2)


def test_limits_are_named_with_time_and_measure(strutwork: Program, tmp_path: Path) -> None:
    run = strutwork(
        "trajectory",
        lift(tmp_path),
        rise(tmp_path),
        "--limit",
        "force=30N",
        "--limit",
        "ram:z:power=10 W",
        "--gravity",
        "0,0,-1.62",
    )
    assert run.status == 0
    assert "Beyond its limit: ram:z, speed 375 mm/s at t = 0.5 s, 25 % more than 300 mm/s" in (
        run.out
    )
    # on the moon the ram bears 3 kg less
    assert "ram:z, force" not in run.out
    assert "ram:z, power" not in run.out
    assert "Out of its range: ram:z from t = 0." in run.out
    assert "furthest 200 mm at t = 1 s, 50 mm beyond 150 mm" in run.out
    assert "gravity 0, 0, -1.62 m/s²" in run.out
    heavy = strutwork("trajectory", lift(tmp_path), rise(tmp_path), "--limit", "ram:z:power=10 W")
    assert "Beyond its limit: ram:z, power 1" in heavy.out


def test_a_machine_of_the_catalogue(strutwork: Program) -> None:
    run = strutwork("trajectory", "mit-ss1", CIRCLE)
    assert "kept at home: ry 0 deg" in run.out
    assert "without mass: block1, block2, block3" in run.err
    assert "Beyond" not in run.out
    refused = strutwork("trajectory", "mit-ss1", CIRCLE, "--reactions")
    assert refused.status == 1
    assert "not determined: the linkage is over-constrained" in refused.err
    massless = strutwork("trajectory", "hexel-hexapod", CIRCLE)
    assert massless.status == 1
    assert "no moving body with mass" in massless.err


def test_more_drives_than_the_tool_has_freedoms(strutwork: Program, tmp_path: Path) -> None:
    """The drives that are not needed stay at home, and are named."""
    file = written(tmp_path, "t,z\n0,0.22\n1,0.221\n2,0.219\n3,0.22\n")
    found = strutwork("trajectory", "prototype-3ppprs", file, "--json").result
    held = found["held"]
    assert [label for label in held if ":" in label] == [f"leg{i}/guide:rz" for i in (1, 2, 3)]
    assert set(held) - {"x", "y", "rx", "ry", "rz"} == {f"leg{i}/guide:rz" for i in (1, 2, 3)}
    still = [d for d in found["drives"] if d["drive"].endswith("/guide:rz")]
    assert [d["high"] - d["low"] for d in still] == pytest.approx([0.0] * 3, abs=1e-12)
    assert found["imbalance"] < 1e-9


def test_joint_coordinates_describe_a_path(strutwork: Program, tmp_path: Path) -> None:
    t = np.linspace(0, 1, 31)
    lines = "\n".join(f"{a!r},{b!r}" for a, b in zip(t.tolist(), (40 * t**2).tolist(), strict=True))
    file = written(tmp_path, '"t, s","R1:rz, deg"\n' + lines)
    found = strutwork("trajectory", "examples/04_four_bar.toml", file, "--json").result
    assert found["coordinates"] == ["R1:rz"]
    assert found["drives"][0]["speed"]["value"] == pytest.approx(np.radians(80), rel=1e-9)
    assert any("begins" not in n and "ends in motion" in n for n in found["notes"])
    assert found["imbalance"] < 1e-9


def test_ways_that_are_refused(strutwork: Program, tmp_path: Path) -> None:
    model = lift(tmp_path)
    rough = written(
        tmp_path,
        "t,z\n" + "\n".join(f"{k / 20},{0.5 + (0.01 if k > 9 else 0)}" for k in range(20)),
    )
    assert "z is not smooth near t = 0.4" in strutwork("trajectory", model, rough).err
    sideways = written(tmp_path, "t,x\n0,0\n1,0\n2,0\n3,0.1\n")
    run = strutwork("trajectory", model, sideways)
    assert run.status == 1
    assert "x cannot move from home" in run.err
    twice = written(tmp_path, "t,z,ram:z\n0,0.5,0\n1,0.5,0\n2,0.5,0\n3,0.6,0.1\n")
    assert "ram:z follows from the other coordinates" in strutwork("trajectory", model, twice).err
    for words, message in (
        (["--gravity", "0,0"], "not three numbers"),
        (["--gravity", "0,0,1 kg"], "not an acceleration"),
        (["--limit", "speed"], "is not understood"),
        (["--limit", "ram:x:speed=1"], "names the unknown drive ram:x"),
    ):
        bad = strutwork("trajectory", model, rise(tmp_path), *words)
        assert bad.status == 1
        assert message in bad.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,z\n", "no row of numbers"),
        ("z\n1\n", "no column of times"),
        ("t,q\n1,2\n", "no column of coordinates"),
        ('"t, h",z\n1,2\n', 'times in "h"'),
        ("t,time,z\n1,2,3\n", "two columns of times"),
        ('t,z,"z, mm"\n1,2,3\n', 'gives "z, mm" twice'),
        ('t,"z, deg"\n1,2\n', "z, deg, a unit that does not fit"),
        ('t,z,"z speed, mm"\n1,2,3\n', "z speed, mm, a unit that does not fit"),
        ("t,z,z speed\n1,2,3\n", "speeds or accelerations of some coordinates only"),
        ("t,z\n1,up\n", "no number in line 2 under z"),
    ],
)
def test_files_that_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        read_samples(written(tmp_path, text))


def test_columns_are_read_in_their_units(tmp_path: Path) -> None:
    file = written(
        tmp_path,
        'remark,"t, ms","x, mm","x speed, mm/s","x acceleration, m/s2","leg:rz, deg",'
        '"leg:rz speed, rad/s","leg:rz acceleration, deg/s^2"\na,250,1,2,3,90,5,180\n',
    )
    found = read_samples(file)
    assert found.times == pytest.approx([0.25])
    x, turn = ("", "x"), ("leg", "rz")
    assert (found.values[x][0], found.rates[x][0], found.changes[x][0]) == pytest.approx(
        (1e-3, 2e-3, 3.0)
    )
    assert (found.values[turn][0], found.rates[turn][0], found.changes[turn][0]) == pytest.approx(
        (np.pi / 2, 5.0, np.pi)
    )


def test_limits_of_drives() -> None:
    drives = (("ram", "z"), ("table", "rz"))
    found = drive_limits(["speed=30 m/min", "speed=60 deg/s", "table:rz:force=2 N*m"], drives)
    assert found["ram", "z"].speed == pytest.approx(0.5)
    assert found["table", "rz"].speed == pytest.approx(np.radians(60))
    assert (found["ram", "z"].force, found["table", "rz"].force) == (None, 2.0)
    assert drive_limits(["acceleration=4"], drives)["table", "rz"].acceleration == 4.0
    with pytest.raises(UnitError, match="not a speed"):
        drive_limits(["ram:z:speed=60 deg/s"], drives)
    with pytest.raises(ModelError, match="not positive"):
        drive_limits(["power=0"], drives)
