"""How sampled variables are spread below their exact worst case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Of a histogram to be drawn.
BINS = 64


@dataclass(frozen=True)
class Spread:
    """Distribution of variables between zero and their exact worst case.

    Parameters
    ----------
    quantiles, low, high : (..., p)
        With their confidence intervals, at `Distribution.shares`; in the variable's own unit.
    mean, deviation, largest, worst : (...)
        Standard deviation with n − 1; the largest sampled; the exact worst case. In the variable's
        own unit.
    counts : (..., BINS)
        Samples in bins of equal width from zero to the worst case.
    """

    quantiles: Array
    low: Array
    high: Array
    mean: Array
    deviation: Array
    largest: Array
    worst: Array
    counts: NDArray[np.int64]

    @property
    def edges(self) -> Array:
        """Of the bins, (..., BINS + 1)."""
        return np.asarray(self.worst[..., None] * np.linspace(0.0, 1.0, BINS + 1))

    def to_dict(self) -> dict[str, Any]:
        """Lists, SI."""
        return {
            "quantiles": self.quantiles.tolist(),
            "low": self.low.tolist(),
            "high": self.high.tolist(),
            "mean": self.mean.tolist(),
            "standard_deviation": self.deviation.tolist(),
            "largest_sampled": self.largest.tolist(),
            "worst": self.worst.tolist(),
            "counts": self.counts.tolist(),
        }
