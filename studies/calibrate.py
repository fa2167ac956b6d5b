"""Calibration: the parameters of a model that meet measured or published numbers best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from strutwork.errors import ModelError, NumericalError, StrutworkError
from strutwork.studies.calibration_problem import Model, Parameter, Problem, Target
from strutwork.studies.chunks import Arrays
from strutwork.studies.description import content_key
from strutwork.studies.identifiability import Identifiability, identifiability
from strutwork.studies.progress import Lines, Progress
from strutwork.studies.run import Chunk, Run

Array = NDArray[Any]

#: Costs that differ by less are one minimum: residuals are in standard deviations, so data say
#: nothing about such a difference.
TIED = 0.02

#: A parameter this near to a bound, as a share of its range, lies on it.
ON_BOUND = 1e-4


@dataclass(frozen=True, repr=False)
class Calibration:
    """What a calibration gives.

    Parameters
    ----------
    parameters : tuple of Parameter
    targets : tuple of Target
    values : (p,)
        Of the best parameters, each in its own unit.
    computed : (t,)
        What the model gives with them, each target in its own unit.
    costs : (s,)
        Half the sum of the squared residuals at the end of each start, no unit; infinite where the
        model failed.
    ends : (s, p)
        Where each start ended, each parameter in its own unit; not a number where the model failed.
    identified : Identifiability
        What the targets determine, at the best parameters.
    on_bounds : tuple of str
        Parameters that a bound holds.
    seed : int
    evaluations : int
        Of the model.
    failures : tuple of str
        Reasons of starts that failed.
    """

    parameters: tuple[Parameter, ...]
    targets: tuple[Target, ...]
    values: Array
    computed: Array
    costs: Array
    ends: Array
    identified: Identifiability
    on_bounds: tuple[str, ...]
    seed: int
    evaluations: int
    failures: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return (
            f"<Calibration: {len(self.parameters)} parameters on {len(self.targets)} targets, "
            f"cost {self.cost:.3g}, {self.identified.rank} combinations determined>"
        )

    @property
    def best(self) -> dict[str, float]:
        """Best parameters by name."""
        return {p.name: float(v) for p, v in zip(self.parameters, self.values, strict=True)}

    @property
    def residuals(self) -> Array:
        """(computed − target) / uncertainty, (t,)."""
        wanted = np.array([t.value for t in self.targets])
        return np.asarray((self.computed - wanted) / [t.uncertainty for t in self.targets])

    @property
    def cost(self) -> float:
        """Half the sum of the squared residuals."""
        return float(0.5 * self.residuals @ self.residuals)

    def met(self, within: float = 1.0) -> bool:
        """Whether every target is met.

        Parameters
        ----------
        within : float
            Largest residual, in uncertainties: no unit.
        """
        return bool(np.all(np.abs(self.residuals) <= within))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers by name; None where a standard error does not exist."""
        errors = self.identified.standard_errors
        return {
            "parameters": [
                {
                    "name": p.name,
                    "unit": p.unit,
                    "value": float(v),
                    "start": p.start,
                    "low": p.low,
                    "high": p.high,
                    "scale": p.scale,
                    "standard_error": float(e) if isfinite(e) else None,
                    "determined": bool(isfinite(e)),
                    "on_bound": p.name in self.on_bounds,
                }
                for p, v, e in zip(self.parameters, self.values, errors, strict=True)
            ],
            "targets": [
                {
                    "name": t.name,
                    "unit": t.unit,
                    "value": t.value,
                    "uncertainty": t.uncertainty,
                    "computed": float(c),
                    "residual": float(r),
                }
                for t, c, r in zip(self.targets, self.computed, self.residuals, strict=True)
            ],
            "cost": self.cost,
            "costs": [float(c) if isfinite(c) else None for c in self.costs],
            "seed": self.seed,
            "evaluations": self.evaluations,
            "failures": list(self.failures),
            **self.identified.to_dict(),
        }


def calibrate(
    model: Model,
    parameters: Sequence[Parameter],
    targets: Sequence[Target],
    *,
    starts: int = 8,
    seed: int = 0,
    step: float = 1e-4,
    threshold: float = 1e-3,
    progress: Progress | None = None,
) -> Calibration:
    """Bounded least squares from several starts.

    The trust-region reflective method (Branch, Coleman and Li 1999) on the scaled parameters.
    The first start is the parameters' own, the others are a Latin hypercube between the bounds.
    Of equal minima the one nearest to the parameters' own start is taken: what the targets do
    not determine stays where it was put.

    Parameters
    ----------
    model : callable
        From parameters by name to computed targets by name.
    parameters : sequence of Parameter
    targets : sequence of Target
    starts : int
    seed : int
        Of the Latin hypercube.
    step : float
        Of the differences, in scaled parameters, no unit.
    threshold : float
        Singular values below this share of the largest belong to combinations of parameters
        that the targets do not determine.
    progress : callable, optional
        Called after every start; default: lines on standard error.

    Returns
    -------
    Calibration

    Raises
    ------
    ModelError
        No parameter, no target, no start, two of one name, a target that the model does not
        give.
    NumericalError
        The model failed from every start.
    """
    chosen, wanted = tuple(parameters), tuple(targets)
    _check(chosen, wanted, starts)
    problem = Problem(model, chosen, wanted, step)
    points = _starts(chosen, starts, seed)

    def evaluate(chunk: Chunk) -> Arrays:
        own = Problem(model, chosen, wanted, step)
        cost, end, why = _searched(own, points[chunk.start])
        count = np.array([own.evaluations])
        return {"cost": cost, "end": end, "why": why, "evaluations": count}

    costs, ends, failures = np.full(starts, np.inf), np.full((starts, len(chosen)), np.nan), []
    # a model may keep what it made last: starts run beside one another in other processes alone
    run = Run(workers=1, progress=progress or Lines("calibration", "starts"))
    for chunk, part in run.chunks(
        evaluate,
        starts,
        1,
        lambda: content_key("calibration", model, chosen, wanted, step, points),
    ):
        i = chunk.start
        costs[i], ends[i] = part["cost"][0], part["end"][0]
        problem.evaluations += int(part["evaluations"][0])
        failures += [f"start {i}: {why}" for why in part["why"].tolist()]
    if not np.isfinite(costs).any():
        raise NumericalError(
            "calibration",
            f"the model failed from each of {starts} starts; the first: {failures[0]}",
            "Narrow the bounds.",
        )
    best = ends[_nearest(costs, ends, np.array([p.scaled(p.start) for p in chosen]))]
    return _result(problem, best, costs, ends, seed, threshold, tuple(failures))


