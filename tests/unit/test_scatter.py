"""Scatter of numbers and what comes of it: against closed forms, and gradients of small scatter."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

from strutwork.errors import ModelError
from strutwork.studies.dimension import Dimension
from strutwork.studies.gradient import gradient
from strutwork.studies.parameter import Parameter
from strutwork.studies.parametric import Parametric
from strutwork.studies.sample import Sample
from strutwork.studies.scatter import scatter
from strutwork.studies.study import Study

HEXAPOD = Path(__file__).parents[2] / "examples/machines/6-ups.toml"
BALLS = "joints.ball*.stiffness.*"

#: A mass on a spring along z: stiffness k and frequency sqrt(k/m)/2 pi in closed form.
SPRING = """
title = "mass on a spring"
[nodes]
A = [0, 0, 0]
T = [0, 0, 0]
[tool]
tcp = "T"
[[supports]]
node = "A"
fixed = "all"
[[masses]]
node = "T"
mass = 50
inertia = [1, 1, 1]
[[joints]]
name = "spring"
type = "bushing"
between = ["A", "T"]
stiffness = { x = 8e8, y = 9e8, z = 2e8, rx = 1e8, ry = 1e8, rz = 1e8 }
"""
K, M = 2e8, 50.0


def of_spring(count: int = 100, **law: Any) -> Study:
    parameter = Parameter("joints.spring.stiffness.z", **law)
    return Study.of(SPRING, [parameter], "stiffness", "vibration", count=count, workspace={})


def test_a_spring_scatters_as_its_closed_form() -> None:
    """Stiffness is the number itself, the first frequency its root."""
    found = of_spring(distribution="lognormal", scatter="20 %").run(workers=1)
    k = found["joints.spring.stiffness.z"].to_numpy()
    stiffness = found.sel(answer="stiffness_free_home z")
    assert float(stiffness["scatter_mean"]) == pytest.approx(k.mean(), rel=1e-12)
    assert float(stiffness["scatter_standard_deviation"]) == pytest.approx(k.std(ddof=1), rel=1e-9)
    assert float(stiffness["scatter_at_mean"]) == pytest.approx(K, rel=1e-12)
    assert str(stiffness["answer_unit"].item()) == "N/m"
    # the frequency of a lognormal stiffness is lognormal, its quantiles the roots of the others
    frequency = found.sel(answer="natural_frequency_home 1")
    law = stats.lognorm(np.sqrt(np.log(1.04)), scale=K / np.sqrt(1.04))
    exact = np.sqrt(law.ppf([0.05, 0.5, 0.95]) / M) / (2 * np.pi)
    low, high = frequency["scatter_quantile_interval"].to_numpy().T
    assert ((low <= exact) & (exact <= high)).all()
    mean = np.sqrt(K / M) / (2 * np.pi) * np.exp(-np.log(1.04) / 8)
    low, high = frequency["scatter_mean_interval"].to_numpy()
    assert abs((low + high) / 2 - mean) < 1.53 * (high - low) / 2
    assert int(frequency["scatter_machines"]) == 100


@pytest.mark.parametrize(
    ("law", "mean", "deviation", "ends"),
    [
        ({"distribution": "normal", "scatter": "10 %"}, K, 0.1 * K, (-np.inf, np.inf)),
        ({"distribution": "normal", "scatter": "20 N/um"}, K, 2e7, (-np.inf, np.inf)),
        ({"distribution": "uniform", "scatter": "20 %"}, K, 0.4 * K / 12**0.5, (1.6e8, 2.4e8)),
        ({"distribution": "uniform", "low": 1e8, "high": 4e8}, 2.5e8, 3e8 / 12**0.5, (1e8, 4e8)),
        ({"distribution": "lognormal", "scatter": "50 %", "mean": 1e8}, 1e8, 5e7, (0, np.inf)),
        (
            {"distribution": "truncated", "scatter": "10 %"},
            K,
            stats.truncnorm(-3, 3).std() * 0.1 * K,
            (1.4e8, 2.6e8),
        ),
        ({"distribution": "normal", "scatter": "10 %", "relative": True}, 1.0, 0.1, (-9, 9)),
    ],
)
def test_values_have_the_stated_distribution(
    law: dict[str, Any], mean: float, deviation: float, ends: tuple[float, float]
) -> None:
    values = of_spring(20_000, **law).drawn.values[:, 0]
    assert values.mean() == pytest.approx(mean, abs=4 * deviation / 20_000**0.5)
    assert values.std() == pytest.approx(deviation, rel=0.05)
    assert ends[0] <= values.min()
    assert values.max() <= ends[1]


def test_small_scatter_of_bearings_propagates_by_gradients() -> None:
    """The variance is the sum of those of each joint, to first order."""
    share = 0.01
    parameter = Parameter(BALLS, distribution="normal", scatter="1 %", independent=True)
    study = Study.of(HEXAPOD, [parameter], "stiffness", count=96, workspace={})
    assert [v.name for v in study.varied] == [f"joints.ball{i}.stiffness.*" for i in range(1, 7)]
    assert {len(v.numbers) for v in study.varied} == {3}
    found = study.run(workers=1)
    machine = Parametric.of(HEXAPOD)
    joints = [Dimension.of(machine, v.name) for v in study.varied]
    slopes = gradient(machine.model, joints, ["stiffness_x", "stiffness_z"])["gradient"].to_numpy()
    scatters = share * np.array([j.value for j in joints])
    exact = np.sqrt(((slopes[..., 0] * scatters) ** 2).sum(axis=1))
    one = found.sel(answer=["stiffness_free_home x", "stiffness_free_home z"])
    deviation = one["scatter_standard_deviation"].to_numpy()
    # a deviation of 96 machines is known to 1 / sqrt(2 n) = 7.2 %
    assert deviation == pytest.approx(exact, rel=0.2)
    # of the machines that were drawn it is that of the linear prediction, but for the curvature
    linear = (study.drawn.values - [j.value for j in joints]) @ slopes[..., 0].T
    assert deviation == pytest.approx(linear.std(axis=0, ddof=1), rel=0.02)
    means = one["scatter_mean"].to_numpy()
    assert means == pytest.approx(one["scatter_at_mean"].to_numpy(), rel=2e-3)


def test_bearings_together_scatter_more_than_each_by_itself() -> None:
    together = Parameter(BALLS, distribution="normal", scatter="5 %")
    apart = Parameter(BALLS, distribution="normal", scatter="5 %", independent=True)
    found = [
        Study.of(HEXAPOD, [p], "stiffness", count=24, workspace={})
        .run(workers=1)
        .sel(answer="stiffness_free_home z")["scatter_standard_deviation"]
        for p in (together, apart)
    ]
    # six equal springs in parallel: root of six
    assert float(found[0] / found[1]) == pytest.approx(6**0.5, rel=0.5)


def test_intervals_hold_what_they_promise_and_stay_open_for_few_machines() -> None:
    rng = np.random.default_rng(2)
    hits = np.zeros(3)
    for _ in range(200):
        found = scatter(rng.normal(size=120))
        exact = stats.norm.ppf([0.05, 0.5, 0.95])
        low, high = found.quantile_intervals.T
        hits += (low <= exact) & (exact <= high)
    assert (hits >= 180).all()
    few = scatter(np.array([1.0, 2.0, np.nan, 3.0, 4.0]))
    assert few.count == 4
    assert np.isnan(few.quantile_intervals).sum() >= 4
    assert np.isnan(scatter(np.array([1.0, 2.0])).mean)


def test_blocks_give_scatter_and_indices_at_once() -> None:
    """Scatter is of those machines that are independent of one another."""
    pytest.importorskip("SALib")
    parameters = [
        Parameter(f"joints.spring.stiffness.{d}", distribution="uniform", scatter="10 %")
        for d in "xz"
    ]
    study = Study.of(SPRING, parameters, sample=Sample("saltelli", 16), workspace={})
    found = study.run(workers=1)
    assert int(found.sel(answer="stiffness_free_home z")["scatter_machines"]) == 32
    total = found.sel(answer="stiffness_free_home z")["sobol_total"].to_numpy()
    assert total == pytest.approx([0.0, 1.0], abs=0.4)


@pytest.mark.parametrize(
    ("law", "message"),
    [
        ({"distribution": "gauss", "scatter": 1.0}, 'unknown distribution "gauss"'),
        ({"distribution": "normal"}, "without scatter"),
        ({"distribution": "normal", "scatter": "-5 %"}, "has the scatter -5 %"),
        ({"distribution": "normal", "scatter": "3 mm"}, "stiffness"),
        ({"distribution": "normal", "scatter": "60 %"}, "more than one percent of its values"),
        ({"distribution": "uniform", "scatter": "120 %"}, "reaches -4e"),
        ({"distribution": "normal", "scatter": 1.0, "low": 1.0, "high": 2.0}, "truncated"),
        ({"distribution": "uniform", "scatter": 1.0, "low": 1.0, "high": 2.0}, "beside a mean"),
        ({"distribution": "uniform", "low": 3.0, "high": 2.0}, "lower end first"),
        ({"distribution": "normal", "scatter": "5 %", "values": [1.0]}, "has values beside"),
        ({"scatter": "5 %"}, "without a distribution"),
        (
            {"distribution": "truncated", "scatter": 1.0, "low": 1.0, "high": 2.0},
            "six standard deviations",
        ),
    ],
)
def test_a_distribution_that_cannot_be_is_refused(law: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        of_spring(8, **law)


def test_distributions_need_points_and_numbers_of_one_value() -> None:
    law: dict[str, Any] = {"distribution": "normal", "scatter": "5 %"}
    parameter = Parameter("joints.spring.stiffness.z", **law)
    with pytest.raises(ModelError, match="has a distribution, and the sample is a grid"):
        Study.of(SPRING, [parameter], sample="grid")
    with pytest.raises(ModelError, match=r"sample\.count: is missing"):
        Study.of(SPRING, [parameter])
    several = Parameter(
        ["joints.spring.stiffness.x", "joints.spring.stiffness.z"],
        distribution="normal",
        scatter="3 N/um",
    )
    with pytest.raises(ModelError, match="of different values together"):
        Study.of(SPRING, [several], count=8)
    shares = Parameter(several.path, **law)
    study = Study.of(SPRING, [shares], count=8)
    assert study.varied[0].relative
    assert study.varied[0].changes(1.1) == pytest.approx(
        {"joints.spring.stiffness.x": 8.8e8, "joints.spring.stiffness.z": 2.2e8}
    )
