"""Coordinates that describe a motion: what is added, held and refused."""

from __future__ import annotations

import pytest

from strutwork.errors import ModelError
from strutwork.kinematics.coordinates import Coordinates, completed, freedoms
from strutwork.kinematics.motion import Motion
from strutwork.machines.load import load
from tests.linkages import gough, slider_crank


def test_tool_directions_then_drives_are_held() -> None:
    motion = load("prototype-3ppprs").motion
    found, added = completed(motion, Coordinates(("rz", "x")))
    assert found.tool == ("x", "y", "z", "rx", "ry", "rz")
    assert len(found) == freedoms(motion) == 9
    assert added["", "z"] == pytest.approx(0.22)
    assert [joint for joint, _ in found.joints] == [f"leg{i}/guide" for i in (1, 2, 3)]
    assert found.labels[-1] == "leg3/guide:rz"
    assert found.rotary.tolist() == [False] * 3 + [True] * 6


def test_a_drive_alone_moves_while_the_others_stand() -> None:
    machine = gough()
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    found, added = completed(motion, Coordinates((), (("P3", "z"),)))
    assert found.tool == ()
    assert [joint for joint, _ in found.joints] == ["P3", "P1", "P2", "P4", "P5", "P6"]
    assert added["P1", "z"] == pytest.approx(float(motion.home_values[2]))


def test_directions_of_the_task_are_held_first() -> None:
    model = load("machines/templates/3-rps.toml")
    assert completed(model.motion, Coordinates(("z",)))[0].tool == ("x", "y", "z")
    assert completed(model.motion, Coordinates(("z",)), ("rx", "ry"))[0].tool == ("z", "rx", "ry")


def test_spins_are_freedoms_that_no_coordinate_takes() -> None:
    machine = gough("spherical")
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    assert freedoms(motion) == 12
    assert len(completed(motion, Coordinates())[0]) == 6


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (Coordinates(("x", "y")), "y cannot move from home: the joints hold it"),
        (Coordinates(("x",), (("crank", "rz"),)), "crank:rz follows from the other"),
        (Coordinates((), (("crunk", "rz"),)), 'unknown joint "crunk".*\n.*crank'),
        (Coordinates((), (("crank", "z"),)), '"z" does not move in it'),
        (Coordinates(("q",)), 'unknown direction "q"'),
    ],
)
def test_what_cannot_be_a_coordinate(asked: Coordinates, message: str) -> None:
    linkage, placement = slider_crank(0.3)
    with pytest.raises(ModelError, match=message):
        completed(Motion(linkage, placement), asked)
