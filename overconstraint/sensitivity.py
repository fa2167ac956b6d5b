"""Which tolerance causes which force: shares in the worst case and in the variance, and slopes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.overconstraint.responses import Responses
from strutwork.overconstraint.sampling import variances
from strutwork.overconstraint.tolerance import Tolerance
from strutwork.overconstraint.worst_case import WorstCase

Array = NDArray[Any]


@dataclass(frozen=True)
class Sensitivity:
    """Effect of every tolerance on every quantity.

    Parameters
    ----------
    responses : Responses
    worst_shares : (..., q, t)
        Shares in the worst case; they sum to one where the zones' middles cause nothing.
    variance : (..., q)
        Of the quantity's components together, squared units of the quantity, when the
        tolerances fall by their distributions.
    variance_shares : (..., q, t)
        Shares in it; they sum to one, or are zero where nothing varies.
    slopes : (..., q, t)
        By how much the worst case grows with the tolerance as it is given (`given_size`): N/m
        or N/rad for a force. Where two combinations are equally bad, that of the one returned.
    """

    responses: Responses
    worst_shares: Array
    variance: Array
    variance_shares: Array
    slopes: Array

    def __repr__(self) -> str:
        return (
            f"<Sensitivity: {len(self.responses.quantities)} quantities to "
            f"{len(self.responses.sources.tolerances)} tolerances, SI>"
        )

    def to_dict(self) -> dict[str, Any]:
        """Names, and the arrays as lists, SI."""
        return {
            "quantities": [q.name for q in self.responses.quantities],
            "units": [q.unit for q in self.responses.quantities],
            "tolerances": [t.name for t in self.responses.sources.tolerances],
            "worst_shares": self.worst_shares.tolist(),
            "variance": self.variance.tolist(),
            "variance_shares": self.variance_shares.tolist(),
            "slopes": self.slopes.tolist(),
        }


def given_size(tolerance: Tolerance) -> float:
    """The value that defines a tolerance and scales its zone.

    Its slope, rad; its size, m; or half the distance of its limits, m.

    Parameters
    ----------
    tolerance : Tolerance
    """
    if tolerance.slope is not None:
        return tolerance.slope
    return tolerance.extent if tolerance.size is None else tolerance.size


def sensitivity(worst: WorstCase) -> Sensitivity:
    """Shares and slopes of every tolerance, in closed form.

    The worst case is a sum of what each tolerance adds at its worst direction; scaling one
    changes it by that at first order (the envelope theorem). The parameters of a zone are not
    correlated, so that the variance is a sum too.

    Parameters
    ----------
    worst : WorstCase

    Returns
    -------
    Sensitivity
    """
    responses = worst.responses
    sources = responses.sources
    belongs = np.zeros((sources.parameters, len(sources.tolerances)))
    for block in sources.blocks:
        belongs[block.start : block.start + block.shape.dimension, block.tolerance] = 1.0
    spread = np.sum(responses.gain**2, axis=-2) * variances(sources)
    parts = spread @ belongs
    variance = parts.sum(axis=-1)
    sizes = np.array([given_size(tolerance) for tolerance in sources.tolerances])
    return Sensitivity(
        responses,
        worst.shares,
        variance,
        parts / np.where(variance > 0, variance, 1.0)[..., None],
        worst.shares * worst.value[..., None] / sizes,
    )
