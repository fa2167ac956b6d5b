from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog, minimize

from strutwork.errors import ModelError
from strutwork.overconstraint import (
    Responses,
    Tolerance,
    allocate,
    distribution,
    tolerance_responses,
    worst_case,
)
from strutwork.overconstraint.distribution import SEED
from strutwork.overconstraint.least_cost import cost_bound, least_cost, sizes_for
from strutwork.overconstraint.sampled_zones import SampledZones
from strutwork.overconstraint.scaled_zones import ScaledZones, by_parameter, scaled
from tests.random_zones import random_responses
from tests.three_struts import LIMITS, case, one_of_each, three_struts, tilted_axes


def all_limits(responses: Responses, share: float) -> dict[tuple[str | None, str], float]:
    """A share of each joint quantity's own worst case."""
    worst = worst_case(responses).value
    return {
        (q.joint, q.kind): share * float(worst[i])
        for i, q in enumerate(responses.quantities)
        if q.joint is not None
    }


def test_one_factor_is_the_least_of_limit_over_force() -> None:
    responses = case()
    found = allocate(responses, LIMITS)
    worst = worst_case(responses)
    ratio = min(value / worst.value[responses.index(*key)] for key, value in LIMITS.items())
    assert found.scale == pytest.approx(ratio, rel=1e-9)
    assert found.utilisation.max() == pytest.approx(1, abs=1e-9)
    assert found.active == ("joint5 radial force",)


def test_allocated_tolerances_built_anew_keep_their_limits() -> None:
    for objective in ("uniform", "cost"):
        found = allocate(case(one_of_each()), LIMITS, objective)
        again = worst_case(tolerance_responses(three_struts(), found.tolerances))
        use = [again.value[again.responses.index(*key)] / value for key, value in LIMITS.items()]
        assert max(use) == pytest.approx(1, abs=2e-9)
        assert found.gap is not None
        assert found.gap < 1e-6


def test_middles_of_zones_are_counted() -> None:
    responses = case(one_of_each())
    found = allocate(responses, LIMITS)
    ratio = min(
        value / worst_case(responses).value[responses.index(*key)] for key, value in LIMITS.items()
    )
    # the middle of the spacer's limits does not shrink with the factor
    assert found.scale[0] != pytest.approx(ratio, rel=1e-3)
    assert found.utilisation.max() == pytest.approx(1, abs=1e-9)


def test_a_larger_factor_breaks_a_limit() -> None:
    responses = case(one_of_each())
    found = allocate(responses, LIMITS)
    more = worst_case(scaled(responses, found.scale * (1 + 1e-6)))
    assert any(more.value[responses.index(*key)] > value for key, value in LIMITS.items())


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("middle", [0.0, 0.5])
def test_least_cost_is_that_of_slsqp(seed: int, middle: float) -> None:
    rng = np.random.default_rng(seed)
    responses = random_responses(rng, 4, 5, middle)
    limits = all_limits(responses, 0.9)
    costs = {f"t{i}": float(c) for i, c in enumerate(rng.uniform(0.3, 3, 4))}
    found = allocate(responses, limits, "cost", costs)
    price = np.array(list(costs.values()))
    limit = np.array(list(limits.values()))

    def room(t: np.ndarray) -> np.ndarray:
        return 1 - worst_case(scaled(responses, t)).value / limit

    start = np.full(4, 0.3)
    other = minimize(
        lambda t: (price / t).sum(),
        start,
        jac=lambda t: -price / t**2,
        method="SLSQP",
        bounds=[(1e-3, 50)] * 4,
        constraints={"type": "ineq", "fun": room},
        options={"ftol": 1e-12, "maxiter": 500},
    )
    # its differences of the worst case leave SLSQP some 1e-5 aside
    assert found.cost == pytest.approx(other.fun, rel=1e-4)
    assert found.gap is not None
    assert found.gap < 1e-6
    assert found.cost <= other.fun * (1 + 1e-6)


