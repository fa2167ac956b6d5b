"""The saddle-point system of the matrix structural analysis, as written.

    [ K  Aᵀ ] [ u ]   [ F ]
    [ A  0  ] [ λ ] = [ g ]

(Deblaise, Hernot, Maurine 2006; Azulay 2014, eq. 37.) K is assembled without joints, A holds
one row for every locked direction, and −λ is the force of the joint on its second node.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from msa.assembly import System
from msa.constraints import (
    Rows,
    check_consistent,
    free_unknowns,
    orthonormal_rows,
    scales,
)
from msa.diagnosis import check_held, check_residual, mechanism_error

Array = NDArray[Any]

#: Misfits that cost no force leave round-off of forces that cancel: this share of |K| |u| counts
#: as load in the residual of a case with misfits.
CANCELLED = 1e-5

#: Displacements below this share of load over stiffness are rounding.
ROUNDING = 1e-12

#: A refinement that changes displacements by less than this share leaves them trusted.
TRUSTED = 1e-7


@dataclass(frozen=True)
class Unknowns:
    """Solution of a system.

    Parameters
    ----------
    displacements : (p, n, m)
        Of the rigid clusters at their reference nodes, m and rad.
    multipliers : (p, r, m)
        Of the constraint rows, N and N·m; where rows are redundant, the least in balance.
    residual : (p,)
        Largest residual of the equilibrium, as a share of the load.
    """

    displacements: Array
    multipliers: Array
    residual: Array


def solve_saddle_point(system: System, load: Array, gaps: Array) -> Unknowns:
    """Solve the whole system with its multipliers, redundant rows found by rank.

    Parameters
    ----------
    system : System
    load : (p, n, m)
        F on the unknowns, N and N·m.
    gaps : (p, r, m)
        g, the misfits of the constraint rows, m and rad.

    Returns
    -------
    Unknowns
        Motions that nothing resists and no load excites are left out of the displacements.

    Raises
    ------
    MechanismError
        A load does work in a motion that nothing resists.
    InconsistentConstraintsError
        Misfits of redundant rows contradict one another.
    NumericalError
        The residual is not small.
    """
    rows = orthonormal_rows(system)
    check_consistent(system, rows, gaps)
    free = free_unknowns(system)
    check_held(system, free, load)
    d = scales(system)[..., None]
    stiffness = system.stiffness * (d * np.swapaxes(d, -1, -2))
    size = np.abs(stiffness).max(axis=(1, 2), initial=0.0)
    size = np.where(size == 0, 1.0, size)[:, None, None]
    extra = np.concatenate([rows.basis, np.swapaxes(free, -1, -2)], axis=1)
    matrix, right = bordered(stiffness / size, extra, load * d / size, rows, gaps)
    solution, trusted = refined_solve(system, matrix, right)
    n, r = system.topology.size, rows.basis.shape[1]
    displacements = solution[:, :n] * d
    multipliers = rows.multipliers(solution[:, n : n + r] * size)
    return checked(system, displacements, multipliers, load, gaps, trusted)


def bordered(
    stiffness: Array, extra: Array, load: Array, rows: Rows, gaps: Array
) -> tuple[Array, Array]:
    """Matrix and right-hand side of the bordered system; absent rows get a one instead."""
    poses, n, _ = stiffness.shape
    count = extra.shape[1]
    matrix = np.zeros((poses, n + count, n + count))
    matrix[:, :n, :n] = stiffness
    matrix[:, n:, :n] = extra
    matrix[:, :n, n:] = np.swapaxes(extra, -1, -2)
    absent = ~np.any(extra, axis=-1)
    matrix[:, range(n, n + count), range(n, n + count)] = np.where(absent, -1.0, 0.0)
    right = np.zeros((poses, n + count, load.shape[-1]))
    right[:, :n] = load
    right[:, n : n + gaps.shape[1]] = rows.right_side(gaps)
    return matrix, right


def refined_solve(system: System, matrix: Array, right: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Solve a stack of systems with one step of iterative refinement.

    Returns
    -------
    solution : (p, n, m)
    trusted : (p,)
        True where the refinement hardly changed the displacements: `TRUSTED` of the largest at
        most. Its size is that of the error of the first solution, so a pose next to a
        mechanism is never trusted, and one whose stiffnesses only differ much is.

    Raises
    ------
    MechanismError, NumericalError
        A singular matrix.
    """
    try:
        solution = np.linalg.solve(matrix, right)
        change = np.linalg.solve(matrix, right - matrix @ solution)
    except np.linalg.LinAlgError as error:
        raise mechanism_error(system, _singular_pose(matrix)) from error
    n = system.topology.size
    moved = np.abs(solution[:, :n]).max(axis=1, initial=0.0)
    trusted = (np.abs(change[:, :n]).max(axis=1, initial=0.0) <= TRUSTED * moved).all(axis=-1)
    return solution + change, trusted


def checked(
    system: System,
    displacements: Array,
    multipliers: Array,
    load: Array,
    gaps: Array,
    trusted: NDArray[np.bool_] | None = None,
) -> Unknowns:
    """The solution with its residuals checked: K u + Aᵀ λ − F, and A u − g.

    Where a misfit drives the structure, or the solution is `trusted`, the residual may be as
    large as the rounding of the terms that cancel in K u.
    """
    d = scales(system)[..., None]
    inner = system.stiffness @ displacements
    held = np.swapaxes(system.rows, -1, -2) @ multipliers
    residual = np.abs((inner + held - load) * d).max(axis=(1, 2), initial=0.0)
    cancels = np.any(gaps, axis=1)
    if trusted is not None:
        cancels = cancels | trusted[:, None]
    forced = displacements * cancels[:, None]
    terms = CANCELLED * np.abs(system.stiffness) @ np.abs(forced)
    size = np.maximum.reduce(
        [np.abs(part * d).max(axis=(1, 2), initial=0.0) for part in (inner, held, load, terms)]
    )
    check_residual(residual, size, "static solution")
    miss = np.abs(system.rows @ displacements - gaps).max(axis=(1, 2), initial=0.0)
    moved = np.abs(displacements).max(axis=(1, 2), initial=0.0)
    # under a load that rigid joints take alone the displacements are rounding of this size
    stiff = np.abs(system.stiffness * (d * np.swapaxes(d, -1, -2))).max(axis=(1, 2), initial=0.0)
    given = np.abs(load * d).max(axis=(1, 2), initial=0.0)
    still = ROUNDING * np.divide(given, stiff, out=np.zeros_like(given), where=stiff > 0)
    size_of_motion = np.maximum.reduce(
        [moved, still, np.full_like(moved, np.abs(gaps).max(initial=0.0))]
    )
    check_residual(miss, size_of_motion, "joint constraints")
    return Unknowns(displacements, multipliers, residual / np.where(size == 0, 1.0, size))


def _singular_pose(matrix: Array) -> int:
    for pose, one in enumerate(matrix):
        if np.linalg.matrix_rank(one) < len(one):
            return pose
    return 0
