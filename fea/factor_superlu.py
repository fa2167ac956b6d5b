"""SuperLU, which comes with SciPy, in METIS's order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import SuperLU, splu

from strutwork.fea.factor import Factor, complex_too, singular
from strutwork.fea.ordering import Ordering

Array = NDArray[Any]
Solve = Callable[[Array], Array]

NAME = "SuperLU"

#: What is factorised: complex matrices, matrices with negative eigenvalues.
COMPLEX, INDEFINITE = True, True


def available() -> bool:
    """Whether the library is installed."""
    return True


def factorize(matrix: sp.csc_array, ordering: Ordering | None) -> Factor:
    """Factors without pivoting, after the order given or SuperLU's own for symmetric patterns.

    Parameters
    ----------
    matrix : (n, n) sparse
        Symmetric, real or complex, any unit.
    ordering : Ordering or None
        Order of elimination; None lets SuperLU choose.

    Raises
    ------
    NumericalError
        A singular matrix.
    """
    options = {"SymmetricMode": True}
    try:
        if ordering is None:
            plain = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
            return Factor(_accepting(matrix.dtype, plain.solve), NAME, lambda: _negative(plain))
        order = ordering.order
        ordered = splu(
            sp.csc_array(matrix[order][:, order]),
            permc_spec="NATURAL",
            diag_pivot_thresh=0.0,
            options=options,
        )
    except RuntimeError as error:
        raise singular() from error

    def solve(right: Array) -> Array:
        result = np.empty_like(right)
        result[order] = ordered.solve(right[order])
        return result

    return Factor(
        _accepting(matrix.dtype, solve), f"{NAME} ordered by METIS", lambda: _negative(ordered)
    )


def _accepting(dtype: np.dtype[Any], solve: Solve) -> Solve:
    if dtype.kind == "c":
        return lambda right: solve(np.asarray(right, dtype=complex))
    return complex_too(solve)


def _negative(factors: SuperLU) -> int:
    return int(np.count_nonzero(factors.U.diagonal() < 0))
