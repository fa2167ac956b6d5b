"""Studying the forces that tolerances lock into an assembly, at one pose or several."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa.structure import PlacedStructure
from strutwork.overconstraint import (
    Allocation,
    Limits,
    Quantity,
    Responses,
    Tolerance,
    WorstCase,
    allocate,
    distribution,
    limit_vector,
    tolerance_responses,
    tool_deviation,
    worst_case,
)
from strutwork.studies.tolerance_result import ToleranceStudy

Array = NDArray[Any]

#: Of the assemblies that stay below the quantiles that are shown.
SHARES = (0.5, 0.9, 0.95, 0.99, 0.999)

#: Assemblies drawn unless another number is asked for.
SAMPLES = 100_000

Teller = Callable[[str], Callable[[int, int], None]]
Objective = Literal["uniform", "cost"]


@dataclass(frozen=True, kw_only=True)
class StudyOptions:
    """What is computed in addition to the worst case.

    Parameters
    ----------
    samples : int
        Of the distribution; 0 for none.
    seed : int
    method : str
        "monte_carlo" or "quasi_monte_carlo".
    objective : "uniform", "cost" or None
        Of the allocation; None for none.
    quantile : float or None
        Share of the assemblies that an allocation keeps within limits; None for all.
    costs : mapping of tolerance name to float
        Weights of the objective "cost", any unit; one where absent.
    """

    samples: int = SAMPLES
    seed: int = 2002
    method: str = "monte_carlo"
    objective: Objective | None = None
    quantile: float | None = None
    costs: Mapping[str, float] | None = None


def tolerance_study(
    placed: PlacedStructure,
    tolerances: Sequence[Tolerance],
    limits: Limits | None = None,
    options: StudyOptions | None = None,
    *,
    title: str = "",
    poses: Sequence[str] | None = None,
    quantities: Sequence[Quantity] | None = None,
    progress: Teller | None = None,
) -> ToleranceStudy:
    """Study the forces that tolerances lock into an assembly.

    Parameters
    ----------
    placed : PlacedStructure
        At one pose or a batch of them.
    tolerances : sequence of Tolerance
    limits : mapping of (joint, kind) to float, optional
        Greatest forces and moments, N and N·m.
    options : StudyOptions, optional
    title : str
    poses : sequence of str, optional
        A label for each pose.
    quantities : sequence of Quantity, optional
        Default: all that the joints carry, and the tool's displacements.
    progress : callable, optional
        Given the name of a part of the work, returns what is called with how far it is.

    Returns
    -------
    ToleranceStudy

    Raises
    ------
    ModelError
        No tolerances, an allocation without limits, or as `misfit_sources`.
    StrutworkError
        As `influence` and `allocate`.
    """
    options = options or StudyOptions()
    known: Limits = limits or {}
    if not tolerances:
        raise ModelError("tolerances", "are none.", "Add [[tolerances]]; see docs/tolerances.md.")
    if options.objective is not None and not known:
        raise ModelError(
            "force limits",
            "are not given, and an allocation needs some.",
            "Add [[force_limits]], or give --limit.",
        )
    responses = in_a_row(tolerance_responses(placed, tolerances, quantities))
    # a worst case over poses says nothing when one of them has no answer
    responses.influence.outcome.require_all()
    worst = worst_case(responses)
    labels = tuple(poses) if poses is not None else _labels(len(worst.value))
    governing = _governing(worst, known)
    there = at_pose(responses, governing)
    sampled = None
    if options.samples:
        sampled = distribution(
            there,
            options.samples,
            options.method,
            options.seed,
            SHARES,
            limits=known or None,
            progress=None if progress is None else progress("distribution"),
        )
    tool = placed.structure.linkage.tool
    return ToleranceStudy(
        title,
        labels,
        worst,
        known,
        governing,
        sampled,
        None if tool is None else tool_deviation(worst),
        _allocation(responses, known, options),
    )


def in_a_row(responses: Responses) -> Responses:
    """The same responses with one batch axis of poses.

    Parameters
    ----------
    responses : Responses
        At a batch of any shape.
    """
    gain = responses.gain
    batch = gain.shape[:-3]
    count = int(np.prod(batch, dtype=int))

    def flat(array: Array, own: int) -> Array:
        whole = np.broadcast_to(array, (*batch, *array.shape[array.ndim - own :]))
        return whole.reshape(count, *array.shape[array.ndim - own :])

    sources, found = responses.sources, responses.influence
    return replace(
        responses,
        gain=flat(gain, 3),
        mean=flat(responses.mean, 2),
        sources=replace(sources, map=flat(sources.map, 2), mean=flat(sources.mean, 1)),
        influence=replace(
            found,
            forces=flat(found.forces, 3),
            tool=flat(found.tool, 2),
            redundant=flat(found.redundant, 0),
            residual=flat(found.residual, 0),
            outcome=found.outcome.reshaped((count,)),
        ),
    )


def at_pose(responses: Responses, pose: int) -> Responses:
    """The responses at one of their poses.

    Parameters
    ----------
    responses : Responses
        With one batch axis.
    pose : int
    """
    sources = responses.sources
    return replace(
        responses,
        gain=responses.gain[pose],
        mean=responses.mean[pose],
        sources=replace(sources, map=sources.map[pose], mean=sources.mean[pose]),
        influence=responses.influence[pose],
    )


def _governing(worst: WorstCase, limits: Limits) -> int:
    """Pose with the largest utilisation, else with the largest force."""
    if limits:
        weight = 1.0 / limit_vector(worst.responses, limits)
    else:
        weight = np.array([float(q.unit == "N") for q in worst.responses.quantities])
    return int((worst.value * weight).max(axis=-1, initial=0.0).argmax())


def _allocation(responses: Responses, limits: Limits, options: StudyOptions) -> Allocation | None:
    if options.objective is None:
        return None
    return allocate(
        responses,
        limits,
        objective=options.objective,
        costs=options.costs if options.objective == "cost" else None,
        quantile=options.quantile,
        samples=options.samples or SAMPLES,
    )


def _labels(count: int) -> tuple[str, ...]:
    return ("as given",) if count == 1 else tuple(f"pose {i}" for i in range(count))
