"""Factorisation of large sparse symmetric matrices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import SuperLU, splu

from strutwork.errors import NumericalError

Array = NDArray[Any]

pymetis: Any
try:
    import pymetis
except ImportError:  # SuperLU's own ordering serves too, with more fill
    pymetis = None


@dataclass(frozen=True)
class Factor:
    """A factorised matrix.

    Parameters
    ----------
    solve : callable
        From a right-hand side (n,) or (n, m) to the solution.
    name : str
        Which factorisation ran.
    negative_pivots : callable
        Number of negative pivots, which is that of negative eigenvalues (Sylvester's law of
        inertia). Copies the factors: for the few cases that need it.
    """

    solve: Callable[[Array], Array]
    name: str
    negative_pivots: Callable[[], int]

    def __repr__(self) -> str:
        return f"<Factor: {self.name}>"


def factorize(matrix: sp.csc_array) -> Factor:
    """Factorise a symmetric matrix, positive definite but for a few eigenvalues.

    By SuperLU without pivoting, in the order of METIS's nested dissection where pymetis is
    installed, else in SuperLU's own for symmetric patterns.

    Parameters
    ----------
    matrix : (n, n) sparse

    Returns
    -------
    Factor

    Raises
    ------
    NumericalError
        A singular matrix.
    """
    whole = sp.csc_array(matrix)
    options = {"SymmetricMode": True}
    try:
        if pymetis is None:
            plain = splu(whole, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
            return Factor(plain.solve, "SuperLU", lambda: _negative(plain))
        order = nested_dissection(whole)
        ordered = splu(
            sp.csc_array(whole[order][:, order]),
            permc_spec="NATURAL",
            diag_pivot_thresh=0.0,
            options=options,
        )
    except RuntimeError as error:
        raise NumericalError(
            "factorisation", "met a singular matrix.", "Look for a part that nothing holds."
        ) from error

    def solve(right: Array) -> Array:
        result = np.empty_like(right)
        result[order] = ordered.solve(right[order])
        return result

    return Factor(solve, "SuperLU ordered by METIS", lambda: _negative(ordered))


def _negative(factors: SuperLU) -> int:
    return int(np.count_nonzero(factors.U.diagonal() < 0))


def nested_dissection(matrix: sp.csc_array) -> NDArray[np.intp]:
    """Fill-reducing order of a symmetric pattern: row i of the ordered matrix is order[i].

    Source: Karypis and Kumar (1998), METIS.
    """
    pattern = sp.csr_array(matrix)
    row = np.repeat(np.arange(pattern.shape[0]), np.diff(pattern.indptr))
    beside = row != pattern.indices
    degrees = np.bincount(row[beside], minlength=pattern.shape[0])
    starts = np.concatenate([[0], np.cumsum(degrees)])
    graph = pymetis.CSRAdjacency(starts.astype(np.int64), pattern.indices[beside].astype(np.int64))
    first, _ = pymetis.nested_dissection(adjacency=graph)
    return np.asarray(first, dtype=np.intp)
