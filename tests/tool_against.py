"""A machine whose table gives way: a column with the tool, and a table on its own base."""

from __future__ import annotations

from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model

PARTS = """
title = "Column and table"

[materials.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"

[sections.bar]
shape = "rod"
diameter = "60 mm"

[nodes]
foot = ["0 mm", "0 mm", "0 mm"]
head = ["0 mm", "0 mm", "500 mm"]
quill = ["0 mm", "0 mm", "500 mm"]
tip = ["200 mm", "30 mm", "450 mm"]
base = ["300 mm", "0 mm", "0 mm"]
table = ["300 mm", "0 mm", "300 mm"]
at_tip = ["200 mm", "30 mm", "450 mm"]

[[beams]]
name = "column"
from = "foot"
to = "head"
material = "steel"
section = "bar"
elements = 2

[[beams]]
name = "pillar"
from = "base"
to = "table"
material = "steel"
section = "bar"
elements = 2

[[bodies]]
name = "arm"
nodes = ["quill", "tip"]

[[bodies]]
name = "plate"
nodes = ["table", "at_tip"]

[[joints]]
name = "slide"
type = "prismatic"
between = ["head", "quill"]
axis = [1, 0, 0]
second_axis = [0, 0, 1]
driven = ["z"]
limits = { z = ["-200 mm", "200 mm"] }

[joints.stiffness]
z = "40 N/um"
x = "300 N/um"
y = "300 N/um"
rx = "1e5 N*m/rad"
ry = "1e5 N*m/rad"
rz = "1e5 N*m/rad"

[damping]
modal_ratio = 0.02

[[masses]]
node = "tip"
mass = "5 kg"

[[masses]]
node = "at_tip"
mass = "20 kg"
"""

#: What holds the column and the table.
SUPPORTS = """
[[supports]]
node = "foot"
fixed = "all"

[[supports]]
node = "base"
fixed = "all"
"""

#: One stiff bed below both, on nothing: only relative motion has a stiffness.
FLOATING = """
[[bodies]]
name = "bed"
nodes = ["foot", "base"]
"""


def column_and_table(against: str | None, tcp: str = "tip", held: str = SUPPORTS) -> Model:
    """The machine with its tool at a node, relative to another or the ground."""
    return parse_model(column_text(against, tcp, held), "column.toml")


def column_text(against: str | None, tcp: str = "tip", held: str = SUPPORTS) -> str:
    """Its model file."""
    work = "" if against is None else f'against = "{against}"\n'
    task = '\n[task]\ndirections = ["x"]\n' if tcp == "tip" else ""
    return f'{PARTS}{held}\n[tool]\ntcp = "{tcp}"\n{work}{task}'
