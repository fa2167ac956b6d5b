"""How an answer scatters where its parameters do: mean, deviation, quantiles, with confidence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Quantiles that are stated, and the level of all confidence intervals.
QUANTILES, LEVEL = (0.05, 0.5, 0.95), 0.95

#: Machines below which there are no statistics.
FEWEST = 3


@dataclass(frozen=True)
class Scatter:
    """How one answer scatters.

    Parameters
    ----------
    count : int
        Machines with a finite answer.
    mean, deviation : float
        Mean and standard deviation (n − 1), any unit; NaN of fewer than `FEWEST` machines.
    mean_interval : (2,)
        Confidence interval of the mean, Student's t; any unit.
    quantiles : (q,)
        At `QUANTILES`, any unit.
    quantile_intervals : (q, 2)
        Their confidence intervals from order statistics, whatever the distribution; any unit, NaN
        at an end for which there are too few machines.
    """

    count: int
    mean: float
    deviation: float
    mean_interval: Array
    quantiles: Array
    quantile_intervals: Array


def scatter(values: Array) -> Scatter:
    """Statistics of an answer over machines drawn independently of one another.

    Of Sobol's points or a Latin hypercube, which lie more evenly, the intervals are wider than
    need be.

    Parameters
    ----------
    values : (n,)
        Any unit; those that are not finite are left out.

    Returns
    -------
    Scatter
    """
    x = np.asarray(values, dtype=float)
    x = np.sort(x[np.isfinite(x)])
    n = len(x)
    none = np.full(2, np.nan)
    if n < FEWEST:
        few = np.full(len(QUANTILES), np.nan)
        return Scatter(n, np.nan, np.nan, none, few, np.full((len(QUANTILES), 2), np.nan))
    # SciPy's statistics take longer to load than a small study to run
    from scipy import stats  # noqa: PLC0415

    mean, deviation = float(x.mean()), float(x.std(ddof=1))
    half = float(stats.t.ppf(0.5 + LEVEL / 2.0, n - 1)) * deviation / n**0.5
    intervals = np.array(
        [
            [interval.low, interval.high]
            for interval in (
                stats.quantile_test(x, p=q).confidence_interval(LEVEL) for q in QUANTILES
            )
        ]
    )
    return Scatter(
        n,
        mean,
        deviation,
        np.array([mean - half, mean + half]),
        np.quantile(x, QUANTILES),
        np.where(np.isfinite(intervals), intervals, np.nan),
    )
