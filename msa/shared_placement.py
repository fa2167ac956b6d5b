"""Statics of a stack of structures whose one placement decides rows, ranks and coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System, system_of
from strutwork.msa.constraints import free_unknowns, orthonormal_rows, scales
from strutwork.msa.diagnosis import mechanism_error
from strutwork.msa.nodal import unbalanced
from strutwork.msa.null_space import independent_basis
from strutwork.msa.on_coordinates import on_coordinates
from strutwork.msa.saddle_point import solve_saddle_point
from strutwork.msa.trust import Unknowns, solve_trusted

Array = NDArray[Any]


def solve_shared(system: System, load: Array, gaps: Array) -> Unknowns:
    """Solve on the independent coordinates of the one placement; multipliers from the equilibrium.

    Returns and errors as `solve_saddle_point`, which is taken where poses differ, where there are
    misfits, and where motions are free.

    Parameters
    ----------
    system : System
    load : (p, n, m)
        F on the unknowns, N and N·m.
    gaps : (p, r, m)
        g, the misfits of the constraint rows, m and rad.
    """
    lone = system.lone
    if lone is None or np.any(gaps) or free_unknowns(lone).shape[-1]:
        return solve_saddle_point(system, load, gaps)
    basis, rows, d = independent_basis(lone), orthonormal_rows(lone), scales(lone)[..., None]
    stiffness = on_coordinates(system, system.contributions())
    diagonal = np.einsum("pii->pi", stiffness)
    if np.any(diagonal <= 0):
        raise mechanism_error(system, int(np.argwhere(diagonal <= 0)[0][0]))
    scale = 1.0 / np.sqrt(diagonal)
    matrix = stiffness * scale[:, :, None] * scale[:, None, :]
    try:
        # Cholesky proves that the matrix is positive definite
        np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError as error:
        raise mechanism_error(system, int(np.linalg.eigvalsh(matrix)[:, 0].argmin())) from error

    def inverse(force: Array, gap: Array, poses: Any) -> tuple[Array, Array]:
        part = system if isinstance(poses, slice) else system_of(system.placed[poses])
        turned = np.swapaxes(basis, -1, -2) @ force
        by = scale[poses][..., None]
        moved = basis @ (by * np.linalg.solve(matrix[poses], by * turned))
        left, _, _ = unbalanced(part, moved, np.zeros_like(gap), force, np.zeros_like(gap))
        return moved, rows.multipliers(rows.basis @ (left * d))

    return solve_trusted(system, inverse, load, gaps)
