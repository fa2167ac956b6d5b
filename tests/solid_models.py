"""Model files with solids for the tests: a column on a mount that carries an arm."""

from __future__ import annotations

import copy
from pathlib import Path

from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.meshes import Mesh, block, patch
from tests.model_files import Content, Edit, toml

#: A granite column on an elastic, damped mount; an arm on its head carries a mass.
COLUMN: Content = {
    "title": "Column",
    "gravity": [0, 0, -9.81],
    "materials": {
        "granite": {"youngs_modulus": "60 GPa", "poissons_ratio": 0.25, "density": 2900},
        "steel": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3, "density": 7850},
    },
    "sections": {"bar": {"shape": "rectangle", "width_y": "60 mm", "height_z": "40 mm"}},
    "nodes": {
        "ground": ["100 mm", "75 mm", 0],
        "foot": ["100 mm", "75 mm", 0],
        "head": ["100 mm", "75 mm", "600 mm"],
        "tip": ["100 mm", "275 mm", "600 mm"],
    },
    "solids": [
        {
            "name": "column",
            "shape": "block",
            "size": ["200 mm", "150 mm", "600 mm"],
            "cell": "200 mm",
            "material": "granite",
            "modes": 18,
            "interfaces": [
                {"node": "foot", "patch": "-z"},
                {
                    "node": "head",
                    "box": [["50 mm", "50 mm", "600 mm"], ["150 mm", "100 mm", "600 mm"]],
                    "kind": "rigid",
                },
            ],
        }
    ],
    "beams": [
        {
            "name": "arm",
            "from": "head",
            "to": "tip",
            "material": "steel",
            "section": "bar",
            "orientation": [0, 0, 1],
        }
    ],
    "masses": [{"node": "tip", "mass": "5 kg"}],
    "joints": [
        {
            "name": "mount",
            "type": "bushing",
            "between": ["ground", "foot"],
            "axis": [0, 0, 1],
            "second_axis": [1, 0, 0],
            "stiffness": {
                **dict.fromkeys("xy", "30 N/um"),
                "z": "80 N/um",
                **dict.fromkeys(("rx", "ry", "rz"), "1e6 N*m/rad"),
            },
            "damping": {"x": 3e3, "y": 2e3, "z": 5e3},
        }
    ],
    "supports": [{"node": "ground", "fixed": "all"}],
    "loads": [{"case": "cutting", "node": "tip", "force": [100, 50, -200], "moment": [3, 0, 1]}],
    "tool": {"tcp": "tip"},
    "damping": {"rayleigh": {"alpha": 8.0, "beta": 2e-6}},
}


def column(*edits: Edit) -> Content:
    """The column, changed by each edit in turn."""
    content = copy.deepcopy(COLUMN)
    for edit in edits:
        edit(content)
    return content


def model_of(*edits: Edit, folder: Path | None = None) -> Model:
    return parse_model(toml(column(*edits)), folder=folder)


def from_file(name: str, **changes: object) -> Edit:
    """The column's shape from a file in place of a block."""

    def edit(content: Content) -> None:
        solid = content["solids"][0]
        for key in ("shape", "size", "cell"):
            solid.pop(key)
        solid |= {"mesh": name, **changes}
        solid["interfaces"][1] |= {"kind": "average"}

    return edit


def brick(divisions: tuple[int, int, int] = (2, 2, 6)) -> Mesh:
    mesh = block((0.2, 0.15, 0.6), divisions, name="brick")
    return patch(mesh, "head", (0.0, 0.0, 0.6), (0.2, 0.15, 0.6))
