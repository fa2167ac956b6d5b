"""A machine with a mesh in its way, whose workspace is known in closed form."""

from __future__ import annotations

from math import pi
from pathlib import Path

import trimesh

#: An arm on two crossed slides beside a post, both upright and 20 mm thick.
TEXT = """
title = "Arm beside a post"

[materials.steel]
youngs_modulus = "205 GPa"
poissons_ratio = 0.29

[sections.rod]
shape = "rod"
diameter = "20 mm"

[nodes]
G = [0, 0, 0]
X0 = [0, 0, 0]
X1 = [0, 0, "100 mm"]
Y0 = [0, 0, "100 mm"]
T = [0, 0, "300 mm"]
P0 = ["100 mm", 0, "50 mm"]
P1 = ["100 mm", 0, "350 mm"]

[[bodies]]
name = "slide"
nodes = ["X0", "X1"]

[[beams]]
name = "arm"
from = "Y0"
to = "T"
material = "steel"
section = "rod"

[[beams]]
name = "post"
from = "P0"
to = "P1"
material = "steel"
section = "rod"

[[joints]]
name = "x"
type = "prismatic"
between = ["G", "X0"]
axis = [1, 0, 0]
driven = ["z"]

[[joints]]
name = "y"
type = "prismatic"
between = ["X1", "Y0"]
axis = [0, 1, 0]
driven = ["z"]

[[supports]]
node = "G"
fixed = "all"

[[supports]]
node = "P0"
fixed = "all"

[tool]
tcp = "T"

[task]
directions = ["x", "y"]

[workspace]
x = { from = "-100 mm", to = "200 mm", points = 5 }
y = { from = "-100 mm", to = "100 mm", points = 5 }
"""

SHAPE = """
[[shapes]]
body = "post"
surface = "post.stl"
unit = "mm"
position = ["100 mm", 0, "200 mm"]
"""

#: Sides of the post's mesh, mm, and what two rods and a rod and this mesh keep free, m².
SIDES = (60.0, 40.0, 300.0)
RODS = pi * 0.02**2
MESH = 0.06 * 0.04 + 2 * (0.06 + 0.04) * 0.01 + pi * 0.01**2
WHOLE = 0.3 * 0.2


def written(folder: Path, text: str = TEXT + SHAPE, sides: tuple[float, ...] = SIDES) -> Path:
    trimesh.creation.box(sides).export(folder / "post.stl")
    path = folder / "arm.toml"
    path.write_text(text)
    return path