def test_least_cost_fulfils_the_conditions_of_kuhn_and_tucker() -> None:
    found = allocate(case(), LIMITS, "cost", {"axis1": 5.0})
    worst = worst_case(found.responses)
    active = [i for i, q in enumerate(found.responses.quantities) if q.name in found.active]
    assert len(active) == 2
    parts = worst.shares[active] * worst.value[active, None] / found.scale
    slope = np.array([5.0, 1.0, 1.0]) / found.scale**2
    multipliers, *_ = np.linalg.lstsq(parts.T, slope, rcond=None)
    assert np.all(multipliers > 0)
    # the cost is stationary to the root of its gap of 1e-9
    assert np.allclose(parts.T @ multipliers, slope, rtol=1e-3)


def test_least_cost_costs_no_more_than_one_factor() -> None:
    responses = case(one_of_each())
    one, cheap = (allocate(responses, LIMITS, objective) for objective in ("uniform", "cost"))
    assert cheap.cost < one.cost


def test_one_factor_is_that_of_a_linear_programme() -> None:
    rng = np.random.default_rng(3)
    responses = random_responses(rng, 8, 6, 0.4)
    flat = replace(responses, gain=responses.gain.copy(), mean=responses.mean.copy())
    flat.gain[:, 1], flat.mean[:, 1] = 0, 0
    limits = all_limits(flat, 0.8)
    found = allocate(flat, limits, fixed=["t1"])
    parts = flat.sources.supports(flat.gain[:, 0])
    limit = np.array(list(limits.values()))
    still = np.abs(flat.mean[:, 0]) + parts[:, 1]
    moves = parts.sum(axis=1) - parts[:, 1]
    other = linprog([-1.0], A_ub=moves[:, None], b_ub=limit - still)
    assert found.scale[0] == pytest.approx(other.x[0], rel=1e-8)
    assert found.scale[1] == 1


def test_master_problem_in_closed_form() -> None:
    costs, rows = np.array([1.0, 4.0, 9.0]), np.array([[2.0, 1.0, 3.0]])
    low, high = np.zeros(3), np.full(3, np.inf)
    t, price = least_cost(costs, rows, np.array([5.0]), low, high)
    exact = np.sqrt(costs / rows[0]) * 5 / np.sqrt(costs * rows[0]).sum()
    assert np.allclose(t, exact, rtol=1e-5)
    assert (costs / t).sum() == pytest.approx((costs / exact).sum(), rel=1e-10)
    bound = cost_bound(costs, rows, np.array([5.0]), (low, high), price)
    assert bound * (1 - 1e-14) <= (costs / exact).sum() <= bound * (1 + 1e-9)
    assert np.allclose(sizes_for(costs, rows.T @ price, low, high), exact, rtol=1e-5)


@pytest.mark.parametrize("seed", range(4))
def test_sizes_and_costs_of_very_different_size(seed: int) -> None:
    rng = np.random.default_rng(seed)
    responses = random_responses(rng, 8, 6, 0.5)
    weight = by_parameter(responses, 10 ** rng.uniform(-4, 4, 8))
    responses = replace(responses, gain=responses.gain * weight)
    costs = {f"t{i}": float(10 ** rng.uniform(-3, 3)) for i in range(8)}
    found = allocate(responses, all_limits(responses, 0.8), "cost", costs)
    assert found.gap is not None
    assert found.gap < 1e-6
    assert found.utilisation.max() == pytest.approx(1, abs=1e-9)


