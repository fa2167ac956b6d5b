"""What an allocation is given, checked: costs, bounds, fixed tolerances, limited quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.overconstraint.responses import Responses
from strutwork.overconstraint.scaled_zones import ScaledZones
from strutwork.overconstraint.sensitivity import given_size
from strutwork.overconstraint.tolerance import Tolerance

Array = NDArray[Any]

#: A tolerance whose largest effect is below this share of the largest of all has none.
IDLE = 1e-12


def prices_of(responses: Responses, costs: Mapping[str, float] | None) -> Array:
    """Cost of every tolerance at its given size, one where none is given, (t,).

    Parameters
    ----------
    responses : Responses
        With t tolerances.
    costs : mapping of tolerance to float or None
        Positive, any unit.
    """
    names = [t.name for t in responses.sources.tolerances]
    given = costs or {}
    _check_known(given, names)
    prices = np.array([float(given.get(name, 1.0)) for name in names])
    for name, price in zip(names, prices, strict=True):
        if not (np.isfinite(price) and price > 0):
            raise ModelError(f"cost of {name}", f"it is {price:g}.", "Give a positive number.")
    return prices


def _check_known(given: Sequence[str] | Mapping[str, Any], names: Sequence[str]) -> None:
    for name in given:
        if name not in names:
            raise ModelError(
                f"tolerance {name}", "is not there.", "Tolerances: " + ", ".join(names[:12]) + "."
            )


def limited_zones(
    responses: Responses,
    limit: Array,
    fixed: Sequence[str],
    bounds: Mapping[str, tuple[float | None, float | None]],
) -> tuple[ScaledZones, NDArray[np.intp]]:
    """The limited quantities with bounds as factors, and their indices, (k,).

    Parameters
    ----------
    responses : Responses
    limit : (q,)
        Of every quantity, N, N·m, m or rad; infinite where there is none.
    fixed : sequence of str
        Tolerances that stay as given.
    bounds : mapping of tolerance to (least, largest)
        m or rad; None for none.
    """
    tolerances = responses.sources.tolerances
    names = [t.name for t in tolerances]
    _check_known(fixed, names)
    _check_known(bounds, names)
    low, high = np.zeros(len(names)), np.full(len(names), np.inf)
    for name, (least, largest) in bounds.items():
        s = names.index(name)
        size = given_size(tolerances[s])
        low[s] = 0.0 if least is None else least / size
        high[s] = np.inf if largest is None else largest / size
        if not (0 <= low[s] < np.inf and high[s] > 0 and low[s] <= high[s]):
            raise ModelError(
                f"bounds of {name}",
                f"they are {least} and {largest}.",
                "Give a least size that is not negative and a largest that is not below it.",
            )
    for name in fixed:
        low[names.index(name)] = high[names.index(name)] = 1.0
    some = np.flatnonzero(np.isfinite(limit))
    part = replace(
        responses,
        quantities=tuple(responses.quantities[q] for q in some),
        gain=responses.gain[..., some, :, :],
        mean=responses.mean[..., some, :],
    )
    return ScaledZones(part, limit[some], low, high), some


def without_idle(zones: ScaledZones, effect: Array) -> ScaledZones:
    """Keep tolerances as given that reach no limited quantity.

    Parameters
    ----------
    zones : ScaledZones
    effect : (m, t)
        `Cuts.rows` of the zones: what each tolerance adds to a limited quantity, as a share of its
        limit.
    """
    size = effect.max(axis=0, initial=0.0)
    idle = size <= IDLE * max(size.max(initial=0.0), 1e-300)
    given = np.clip(1.0, zones.low, zones.high)
    low, high = np.where(idle, given, zones.low), np.where(idle, given, zones.high)
    if np.all(low == high):
        raise ModelError(
            "allocation",
            "no tolerance that may change reaches a limited quantity.",
            "Limit another quantity, or free a tolerance.",
        )
    return replace(zones, low=low, high=high)


def resized(tolerance: Tolerance, scale: float) -> Tolerance:
    """A tolerance of another size; limits keep their middle.

    Parameters
    ----------
    tolerance : Tolerance
    scale : float
        No unit.
    """
    if tolerance.slope is not None:
        return replace(tolerance, slope=scale * tolerance.slope)
    if tolerance.size is not None:
        return replace(tolerance, size=scale * tolerance.size)
    half = scale * tolerance.extent
    return replace(tolerance, limits=(tolerance.middle - half, tolerance.middle + half))
