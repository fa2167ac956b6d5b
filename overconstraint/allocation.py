"""The largest tolerances that keep every force within its limit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.overconstraint.allocation_inputs import (
    limited_zones,
    prices_of,
    resized,
    without_idle,
)
from strutwork.overconstraint.cheapest import cheapest, cheapest_sampled
from strutwork.overconstraint.distribution import SEED, distribution
from strutwork.overconstraint.limits import Limits, limit_vector
from strutwork.overconstraint.responses import Responses
from strutwork.overconstraint.sampled_zones import SampledZones
from strutwork.overconstraint.scaled_zones import CERTIFICATE, Cuts, ScaledZones, scaled
from strutwork.overconstraint.sensitivity import given_size
from strutwork.overconstraint.tolerance import Tolerance
from strutwork.overconstraint.worst_case import worst_case

Array = NDArray[Any]

OBJECTIVES = ("uniform", "cost")

#: A limit is active where the force reaches this share of it.
ACTIVE = 1 - 1e-6

#: With a quantile, where it is the largest in this share of the assemblies about the quantile.
MAKES = 0.05


@dataclass(frozen=True)
class Allocation:
    """Tolerances that satisfy the limits.

    Parameters
    ----------
    tolerances : tuple of Tolerance
        The allocated ones.
    scale : (t,)
        Allocated over given size, no unit.
    sizes : (t,)
        Allocated, in the number that each tolerance is given by (`given_size`): m or rad.
    responses : Responses
        With the allocated tolerances.
    limit : (q,)
        N, N·m, m or rad; infinite where there is none.
    forces : (..., q)
        The worst case, or the quantile of each quantity for itself, in its unit.
    utilisation : (..., q)
        Ratio of forces to limits, zero where there is none.
    active : tuple of str
        Quantities that stop the tolerances.
    cost : float
        Σ costs · given size / allocated size, in the unit of the costs, which may be any unit.
    gap : float or None
        As a share: no tolerances within the limits cost less than cost·(1 − gap), certified; None
        where nothing is claimed. For a uniform scale how far it may lie below the largest.
    method, optimality : str
        In words.
    """

    tolerances: tuple[Tolerance, ...]
    scale: Array
    sizes: Array
    responses: Responses
    limit: Array
    forces: Array
    utilisation: Array
    active: tuple[str, ...]
    cost: float
    gap: float | None
    method: str
    optimality: str

    def __repr__(self) -> str:
        return (
            f"<Allocation: {len(self.scale)} tolerances, scales {self.scale.min():.4g} to "
            f"{self.scale.max():.4g}, active: {', '.join(self.active) or 'none'}>"
        )

    def to_dict(self) -> dict[str, Any]:
        """Everything as lists and text, SI; a missing limit is None."""
        return {
            "tolerances": [t.name for t in self.tolerances],
            "scale": self.scale.tolist(),
            "sizes": self.sizes.tolist(),
            "quantities": [q.name for q in self.responses.quantities],
            "units": [q.unit for q in self.responses.quantities],
            "limits": [float(v) if np.isfinite(v) else None for v in self.limit],
            "forces": self.forces.tolist(),
            "utilisation": self.utilisation.tolist(),
            "active": list(self.active),
            "cost": self.cost,
            "gap": self.gap,
            "method": self.method,
            "optimality": self.optimality,
        }


def allocate(
    responses: Responses,
    limits: Limits,
    objective: str = "uniform",
    costs: Mapping[str, float] | None = None,
    quantile: float | None = None,
    fixed: Sequence[str] = (),
    bounds: Mapping[str, tuple[float | None, float | None]] | None = None,
    samples: int = 100_000,
) -> Allocation:
    """Largest tolerances, by one factor or at least cost, that satisfy all limits.

    The worst case is convex in the sizes, so that the worst-case allocations are solved to a
    certificate. The cost of a tolerance is taken as reciprocal in its size, c·given/allocated
    (Chase and Greenwood 1988). Middles of zones stay where they are.

    Parameters
    ----------
    responses : Responses
        At a batch of poses the limits hold at all of them.
    limits : mapping of (joint, kind) to float
        N, N·m, m or rad; see `bearing_limit`.
    objective : str
        "uniform": one factor for all, as large as can be. "cost": least Σ cₛ/tₛ.
    costs : mapping of tolerance to float, optional
        Cost of each tolerance at its given size, any unit; default one. With "cost".
    quantile : float, optional
        Share of the assemblies that shall keep all limits; without, all of them.
    fixed : sequence of str
        Tolerances that stay as given.
    bounds : mapping of tolerance to (least, largest), optional
        In the number that the tolerance is given by, m or rad; None for none.
    samples : int
        For a quantile.

    Returns
    -------
    Allocation
        A tolerance that reaches no limited quantity stays as given.

    Raises
    ------
    ModelError
        An unknown objective or name, wrong costs, bounds or limits, no tolerance that could
        change, or limits that cannot be met: names the joint, the limit and the least force.
    NumericalError
        The solution did not meet its certificate.
    """
    if objective not in OBJECTIVES:
        raise ModelError(
            "objective", f'"{objective}" is unknown.', "Choose one of: " + ", ".join(OBJECTIVES)
        )
    if quantile is not None and not 0 < quantile < 1:
        raise ModelError("quantile", f"it is {quantile:g}.", "Give a share between 0 and 1.")
    limit = limit_vector(responses, limits)
    prices = prices_of(responses, costs)
    zones, some = limited_zones(responses, limit, fixed, bounds or {})
    cuts = zones.first_cuts()
    zones = without_idle(zones, cuts.rows)
    names = [responses.quantities[q].name for q in some]
    if quantile is None:
        zones.check_reachable()
        scale, gap = (
            _uniform(zones, cuts) if objective == "uniform" else (cheapest(zones, prices, cuts))
        )
        seed = None
    else:
        scale, seed = _within_quantile(
            SampledZones(zones, quantile, samples, SEED), prices, cuts, objective
        )
        gap = None
    scale = np.where(np.isfinite(scale), scale, 1.0)
    done = scaled(responses, scale)
    tolerances = tuple(
        resized(t, float(s)) for t, s in zip(responses.sources.tolerances, scale, strict=True)
    )
    done = replace(done, sources=replace(done.sources, tolerances=tolerances))
    if quantile is None or seed is None:
        forces = worst_case(done, CERTIFICATE).bound
        reach = (forces[..., some] / limit[some]).reshape(-1, len(some)).max(axis=0) >= ACTIVE
    else:
        sampled = distribution(done, samples, seed=seed, quantiles=(quantile,))
        forces = sampled.values.quantiles[..., 0]
        reach = SampledZones(zones, quantile, samples, seed).slopes(scale)[1] >= MAKES
    method, optimality = _words(objective, quantile, samples)
    return Allocation(
        tolerances,
        scale,
        scale * np.array([given_size(t) for t in responses.sources.tolerances]),
        done,
        limit,
        forces,
        forces / limit,
        tuple(name for name, here in zip(names, reach, strict=True) if here),
        float((prices / scale).sum()),
        gap,
        method,
        optimality,
    )


def _uniform(zones: ScaledZones, cuts: Cuts) -> tuple[Array, float]:
    """Scales of one factor, and how far it may lie below the largest."""
    ones = np.ones(len(zones.low))
    free = np.all(zones.low == 0) and np.all(np.isinf(zones.high))
    if free and not np.any(zones.responses.mean):
        # the worst case is proportional to the factor
        return np.asarray(ones / zones.worst(ones)[1].max()), CERTIFICATE
    factor, cuts = zones.along(ones, cuts)
    gap = max(0.0, 1 - factor / zones.stop(ones, cuts)) if np.isfinite(factor) else 0.0
    return zones.clip(factor, ones), gap


def _within_quantile(
    sample: SampledZones, prices: Array, cuts: Cuts, objective: str
) -> tuple[Array, int]:
    """Scales, and the seed of the sample that they are exact for."""
    ray = np.ones(len(prices))
    if objective == "cost":
        ray = cheapest_sampled(sample, prices, cuts)
        # a sample that the proportions have not seen
        sample = replace(sample, seed=sample.seed + 1)
    return sample.zones.clip(sample.along(ray), ray), sample.seed


def _words(objective: str, quantile: float | None, samples: int) -> tuple[str, str]:
    if quantile is None:
        if objective == "uniform":
            return (
                "largest common factor within the exact worst case, by Newton's method on cuts",
                "global optimum: the worst case is convex in the factor; certified to the gap",
            )
        return (
            "least sum of costs over sizes within the exact worst case, by cutting planes",
            "global optimum: a convex problem; certified by its Lagrange dual to the gap",
        )
    kept = f"{quantile:.6g} of {samples} sampled assemblies meet all limits"
    error = 1.96 * np.sqrt(quantile * (1 - quantile) / samples)
    doubt = f"as a share of all assemblies this is known to ±{error:.2g} (95 %)"
    if objective == "uniform":
        return f"largest common factor at which {kept}", f"exact for the sample; {doubt}"
    return (
        "sizes improved from the worst-case optimum along the slopes of the quantile, then scaled "
        f"until {kept}; the last sample is not the one that was improved on"
    ), (
        "the factor is exact for the sample; the proportions are improved, not optimal for "
        f"certain, since a quantile is not convex; {doubt}"
    )
