"""Corrections of a Newton step, of many poses at once, and whether rows keep their sense."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def alike(before: Array, after: Array) -> NDArray[np.bool_]:
    """Whether rows span their space with one sense.

    Two branches that part at a singularity have determinants of opposite sign: a step that slips
    from one to the other shows there.

    Parameters
    ----------
    before, after : (k, r, n)
        Any unit, the same in both.

    Returns
    -------
    (k,) of bool
    """
    sign, _ = np.linalg.slogdet(after @ np.swapaxes(before, -1, -2))
    return np.asarray(sign > 0)


def least(matrix: Array, right: Array) -> Array:
    """Smallest x with A x = b.

    Parameters
    ----------
    matrix : (k, r, n)
        A, r <= n independent rows, any unit.
    right : (k, r)
        b, any unit.

    Returns
    -------
    (k, n)
        Infinite where A, or A A^T, has no inverse.
    """
    if matrix.shape[1] == matrix.shape[2]:
        square, vector = matrix, right[..., None]
        return np.asarray(_solve(square, vector)[..., 0])
    across = np.swapaxes(matrix, -1, -2)
    return np.asarray((across @ _solve(matrix @ across, right[..., None]))[..., 0])


def _solve(matrix: Array, right: Array) -> Array:
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        # one matrix without an inverse must not end the others: its step is refused
        found = np.full(right.shape, np.inf)
        for k in range(len(matrix)):
            try:
                found[k] = np.linalg.solve(matrix[k], right[k])
            except np.linalg.LinAlgError:
                continue
        return found
