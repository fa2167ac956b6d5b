"""Sizes of least cost under linear limits: an interior point and a dual bound in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import NumericalError

Array = NDArray[Any]

#: Gap between the cost found and its lower bound, as a share.
GAP = 1e-11

#: A gap at which the steps may end when rounding allows no better; the caller certifies its own.
ENOUGH = 1e-4

ROUNDS = 200


def least_cost(
    costs: Array, rows: Array, limits: Array, low: Array, high: Array
) -> tuple[Array, Array]:
    """Sizes t that minimise Σ cₛ/tₛ subject to rows·t ≤ limits and low ≤ t ≤ high.

    Path following on the primal and dual together (Boyd and Vandenberghe, Convex Optimization,
    11.7), feasible throughout.

    Parameters
    ----------
    costs : (s,)
        c, positive, any unit.
    rows : (m, s)
        Utilisation of each limit per size, any unit; not negative, every column with an entry that
        is not zero or a finite `high`.
    limits : (m,)
        In the unit of rows·t, any unit; more than rows·low.
    low, high : (s,)
        In the unit of t, any unit; low < high; low may be zero, high infinite.

    Returns
    -------
    sizes : (s,)
        Strictly within the limits.
    multipliers : (m,)
        Of the limits, not negative; `cost_bound` of them certifies the cost.

    Raises
    ------
    NumericalError
        The duality gap did not close.
    """
    # every limit as one, so that slacks compare
    given, rows, limits = limits, rows / limits[:, None], np.ones_like(limits)
    held = np.flatnonzero(np.isfinite(high))
    above = np.flatnonzero(low > 0)
    eye = np.eye(len(costs))
    every = np.concatenate([rows, eye[held], -eye[above]])
    ends = np.concatenate([limits, high[held], -low[above]])
    t = _inside(rows, limits, low, high)
    slack = ends - every @ t
    price = np.full(len(ends), (costs / t).sum() / len(ends)) / slack
    best: tuple[float, Array, Array] = (np.inf, t, price[: len(limits)])
    for _ in range(ROUNDS):
        multipliers = price[: len(limits)]
        cost = (costs / t).sum()
        gap = 1 - cost_bound(costs, rows, limits, (low, high), multipliers) / cost
        if gap < best[0]:
            best = (gap, t, multipliers)
        if gap <= GAP:
            break
        centre = 0.1 * (price @ slack) / len(ends)
        hessian = np.diag(2 * costs / t**3) + every.T @ ((price / slack)[:, None] * every)
        slope = -costs / t**2 + every.T @ (centre / slack)
        scale = 1 / np.sqrt(np.diag(hessian))
        step = scale * np.linalg.solve(scale[:, None] * hessian * scale, -slope * scale)
        price_step = centre / slack - price + price / slack * (every @ step)
        reach = min(_reach(slack, -every @ step), _reach(t, step), _reach(price, price_step))
        before = _residual(costs, every, (t, slack, price), centre)
        trial = (t, slack, price)
        for _ in range(40):
            trial = (
                t + reach * step,
                slack - reach * (every @ step),
                price + reach * price_step,
            )
            if _residual(costs, every, trial, centre) <= (1 - 0.01 * reach) * before:
                break
            reach /= 2
        t, _, price = trial
        slack = ends - every @ t
        if not (np.all(slack > 0) and np.all(np.isfinite(t))):
            break
    if not best[0] <= ENOUGH:
        raise NumericalError(
            "allocation",
            f"its cost is known to {best[0]:.1e} only.",
            "Give costs and bounds of sizes closer to one another.",
        )
    return best[1], best[2] / given


def sizes_for(costs: Array, pull: Array, low: Array, high: Array) -> Array:
    """Sizes that minimise Σ cₛ/tₛ + pullₛ tₛ between their bounds, √(c/pull) clipped, (s,).

    Parameters
    ----------
    costs : (s,)
        c, cost times size, any unit.
    pull : (s,)
        Price of each size, not negative, any unit.
    low, high : (s,)
        Bounds of the sizes, any unit.
    """
    free = np.sqrt(costs / np.where(pull > 0, pull, 1.0))
    return np.clip(np.where(pull > 0, free, np.inf), low, high)


def cost_bound(
    costs: Array, rows: Array, limits: Array, bounds: tuple[Array, Array], multipliers: Array
) -> float:
    """The Lagrange dual: no sizes within the limits cost less, whatever the multipliers ≥ 0.

    Parameters
    ----------
    costs : (s,)
        c, any unit.
    rows : (m, s)
        Of the limits, any unit.
    limits : (m,)
        In the unit of rows·t, any unit.
    bounds : ((s,), (s,))
        Least and largest sizes, any unit.
    multipliers : (m,)
        Price of each limit, not negative, any unit.
    """
    pull = rows.T @ multipliers
    t = sizes_for(costs, pull, *bounds)
    finite = np.isfinite(t)
    return float(
        (costs[finite] / t[finite] + pull[finite] * t[finite]).sum() - limits @ multipliers
    )


def _residual(
    costs: Array, every: Array, point: tuple[Array, Array, Array], centre: float
) -> float:
    """How far a point is from the path, sizes and slacks weighed by themselves."""
    t, slack, price = point
    dual = t * (every.T @ price - costs / t**2)
    return float(np.sqrt((dual**2).sum() + ((price * slack - centre) ** 2).sum()))


def _inside(rows: Array, limits: Array, low: Array, high: Array) -> Array:
    """Sizes strictly within everything."""
    way = np.minimum(1.0, (high - low) / 2)
    used = rows @ way
    room = limits - rows @ low
    return np.asarray(low + way * min(1.0, 0.5 * np.min(room / np.maximum(used, 1e-300))))


def _reach(value: Array, step: Array) -> float:
    """How much of a step keeps the values positive, at most one."""
    falls = step < 0
    return min(1.0, 0.99 * float(np.min(-value[falls] / step[falls]))) if np.any(falls) else 1.0
