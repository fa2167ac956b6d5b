"""Rows of integers that hold the same numbers in any order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]


def row_groups(rows: Ints, *, cyclic: bool = False) -> tuple[Ints, Ints]:
    """Rows (r, k) with the same numbers, whatever their order.

    Parameters
    ----------
    rows : (r, k) int
    cyclic : bool
        Only rows that are rotations of one another are the same: faces seen from one side.

    Returns
    -------
    first : (g,) int
        The first row of each group.
    group : (r,) int
        The group of each row.
    """
    keys = _from_least(rows) if cyclic else np.sort(rows, axis=1)
    # sorting by columns is several times faster than np.unique(axis=0)
    order = np.lexsort(keys.T[::-1])
    ordered = keys[order]
    new = np.append(True, (ordered[1:] != ordered[:-1]).any(axis=1))[: len(rows)]
    group = np.empty(len(rows), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    # lexsort is stable: the first of a group in sorted order is its first in the given order
    return order[new], group


def _from_least(rows: Ints) -> Ints:
    """Each row rotated until its least number comes first."""
    width = rows.shape[1]
    start = rows.argmin(axis=1)[:, None] if len(rows) else np.zeros((0, 1), dtype=np.int64)
    return np.take_along_axis(rows, (start + np.arange(width)) % width, axis=1)
