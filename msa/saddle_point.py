"""The saddle-point system of the matrix structural analysis, as written.

    [ K  Aᵀ ] [ u ]   [ F ]
    [ A  0  ] [ λ ] = [ g ]

(Deblaise, Hernot, Maurine 2006; Azulay 2014, eq. 37.) K is assembled without joints, A holds
one row for every locked direction, and −λ is the force of the joint on its second node.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System
from strutwork.msa.constraints import check_consistent, free_unknowns, orthonormal_rows, scales
from strutwork.msa.diagnosis import check_held, mechanism_error
from strutwork.msa.trust import Unknowns, solve_trusted

Array = NDArray[Any]


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
        The error is not known to be small.
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
    matrix = bordered(stiffness / size, extra)
    n, r = system.topology.size, rows.basis.shape[1]

    def inverse(force: Array, gap: Array, poses: Any) -> tuple[Array, Array]:
        one = rows[poses]
        right = np.zeros((*matrix[poses].shape[:2], force.shape[-1]))
        right[:, :n] = force * d[poses] / size[poses]
        right[:, n : n + r] = one.right_side(gap)
        try:
            solution = np.linalg.solve(matrix[poses], right)
        except np.linalg.LinAlgError as error:
            raise mechanism_error(system, _singular_pose(matrix)) from error
        held = one.multipliers(solution[:, n : n + r] * size[poses])
        return solution[:, :n] * d[poses], held

    return solve_trusted(system, inverse, load, gaps)


def bordered(stiffness: Array, extra: Array) -> Array:
    """Matrix of the bordered system, (p, n + q, n + q); absent rows get a one instead.

    Parameters
    ----------
    stiffness : (p, n, n)
        Scaled, symmetric; no unit.
    extra : (p, q, n)
        Rows below it, zero where absent; no unit.
    """
    poses, n, _ = stiffness.shape
    count = extra.shape[1]
    matrix = np.zeros((poses, n + count, n + count))
    matrix[:, :n, :n] = stiffness
    matrix[:, n:, :n] = extra
    matrix[:, :n, n:] = np.swapaxes(extra, -1, -2)
    absent = ~np.any(extra, axis=-1)
    matrix[:, range(n, n + count), range(n, n + count)] = np.where(absent, -1.0, 0.0)
    return matrix


def _singular_pose(matrix: Array) -> int:
    for pose, one in enumerate(matrix):
        if np.linalg.matrix_rank(one) < len(one):
            return pose
    return 0