def _searched(problem: Problem, point: Array) -> tuple[Array, Array, Array]:
    """Cost (1,), end (1, p) of a search from a start, and why there is none."""
    try:
        found = least_squares(
            problem.residuals,
            point,
            jac=problem.slopes,
            bounds=problem.bounds,
            x_scale="jac",
            xtol=1e-6,
            ftol=1e-6,
            gtol=1e-9,
            max_nfev=60,
        )
    except ModelError:
        raise
    except StrutworkError as error:
        nothing = np.full((1, len(point)), np.nan)
        return np.array([np.inf]), nothing, np.array([str(error)])
    return np.array([found.cost]), found.x[None], np.array([], dtype=np.str_)


def assess(
    model: Model,
    parameters: Sequence[Parameter],
    targets: Sequence[Target],
    *,
    step: float = 1e-4,
    threshold: float = 1e-3,
) -> Calibration:
    """What parameters as they start give and what the targets determine there, without a search.

    Parameters
    ----------
    model : callable
        From parameters by name to computed targets by name.
    parameters : sequence of Parameter
    targets : sequence of Target
    step : float
        Of the differences, in scaled parameters, no unit.
    threshold : float
        Share of the largest singular value, as `calibrate`.

    Returns
    -------
    Calibration

    Raises
    ------
    StrutworkError
        As `calibrate`, and whatever the model raises.
    """
    chosen, wanted = tuple(parameters), tuple(targets)
    _check(chosen, wanted, 1)
    problem = Problem(model, chosen, wanted, step)
    point = np.array([p.scaled(p.start) for p in chosen])
    cost = 0.5 * float(np.sum(problem.residuals(point) ** 2))
    return _result(problem, point, np.array([cost]), point[None], 0, threshold, ())


def _result(
    problem: Problem,
    best: Array,
    costs: Array,
    ends: Array,
    seed: int,
    threshold: float,
    failures: tuple[str, ...],
) -> Calibration:
    names = tuple(p.name for p in problem.parameters)
    return Calibration(
        problem.parameters,
        problem.targets,
        np.array(list(problem.values(best).values())),
        problem.computed(best),
        costs,
        np.array([list(problem.values(end).values()) for end in ends]),
        identifiability(problem.jacobian(best), names, threshold),
        _on_bounds(problem.parameters, best),
        seed,
        problem.evaluations,
        failures,
    )


def _check(parameters: tuple[Parameter, ...], targets: tuple[Target, ...], starts: int) -> None:
    for what, names in (
        ("parameter", [p.name for p in parameters]),
        ("target", [t.name for t in targets]),
    ):
        if not names:
            raise ModelError("calibration", f"has no {what}.", "Give at least one.")
        twice = [n for n in names if names.count(n) > 1]
        if twice:
            raise ModelError(f"{what} {twice[0]}", "is given twice.", "Give each a name.")
    if starts < 1:
        raise ModelError("calibration", f"{starts} starts asked for.", "Request at least one.")


def _starts(parameters: tuple[Parameter, ...], count: int, seed: int) -> Array:
    """Scaled starting points, (s, p)."""
    # read when asked for: statistics take longer to load than all else that a command needs
    from scipy.stats import qmc  # noqa: PLC0415

    low, high, own = (
        np.array([p.scaled(v) for p, v in zip(parameters, values, strict=True)])
        for values in zip(*((p.low, p.high, p.start) for p in parameters), strict=True)
    )
    cube = qmc.LatinHypercube(len(parameters), seed=seed).random(count - 1)
    # the reflective method wants to begin inside
    inside = 1e-6 * (high - low)
    points = np.vstack([own, low + cube * (high - low)])
    return np.asarray(np.clip(points, low + inside, high - inside))


def _nearest(costs: Array, ends: Array, own: Array) -> int:
    """Of the least costs the end nearest to the own start."""
    equal = np.flatnonzero(costs <= costs.min() + TIED)
    far = np.linalg.norm(ends[equal] - own, axis=1)
    return int(equal[int(far.argmin())])


def _on_bounds(parameters: tuple[Parameter, ...], point: Array) -> tuple[str, ...]:
    held = []
    for p, x in zip(parameters, point, strict=True):
        low, high = p.scaled(p.low), p.scaled(p.high)
        if min(x - low, high - x) <= ON_BOUND * (high - low):
            held.append(p.name)
    return tuple(held)
