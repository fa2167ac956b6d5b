"""CHOLMOD through scikit-sparse: the fastest for positive definite matrices."""

from __future__ import annotations

import importlib.util
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.fea.factor import Factor, NotPositiveError, complex_too
from strutwork.fea.ordering import Ordering

Array = NDArray[Any]

NAME = "CHOLMOD"

#: What is factorised: complex matrices, matrices with negative eigenvalues.
COMPLEX, INDEFINITE = False, False


def available() -> bool:
    """Whether a scikit-sparse with the interface of 0.4 is installed."""
    return (
        importlib.util.find_spec("sksparse") is not None
        and importlib.util.find_spec("sksparse.cholmod") is not None
    )


def factorize(matrix: sp.csc_array, ordering: Ordering | None) -> Factor:
    """Supernodal Cholesky factors.

    Source: Chen, Davis, Hager and Rajamanickam (2008), ACM TOMS 35, algorithm 887.

    Parameters
    ----------
    matrix : (n, n) sparse
        Real, symmetric, positive definite, any unit.
    ordering : Ordering or None
        Order of elimination; None lets METIS choose.

    Raises
    ------
    NotPositiveError
        A pivot that is not positive.
    NumericalError
        Any other failure of CHOLMOD, as memory that runs out.
    """
    from sksparse.cholmod import (  # noqa: PLC0415 - an extra
        CholmodError,
        CholmodNotPositiveDefiniteError,
        cholesky,
    )

    # scikit-sparse 0.4 knows no sparse arrays
    whole = sp.csc_matrix(matrix)
    order = None if ordering is None else ordering.order
    if order is not None:
        whole = whole[order][:, order]
    try:
        factor = cholesky(
            whole,
            mode="supernodal",
            ordering_method="metis" if order is None else "natural",
        )
    except CholmodNotPositiveDefiniteError as error:
        raise NotPositiveError from error
    except CholmodError as error:
        raise NumericalError("factorisation", str(error), "Try another solver.") from error

    def solve(right: Array) -> Array:
        if order is None:
            return np.asarray(factor.solve_A(right))
        result = np.empty_like(right)
        result[order] = factor.solve_A(right[order])
        return result

    return Factor(complex_too(solve), NAME, lambda: 0)
