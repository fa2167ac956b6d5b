"""Screws: their row ties the way along the axis to the turn, everywhere the rows go."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import modes
from strutwork.kinematics import Body, Joint, Linkage, Placement, jacobians, mobility
from strutwork.kinematics.coordinates import Coordinates
from strutwork.kinematics.dynamics import Dynamics
from strutwork.kinematics.motion import Motion
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.msa import solve, tool_compliance
from strutwork.msa.body_mass import body_masses

PITCH, TABLE, TURNING = 0.01, 30.0, 0.001

#: A table on a guide, moved by a screw that turns in a bearing.
AXIS = """
title = "Ball screw axis"
[nodes]
rail = [0.3, 0, -0.08]
base = [0, 0, 0]
screw = [0, 0, 0]
nut0 = [0.3, 0, 0]
nut = [0.3, 0, 0]
slide = [0.3, 0, -0.08]
tcp = [0.3, 0, 0.1]
[[bodies]]
name = "spindle"
nodes = ["screw", "nut0"]
mass = 4
center_of_mass = [0.15, 0, 0]
inertia = [[0.001, 0, 0], [0, 0.05, 0], [0, 0, 0.05]]
[[bodies]]
name = "table"
nodes = ["slide", "nut", "tcp"]
mass = 30
center_of_mass = [0.3, 0, 0]
[[supports]]
node = "base"
fixed = "all"
[[supports]]
node = "rail"
fixed = "all"
[[joints]]
name = "bearing"
type = "revolute"
between = ["base", "screw"]
axis = [1, 0, 0]
driven = ["rz"]
DRIVE
[[joints]]
name = "nut"
type = "helical"
between = ["nut0", "nut"]
axis = [1, 0, 0]
pitch = "PITCH"
[[joints]]
name = "guide"
type = "prismatic"
between = ["rail", "slide"]
axis = [1, 0, 0]
[tool]
tcp = "tcp"
"""


def axis(pitch: str = "10 mm", drive: str = "") -> Model:
    return parse_model(AXIS.replace("PITCH", pitch).replace("DRIVE", drive))


def test_one_freedom_that_turns_and_slides() -> None:
    model = axis()
    found = mobility(model.structure.linkage, model.placement)
    assert (found.mobility, found.mobility_locked) == (1, 0)
    # the guide and the screw's line both hold the table's turns and sides
    assert found.redundant == 4
    inverse = jacobians(model.structure.linkage, model.placement).inverse
    # of a nut that cannot turn: the screw turns back against its lead
    assert abs(inverse[..., 0, 0]) == pytest.approx(2 * pi / PITCH, rel=1e-12)


@pytest.mark.parametrize("pitch", [0.01, -0.004])
def test_it_moves_over_many_turns(pitch: float) -> None:
    motion = axis(f"{1e3 * pitch} mm").motion
    turns = np.array([0.3, -1.0, 3.6, 12.25])
    moved = motion.move(joints={("bearing", "rz"): 2 * pi * turns})
    assert moved.reached.all()
    place = moved.tool
    assert place is not None
    # the nut does not turn: by each turn of the screw it comes nearer to a right-handed one's end
    np.testing.assert_allclose(place.position[:, 0] - 0.3, -pitch * turns, atol=1e-12)
    np.testing.assert_allclose(moved.coordinate("nut", "rz"), -2 * pi * turns, atol=1e-9)
    back = motion.move(task={"x": place.position[:, 0]})
    assert back.reached.all()
    np.testing.assert_allclose(back.coordinate("bearing", "rz"), 2 * pi * turns, atol=1e-8)


@pytest.mark.parametrize("method", ["saddle_point", "null_space", None])
def test_a_soft_drive_is_soft_along_the_screw(method: Any) -> None:
    """k_axial = k_torsion (2 pi / p)^2."""
    torsion = 2000.0
    model = axis(drive=f'stiffness = {{ rz = "{torsion} N m/rad" }}')
    compliance = tool_compliance(model.placed, method)
    assert compliance[0, 0] == pytest.approx((PITCH / (2 * pi)) ** 2 / torsion, rel=1e-10)
    assert np.abs(np.delete(np.delete(compliance, 0, 0), 0, 1)).max() <= 1e-12 * compliance[0, 0]


def test_table_and_screw_vibrate_together() -> None:
    torsion = 2000.0
    model = axis(drive=f'stiffness = {{ rz = "{torsion} N m/rad" }}')
    lead = PITCH / (2 * pi)
    wanted = np.sqrt(torsion / (TURNING + TABLE * lead**2)) / (2 * pi)
    assert modes(model.placed, 1).frequencies[0] == pytest.approx(wanted, rel=1e-10)


def test_the_drive_feels_the_table_by_its_lead() -> None:
    model = axis()
    masses = body_masses(model.structure.at(model.placement))
    dynamics = Dynamics(model.motion, masses, Coordinates((), (("bearing", "rz"),)))
    at = dynamics.at(model.motion.move(joints={("bearing", "rz"): np.array([0.0, 7.0])}))
    lead = PITCH / (2 * pi)
    np.testing.assert_allclose(at.mass[:, 0, 0], TURNING + TABLE * lead**2, rtol=1e-10)
    # straight and even: nothing changes along the way
    np.testing.assert_allclose(at.coriolis([[50.0]]), 0.0, atol=1e-10)


def test_a_force_along_the_table_is_a_moment_at_the_bearing() -> None:
    model = parse_model(
        AXIS.replace("PITCH", "10 mm").replace("DRIVE", "")
        + '[[loads]]\ncase = "push"\nnode = "tcp"\nforce = [1000, 0, 0]\n'
    )
    solution = solve(model.placed, model.cases)
    for name in ("bearing", "nut"):
        force = np.asarray(solution.joint_force(name, "push"))
        assert abs(float(force[5])) == pytest.approx(1000 * PITCH / (2 * pi), rel=1e-9)
        assert abs(float(force[2])) == pytest.approx(1000.0, rel=1e-9)


def differential(first: float, second: float) -> Motion:
    """A rod with two threads between the ground and a nut that a guide keeps from turning."""
    nodes = ("g1", "r1", "r2", "n", "g2", "s")
    linkage = Linkage(
        nodes,
        (Body("ground", ("g1", "g2")), Body("rod", ("r1", "r2")), Body("nut", ("n", "s"))),
        (
            Joint("fixed thread", "helical", ("g1", "r1"), pitch=first),
            Joint("moving thread", "helical", ("r2", "n"), pitch=second),
            Joint("guide", "prismatic", ("g2", "s")),
        ),
        "n",
    )
    positions = np.repeat([[0, 0, 0], [0, 0, 0.1], [0.05, 0, 0.1]], 2, axis=0)
    placement = Placement(positions, np.tile(np.eye(3), (3, 1, 1)), np.zeros(0))
    return Motion(linkage, placement)


def test_a_differential_screw_moves_by_the_difference() -> None:
    motion = differential(0.005, 0.004)
    turns = np.array([1.0, -6.5])
    moved = motion.move(joints={("fixed thread", "rz"): 2 * pi * turns})
    assert moved.reached.all()
    assert moved.tool is not None
    np.testing.assert_allclose(moved.tool.position[:, 2] - 0.1, 0.001 * turns, atol=1e-12)
    # of equal threads the nut stands still
    still = differential(0.005, 0.005).move(joints={("fixed thread", "rz"): 2 * pi * turns})
    assert still.tool is not None
    np.testing.assert_allclose(still.tool.position[:, 2], 0.1, atol=1e-12)


def test_the_row_does_no_work() -> None:
    """Forces through it: a push along and the moment about the axis that holds it."""
    motion = differential(0.005, 0.004)
    thread = motion.linkage.joints[0]
    lead = thread.lead
    push = 123.0
    wrench = np.array([0, 0, push, 0, 0, -lead * push])
    twist = np.array([0, 0, lead * 2.0, 0, 0, 2.0])
    assert wrench @ twist == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({}, "helical with the pitch None"),
        ({"pitch": 0.0}, "pitch 0.0"),
        ({"pitch": float("nan")}, "pitch nan"),
        ({"pitch": 0.01, "driven": ("z",)}, "z follows rz"),
        ({"pitch": 0.01, "stiffness": {"z": 1e6}}, "z follows rz"),
        ({"pitch": 0.01, "limits": {"z": (0.0, 1.0)}}, "z follows rz"),
    ],
)
def test_bad_screws_are_named(fields: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        Joint("nut", "helical", ("a", "b"), **fields)


def test_a_pitch_belongs_to_a_screw() -> None:
    with pytest.raises(ModelError, match="revolute and has a pitch"):
        Joint("pin", "revolute", ("a", "b"), pitch=0.01)
    with pytest.raises(ModelError, match="pitch"):
        replace(Joint("nut", "helical", ("a", "b"), pitch=0.01), pitch=None)


def test_a_screw_whose_turn_is_held_by_a_spring_stays() -> None:
    """Elastic directions are held in motion: the screw is a rigid part of what moves."""
    nodes = ("g", "a", "b", "n")
    linkage = Linkage(
        nodes,
        (Body("ground", ("g",)), Body("rod", ("a", "b")), Body("nut", ("n",))),
        (
            Joint("pin", "revolute", ("g", "a")),
            Joint("thread", "helical", ("b", "n"), {"rz": 100.0}, pitch=0.005),
        ),
        "n",
    )
    positions = np.array([[0, 0, 0], [0, 0, 0], [0.2, 0, 0], [0.2, 0, 0]])
    motion = Motion(linkage, Placement(positions, np.tile(np.eye(3), (2, 1, 1)), np.zeros(0)))
    moved = motion.move(joints={("pin", "rz"): [1.0]})
    assert moved.reached.all()
    assert moved.tool is not None
    np.testing.assert_allclose(
        moved.tool.position[0], [0.2 * np.cos(1), 0.2 * np.sin(1), 0], atol=1e-12
    )
