from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError, NumericalError
from strutwork.overconstraint import Responses, distribution, draw, worst_case
from strutwork.overconstraint.distribution import SEED
from strutwork.overconstraint.sampling import SCRAMBLES, uniform_numbers, variances
from strutwork.overconstraint.spread import BINS
from strutwork.overconstraint.tally import Tally
from tests.random_zones import random_responses
from tests.three_struts import LIMITS, case, one_of_each, tilted_axes

KINDS = ("surface", "uniform", "normal")


def plain_loop(responses: Responses, z: np.ndarray) -> list[list[float]]:
    """Every quantity of every sample, number by number."""
    found = []
    for sample in z.tolist():
        row = []
        for gain, mean in zip(responses.gain.tolist(), responses.mean.tolist(), strict=True):
            parts = [
                m + sum(a * b for a, b in zip(line, sample, strict=True))
                for line, m in zip(gain, mean, strict=True)
            ]
            row.append(math.sqrt(parts[0] ** 2 + parts[1] ** 2))
        found.append(row)
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_samples_in_a_plain_loop_give_the_same_figures(kind: str) -> None:
    responses = case(one_of_each(kind))
    found = distribution(responses, 3000, quantiles=(0.5, 0.99), limits=LIMITS)
    uniform = np.random.default_rng(SEED).random((3000, responses.sources.parameters))
    values = np.array(plain_loop(responses, draw(responses.sources, uniform)))
    scale = found.values.worst
    assert np.allclose(found.values.mean, values.mean(axis=0), rtol=1e-12)
    assert np.allclose(found.values.deviation, values.std(axis=0, ddof=1), rtol=1e-10)
    assert np.allclose(found.values.largest, values.max(axis=0), rtol=1e-12)
    for p, share in enumerate(found.shares):
        exact = np.quantile(values, share, axis=0, method="inverted_cdf")
        assert np.all(
            np.abs(found.values.quantiles[:, p] - exact) <= 1.01 * found.resolution * scale
        )
    limited = [responses.index(*key) for key in LIMITS]
    use = (values[:, limited] / np.array(list(LIMITS.values()))).max(axis=1)
    assert found.utilisation is not None
    assert found.utilisation.largest == pytest.approx(use.max(), rel=1e-12)
    assert found.utilisation.mean == pytest.approx(use.mean(), rel=1e-12)


def test_histograms_count_every_sample_below_the_worst_case() -> None:
    found = distribution(case(one_of_each()), 5000)
    assert found.values.counts.shape == (len(found.responses.quantities), BINS)
    assert np.all(found.values.counts.sum(axis=-1) == 5000)
    assert np.array_equal(found.values.edges[:, -1], found.values.worst)


@pytest.mark.parametrize("method", ["monte_carlo", "quasi_monte_carlo"])
def test_no_sample_exceeds_the_worst_case(method: str) -> None:
    responses = case(one_of_each("surface"))
    found = distribution(responses, 20_000, method)
    worst = worst_case(responses)
    assert np.all(found.values.largest <= worst.bound * (1 + 1e-12))
    assert np.all(found.values.high <= worst.bound[:, None] * (1 + 1e-12))


def test_a_single_cone_comes_to_its_worst_case() -> None:
    responses = case(tilted_axes()[:1])
    found = distribution(responses, 20_000)
    assert np.all(found.values.largest > found.values.worst * (1 - 1e-6))


def test_a_sample_beyond_the_worst_case_is_an_error() -> None:
    responses = case()
    worst = worst_case(responses)
    small = replace(worst, bound=0.5 * worst.bound)
    with pytest.raises(NumericalError, match="exceeds the exact worst case"):
        distribution(responses, 1000, worst=small)


def test_confidence_covers_the_quantile_as_often_as_stated() -> None:
    responses = case(tilted_axes("uniform"))
    exact = distribution(responses, 2_000_000, seed=1).values.quantiles
    held = 0
    for seed in range(40):
        few = distribution(responses, 2000, seed=seed)
        held += int(((few.values.low <= exact) & (exact <= few.values.high))[0].sum())
    # 200 intervals at 95 %, those of one seed not independent: fewer than 180 would be a defect
    assert held >= 180


def test_quasi_monte_carlo_is_nearer_and_knows_it() -> None:
    responses = case(tilted_axes("uniform"))
    plain = distribution(responses, 16_384)
    quasi = distribution(responses, 16_384, "quasi_monte_carlo")
    exact = distribution(responses, 4_000_000, "quasi_monte_carlo", seed=5)
    width = quasi.values.high - quasi.values.low
    # a quantile is a jump of the integrand, which takes much of what Sobol points gain
    assert np.median(width / (plain.values.high - plain.values.low)) < 0.75
    assert quasi.samples == 16_384
    apart = np.abs(quasi.values.quantiles - exact.values.quantiles)
    assert np.mean(apart <= width / 2 + 2 * exact.resolution * exact.values.worst[:, None]) > 0.85
    assert np.allclose(quasi.values.mean, exact.values.mean, rtol=2e-3)


