"""A basis with many zeros, so that parts can be distinguished."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def sparse_basis(vectors: Array) -> Array:
    """Another basis (n, k) of the columns' span with many zeros: parts can be distinguished.

    Gauss-Jordan elimination with complete pivoting; each vector's largest entry is one.

    Parameters
    ----------
    vectors : (n, k)
        Independent columns, all entries of one unit, whichever.
    """
    rows = np.array(vectors.T, dtype=float)
    for k in range(len(rows)):
        pivot, j = divmod(int(np.abs(rows[k:]).argmax()), rows.shape[1])
        rows[[k, k + pivot]] = rows[[k + pivot, k]]
        rows[k] /= rows[k, j]
        others = np.arange(len(rows)) != k
        rows[others] -= np.outer(rows[others, j], rows[k])
    rows[np.abs(rows) < 1e-7] = 0.0
    largest = np.abs(rows).max(axis=1, initial=0.0)
    return np.asarray((rows / np.where(largest == 0, 1.0, largest)[:, None]).T)