def test_bounds_and_fixed_sizes_are_kept() -> None:
    bounds = {"axis1": (200e-6, None), "axis2": (None, 140e-6)}
    for objective in ("uniform", "cost"):
        found = allocate(case(), LIMITS, objective, bounds=bounds)
        assert found.sizes[0] >= 200e-6 * (1 - 1e-12)
        assert found.sizes[1] <= 140e-6 * (1 + 1e-12)
        assert found.utilisation.max() == pytest.approx(1, abs=1e-9)
    free = allocate(case(), LIMITS, "cost")
    wide = allocate(case(), LIMITS, "cost", bounds={"axis1": (1e-6, 1e-3)})
    assert wide.cost == pytest.approx(free.cost, rel=1e-8)
    fixed = allocate(case(), LIMITS, fixed=["axis1"])
    assert fixed.sizes[0] == 300e-6
    assert fixed.sizes[1] == pytest.approx(fixed.sizes[2])


def test_largest_sizes_that_keep_all_limits_stop_nothing() -> None:
    bounds = {f"axis{i}": (None, 10e-6) for i in (1, 2, 3)}
    for objective in ("uniform", "cost"):
        found = allocate(case(), LIMITS, objective, bounds=bounds)
        assert np.allclose(found.sizes, 10e-6)
        assert found.active == ()
        assert found.gap == 0


def test_a_tolerance_without_effect_stays() -> None:
    responses = random_responses(np.random.default_rng(0), 4, 4)
    responses.gain[..., 0:2] = 0
    for objective in ("uniform", "cost"):
        found = allocate(responses, all_limits(responses, 0.5), objective)
        assert found.scale[0] == 1
        assert np.all(found.scale[1:] != 1)


def test_limits_hold_at_every_pose() -> None:
    both = random_responses(np.random.default_rng(4), 4, 3, 0.2, batch=(2,))
    limits = {(q.joint, q.kind): 3.0 for q in both.quantities}
    found = allocate(both, limits, "cost")
    assert found.utilisation.shape == (2, 3)
    assert found.utilisation.max() == pytest.approx(1, abs=1e-9)
    one = allocate(replace(both, gain=both.gain[0], mean=both.mean[0]), limits, "cost")
    assert one.cost <= found.cost * (1 + 1e-9)


def test_factor_of_a_quantile_is_exact_on_its_sample() -> None:
    responses = case(tilted_axes("uniform"))
    found = allocate(responses, LIMITS, quantile=0.99, samples=20_000)
    sampled = distribution(responses, 20_000, seed=SEED, quantiles=(0.99,), limits=LIMITS)
    assert sampled.utilisation is not None
    rough = 1 / float(sampled.utilisation.quantiles[0])
    assert found.scale == pytest.approx(rough, rel=2 * sampled.resolution)
    assert found.gap is None
    assert found.scale[0] > allocate(responses, LIMITS).scale[0]


@pytest.mark.parametrize("objective", ["uniform", "cost"])
@pytest.mark.parametrize(
    "options", [{}, {"fixed": ["axis1"]}, {"bounds": {"axis1": (None, 120e-6)}}]
)
def test_share_of_the_sample_within_limits_is_the_one_asked_for(
    objective: str, options: dict[str, object]
) -> None:
    responses = case(one_of_each())
    limits = all_limits(responses, 0.8)
    found = allocate(responses, limits, objective, quantile=0.95, samples=4000, **options)  # type: ignore[arg-type]
    limited = np.array([responses.index(*key) for key in limits])
    part = replace(
        responses,
        quantities=tuple(responses.quantities[q] for q in limited),
        gain=responses.gain[limited],
        mean=responses.mean[limited],
    )
    never = np.zeros(len(found.scale))
    zones = ScaledZones(part, np.array(list(limits.values())), never, never + np.inf)
    seed = SEED if objective == "uniform" else SEED + 1
    use, _ = SampledZones(zones, 0.95, 4000, seed).utilisation(found.scale)
    assert (use <= 1 + 1e-12).sum() == 3800
    assert np.sort(use)[3799] == pytest.approx(1, abs=1e-9)


