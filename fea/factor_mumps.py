"""MUMPS through PyMUMPS: symmetric, indefinite and complex too."""

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

NAME = "MUMPS"

#: What is factorised: complex matrices, matrices with negative eigenvalues.
COMPLEX, INDEFINITE = True, True

#: MUMPS's codes for matrices that are structurally or numerically singular.
SINGULAR = (-6, -10)


class _Alone:
    """Stands in for the communicator where MUMPS was built without MPI."""

    rank = 0

    @staticmethod
    def py2f() -> int:
        """Any number: the sequential library looks at none."""
        return -987654


def available() -> bool:
    """Whether PyMUMPS is installed."""
    return importlib.util.find_spec("mumps") is not None


def _communicator() -> Any:
    try:
        from mpi4py import MPI  # noqa: PLC0415 - an extra
    except (ImportError, RuntimeError):  # no MPI on this machine: then MUMPS is sequential
        return _Alone()
    return MPI.COMM_SELF


def factorize(matrix: sp.csc_array, ordering: Ordering | None) -> Factor:
    """Symmetric factors L D Lᵀ, pivoted within the fronts.

    Source: Amestoy, Duff, L'Excellent and Koster (2001), SIAM Journal on Matrix Analysis and
    Applications 23, 15.

    Parameters
    ----------
    matrix : (n, n) sparse
        Symmetric, real or complex, any unit.
    ordering : Ordering or None
        Order of elimination; None lets MUMPS choose.

    Raises
    ------
    NumericalError
        A singular matrix, or any other failure of MUMPS, with its number.
    """
    import mumps  # noqa: PLC0415 - an extra

    kind = matrix.dtype.kind == "c"
    context = (mumps.ZMumpsContext if kind else mumps.DMumpsContext)(
        par=1, sym=2, comm=_communicator()
    )
    context.set_silent()
    size = matrix.shape[0]
    context.set_shape(size)
    context.set_centralized_assembled(*_entries(matrix))
    context.set_icntl(13, 1)
    context.set_icntl(14, 30)
    if ordering is None:
        context.set_icntl(7, 5)
    else:
        place = np.empty(size, dtype=np.int32)
        place[ordering.order] = np.arange(1, size + 1)
        context.set_icntl(7, 1)
        context.id.perm_in = context.cast_array(place)
    try:
        context.run(4)
    except RuntimeError as error:
        code = context.get_infog(1)
        context.destroy()
        if code in SINGULAR:
            raise singular() from error
        raise NumericalError(
            "factorisation", f"failed with MUMPS's error {code}.", "Try another solver."
        ) from error
    # refinement and error analysis alone would read the entries again, and neither is asked for
    context._refs.clear()  # noqa: SLF001 - 16 bytes an entry through the solutions
    negative = int(context.get_infog(12))
    handle = _Handle(context)

    def solve(right: Array) -> Array:
        return handle.solve(np.asarray(right, dtype=complex if kind else float))

    return Factor(solve if kind else complex_too(solve), NAME, lambda: negative)


def _entries(matrix: sp.csc_array) -> tuple[Array, Array, Array]:
    """Rows and columns, counted from one, and values of the lower triangle."""
    lower = sp.coo_array(sp.tril(matrix))
    row, column = (np.array(x, dtype=np.int32) for x in lower.coords)
    row += 1
    column += 1
    return row, column, np.ascontiguousarray(lower.data)


class _Handle:
    """Keeps a MUMPS instance alive as long as its solve, and ends it in order."""

    def __init__(self, context: Any) -> None:
        self._context = context
        self._end = weakref.finalize(self, context.destroy)

    def solve(self, right: Array) -> Array:
        context = self._context
        columns = np.array(right.reshape(len(right), -1), order="F")
        context.id.nrhs = columns.shape[1]
        context.id.lrhs = len(columns)
        context.id.rhs = context.cast_array(columns)
        context.run(3)
        return columns.reshape(right.shape)
