"""PARDISO of the Math Kernel Library through pypardiso: real symmetric matrices."""

from __future__ import annotations

import importlib.util
import weakref
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.fea.factor import Factor, complex_too, singular
from strutwork.fea.ordering import Ordering

Array = NDArray[Any]

NAME = "PARDISO"

#: What is factorised: complex matrices, matrices with negative eigenvalues.
COMPLEX, INDEFINITE = False, True

#: Matrix type: real, symmetric, indefinite.
SYMMETRIC = -2

#: 64 parameters count from one; those that differ from zero. Input: own values, nested
#: dissection, perturbation of tiny pivots 1e-13, count of negative pivots.
PARAMETERS = {1: 1, 2: 2, 10: 13, 18: -1, 24: 0, 27: 0}

PERTURBED, NEGATIVE = 14, 23


def available() -> bool:
    """Whether pypardiso is installed."""
    return importlib.util.find_spec("pypardiso") is not None


def factorize(matrix: sp.csc_array, _: Ordering | None) -> Factor:
    """Symmetric factors L D Lᵀ in PARDISO's own order.

    Source: Schenk and Gärtner (2004), Future Generation Computer Systems 20, 475.

    Parameters
    ----------
    matrix : (n, n) sparse
        Real, symmetric, any unit.
    _ : Ordering or None
        Not used: PARDISO takes its own.

    Raises
    ------
    NumericalError
        A singular matrix, or any other failure of PARDISO.
    """
    from pypardiso import PyPardisoSolver  # noqa: PLC0415 - an extra

    # PARDISO wants the whole diagonal stored
    upper = sp.csr_matrix(sp.triu(matrix) + sp.csr_matrix(matrix.shape))
    if not np.all(matrix.diagonal() != 0):
        raise singular()
    upper.sort_indices()
    solver = PyPardisoSolver(mtype=SYMMETRIC)
    for place, value in PARAMETERS.items():
        solver.set_iparm(place, value)
    try:
        solver.factorize(upper)
    except Exception as error:
        solver.free_memory(everything=True)
        raise NumericalError("factorisation", str(error), "Try another solver.") from error
    if solver.get_iparm(PERTURBED) > 0:
        solver.free_memory(everything=True)
        raise singular()
    negative = int(solver.get_iparm(NEGATIVE))
    return Factor(complex_too(_Handle(solver, upper).solve), NAME, lambda: negative)


class _Handle:
    """Keeps the factors as long as their solve, and frees them in order."""

    def __init__(self, solver: Any, upper: Any) -> None:
        self._solver, self._upper = solver, upper
        weakref.finalize(self, solver.free_memory, everything=True)

    def solve(self, right: Array) -> Array:
        columns = np.asfortranarray(right.reshape(len(right), -1))
        return np.asarray(self._solver.solve(self._upper, columns)).reshape(right.shape)
