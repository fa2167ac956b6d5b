"""Designs along gradients: the gradients, where the search ends, finished fronts, refusals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.studies.design import Design
from strutwork.studies.design_gradient import Gradients
from strutwork.studies.design_judged import CANNOT_BE, FEASIBLE
from strutwork.studies.design_slsqp import starts
from strutwork.studies.design_store import parts_of, run_design
from strutwork.studies.design_terms import Constraint, Cost, CostOf, Search
from strutwork.studies.parameter import Parameter

pytest.importorskip("pymoo")

MACHINES = Path(__file__).parents[2] / "examples/machines"
RPS = MACHINES / "3-rps.toml"
OUTER, INNER = (f"sections.cylinder.{d}_diameter" for d in ("outer", "inner"))
TUBES = {OUTER: ("50 mm", "80 mm"), INNER: ("20 mm", "60 mm")}
POSES = {"z": [0.66, 0.7]}


def designed(*objectives: str, **options: Any) -> Design:
    given: dict[str, Any] = {"workspace": {}, "method": "gradient", "starts": 1}
    return Design.of(RPS, TUBES, *objectives, **(given | options))


def best(design: Design) -> dict[str, float]:
    found = run_design(design)
    row = int(found["front"][0])
    return {
        str(n): float(found[n][row]) for n in found if found[n].dims == ("machine",) and n != "name"
    } | {OUTER: float(found[OUTER][row]), INNER: float(found[INNER][row])}


def test_gradients_are_those_of_finite_differences() -> None:
    limits = ["mean_stiffness_z", "blocked_stiffness_x", "mass", "first_frequency"]
    design = designed(
        "cost",
        workspace=POSES,
        cost=Cost(1.0, 2.0, (CostOf(OUTER, 3.0, "1 mm"),)),
        constraints=[Constraint.of(name, at_least=0.0) for name in limits],
        method="evolution",
    )
    found = Gradients(design, (0, 1))
    sample = np.array([0.06, 0.035])
    values, rates = found.values(sample), found.rates(sample)
    judged = design.judge(sample[None]).values[0]
    # of both poses where the worst counts
    assert [len(values[n]) for n in ("cost", *limits)] == [1, 1, 2, 1, 1]
    for quantity, value in zip(design.quantities, judged, strict=True):
        assert values[quantity.name].min() == pytest.approx(value, rel=1e-9)
        for i in (0, 1):
            step = np.eye(2)[i] * 2e-6
            above, below = (found.values(sample + s)[quantity.name] for s in (step, -step))
            expected = (above - below) / 4e-6
            assert rates[quantity.name][i] == pytest.approx(expected, rel=1e-5)


def test_the_lightest_machine_is_found_along_gradients() -> None:
    """The best of a fine grid of all machines is no lighter, and nearly as light."""
    design = designed("mass", constraints=[Constraint.of("stiffness_z", at_least="stated")])
    (limit,) = design.constraints
    assert limit.at_least == design.stated.values[0, 1]
    light = best(design)
    assert light["stiffness_z"] >= limit.at_least
    assert light["stiffness_z"] == pytest.approx(limit.at_least, rel=1e-6)
    axis = np.linspace(0.0, 1.0, 13)
    shares = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    judged = design.judge(design.samples(shares))
    good = judged.status == FEASIBLE
    least = judged.values[good, 0].min()
    assert light["mass"] <= least * (1.0 + 1e-9)
    assert light["mass"] == pytest.approx(least, rel=0.05)


def test_the_worst_pose_is_made_as_stiff_as_can_be() -> None:
    """No pose falls below the least, whichever becomes the worst on the way."""
    design = designed(
        "stiffness_x", workspace=POSES, constraints=[Constraint.of("mass", at_most="stated")]
    )
    stiff = best(design)
    assert stiff["mass"] <= float(design.stated.values[0, 1])
    assert stiff["stiffness_x"] > 1.01 * design.stated.values[0, 0]
    axis = np.linspace(0.0, 1.0, 9)
    shares = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    judged = design.judge(design.samples(shares))
    most = judged.values[judged.status == FEASIBLE, 0].max()
    assert most <= stiff["stiffness_x"] * (1.0 + 1e-9)
    assert most == pytest.approx(stiff["stiffness_x"], rel=0.15)


def test_a_front_is_finished_along_gradients() -> None:
    options: dict[str, Any] = {"population": 4, "generations": 1, "seed": 2}
    rough = run_design(designed("stiffness_x", "mass", **options, method="evolution"))
    found = run_design(designed("stiffness_x", "mass", **options, method="both"))
    assert int(found.attrs["generations"]) == 2
    assert "SLSQP" in found.attrs["method"]
    assert "NSGA-II" in found.attrs["method"]
    np.testing.assert_array_equal(found["share"][:4], rough["share"])
    front = rough["front"].to_numpy()
    last = found["generation"].to_numpy() == 2
    assert np.count_nonzero(last) == len(front)
    # no heavier and stiffer, one by one
    assert (found["mass"].to_numpy()[last] <= rough["mass"].to_numpy()[front]).all()
    before = rough["stiffness_x"].to_numpy()[front]
    share = found["stiffness_x"].to_numpy()[last] / before - 1.0
    assert (share >= -1e-6).all()
    assert share.max() > 0.01


def test_machines_that_cannot_be_end_no_search() -> None:
    """Nothing but the machine itself keeps the inner diameter below the outer one."""
    design = Design.of(
        RPS,
        {OUTER: ("50 mm", "80 mm"), INNER: ("20 mm", "79 mm")},
        "mass",
        constraints=[Constraint.of("stiffness_x", at_least="stated")],
        workspace={},
        method="gradient",
        starts=3,
        seed=5,
    )
    found = run_design(design)
    status = found["status"].to_numpy()
    assert (status == CANNOT_BE).any()
    row = int(found["front"][0])
    assert float(found["mass"][row]) < 0.95 * design.stated.values[0, 0]


def test_starts_are_resumed(tmp_path: Path) -> None:
    design = designed(
        "mass", starts=2, constraints=[Constraint.of("stiffness_z", at_least="stated")]
    )
    whole, path = run_design(design), tmp_path / "light.nc"
    first, second = starts(design)
    assert design.samples(first[None])[0] == pytest.approx(design.stated_values)
    assert not np.allclose(first, second)

    def stop(*_: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_design(design, path, told=stop)
    assert len(list(parts_of(design, path).iterdir())) == 1
    counted: list[tuple[int, int]] = []
    found = run_design(
        design, path, resume=True, progress=lambda done, total: counted.append((done, total))
    )
    assert counted == [(0, 2), (1, 2), (2, 2)]
    np.testing.assert_array_equal(found["share"], whole["share"])
    assert not parts_of(design, path).exists()
    again = run_design(design, path, resume=True)
    np.testing.assert_array_equal(again["mass"], whole["mass"])
    # both end at the same machine
    for number in (1, 2):
        ends = found["mass"].to_numpy()[
            (found["generation"].to_numpy() == number) & (found["status"].to_numpy() == FEASIBLE)
        ]
        assert ends.min() == pytest.approx(whole["mass"].to_numpy()[whole["front"][0]], rel=1e-5)


def test_a_log_range_has_its_own_slope() -> None:
    """The result is the same over a range that is divided by ratios."""
    tubes = [Parameter(path, low=low, high=high, log=True) for path, (low, high) in TUBES.items()]
    limit = Constraint.of("stiffness_z", at_least="stated")
    logged = Design.of(
        RPS, tubes, "mass", constraints=[limit], workspace={}, method="gradient", starts=1
    )
    plain = designed("mass", constraints=[limit])
    assert best(logged)["mass"] == pytest.approx(best(plain)["mass"], rel=1e-6)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: designed("reach"), "has no gradient: it counts poses"),
        (lambda: designed("condition"), "what a parameter does to the Jacobian"),
        (lambda: designed("stiffness_z", "mass"), "there are 2."),
        (lambda: designed("mass", method="simplex"), "Methods: evolution, gradient, both"),
        (lambda: designed("mass", starts=0), "has 0 starts"),
        (
            lambda: Design.of(RPS, {OUTER: ["50 mm"]}, "mass", workspace={}, method="gradient"),
            "has a list of values",
        ),
        (
            lambda: Design.of(
                MACHINES / "6-ups.toml",
                {"sections.ram.diameter": ("40 mm", "60 mm")},
                "first_frequency",
                workspace={},
                method="gradient",
            ),
            'the machine vibrates under "preload"',
        ),
    ],
)
def test_what_has_no_gradient_is_refused_with_the_reason(make: Any, message: str) -> None:
    with pytest.raises(ModelError) as caught:
        make()
    assert message in str(caught.value)


def test_a_start_that_cannot_be_is_named() -> None:
    design = Design.of(
        RPS,
        {INNER: ("75 mm", "90 mm")},
        "mass",
        workspace={},
        method="gradient",
        starts=1,
    )
    with pytest.raises(ModelError, match=r"cannot begin: section cylinder: inner_diameter"):
        run_design(design)


def test_rounds_and_settings_of_a_search() -> None:
    assert Search(10, 5).rounds == 5
    assert Search(10, 5, method="both").rounds == 6
    assert Search(method="gradient", starts=4).rounds == 4
    # results of before are known by these
    assert Search(10, 5, 1).settings == {"population": 10, "seed": 1}