def test_scrambles_do_not_know_each_other_and_are_balanced() -> None:
    points: dict[int, list[np.ndarray]] = {}
    for scramble, uniform in uniform_numbers("quasi_monte_carlo", 2, 1024, 3, 16):
        points.setdefault(scramble, []).append(uniform)
    assert len(points) == SCRAMBLES
    sets = [np.concatenate(parts) for parts in points.values()]
    assert not np.array_equal(sets[0], sets[1])
    for each in sets:
        # one point in each of 64 strips, whatever the scramble
        assert np.array_equal(np.sort((each[:, 0] * 64).astype(int)), np.arange(64))


def test_the_seed_alone_decides() -> None:
    first, again = (distribution(case(), 3000, seed=7).values for _ in range(2))
    other = distribution(case(), 3000, seed=8).values
    assert np.array_equal(first.quantiles, again.quantiles)
    assert not np.array_equal(first.quantiles, other.quantiles)


def test_chunks_do_not_change_the_numbers() -> None:
    whole = next(uniform_numbers("monte_carlo", 3, 100, 1, 128))[1]
    parts = np.concatenate([u for _, u in uniform_numbers("monte_carlo", 3, 100, 1, 8)])
    assert np.array_equal(whole, parts)


@pytest.mark.parametrize("kind", KINDS)
def test_poses_of_a_batch_are_those_of_their_own(kind: str) -> None:
    both = random_responses(np.random.default_rng(2), 5, 4, 0.3, kind, (2,))
    found = distribution(both, 2000, limits={("j1", "radial force"): 3.0})
    for i in range(2):
        one = replace(both, gain=both.gain[i], mean=both.mean[i])
        alone = distribution(one, 2000, limits={("j1", "radial force"): 3.0})
        assert np.allclose(found.values.quantiles[i], alone.values.quantiles, rtol=1e-9)
        assert found.utilisation is not None
        assert alone.utilisation is not None
        assert found.utilisation.mean[i] == pytest.approx(float(alone.utilisation.mean))


@pytest.mark.parametrize("kind", KINDS)
def test_points_lie_in_their_zones_with_the_variance_of_the_closed_form(kind: str) -> None:
    sources = random_responses(np.random.default_rng(0), 4, 1, 0, kind).sources
    z = draw(sources, np.random.default_rng(1).random((200_000, sources.parameters)))
    for block in sources.blocks:
        part = z[:, block.start : block.start + block.shape.dimension]
        gauge = block.shape.gauge(part)
        assert gauge.max() <= 1 + 1e-12
        if kind == "surface":
            assert gauge.min() >= 1 - 1e-12
    covariance = z.T @ z / len(z)
    # four standard errors of a second moment of 200 000 numbers of size one
    assert np.abs(covariance - np.diag(variances(sources))).max() < 4 / math.sqrt(200_000)


def test_progress_counts_to_the_end() -> None:
    told: list[tuple[int, int]] = []
    distribution(case(), 50_000, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (50_000, 50_000)
    assert [done for done, _ in told] == sorted(done for done, _ in told)
    assert len(told) > 1


def test_two_tallies_make_one() -> None:
    values = np.random.default_rng(0).random((3, 1000))
    span = np.ones(3)
    whole, first, second = Tally(span, 64), Tally(span, 64), Tally(span, 64)
    whole.add(values)
    first.add(values[:, :300])
    second.add(values[:, 300:])
    first.join(second)
    assert np.array_equal(first.counts, whole.counts)
    assert np.allclose(first.deviation, values.std(axis=1, ddof=1))
    assert np.allclose(first.mean, values.mean(axis=1))


def test_what_cannot_be_sampled() -> None:
    responses = case()
    with pytest.raises(ModelError, match="unknown method"):
        distribution(responses, method="sobol")
    with pytest.raises(ModelError, match="0 samples"):
        distribution(responses, 0)
    with pytest.raises(ModelError, match="quantiles"):
        distribution(responses, quantiles=(0.5, 1.0))
    with pytest.raises(ModelError, match="no tolerance"):
        distribution(case([]), 100)
    with pytest.raises(ModelError, match="limit of the joint1 radial force"):
        distribution(responses, 100, limits={("joint1", "radial force"): -1.0})


def test_what_it_writes_down() -> None:
    written = distribution(case(), 1000, limits=LIMITS).to_dict()
    assert written["quantities"][0] == "joint1 radial force"
    assert len(written["values"]["quantiles"][0]) == len(written["shares"])
    assert isinstance(written["utilisation"]["worst"], float)
