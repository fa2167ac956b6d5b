"""Tolerances written in another frame lock in the same forces, through the file."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.machines.model_file import parse_model
from strutwork.overconstraint import tool_deviation, worst_case
from strutwork.overconstraint.responses import tolerance_responses
from strutwork.units import LENGTH, quantity
from tests.model_files import Content, toml

Array = NDArray[Any]

RAILS = Path(__file__).parents[2] / "examples" / "06_table_on_two_rails.toml"

#: A surface that tilts, whose length lies askew to everything else.
SURFACE = {
    "name": "surface of rail A",
    "kind": "location",
    "joints": ["block A1", "block A2"],
    "datum": "A1",
    "axis": [0, 0, 1],
    "along": [2, 1, 0],
    "length": "400 mm",
    "width": "60 mm",
    "size": "8 um",
}

coordinate = st.floats(-2.0, 2.0)
turns = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)


def moved(turn: Array, shift: Array) -> Content:
    content: Content = tomllib.loads(RAILS.read_text(encoding="utf-8"))
    content["tolerances"].append(dict(SURFACE))
    for name, place in content["nodes"].items():
        at = turn @ np.array([quantity(v, LENGTH, name) for v in place]) + shift
        content["nodes"][name] = at.tolist()
    for joint in content["joints"]:
        joint["second_axis"] = (turn @ np.array([0.0, 1.0, 0.0])).tolist()
        joint["axis"] = (turn @ np.array([1.0, 0.0, 0.0])).tolist()
    for tolerance in content["tolerances"]:
        for key in {"axis", "along"} & tolerance.keys():
            tolerance[key] = (turn @ np.array(tolerance[key], dtype=float)).tolist()
    return content


def answers(turn: Array, shift: Array) -> tuple[Array, Array, float]:
    """Worst forces, their shares by tolerance, and the tool's largest displacement."""
    model = parse_model(toml(moved(turn, shift)))
    worst = worst_case(tolerance_responses(model.placed, model.tolerances))
    forces = [i for i, q in enumerate(worst.responses.quantities) if q.joint is not None]
    return worst.value[forces], worst.shares[forces], float(tool_deviation(worst).largest)


REFERENCE = answers(np.eye(3), np.zeros(3))


@settings(max_examples=20, deadline=None)
@given(turns, st.tuples(coordinate, coordinate, coordinate))
def test_rotation_and_translation_change_nothing(
    turn: tuple[float, ...], shift: tuple[float, ...]
) -> None:
    forces, shares, tool = answers(Rotation.from_quat(turn).as_matrix(), np.array(shift))
    # bounds are certified to 1e-9, that of the tool to 1e-4
    assert forces == pytest.approx(REFERENCE[0], rel=1e-8, abs=1e-6)
    loaded = REFERENCE[0] > 1.0
    # the worst direction of a force is flat: its place, and so the shares, is known less well
    assert shares[loaded] == pytest.approx(REFERENCE[1][loaded], abs=1e-3)
    assert tool == pytest.approx(REFERENCE[2], rel=2e-4)
