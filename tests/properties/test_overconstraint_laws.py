from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork.overconstraint import Responses, allocate, distribution, sensitivity, worst_case
from strutwork.overconstraint.scaled_zones import ScaledZones, scaled
from tests.random_zones import random_responses

KIND = st.sampled_from(["surface", "uniform", "normal"])
SEED = st.integers(0, 2**32 - 1)
MIDDLE = st.sampled_from([0.0, 0.5])


def limits_of(
    responses: Responses, rng: np.random.Generator
) -> dict[tuple[str | None, str], float]:
    """Limits that the middles alone keep."""
    still = np.linalg.norm(responses.mean, axis=-1)
    room = worst_case(responses).value - still
    limit = still + room * rng.uniform(0.3, 1.5, len(still))
    return {(q.joint, q.kind): float(v) for q, v in zip(responses.quantities, limit, strict=True)}


@settings(max_examples=20)
@given(SEED, KIND, MIDDLE, st.sampled_from(["monte_carlo", "quasi_monte_carlo"]))
def test_quantiles_ascend_within_their_confidence_below_the_worst_case(
    seed: int, kind: str, middle: float, method: str
) -> None:
    responses = random_responses(np.random.default_rng(seed), 5, 4, middle, kind)
    spread = distribution(responses, 512, method, seed=seed).values
    assert np.all(np.diff(spread.quantiles, axis=-1) >= 0)
    assert np.all(spread.low <= spread.quantiles)
    assert np.all(spread.quantiles <= spread.high)
    assert np.all(spread.high <= spread.worst[:, None] * (1 + 1e-12))
    assert np.all(spread.quantiles[:, -1] <= spread.largest)
    assert np.all(spread.largest <= spread.worst * (1 + 1e-12))


@settings(max_examples=20)
@given(SEED, KIND, st.floats(0.1, 10))
def test_a_factor_on_all_zones_is_one_on_all_forces(seed: int, kind: str, factor: float) -> None:
    responses = random_responses(np.random.default_rng(seed), 4, 3, 0.0, kind)
    other = scaled(responses, np.full(4, factor))
    first, second = sensitivity(worst_case(responses)), sensitivity(worst_case(other))
    assert np.allclose(second.variance, factor**2 * first.variance, rtol=1e-10)
    assert np.allclose(second.variance_shares, first.variance_shares, rtol=1e-9)
    assert np.allclose(first.variance_shares.sum(axis=-1), 1)
    assert np.allclose(first.worst_shares.sum(axis=-1), 1, rtol=1e-8)
    a, b = (distribution(r, 256, seed=1).values for r in (responses, other))
    assert np.allclose(b.quantiles, factor * a.quantiles, rtol=1e-3)
    assert np.allclose(b.mean, factor * a.mean, rtol=1e-10)


@settings(max_examples=20)
@given(SEED, MIDDLE)
def test_cuts_never_exceed_the_worst_case_and_meet_it_where_they_were_made(
    seed: int, middle: float
) -> None:
    rng = np.random.default_rng(seed)
    responses = random_responses(rng, 4, 3, middle)
    none = np.zeros(4)
    zones = ScaledZones(responses, np.ones(3), none, none + np.inf)
    here, there = rng.uniform(0.1, 3, (2, 4))
    found, share = zones.worst(here)
    cuts = zones.cuts(found.direction)
    assert np.allclose(cuts.rows @ here + cuts.offset, share, rtol=1e-8)
    assert np.all(cuts.rows @ there + cuts.offset <= zones.worst(there)[1] * (1 + 1e-9))


@settings(max_examples=15)
@given(SEED, MIDDLE, st.sampled_from(["uniform", "cost"]))
def test_allocations_are_within_limits_tight_and_certified(
    seed: int, middle: float, objective: str
) -> None:
    rng = np.random.default_rng(seed)
    responses = random_responses(rng, 5, 6, middle)
    limits = limits_of(responses, rng)
    costs = {f"t{i}": float(c) for i, c in enumerate(10 ** rng.uniform(-1, 1, 5))}
    found = allocate(responses, limits, objective, costs)
    assert found.utilisation.max() <= 1 + 1e-12
    assert found.utilisation.max() == pytest.approx(1, abs=1e-9)
    assert found.gap is not None
    assert found.gap < 1e-6
    # nothing that is within the limits costs less, as far as a search at random can tell
    price = np.array(list(costs.values()))
    limit = np.array(list(limits.values()))
    if objective == "cost":
        for _ in range(30):
            t = found.scale * np.exp(rng.normal(size=5) * rng.choice([0.01, 0.1, 1.0]))
            t *= 1 / max(1.0, (worst_case(scaled(responses, t)).bound / limit).max())
            if np.all(worst_case(scaled(responses, t)).bound <= limit):
                assert (price / t).sum() >= found.cost * (1 - 1e-6)


@settings(max_examples=10)
@given(SEED, st.floats(0.5, 2.0))
def test_limits_and_sizes_in_other_units_change_nothing(seed: int, unit: float) -> None:
    rng = np.random.default_rng(seed)
    responses = random_responses(rng, 4, 4)
    limits = limits_of(responses, rng)
    other = replace(responses, gain=unit * responses.gain)
    first = allocate(responses, limits, "cost")
    second = allocate(other, {key: unit * value for key, value in limits.items()}, "cost")
    assert np.allclose(first.scale, second.scale, rtol=1e-4)
    assert first.cost == pytest.approx(second.cost, rel=1e-7)


@settings(max_examples=10)
@given(SEED, KIND)
def test_fewer_assemblies_within_limits_allow_larger_tolerances(seed: int, kind: str) -> None:
    rng = np.random.default_rng(seed)
    responses = random_responses(rng, 4, 4, 0.2, kind)
    limits = limits_of(responses, rng)
    factors = [
        allocate(responses, limits, quantile=q, samples=500).scale[0] for q in (0.5, 0.9, 0.99)
    ]
    factors.append(allocate(responses, limits).scale[0] * (1 - 1e-8))
    assert factors == sorted(factors, reverse=True)
