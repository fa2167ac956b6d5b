"""Tolerances of least cost: cutting planes for the worst case, slopes for a quantile."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.overconstraint.least_cost import cost_bound, least_cost
from strutwork.overconstraint.sampled_zones import SampledZones
from strutwork.overconstraint.scaled_zones import AIM, Cuts, ScaledZones

Array = NDArray[Any]

#: Certified gap at which cutting planes end, and the one that must be met: what `AIM` leaves of
#: a limit counts for more where the middles of the zones all but fill it.
GAP, ENOUGH = 2e-9, 1e-3

ROUNDS = 100

#: Cuts below this share of their limit are dropped, quantities above it are cut.
NEAR = 0.5

#: Improvements of a quantile's proportions at most, and the least that is worth another.
IMPROVEMENTS, WORTH = 12, 1e-4

#: Assemblies that they are improved on at most.
SAMPLES = 10_000


def cheapest(zones: ScaledZones, costs: Array, cuts: Cuts) -> tuple[Array, float]:
    """Scales t of least Σ cₛ/tₛ that keep the worst case within all limits.

    Kelley's cutting planes: the least cost under the cuts known so far is a lower bound, what
    remains of it within the limits an upper one.

    Parameters
    ----------
    zones : ScaledZones
        Reachable, and with a tolerance that is free.
    costs : (t,)
        c, at the given sizes, any unit.
    cuts : Cuts
        Those known so far.

    Returns
    -------
    scale : (t,)
    gap : float
        Certified, as a share of the cost.

    Raises
    ------
    NumericalError
        The gap did not close.
    """
    ones = np.ones(len(costs))
    factor, cuts = zones.along(ones, cuts)
    start = zones.clip(factor, ones)
    if np.isinf(factor):
        return start, 0.0
    free = zones.low < zones.high
    low, high = zones.low[free], zones.high[free]
    # in these units all sizes would be equal under a single limit
    unit = np.sqrt(costs[free] / np.maximum(cuts.rows[:, free].max(axis=0), 1e-300))
    whole = start.copy()
    whole[free] = unit
    unit *= min(zones.stop(np.where(whole > 0, whole, 1.0), cuts), 1e300)
    price, box = costs[free] / unit, (low / unit, high / unit)
    least = zones.worst(zones.low)[1]
    bound, scale = -np.inf, start
    for _ in range(ROUNDS):
        rows = cuts.rows[:, free] * unit
        room = 1 - cuts.offset - cuts.rows[:, ~free] @ zones.low[~free]
        sizes, multipliers = least_cost(price, rows, room - (1 - AIM), *box)
        bound = max(bound, cost_bound(price, rows, room, box, multipliers))
        trial = zones.low.copy()
        trial[free] = sizes * unit
        found, share = zones.worst(trial)
        over = share > 1
        back = np.min((1 - least[over]) / (share[over] - least[over]), initial=1.0)
        within = zones.low + back * (trial - zones.low)
        if _cost(costs, within, free) < _cost(costs, scale, free):
            scale = within
        if 1 - bound / _cost(costs, scale, free) <= GAP or not np.any(over):
            break
        height = cuts.rows @ trial + cuts.offset
        cuts = cuts.kept(height > NEAR).joined(zones.cuts(found.direction).kept(share > NEAR))
    scale = zones.clip(zones.along(scale, cuts)[0], scale)
    gap = max(0.0, 1 - bound / _cost(costs, scale, free))
    if not gap <= ENOUGH:
        raise NumericalError(
            "allocation",
            f"its cost is known to {gap:.1e} only after {ROUNDS} rounds of cuts.",
            "Give costs and bounds of sizes closer to one another.",
        )
    return scale, gap


def cheapest_sampled(sample: SampledZones, costs: Array, cuts: Cuts) -> Array:
    """Proportions (t,) that cost less than the worst case's optimum where a share of them counts.

    At an optimum each cost's slope is in proportion to the quantile's, c/t² = μ ∂Q/∂t. From the
    worst case's proportions t is moved towards √(c/∂Q/∂t) and kept where that costs less.

    Parameters
    ----------
    sample : SampledZones
    costs : (t,)
        c, at the given sizes, any unit.
    cuts : Cuts
        Of the worst case, for its optimum.
    """
    sample = replace(sample, samples=min(sample.samples, SAMPLES))
    zones = sample.zones
    free = zones.low < zones.high
    worst = np.all(zones.worst(zones.low)[1] < AIM)
    ray = cheapest(zones, costs, cuts)[0] if worst else np.ones(len(costs))
    ray = np.where(ray > 0, ray, 1.0)
    best = zones.clip(sample.along(ray), ray)
    if not np.all(np.isfinite(best)):
        return ray
    share = 1.0
    for _ in range(IMPROVEMENTS):
        slope = sample.slopes(best)[0]
        # where a sampled slope is lost in noise, a small one stands for it
        slope = np.maximum(slope, 1e-3 * np.max(np.abs(slope[free]) * best[free]) / best)
        wanted = np.sqrt(costs / slope)
        wanted *= np.exp(np.mean(np.log(best[free]) - np.log(wanted[free])))
        ray = np.where(free, best ** (1 - share) * wanted**share, np.maximum(best, 1e-300))
        trial = zones.clip(sample.along(ray), ray)
        gain = 1 - _cost(costs, trial, free) / _cost(costs, best, free)
        if gain > 0:
            best = trial
        else:
            share /= 2
        if 0 < gain < WORTH or share < 0.1:
            break
    return best


def _cost(costs: Array, scale: Array, free: NDArray[np.bool_]) -> float:
    return float((costs[free] / np.maximum(scale[free], 1e-300)).sum())
