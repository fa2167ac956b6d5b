"""Legs of the biglide for a prescribed square, chosen by the design engine (section 3.3).

@inproceedings{chablat2003,
  author    = {Chablat, Damien and Wenger, Philippe and Majou, F{\'e}lix},
  title     = {The Optimal Design of Three Degree-of-Freedom Parallel Mechanisms for Machining
               Applications},
  booktitle = {International Conference on Advanced Robotics},
  year      = {2003}
}

The document takes legs of length one and seeks the largest square within 1/3 and 3; the engine is
given the square and seeks the shortest legs. Both are the same ratio: with legs of one the largest
squares have 16/13 m² along the rails and 128/73 m² at 45° (exact). The printed areas of 0.62 and
0.89 m² are about half of these, so that legs of 0.71 m suffice for them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.machines.biglide import Biglide
from strutwork.papers.chablat_2003.published import HIGH, LOW, SQUARES
from strutwork.studies.design import Design
from strutwork.studies.design_file import read_design
from strutwork.studies.design_judged import FEASIBLE, OUTSIDE
from strutwork.studies.design_store import run_design
from strutwork.studies.design_terms import Constraint
from strutwork.studies.pose_sets import TaskList

FILE = Path(__file__).parents[3] / "examples/studies/biglide-design.toml"

#: Area of the largest square for legs of one, m², by the angle of its sides to the rails: exact.
AREAS = {0.0: 16.0 / 13.0, 45.0: 128.0 / 73.0}
PRINTED = dict(zip((45.0, 0.0), (v.value for v in SQUARES), strict=True))


def corners(area: float, angle: float) -> TaskList:
    """Of a square about S, and S itself: the corners are where the bounds are met first."""
    turn = np.radians(angle + 45.0 + 90.0 * np.arange(4))
    reach = np.sqrt(area / 2.0)
    x, y = (np.append(reach * f(turn), 0.0) for f in (np.cos, np.sin))
    return TaskList({"x": x, "y": y})


def shortest(area: float, angle: float) -> Design:
    limits = [
        Constraint.of("least_amplification", at_least=LOW),
        Constraint.of("largest_amplification", at_most=HIGH),
    ]
    return Design.of(
        "biglide",
        {"leg_length": ("0.4 m", "2 m")},
        "mass",
        constraints=limits,
        workspace=corners(area, angle),
    )


@pytest.mark.parametrize("angle", AREAS)
def test_legs_of_one_are_the_shortest_for_the_exact_squares(angle: float) -> None:
    design = shortest(AREAS[angle], angle)
    judged = design.judge(np.array([[1.0 - 1e-6], [1.0 + 1e-6]]))
    assert judged.status.tolist() == [OUTSIDE, FEASIBLE]
    assert judged.values[0, 0] < judged.values[1, 0]
    assert judged.values[1, 2] == pytest.approx(HIGH, rel=1e-5)


@pytest.mark.parametrize("angle", AREAS)
def test_the_printed_squares_need_legs_of_seven_tenths(angle: float) -> None:
    """The printed areas are about half of what legs of one allow: not reproducible."""
    length = np.sqrt(PRINTED[angle] / AREAS[angle])
    assert length == pytest.approx(np.sqrt(0.5), rel=0.01)
    judged = shortest(PRINTED[angle], angle).judge(length * np.array([[1.0 - 1e-6], [1.0 + 1e-6]]))
    assert judged.status.tolist() == [OUTSIDE, FEASIBLE]


@pytest.mark.slow
def test_the_design_of_the_example() -> None:
    design = read_design(FILE)
    found = run_design(design)
    length = float(found["legs"][found["front"][0]])
    exact = 1.2 / np.sqrt(AREAS[0.0])
    # of 96 machines over 0.7 m the best stands within 0.2 % of the exact length, on its long side
    assert exact <= length <= 1.002 * exact
    # the bounds hold inside the square as on its border
    axis = np.linspace(-0.6, 0.6, 25)
    x, y = (g.ravel() for g in np.meshgrid(axis, axis))
    inside = Design.of(
        Biglide(leg_length=length),
        {"leg_length": ("0.9 m", "1.6 m")},
        "least_amplification",
        "largest_amplification",
        workspace=TaskList({"x": x, "y": y}),
    )
    least, largest = inside.stated.values[0]
    assert least >= LOW
    assert largest <= HIGH
