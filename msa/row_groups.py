"""Constraint rows of unit size, and the groups of them that share no unknown.

By NumPy alone: loading SciPy takes longer than the check of a model that asks for their rank.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System

Array = NDArray[Any]
Ints = NDArray[np.intp]


@dataclass(frozen=True)
class UnitRows:
    """Constraint rows on scaled unknowns, (r, n), of unit size, by their entries that are not zero.

    Parameters
    ----------
    row, column : (e,) of int
        Places of the entries, row by row.
    value : (e,)
        The entries, no unit.
    size : (r,)
        By which each row was divided: no unit, or 1/m of a locked rotation; 1 for a row of zeros.
    """

    row: Ints
    column: Ints
    value: Array
    size: Array

    def __repr__(self) -> str:
        return f"<UnitRows: {len(self)} rows, {len(self.value)} entries>"

    def __len__(self) -> int:
        return len(self.size)


def unit_rows(system: System, d: Array) -> UnitRows:
    """Constraint rows at one pose, each divided by its size.

    Parameters
    ----------
    system : System
        At one pose, with n unknowns.
    d : (n,)
        Scales of the unknowns: 1 of a translation, 1/length of a rotation, 1/m.
    """
    vertex, values = system.row_blocks
    row, block = np.nonzero(vertex >= 0)
    column = 6 * vertex[row, block][:, None] + np.arange(6)
    # two blocks of a row may lie on one cluster: they add up
    at, place = np.unique(row[:, None] * len(d) + column, return_inverse=True)
    value = np.bincount(place.ravel(), values[0][row, block].ravel(), minlength=len(at))
    row, column = np.divmod(at, max(len(d), 1))
    value = value * d[column]
    kept = value != 0
    row, column, value = row[kept], column[kept], value[kept]
    size = np.sqrt(np.bincount(row, value**2, minlength=len(vertex)))
    size[size == 0] = 1.0
    return UnitRows(row, column, value / size[row], size)


def row_groups(rows: UnitRows) -> Iterator[tuple[Ints, Array, Ints]]:
    """Rows that share an unknown: their indices (k,), dense block (k, c) and columns (c,).

    Parameters
    ----------
    rows : UnitRows
    """
    count = len(rows)
    if count == 0:
        return
    # rows and unknowns are the two sides of one graph: no product of rows by rows is made
    ends = rows.column.max(initial=-1) + 1
    label = _components(count + int(ends), rows.row, count + rows.column)[:count]
    # entries and rows in the order of their groups: each group is a slice
    by_group = np.argsort(label[rows.row], kind="stable")
    order = np.argsort(label, kind="stable")
    names, starts = np.unique(label[order], return_index=True)
    cuts = np.searchsorted(label[rows.row][by_group], names)
    for own, entries in zip(np.split(order, starts[1:]), np.split(by_group, cuts[1:]), strict=True):
        columns, column = np.unique(rows.column[entries], return_inverse=True)
        block = np.zeros((len(own), len(columns)))
        block[np.searchsorted(own, rows.row[entries]), column] = rows.value[entries]
        yield own, block, columns


def _components(count: int, first: Ints, second: Ints) -> Ints:
    """The least vertex of the connected part of each of `count` vertices, by its edges."""
    label = np.arange(count)
    while True:
        least = np.minimum(label[first], label[second])
        lower = label.copy()
        # roots take the least label that an edge brings them, then every vertex that of its root
        np.minimum.at(lower, label[first], least)
        np.minimum.at(lower, label[second], least)
        while np.any(lower != lower[lower]):
            lower = lower[lower]
        if np.array_equal(lower, label):
            return label
        label = lower
