"""Distributions of forces that have a closed form.

@book{feller1971,
  author = {Feller, William},
  title = {An Introduction to Probability Theory and Its Applications, Volume II},
  edition = {2}, publisher = {Wiley}, year = {1971},
  note = {I.10: projections of random directions}
}

A direction at random in the plane has a component of arcsine law, one in space of a uniform law;
a point uniform in a disc of radius one lies within r with probability r²; a normal point of the
plane, cut at 3σ, with (1 − exp(−r²/2σ²))/(1 − exp(−9/2)).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import exp, log, pi, sin, sqrt

import numpy as np
import pytest
from scipy.stats import norm

from strutwork.overconstraint import (
    Ball,
    Disc,
    Interval,
    Responses,
    Tolerance,
    UnitSet,
    distribution,
)
from strutwork.overconstraint.sources import Block
from tests.three_struts import case

SAMPLES = 2**20

#: A quantile of 2²⁰ Sobol' points in 16 scrambles is known to some 2e-4 of the worst case, here
#: asserted with room for the least favourable, which is steep at the median.
TOLERANCE = 1e-3


def one_zone(shape: UnitSet, kind: str, components: int) -> Responses:
    """A quantity that is one component of a zone's point, or the length of two."""
    responses = case()
    gain = np.zeros((1, 2, shape.dimension))
    for i in range(components):
        gain[0, i, i] = 1.0
    tolerance = Tolerance("t", "length", ("joint1",), size=1.0, distribution=kind)
    sources = replace(responses.sources, tolerances=(tolerance,), blocks=(Block(0, shape, 0),))
    sources = replace(sources, columns=(), map=gain[0, :0], mean=np.zeros(0))
    return replace(
        responses,
        quantities=responses.quantities[:1],
        gain=gain,
        mean=np.zeros((1, 2)),
        sources=sources,
    )


@pytest.mark.parametrize(
    ("shape", "kind", "components", "law"),
    [
        (Disc(), "surface", 1, lambda p: sin(pi * p / 2)),
        (Ball(), "surface", 1, lambda p: p),
        (Interval(), "uniform", 1, lambda p: p),
        (Interval(), "normal", 1, lambda p: norm.ppf(0.5 + p * (norm.cdf(3) - 0.5)) / 3),
        (Disc(), "uniform", 2, sqrt),
        (Disc(), "normal", 2, lambda p: sqrt(-2 * log(1 - p * (1 - exp(-4.5)))) / 3),
        (Disc(), "surface", 2, lambda _: 1.0),
        (Ball(), "surface", 2, lambda p: sqrt(1 - (1 - p) ** 2)),
    ],
)
def test_quantiles_are_those_of_the_law(
    shape: UnitSet, kind: str, components: int, law: Callable[[float], float]
) -> None:
    responses = one_zone(shape, kind, components)
    for method in ("monte_carlo", "quasi_monte_carlo"):
        found = distribution(responses, SAMPLES, method, quantiles=(0.1, 0.5, 0.9, 0.99))
        exact = np.array([law(p) for p in found.shares])
        # four standard errors of the share, with the law's slope, for plain Monte Carlo
        shares = np.array(found.shares)
        doubt = 4 * np.sqrt(shares * (1 - shares) / SAMPLES)
        slope = np.array([(law(p + 1e-6) - law(p - 1e-6)) / 2e-6 for p in found.shares])
        allowed = doubt * slope if method == "monte_carlo" else TOLERANCE
        # and the width of a fine cell
        assert np.all(np.abs(found.values.quantiles[0] - exact) <= allowed + found.resolution)
