"""The planar five-bar: four working modes of a pose, two assembly modes of its drives.

Two cranks and two rods in a plane meet at the tool (working modes: Chablat and Wenger 1998, Working
modes and aspects in fully parallel manipulators, IEEE ICRA). For a place of the tool each knee
lies where a circle about its motor cuts one about the tool: 2 x 2. For two crank angles the tool
lies where two circles about the knees cut: 2. The circles' closed form is the oracle.
"""

from __future__ import annotations

from math import atan2, cos, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement
from strutwork.kinematics.branches import Branches, branches
from strutwork.kinematics.motion import Motion

Array = NDArray[Any]

#: Motors, crank, rod and tool at home, m.
MOTORS = np.array([[-0.1, 0.0], [0.1, 0.0]])
CRANK, ROD = 0.17, 0.23
TOOL = np.array([0.02, 0.25])


def cuts(first: Array, r: float, second: Array, s: float) -> Array:
    """Where two circles in a plane cut, (2, 2)."""
    way = second - first
    d = float(np.hypot(*way))
    along = (r**2 - s**2 + d**2) / (2.0 * d)
    across = np.sqrt(r**2 - along**2)
    unit = way / d
    side = np.array([-unit[1], unit[0]])
    return np.array([first + along * unit + k * across * side for k in (1.0, -1.0)])


def five_bar() -> Motion:
    """Cranks outward of the line from motor to tool."""
    knees = [cuts(MOTORS[0], CRANK, TOOL, ROD)[0], cuts(MOTORS[1], CRANK, TOOL, ROD)[1]]
    nodes, places, bodies, joints = [], [], [], []
    for k, (motor, knee) in enumerate(zip(MOTORS, knees, strict=True), start=1):
        nodes += [f"{n}{k}" for n in ("base", "shaft", "knee", "root", "end")]
        places += [motor, motor, knee, knee, TOOL]
        bodies.append(Body(f"crank{k}", (f"shaft{k}", f"knee{k}")))
        tip = (f"root{k}", f"end{k}", "tool") if k == 1 else (f"root{k}", f"end{k}")
        bodies.append(Body(f"rod{k}", tip))
        joints += [
            Joint(f"motor{k}", "revolute", (f"base{k}", f"shaft{k}"), driven=("rz",)),
            Joint(f"elbow{k}", "revolute", (f"knee{k}", f"root{k}")),
        ]
    joints.append(Joint("tip", "revolute", ("end1", "end2")))
    bodies.append(Body(GROUND, ("base1", "base2")))
    linkage = Linkage((*nodes, "tool"), tuple(bodies), tuple(joints), "tool")
    flat = np.array([*places, TOOL])
    positions = np.concatenate([flat, np.zeros((len(flat), 1))], axis=1)
    frames = np.tile(np.eye(3), (len(joints), 1, 1))
    return Motion(linkage, Placement(positions, frames, np.zeros(0)))


def nodes_of(motion: Motion, found: Branches, name: str) -> Array:
    """A node in all ways, (m, 2)."""
    positions, _, _ = motion.joints.place(found.bodies)
    return np.asarray(positions[:, motion.linkage.node_index[name], :2])


def same(found: Array, expected: Array) -> None:
    """Rows are the same but for their order, to 1e-9 m."""
    assert len(found) == len(expected)
    apart = np.linalg.norm(found[:, None] - expected, axis=-1)
    assert apart.min(axis=1).max() < 1e-9
    assert sorted(apart.argmin(axis=1)) == list(range(len(expected)))


def test_four_working_modes() -> None:
    motion = five_bar()
    where = TOOL + np.array([0.01, -0.02])
    found = branches(motion, task={"x": where[0], "y": where[1]}, starts=100)
    left = cuts(MOTORS[0], CRANK, where, ROD)
    right = cuts(MOTORS[1], CRANK, where, ROD)
    expected = np.array([[*a, *b] for a in left for b in right])
    knees = [nodes_of(motion, found, f"knee{k}") for k in (1, 2)]
    same(np.concatenate(knees, axis=1), expected)


def test_two_assembly_modes_of_each() -> None:
    motion = five_bar()
    turned = {("motor1", "rz"): 0.1, ("motor2", "rz"): -0.05}
    found = branches(motion, joints=turned, starts=100)
    knees = []
    for k, motor in enumerate(MOTORS, start=1):
        home = motion.home.positions[motion.linkage.node_index[f"knee{k}"], :2] - motor
        angle = atan2(home[1], home[0]) + turned[f"motor{k}", "rz"]
        knees.append(motor + CRANK * np.array([cos(angle), sin(angle)]))
    same(nodes_of(motion, found, "tool"), cuts(knees[0], ROD, knees[1], ROD))
