"""A rigid shaft in bearings, for tests of their tables and of their equilibrium."""

from __future__ import annotations

from pathlib import Path

from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model

BALLS = """
[bearings.front]
type = "angular_contact"
source = "made up"
balls = 15
ball_diameter = "6.35 mm"
pitch_diameter = "36 mm"
contact_angle = "25 deg"
inner_groove = 0.52
outer_groove = 0.53
arrangement = "back_to_back"
spacing = "12 mm"
preload = "150 N"
"""

ROLLERS = """
[bearings.rear]
type = "cylindrical_rollers"
source = "made up"
rollers = 16
length = "6 mm"
clearance = "-6 um"
"""

#: A rigid shaft in both, and a mass.
SHAFT = """
title = "Shaft"
preload = "cut"

[nodes]
seat = [0, 0, 0]
front = [0, 0, 0]
back = [0, 0, "-120 mm"]
rear = [0, 0, "-120 mm"]
nose = [0, 0, "60 mm"]

[[supports]]
node = "seat"
fixed = "all"

[[supports]]
node = "back"
fixed = "all"

[[bodies]]
name = "shaft"
nodes = ["front", "rear", "nose"]
mass = "3 kg"
center_of_mass = [0, 0, "-30 mm"]
inertia = [[0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.001]]

[[joints]]
name = "balls"
type = "revolute"
between = ["seat", "front"]
bearing = "front"
driven = ["rz"]

[[joints]]
name = "rollers"
type = "cylindrical"
between = ["back", "rear"]
bearing = "rear"

[[loads]]
case = "cut"
node = "nose"
force = ["90 N", "20 N", "-100 N"]

[[loads]]
case = "push"
node = "nose"
force = [0, 0, "-300 N"]

[[loads]]
case = "too much"
node = "nose"
force = [0, 0, "-600 N"]

[tool]
tcp = "nose"
"""


def shaft(*edits: tuple[str, str], folder: Path | None = None) -> Model:
    text = SHAFT + BALLS + ROLLERS
    for old, new in edits:
        assert old in text
        text = text.replace(old, new, 1)
    return parse_model(text, folder=folder)
