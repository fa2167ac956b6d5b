"""Model files for the tests: a small writer of TOML and a model with one of everything."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

Content = dict[str, Any]
Edit = Callable[[Content], object]

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.toml"))

SAMPLE: Content = {
    "title": "One of everything",
    "gravity": [0, 0, -9.81],
    "materials": {
        "steel": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3, "density": "7850 kg/m^3"}
    },
    "sections": {
        "tube": {"shape": "tube", "outer_diameter": "40 mm", "inner_diameter": "30 mm"},
        "bar": {"shape": "rectangle", "width_y": "20 mm", "height_z": "30 mm"},
    },
    "nodes": {
        "A": [0, 0, 0],
        "B": ["300 mm", 0, 0],
        "C": ["300 mm", 0, 0],
        "D": ["300 mm", "200 mm", "50 mm"],
        "TCP": ["300 mm", "100 mm", "100 mm"],
        "F": ["300 mm", "200 mm", "50 mm"],
        "G": ["600 mm", "200 mm", "50 mm"],
    },
    "beams": [
        {"name": "arm", "from": "A", "to": "B", "material": "steel", "section": "tube"},
        {"name": "strut", "from": "F", "to": "G", "material": "steel", "section": "bar"},
    ],
    "bodies": [{"name": "plate", "nodes": ["C", "D", "TCP"], "mass": "2 kg"}],
    "masses": [{"node": "B", "mass": "0.2 kg"}],
    "joints": [
        {
            "name": "hinge",
            "type": "revolute",
            "between": ["B", "C"],
            "axis": [0, 1, 0],
            "driven": ["rz"],
            "stiffness": {"rz": "2e4 N*m/rad"},
            "damping": {"rz": "3 N*m*s/rad"},
        },
        {
            "name": "mount",
            "type": "bushing",
            "between": ["D", "F"],
            "stiffness": {"x": "30 N/um", "y": "30 N/um", "z": "20 N/um"},
        },
    ],
    "springs": [{"node": "B", "stiffness": {"z": "1 N/um"}}],
    "supports": [{"node": "A", "fixed": "all"}, {"node": "G", "fixed": ["x", "y", "z", "rx"]}],
    "loads": [{"case": "cutting", "node": "TCP", "force": ["100 N", 0, 0]}],
    "line_loads": [{"case": "wind", "beam": "arm", "force": [0, 0, -100]}],
    "settlements": [{"case": "settle", "node": "A", "displacement": {"z": "-1 mm"}}],
    "misfits": [{"case": "assembly", "joint": "hinge", "gap": {"x": "30 um"}}],
    "tool": {"tcp": "TCP"},
    "damping": {"modal_ratio": 0.01},
}


def sample(*edits: Edit) -> Content:
    """The sample, changed by each edit in turn."""
    content = copy.deepcopy(SAMPLE)
    for edit in edits:
        edit(content)
    return content


def put(path: str, value: object) -> Edit:
    """An edit that sets a field, such as "nodes.A" or "beams.0.section"."""

    def edit(content: Content) -> None:
        at: Any = content
        *steps, last = path.split(".")
        for step in steps:
            at = at[int(step)] if isinstance(at, list) else at[step]
        at[int(last) if isinstance(at, list) else last] = value

    return edit


def drop(path: str) -> Edit:
    """An edit that removes a field."""

    def edit(content: Content) -> None:
        at: Any = content
        *steps, last = path.split(".")
        for step in steps:
            at = at[int(step)] if isinstance(at, list) else at[step]
        del at[int(last) if isinstance(at, list) else last]

    return edit


def add(path: str, value: object) -> Edit:
    """An edit that appends to a list of tables."""

    def edit(content: Content) -> None:
        content.setdefault(path, []).append(value)

    return edit


def toml(content: Mapping[str, Any]) -> str:
    """The content as TOML, every table inline."""
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in content.items())


def _value(value: object) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value)


def _key(key: str) -> str:
    return json.dumps(key, ensure_ascii=False)
