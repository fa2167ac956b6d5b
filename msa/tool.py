"""Compliance at the tool."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.msa.assembly import System, system_of
from strutwork.msa.compiled import available, compiled_compliance, program_of
from strutwork.msa.diagnosis import mechanisms_under
from strutwork.msa.movable import always_movable, movable_directions, tool_length
from strutwork.msa.solve import METHODS, default_method
from strutwork.msa.stiffness import doubtful, scaled
from strutwork.msa.structure import PlacedStructure
from strutwork.msa.variant_of import expected_poses, origin_of
from strutwork.outcome import Outcome, solve_poses

Array = NDArray[Any]

ToolMethod = Literal["compiled", "saddle_point", "null_space", "condensed", "sparse"]

#: Poses from which the compiled kernel is worth loading.
COMPILED_FROM = 256

#: As many of variants of one structure, each of which the dense solvers would take by itself.
VARIANTS_FROM = 64

#: Poses solved at once by the dense solvers: keeps a stack of frames within some megabytes.
CHUNK = 128


def tool_compliance(
    placed: PlacedStructure, method: ToolMethod | None = None, workers: int = 1
) -> Array:
    """Compliance at the tool centre point.

    Solves the system for six unit wrenches (Azulay 2014, eq. 37); never inverts a part of the
    stiffness.

    Parameters
    ----------
    placed : PlacedStructure
    method : str, optional
        "compiled", or as `solve`. Default: compiled for `COMPILED_FROM` poses and more where
        the kernel applies, else as `solve`. Poses that the compiled kernel cannot vouch for
        are solved again by the saddle-point system, or the sparse solver where it is large.
    workers : int
        Threads of the compiled kernel.

    Returns
    -------
    compliance : (..., 6, 6)
        Twist per unit wrench; blocks in m/N, 1/N, 1/N, rad/(N·m). Symmetric; exactly without
        what rounding would add in directions that the locked joints leave no motion. In a
        batch, NaN at poses without an answer; `compliance_and_outcome` says why.

    Raises
    ------
    MechanismError
        The structure moves freely under one of the wrenches, at the single pose or at all of
        the batch; names the joints that let it.
    ModelError
        No tool, an unknown method, or a structure that the compiled kernel does not take.
    NumericalError
        The residual is not small, at the single pose or at all of the batch.

    Warns
    -----
    PoseWarning
        Some poses of the batch have no answer: how many, and why.
    """
    compliance, outcome = compliance_and_outcome(placed, method, workers)
    outcome.require_some().warn("tool compliance")
    return compliance


def compliance_and_outcome(
    placed: PlacedStructure, method: ToolMethod | None = None, workers: int = 1
) -> tuple[Array, Outcome]:
    """Compliance at the tool centre point, and what became of every pose.

    Parameters
    ----------
    placed, method, workers
        As `tool_compliance`.

    Returns
    -------
    compliance : (..., 6, 6)
        As `tool_compliance`; NaN where a pose was not solved.
    outcome : Outcome
        Which poses were solved, and why others were not. Poses never raise.

    Raises
    ------
    ModelError
        As `tool_compliance`, and what is wrong with the model whatever the pose.
    """
    system = system_of(placed)
    if method not in (None, "compiled", *METHODS):
        raise ModelError(
            "tool_compliance",
            f'unknown method "{method}".',
            "One of: compiled, " + ", ".join(METHODS),
        )
    program = None
    structure = placed.structure
    many = max(system.poses, placed.of_many) >= COMPILED_FROM
    many = many or expected_poses(structure) >= VARIANTS_FROM
    if method == "compiled" or (method is None and many):
        # the kernel has the numbers of one structure for all poses
        one = system.placed.numbers is structure.numbers
        program = program_of(system) if one and available() else None
        if program is None and method == "compiled":
            raise ModelError(
                "tool_compliance",
                "the compiled kernel does not support this structure, or numba is not installed.",
                "Omit the method.",
            )
    if program is None:
        result, outcome = _stacked(system, method)
    else:
        result, again = compiled_compliance(system, program, workers, keeps=not placed.of_many)
        outcome = Outcome.good((system.poses,))
        if np.any(again):
            result[again], some = _stacked(system_of(system.placed[again]), None)
            outcome.status[again] = some.status
            outcome = Outcome(outcome.status, some.reasons, some.errors)
    _project(system, result, outcome.solved)
    return result.reshape(*placed.batch, 6, 6), outcome.reshaped(placed.batch)


def prepare_compliance(placed: PlacedStructure) -> None:
    """Make what all parts of a study share, on poses that are spread over the study.

    The coordinates that follow from others in closed loops are chosen on the poses of the first
    solve. Made beforehand, they do not hang on which part of the study comes first.

    Parameters
    ----------
    placed : PlacedStructure
        Some poses of it, with `PlacedStructure.of_many`; none does nothing.
    """
    system = system_of(placed)
    if system.poses and placed.of_many >= COMPILED_FROM and available():
        program_of(system)


def _stacked(system: System, method: ToolMethod | None) -> tuple[Array, Outcome]:
    """Compliance through the stacked dense solvers, or the sparse one, (p, 6, 6)."""
    chosen = method or default_method(system)
    system.tool_load()  # a structure without a tool is no matter of poses
    result = np.full((system.poses, 6, 6), np.nan)

    def run(part: NDArray[np.intp]) -> None:
        for start in range(0, len(part), CHUNK):
            some = part[start : start + CHUNK]
            result[some] = _solved(system_of(system.placed[some]), chosen)

    outcome = solve_poses(run, system.poses, lambda: mechanisms_under(system, System.tool_load))
    result[~outcome.solved] = np.nan
    return result, outcome


def _solved(system: System, method: str) -> Array:
    system.placed.check()
    load = system.tool_load()
    gaps = np.zeros((system.poses, len(system.row_labels), 6))
    unknowns = METHODS[method](system, load, gaps)
    result = np.swapaxes(load, -1, -2) @ unknowns.displacements
    gap = np.abs(result - np.swapaxes(result, -1, -2)).max(axis=(1, 2), initial=0.0)
    size = np.abs(result).max(axis=(1, 2), initial=0.0)
    if not np.all(gap <= 1e-6 * size):
        raise NumericalError(
            "tool compliance", "is not symmetric to 1e-6.", "The structure is badly conditioned."
        )
    return np.asarray((result + np.swapaxes(result, -1, -2)) / 2.0)


def _project(system: System, compliance: Array, solved: NDArray[np.bool_]) -> None:
    """Leave in each compliance (p, 6, 6) only the directions in which the tool can move."""
    if _always_movable(system):
        return
    poses = np.flatnonzero(solved)
    for start in range(0, len(poses), 64 * CHUNK):
        some = poses[start : start + 64 * CHUNK]
        part = system_of(system.placed[some])
        some = some[doubtful(scaled(compliance[some], tool_length(part))[0])]
        if not some.size:
            continue
        found = movable_directions(system_of(system.placed[some]))
        locked = found.rank < 6
        some = some[locked]
        compliance[some] = found[locked].projected(compliance[some])


def _always_movable(system: System) -> bool:
    """As `always_movable`; kept with the structure whose topology decides it."""
    structure = system.placed.structure
    kept = (origin_of(structure) or structure).__dict__
    if "_always_movable" not in kept:
        kept["_always_movable"] = always_movable(system)
    return bool(kept["_always_movable"])
