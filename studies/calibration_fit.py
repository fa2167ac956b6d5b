"""The numbers of a machine that meet its measurements best, and how well they are known."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from strutwork.errors import ModelError, NumericalError, StrutworkError
from strutwork.studies.calibration_result import (
    NINETY_FIVE,
    Found,
    MachineCalibration,
    Verdict,
    agreements_of,
)
from strutwork.studies.experiment import Experiment
from strutwork.studies.identifiability import Identifiability, identifiability
from strutwork.studies.progress import Progress, silent
from strutwork.studies.undetermined import undetermined

Array = NDArray[Any]

#: A combination is determined where its 95 % interval is narrower than a factor of ten in all:
#: 2 · 1.96 / s < ln 10 for the singular value s.
TELLS = 2.0 * NINETY_FIVE / np.log(10.0)

#: Singular values below this share of the largest are rounding.
ROUNDING = 1e-7

#: Weight that leaves numbers which nothing determines at their guess, and moves no other.
TETHER = 1e-3

#: Costs that differ by less are one minimum: the data say nothing about such a difference.
TIED = 0.02

#: A number this near to a bound, as a share of its scaled range, lies on it.
ON_BOUND = 1e-4


def fit(
    experiment: Experiment, starts: int = 6, seed: int = 0, progress: Progress = silent
) -> MachineCalibration:
    """Bounded weighted least squares from several starts.

    The trust-region reflective method (Branch, Coleman and Li 1999) on the scaled numbers, the
    first start the guess, the others a Latin hypercube between the bounds. What nothing
    determines stays at its guess.

    Parameters
    ----------
    experiment : Experiment
    starts : int
    seed : int
        Of the Latin hypercube.
    progress : callable, optional
        Called after every start.

    Returns
    -------
    MachineCalibration

    Raises
    ------
    ModelError
        No measurement, or fewer measured numbers and priors than parameters; as the measurements.
    UnreachableError
        A pose that the machine cannot take.
    NumericalError
        The machine failed from every start.
    """
    notes = checked(experiment)
    points = _starts(experiment, starts, seed)
    costs, ends, failures = np.full(len(points), np.inf), points.copy(), []
    for i, start in enumerate(points):
        try:
            costs[i], ends[i] = _searched(experiment, start)
        except ModelError:
            if i == 0:
                raise
            failures.append(f"start {i + 1}: the machine cannot be made or measured there")
        except StrutworkError as error:
            failures.append(f"start {i + 1}: {error}")
        progress(i + 1, len(points))
    if not np.isfinite(costs).any():
        raise NumericalError(
            "calibration",
            f"failed from every start; the first: {failures[0]}",
            "Narrow the ranges.",
        )
    equal = np.flatnonzero(costs <= costs.min() + TIED)
    far = np.linalg.norm(ends[equal] - experiment.guess, axis=1)
    return _result(experiment, ends[equal[int(far.argmin())]], costs, notes, tuple(failures))


def checked(experiment: Experiment) -> tuple[str, ...]:
    """Refuse measurements that cannot be met, and say what is to be known of the others.

    Parameters
    ----------
    experiment : Experiment

    Raises
    ------
    ModelError
        None at all, fewer numbers and priors than parameters, or as the measurements.
    UnreachableError
        A pose that the machine cannot take.
    """
    if not experiment.measurements:
        raise ModelError(
            "calibration",
            "has no measurement.",
            "Add [[frequencies]], [[frf]] or [[deflections]]; --poses alone needs none.",
        )
    known = experiment.count + sum(u.prior is not None for u in experiment.unknowns)
    if known < len(experiment.unknowns):
        raise ModelError(
            "calibration",
            f"has {experiment.count} measured numbers for {len(experiment.unknowns)} parameters.",
            "Measure more, calibrate fewer parameters, or give a prior to those that are known.",
        )
    standing = experiment.standing(experiment.values(experiment.guess))
    return tuple(
        note
        for m, at in zip(experiment.measurements, standing, strict=True)
        for note in m.check(at)
    )


def priors(experiment: Experiment) -> Array:
    """Weights of what is known before, (g,), per unit of the scaled numbers; zero without one.

    Parameters
    ----------
    experiment : Experiment
    """
    return np.array([0.0 if u.prior is None else 1.0 / u.prior for u in experiment.unknowns])


def _starts(experiment: Experiment, count: int, seed: int) -> Array:
    from scipy.stats import qmc  # noqa: PLC0415 - slow to load

    low, high = experiment.bounds
    cube = qmc.LatinHypercube(len(low), seed=seed).random(max(count - 1, 0))
    # the reflective method wants to begin inside
    inside = 1e-6 * (high - low)
    points = np.vstack([experiment.guess, low + cube * (high - low)])
    return np.asarray(np.clip(points, low + inside, high - inside))


def _searched(experiment: Experiment, start: Array) -> tuple[float, Array]:
    """Cost without the tether, and the end of a search."""
    weights = np.hypot(priors(experiment), TETHER)
    guess, low_high = experiment.guess, experiment.bounds

    def residuals(point: Array) -> Array:
        # the constant makes the relative limit of the cost an absolute one: a cost near zero is met
        return np.concatenate([[1.0], experiment.residuals(point), weights * (point - guess)])

    def jacobian(point: Array) -> Array:
        still = np.zeros((1, len(point)))
        return np.concatenate([still, experiment.jacobian(point), np.diag(weights)])

    found = least_squares(
        residuals,
        start,
        jac=jacobian,
        bounds=low_high,
        xtol=1e-8,
        ftol=1e-8,
        gtol=1e-8,
        max_nfev=60,
    )
    tether = 0.5 * float(np.sum((TETHER * (found.x - guess)) ** 2))
    return float(found.cost) - 0.5 - tether, found.x


def limited(jacobian: Array, names: tuple[str, ...]) -> Identifiability:
    """Singular values with the limit below which a combination is not determined.

    Parameters
    ----------
    jacobian : (t, g)
        Of the residuals by the scaled numbers, no unit.
    names : (g,) of str
    """
    rows = jacobian if len(jacobian) else np.zeros((1, len(names)))
    found = identifiability(rows, names)
    largest = float(found.singular_values[0])
    limit = max(ROUNDING, TELLS / largest if largest > 0 else np.inf)
    return identifiability(rows, names, min(limit, 1.0))


def deviations(identified: Identifiability) -> Array:
    """Standard deviations of the scaled numbers, (g,), no unit; infinite where not determined.

    Parameters
    ----------
    identified : Identifiability
    """
    return np.asarray(identified.standard_errors)


def _result(
    experiment: Experiment,
    point: Array,
    costs: Array,
    notes: tuple[str, ...],
    failures: tuple[str, ...],
) -> MachineCalibration:
    jacobian = experiment.jacobian(point)
    identified = limited(jacobian, experiment.names)
    held = _on_bounds(experiment, point)
    # what a bound holds is no longer free: the others are judged with it fixed
    rest = ~held
    spread = np.full(len(held), np.inf)
    if rest.any():
        own = np.concatenate([jacobian[:, rest], np.diag(priors(experiment)[rest])])
        names = tuple(n for n, r in zip(experiment.names, rest, strict=True) if r)
        spread[rest] = deviations(limited(own, names))
        data = limited(jacobian[:, rest], names)
        judged = dict(zip(names, np.isfinite(deviations(data)), strict=True))
    else:
        judged = {}
    values = experiment.values(point)
    found = []
    for k, unknown in enumerate(experiment.unknowns):
        p = unknown.parameter
        verdict: Verdict = "at its bound"
        if not held[k]:
            verdict = "identifiable" if judged[p.name] else "not identifiable"
        known = bool(np.isfinite(spread[k]))
        ends = unknown.interval(float(values[k]), float(spread[k]), NINETY_FIVE) if known else None
        found.append(
            Found(
                *(p.name, p.unit, unknown.varied.meaning, float(values[k]), p.start, p.low, p.high),
                *(float(spread[k]), ends, verdict, unknown.prior is not None),
            )
        )
    standing = experiment.standing(values)
    said = [
        note
        for m, at in zip(experiment.measurements, standing, strict=True)
        for note in m.notes(at)
    ]
    by = dict.fromkeys(name for _, name in experiment.differences.taken)
    if by:
        said.append(
            f"derivatives for {', '.join(by)} are finite differences: no analytical ones exist"
        )
    groups = undetermined(experiment, point, identified) if rest.any() else ()
    return MachineCalibration(
        experiment,
        point,
        tuple(found),
        agreements_of(experiment, point),
        identified,
        groups,
        costs,
        (*notes, *said),
        failures,
    )


def _on_bounds(experiment: Experiment, point: Array) -> NDArray[np.bool_]:
    low, high = experiment.bounds
    near = np.minimum(point - low, high - point) <= ON_BOUND * (high - low)
    return np.asarray(near)
