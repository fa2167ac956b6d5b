"""Singular values of stacks of small matrices."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Below this many matrices the compiled code is not worth its load time.
FEW = 256


@cache
def compiled() -> bool:
    """Whether compiled code can be used: numba is installed."""
    try:
        import strutwork.kinematics.leg_kernel  # noqa: F401, PLC0415 - numba is slow to import, may be absent
    except ImportError:
        return False
    return True


def singular_values(matrices: Array) -> Array:
    """Singular values, largest first.

    Parameters
    ----------
    matrices : (..., m, n)
        All entries of one unit, whichever.

    Returns
    -------
    values : (..., min(m, n))
    """
    rows, columns = matrices.shape[-2:]
    count = int(np.prod(matrices.shape[:-2], dtype=int))
    if count < FEW or rows < columns or not compiled():
        return np.asarray(np.linalg.svd(matrices, compute_uv=False))
    from strutwork.kinematics.leg_kernel import jacobi_values  # noqa: PLC0415 - as in `compiled`

    flat = np.ascontiguousarray(matrices, dtype=float).reshape(count, rows, columns)
    values = np.empty((count, columns))
    jacobi_values(flat, values)
    return values.reshape(*matrices.shape[:-2], columns)
