"""A sparse matrix put together from dense blocks."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Array = NDArray[Any]


class Triplets:
    """Dense blocks at rows and columns; what falls on one place is added."""

    def __init__(self) -> None:
        self._parts: list[tuple[Array, Array, Array]] = []

    def add(self, rows: NDArray[np.intp], columns: NDArray[np.intp], block: Array) -> None:
        """Add a block (k, l) at k rows and l columns."""
        row = np.repeat(rows, len(columns))
        self._parts.append((row, np.tile(columns, len(rows)), block.ravel()))

    def add_entries(
        self, rows: NDArray[np.intp], columns: NDArray[np.intp], values: Array
    ) -> None:
        """Add entries (e,), each at its row and column."""
        self._parts.append((rows, columns, values))

    def matrix(self, shape: tuple[int, int]) -> sp.csr_array:
        """The matrix of all blocks."""
        if not self._parts:
            return sp.csr_array(shape)
        row, column, value = (np.concatenate(x) for x in zip(*self._parts, strict=True))
        return sp.coo_array((value, (row, column)), shape=shape).tocsr()
