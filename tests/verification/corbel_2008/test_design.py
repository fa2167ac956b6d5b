"""Rods and rails of the linear Delta, chosen by the design engine (section III).

@inproceedings{corbel2008,
  author    = {Corbel, D. and Company, O. and Pierrot, F.},
  title     = {Optimal design of a 6-dof parallel measurement mechanism integrated in a 3-dof
               parallel machine-tool},
  booktitle = {IEEE/RSJ International Conference on Intelligent Robots and Systems},
  year      = {2008}
}

The document chooses ΔR = 480 mm for rods of 800 mm by the condition number over a square of 300 mm
and prints no number. The formula beside which the engine is held is its eqs. 2 to 4: row i of the
inverse Jacobian is (a_i/h_i, 1), with h_i = √(L² − |a_i|²).
"""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.linear_delta import OUTWARD, LinearDelta
from strutwork.papers.corbel_2008.actuation import best_reach
from strutwork.studies.design import Design
from strutwork.studies.design_file import read_design
from strutwork.studies.design_judged import FEASIBLE, OUTSIDE
from strutwork.studies.design_store import run_design

FILE = Path(__file__).parents[3] / "examples/studies/delta-design.toml"
#: Radius of the joints on the platform, m: the rails stand ΔR farther out.
PLATFORM = LinearDelta().platform_radius
PRINTED = 0.480
LINE = np.linspace(-0.15, 0.15, 3)


def by_formula(rod: float, reach: float) -> NDArray[np.float64]:
    """Largest condition, least and largest singular value of the Jacobian over the square."""
    found = []
    for x, y in product(LINE, LINE):
        across = np.array([x, y]) - reach * OUTWARD[:, :2]
        height = np.sqrt(rod**2 - (across**2).sum(axis=1))
        rows = np.hstack([across / height[:, None], np.ones((3, 1))])
        found.append(np.linalg.svd(np.linalg.inv(rows), compute_uv=False))
    values = np.array(found)
    return np.array([(values[:, 0] / values[:, 2]).max(), values.min(), values.max()])


def one_length() -> Design:
    return Design.of(
        "linear-delta",
        {"base_radius": ("440 mm", "640 mm")},
        "condition",
        workspace=TaskGrid({"x": LINE, "y": LINE}),
        population=6,
        generations=9,
        seed=1,
    )


def test_the_engine_judges_as_the_formula() -> None:
    design = read_design(FILE)
    lengths = np.array([[0.8, PLATFORM + PRINTED], [0.7, PLATFORM + 0.4], [1.0, PLATFORM + 0.3]])
    judged = design.judge(lengths)
    names = [q.name for q in design.quantities]
    columns = [
        names.index(n) for n in ("condition", "least_amplification", "largest_amplification")
    ]
    expected = np.array([by_formula(rod, rails - PLATFORM) for rod, rails in lengths])
    np.testing.assert_allclose(judged.values[:, columns], expected, rtol=1e-9)
    # the printed dimensions keep bounds of 1/3 and 3; short reaches move the tool too fast
    kept = (expected[:, 1] >= 1.0 / 3.0) & (expected[:, 2] <= 3.0)
    assert judged.status.tolist() == [FEASIBLE if k else OUTSIDE for k in kept]
    assert kept[0]


@pytest.mark.slow
def test_the_engine_finds_the_best_reach() -> None:
    """ΔR = 487 mm; the printed 480 mm are as good to 0.2 %."""
    best = best_reach(0.8)
    found = run_design(one_length())
    row = found["front"][0]
    # of 54 machines over 200 mm the best is this near to a bounded search; the optimum is flat
    assert float(found["base_radius"][row]) - PLATFORM == pytest.approx(best.reach, abs=2e-3)
    assert float(found["condition"][row]) == pytest.approx(best.worst, rel=1e-3)
    stated = float(found["condition"].attrs["stated"])
    assert 1.0 <= stated / best.worst < 1.002


@pytest.mark.slow
def test_long_rods_are_even_and_heavy() -> None:
    """Section III-B: a compromise between performance and size."""
    found = run_design(read_design(FILE))
    front = found["front"].to_numpy()
    assert len(front) > 5
    mass, condition = (found[n].to_numpy()[front] for n in ("mass", "condition"))
    rods = found["rods"].to_numpy()[front]
    # the most even first
    assert (np.diff(condition) > 0.0).all()
    assert (np.diff(mass) < 0.0).all()
    assert (np.diff(rods) < 1e-9).all()
    for row in front:
        rod, rails = float(found["rods"][row]), float(found["rails"][row])
        assert float(found["condition"][row]) == pytest.approx(
            by_formula(rod, rails - PLATFORM)[0], rel=1e-9
        )
        # no reach makes machines of these rods much more even
        assert float(found["condition"][row]) <= 1.1 * best_reach(rod).worst
