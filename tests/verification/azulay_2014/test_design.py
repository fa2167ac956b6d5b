"""The lightest struts of the proposed machine that keep the stiffness of Table 4.

@article{azulay2014comparative,
  author  = {Azulay, Hay and Mahmoodi, Masih and Zhao, Ray and Mills, James K.
             and Benhabib, Beno},
  title   = {Comparative analysis of a new {3xPPRS} parallel kinematic mechanism},
  journal = {Robotics and Computer-Integrated Manufacturing},
  volume  = {30},
  year    = {2014}
}

The paper chooses one tube, 19/14 mm, and no optimum. The table's means are kept as the machine with
this tube has them here, direction by direction; how near these are to the printed ones stands in
`test_static`. With tubes of 22 mm at most, chosen separately for links and first links, the struts
become 9.5 % lighter with true spherical joints, and 28 % with links clamped in the platform, the
model that the table suggests.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray

from strutwork.machines import Proposed3PPRS
from strutwork.machines.three_legs import TUBE_19_14
from strutwork.msa.sections import tube
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.studies import stiffness_map, summary
from strutwork.studies.design import Design
from strutwork.studies.design_file import read_design
from strutwork.studies.design_gradient import Gradients
from strutwork.studies.design_judged import FEASIBLE
from strutwork.studies.design_store import run_design
from strutwork.studies.design_terms import Constraint, Search
from strutwork.studies.parametric import Parametric
from strutwork.studies.pose_sets import hemisphere_poses

Array = NDArray[np.float64]

FILE = Path(__file__).parents[3] / "examples/studies/struts-design.toml"
LOW, HIGH = np.array([14e-3, 8e-3] * 2), np.array([22e-3, 20e-3] * 2)


def few_points(*, apparent: bool = False) -> Design:
    """The design of the example over 13 check points with four rolls."""
    machine = Proposed3PPRS(first_link_section=TUBE_19_14)
    made = Parametric.of(machine.apparent() if apparent else machine)
    ranges = {"outer": ("14 mm", "22 mm"), "inner": ("8 mm", "20 mm")}
    return Design.of(
        made,
        {
            f"{section}.{side}_diameter": ends
            for section in ("section", "first_link_section")
            for side, ends in ranges.items()
        },
        "mass",
        constraints=[
            Constraint.of(f"mean_blocked_stiffness_{a}", at_least="stated") for a in "xyz"
        ],
        workspace=hemisphere_poses(made, 4e-3, 2, 4, ("revolute",)),
        method="gradient",
        starts=1,
    )


def area(sample: Array) -> Array:
    """Of both tubes, (2,), m²."""
    outer, inner = np.asarray(sample).reshape(2, 2).T
    return np.asarray(np.pi / 4.0 * (outer**2 - inner**2))


def optimum(found: xr.Dataset) -> Array:
    """Tubes of the best machine, (4,), m."""
    row = int(found["front"][0])
    return np.array([float(found[str(name)][row]) for name in found["parameter"].to_numpy()])


def test_no_lighter_tubes_are_as_stiff() -> None:
    """Neither among tubes at random, nor by the multipliers of the optimum."""
    design = few_points()
    found = run_design(design)
    best = optimum(found)
    values = design.judge(best[None]).values[0]
    mass, kept = values[0], np.array([c.at_least for c in design.constraints], dtype=float)
    assert mass < 0.95 * design.stated.values[0, 0]
    assert (values[1:] >= kept).all()
    rng = np.random.default_rng(1)
    shares = np.clip(rng.random((16, 4)), 0.0, 1.0)
    near = np.clip((best + rng.normal(0.0, 3e-4, (24, 4)) - LOW) / (HIGH - LOW), 0.0, 1.0)
    judged = design.judge(design.samples(np.concatenate([shares, near])))
    good = judged.status == FEASIBLE
    assert np.count_nonzero(good) > 3
    assert judged.values[good, 0].min() >= mass * (1.0 - 1e-6)
    # Karush, Kuhn and Tucker: the slope of the mass is a combination of those of active limits
    rates = Gradients(design, (0, 1, 2, 3)).rates(best)
    names = [c.quantity.name for c in design.constraints]
    active = values[1:] < kept * (1.0 + 1e-5)
    assert active.any()
    inside = (best > LOW + 1e-6) & (best < HIGH - 1e-6)
    slopes = np.array([rates[n][:, 0] for n, a in zip(names, active, strict=True) if a])
    aim = rates["mass"][:, 0]
    multipliers, *_ = np.linalg.lstsq(slopes[:, inside].T, aim[inside])
    assert (multipliers > 0.0).all()
    left = aim - multipliers @ slopes
    np.testing.assert_allclose(left[inside], 0.0, atol=1e-3 * np.abs(aim).max())
    # at an upper end more would make it lighter
    assert (left[best >= HIGH - 1e-6] < 0.0).all()


@pytest.mark.slow
def test_the_lightest_struts_of_the_example() -> None:
    design = read_design(FILE)
    found = run_design(design)
    best = optimum(found)
    generation = found["generation"].to_numpy()
    good = found["status"].to_numpy() == FEASIBLE
    masses = found["mass"].to_numpy()
    stated = design.stated.values[0]
    # every start ends at the same mass
    ends = [masses[good & (generation == n)].min() for n in (1, 2, 3)]
    assert ends == pytest.approx([ends[0]] * 3, rel=1e-6)
    # a regression: nobody else has computed it
    assert ends[0] == pytest.approx(0.68517, rel=1e-4)
    assert 1.0 - ends[0] / stated[0] == pytest.approx(0.095, abs=0.001)
    # along z the machine is as stiff as before: what the links carry along themselves decides, so
    # that only the area of their tube is determined
    values = design.judge(best[None]).values[0]
    assert values[3] == pytest.approx(stated[3], rel=1e-6)
    assert (values[1:3] > stated[1:3]).all()
    assert area(best) == pytest.approx([111.76e-6, 155.16e-6], rel=1e-3)
    assert best[2] == pytest.approx(22e-3, rel=1e-9)
    # with the rolls that suit the new tubes, as the table has them
    machine = Proposed3PPRS(section=tube(*best[:2]), first_link_section=tube(*best[2:]))
    mapped = summary(stiffness_map(machine, filters=AS_IN_AZULAY))
    means = [mapped.axis(a).statistics.mean for a in "xyz"]
    assert (np.array(means) >= stated[1:] * (1.0 - 2e-3)).all()
    assert means[0] >= values[1] * (1.0 - 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("apparent", [False, True])
def test_evolution_finds_no_lighter_struts(apparent: bool) -> None:
    design = few_points(apparent=apparent)
    found = run_design(design)
    light = float(found["mass"][found["front"][0]])
    evolved = run_design(replace(design, search=Search(population=24, generations=25, seed=1)))
    other = float(evolved["mass"][evolved["front"][0]])
    assert light * (1.0 - 1e-6) <= other < 1.03 * light
    share = 1.0 - light / float(found["mass"].attrs["stated"])
    # a regression; over all 317 points 9.5 and 28.4 %
    assert share == pytest.approx(0.284 if apparent else 0.095, abs=0.03)
