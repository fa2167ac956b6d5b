"""Order and symbolic factor of a sparse symmetric elimination, free of numbers.

Small patterns of some hundred unknowns, made once per structure: plain Python will do.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]

#: Longest list of multiplications that the kernel takes; larger structures are solved sparse.
LARGEST = 20_000_000


def ints(values: Any) -> Ints:
    """Contiguous 64-bit integers, of the same shape.

    Parameters
    ----------
    values : array of int
        Of any shape, which is kept.
    """
    return np.ascontiguousarray(values, dtype=np.int64)


def elimination_order(count: int, groups: list[list[int]], last: list[int]) -> list[int]:
    """Minimum degree order with the coordinates of `last` at the end, (count,).

    Parameters
    ----------
    count : int
        Number of coordinates.
    groups : list of list of int
        Coordinates that couple with one another, a group each part.
    last : list of int
    """
    neighbours: list[set[int]] = [set() for _ in range(count)]
    for group in groups:
        for c in group:
            neighbours[c].update(group)
    for c in range(count):
        neighbours[c].discard(c)
    late = set(last)
    remaining = [c for c in range(count) if c not in late]
    order = []
    while remaining:
        c = min(remaining, key=lambda c: len(neighbours[c]))
        remaining.remove(c)
        order.append(c)
        around = neighbours[c]
        for other in around:
            neighbours[other] |= around
            neighbours[other] -= {c, other}
    return order + sorted(late)


def symbolic_factor(count: int, pattern: set[tuple[int, int]]) -> list[list[int]] | None:
    """Rows below the diagonal of each column of the factor; None where it is too large.

    Parameters
    ----------
    count : int
        Number of coordinates.
    pattern : set of (int, int)
        Rows and columns of the matrix that are not zero; only those below the diagonal count.
    """
    columns: list[set[int]] = [set() for _ in range(count)]
    for i, j in pattern:
        if i > j:
            columns[j].add(i)
    work = 0
    for j in range(count):
        if columns[j]:
            parent = min(columns[j])
            columns[parent] |= columns[j] - {parent}
        work += len(columns[j]) ** 2
        if work > LARGEST:
            return None
    return [sorted(column) for column in columns]


def elimination_tape(
    factor: list[list[int]], entries: list[tuple[int, int]]
) -> tuple[Ints, Ints, Ints, Ints, Ints, Ints, int]:
    """`fill`, `column_start`, `column_row`, `column_slot`, `update_start`, `update` and `slots`.

    (e,), (n + 1,), (l,), (l,), (n + 1,), (u, 3) and an int: of e entries of the matrix in n
    columns, l entries of the factor below the diagonal, and u updates.

    Parameters
    ----------
    factor : list of list of int
        From `symbolic_factor`.
    entries : list of (int, int)
        Row and column of every slot of the matrix, on or below the diagonal.
    """
    slot: dict[tuple[int, int], int] = {}
    for j, column in enumerate(factor):
        for i in (j, *column):
            slot[i, j] = len(slot)
    column_row = [i for column in factor for i in column]
    column_slot = [slot[i, j] for j, column in enumerate(factor) for i in column]
    column_start = np.cumsum([0, *(len(column) for column in factor)])
    update = [
        (slot[i, k], slot[i, j], slot[k, j])
        for j, column in enumerate(factor)
        for a, i in enumerate(column)
        for k in column[: a + 1]
    ]
    counts = [len(column) * (len(column) + 1) // 2 for column in factor]
    return (
        ints([slot[e] for e in entries]),
        ints(column_start),
        ints(column_row),
        ints(column_slot),
        ints(np.cumsum([0, *counts])),
        ints(update).reshape(-1, 3),
        len(slot),
    )
