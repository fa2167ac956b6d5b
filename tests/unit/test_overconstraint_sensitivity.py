from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.overconstraint import (
    Tolerance,
    bearing_limit,
    distribution,
    given_size,
    limit_vector,
    sensitivity,
    worst_case,
)
from tests.three_struts import case, one_of_each, tilted_axes

KINDS = ("surface", "uniform", "normal")


@pytest.mark.parametrize("kind", KINDS)
def test_variance_is_that_of_a_sample(kind: str) -> None:
    found = sensitivity(worst_case(case(tilted_axes(kind))))
    sample = distribution(case(tilted_axes(kind)), 200_000, "quasi_monte_carlo").values
    # the components' means are zero, so that their variance is the mean square of the length
    square = sample.deviation**2 + sample.mean**2
    assert np.allclose(found.variance, square, rtol=2e-3)


def test_shares_of_the_variance_sum_to_one() -> None:
    found = sensitivity(worst_case(case(one_of_each())))
    assert np.allclose(found.variance_shares.sum(axis=-1), 1.0, rtol=1e-12)
    assert np.all(found.variance_shares >= 0)


def test_a_tolerance_that_acts_alone_has_the_whole_share() -> None:
    found = sensitivity(worst_case(case(tilted_axes()[:1])))
    assert np.allclose(found.variance_shares, 1.0)
    assert np.allclose(found.worst_shares, 1.0)


def test_slopes_are_differences_of_worst_cases() -> None:
    tolerances = one_of_each()
    found = sensitivity(worst_case(case(tolerances)))
    for t, tolerance in enumerate(tolerances):
        step = 1e-4 * given_size(tolerance)
        values = []
        for sign in (-1, 1):
            if tolerance.slope is not None:
                other = replace(tolerance, slope=tolerance.slope + sign * step)
            elif tolerance.size is not None:
                other = replace(tolerance, size=tolerance.size + sign * step)
            else:
                assert tolerance.limits is not None
                low, high = tolerance.limits
                other = replace(tolerance, limits=(low - sign * step, high + sign * step))
            values.append(worst_case(case([*tolerances[:t], other, *tolerances[t + 1 :]])).value)
        slope = (values[1] - values[0]) / (2 * step)
        # the worst case is known to 1e-9 of itself, which the step magnifies
        doubt = 2e-9 * found.responses.gain.shape[-1] * values[0] / step
        assert np.all(np.abs(found.slopes[:, t] - slope) <= 1e-5 * np.abs(slope) + doubt)


def test_nothing_varies_without_an_effect() -> None:
    responses = case()
    still = replace(responses, gain=0 * responses.gain)
    found = sensitivity(worst_case(still))
    assert not np.any(found.variance_shares)
    assert np.all(np.isfinite(found.slopes))


def test_what_it_writes_down() -> None:
    written = sensitivity(worst_case(case())).to_dict()
    assert written["tolerances"] == ["axis1", "axis2", "axis3"]
    assert len(written["slopes"]) == len(written["quantities"])


def test_sizes_as_given() -> None:
    assert given_size(Tolerance("a", "length", ("j",), limits=(-1e-5, 3e-5))) == pytest.approx(2e-5)
    assert given_size(Tolerance("a", "length", ("j",), size=1e-5)) == 1e-5
    assert given_size(Tolerance("a", "parallelism", ("j",), size=1e-5, length=0.1)) == 1e-5
    assert given_size(Tolerance("a", "parallelism", ("j",), slope=1e-4)) == 1e-4


def test_limits_by_joint_and_kind() -> None:
    responses = case()
    limit = limit_vector(responses, {("joint2", "axial force"): 5.0, (None, "displacement"): 1e-4})
    finite = [responses.quantities[q].name for q in np.flatnonzero(np.isfinite(limit))]
    assert finite == ["joint2 axial force"] + [f"tool displacement in {d}" for d in "xyz"]
    with pytest.raises(ModelError, match="there are none"):
        limit_vector(responses, {})
    with pytest.raises(ModelError, match=r'joint9: has no "axial force"'):
        limit_vector(responses, {("joint9", "axial force"): 1.0})
    with pytest.raises(ModelError, match="it is nan"):
        limit_vector(responses, {("joint1", "axial force"): float("nan")})


def test_what_a_bearing_may_carry() -> None:
    assert bearing_limit(20e3) == 20e3
    assert bearing_limit(20e3, 4.0) == 5e3
    with pytest.raises(ModelError, match="static rating is 0"):
        bearing_limit(0.0)
    with pytest.raises(ModelError, match="safety factor is -1"):
        bearing_limit(1e3, -1.0)