def test_improved_proportions_cost_less_than_the_worst_cases() -> None:
    responses = random_responses(np.random.default_rng(1), 12, 10)
    limits = all_limits(responses, 0.7)
    costs = {"t1": 10.0, "t2": 0.1}
    found = allocate(responses, limits, "cost", costs, quantile=0.95, samples=10_000)
    worst = allocate(responses, limits, "cost", costs)
    same = allocate(
        scaled(responses, worst.scale),
        limits,
        quantile=0.95,
        samples=10_000,
    )
    assert found.cost < worst.cost / same.scale[0] * (1 - 1e-3)


def test_slopes_of_a_quantile_are_its_differences() -> None:
    responses = case(tilted_axes("uniform"))
    joints = responses.index("joint1", "radial force")
    part = replace(
        responses,
        quantities=responses.quantities[joints : joints + 1],
        gain=responses.gain[joints : joints + 1],
        mean=responses.mean[joints : joints + 1],
    )
    none = np.zeros(3)
    sample = SampledZones(ScaledZones(part, np.array([6e3]), none, none + np.inf), 0.9, 200_000, 1)
    slopes, makes = sample.slopes(np.ones(3))
    assert makes == pytest.approx(1)
    for t in range(3):
        ends = []
        for sign in (-1, 1):
            use, _ = sample.utilisation(1 + 0.02 * sign * np.eye(3)[t])
            ends.append(np.sort(use)[sample.needed - 1])
        # 1000 assemblies about the quantile know a mean slope to some percent
        assert slopes[t] == pytest.approx((ends[1] - ends[0]) / 0.04, rel=0.15, abs=0.02)


def test_limits_that_cannot_be_met() -> None:
    responses = case(one_of_each())
    limits = all_limits(responses, 0.9)
    with pytest.raises(ModelError, match=r"limit of the joint\d .*cannot be met.*still") as error:
        allocate(responses, limits, bounds={"axis1": (1e-2, None)})
    assert "Raise the limit" in error.value.remedy
    with pytest.raises(ModelError, match="joint1 radial force: 100 N cannot be met"):
        # the spacer's middle alone loads the joints
        allocate(responses, {("joint1", "radial force"): 100.0}, "cost")
    with pytest.raises(ModelError, match=r"fewer than 0\.99 of the assemblies"):
        allocate(responses, {("joint1", "radial force"): 100.0}, quantile=0.99, samples=1000)


def test_what_cannot_be_allocated() -> None:
    responses = case()
    with pytest.raises(ModelError, match='"cheap" is unknown'):
        allocate(responses, LIMITS, "cheap")
    with pytest.raises(ModelError, match="tolerance axis9: is not there"):
        allocate(responses, LIMITS, fixed=["axis9"])
    with pytest.raises(ModelError, match="cost of axis1: it is 0"):
        allocate(responses, LIMITS, "cost", {"axis1": 0.0})
    with pytest.raises(ModelError, match="bounds of axis1"):
        allocate(responses, LIMITS, bounds={"axis1": (2e-4, 1e-4)})
    with pytest.raises(ModelError, match="quantile: it is 1"):
        allocate(responses, LIMITS, quantile=1.0)
    with pytest.raises(ModelError, match="no tolerance that may change"):
        allocate(responses, LIMITS, fixed=["axis1", "axis2", "axis3"])


def test_lengths_keep_their_middle() -> None:
    found = allocate(case(one_of_each()), LIMITS)
    spacer = found.tolerances[4]
    assert isinstance(spacer, Tolerance)
    assert spacer.middle == pytest.approx(10e-6)
    assert spacer.extent == pytest.approx(20e-6 * found.scale[4])


def test_what_it_writes_down() -> None:
    for quantile in (None, 0.9):
        written = allocate(case(), LIMITS, quantile=quantile, samples=1000).to_dict()
        assert written["limits"][0] == 6e3
        assert written["limits"][-1] is None
        assert written["tolerances"] == ["axis1", "axis2", "axis3"]
        assert written["method"]
        assert written["optimality"]
