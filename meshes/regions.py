"""Regions from named sets of cells that may overlap."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
UNNAMED = "solid"


def partition(count: int, *levels: Mapping[str, Ints]) -> tuple[tuple[str, ...], Ints]:
    """One region for each cell.

    A cell of several sets, each within the next, is of the smallest, of equal ones the last.
    Where two sets cross, the cells of both are a region of their own, "A and B": which material
    they have is not for us to guess.

    Parameters
    ----------
    count : int
        Number of cells.
    *levels : mapping of str to (k,) int
        Cells of each set. Sets of an earlier level decide where they have cells.

    Returns
    -------
    names : tuple of str
    region : (count,) int
        Index of each cell's region in `names`; cells of no set are called "solid".
    """
    left = np.ones(count, dtype=bool)
    names: dict[str, int] = {}
    found = np.full(count, -1, dtype=np.int64)
    for given in levels:
        own = {name: np.unique(cells[left[cells]]) for name, cells in given.items()}
        own = {name: cells for name, cells in own.items() if len(cells)}
        keys = tuple(own)
        combination = _combinations(count, [own[key] for key in keys])
        labels, index = np.unique(combination[1], return_inverse=True)
        number = []
        for label in labels.tolist():
            name = _name(keys, own, combination[0][label]) if label else ""
            number.append(names.setdefault(name, len(names)) if name else -1)
        found = np.where(left, np.array(number, dtype=np.int64)[index], found)
        left &= found < 0
    order = list(dict.fromkeys(n for level in levels for n in level if n in names))
    order += [n for n in names if n not in order]
    if (found < 0).any() and UNNAMED not in order:
        order.append(UNNAMED)
    # cells of no set have found -1: the last place
    last = order.index(UNNAMED) if UNNAMED in order else 0
    place = np.array([*(order.index(n) for n in names), last], dtype=np.int64)
    return tuple(order), place[found]


def _combinations(count: int, sets: list[Ints]) -> tuple[list[tuple[int, ...]], Ints]:
    """The sets that hold each cell: those of each label, and the label of each cell."""
    label = np.zeros(count, dtype=np.int64)
    members: list[tuple[int, ...]] = [()]
    for index, cells in enumerate(sets):
        before, inverse = np.unique(label[cells], return_inverse=True)
        made = []
        for old in before.tolist():
            made.append(len(members))
            members.append((*members[old], index))
        label[cells] = np.array(made, dtype=np.int64)[inverse]
    return members, label


def _name(keys: tuple[str, ...], sets: Mapping[str, Ints], members: tuple[int, ...]) -> str:
    """Name of the least of the sets, or of all that hold no other of them."""
    # of equal sets the later: decks name blocks of elements first, and what they mean after
    names = sorted((keys[m] for m in reversed(members)), key=lambda n: len(sets[n]))
    least: list[str] = []
    for name in names:
        inside = [n for n in least if np.isin(sets[n], sets[name]).all()]
        if not inside:
            least.append(name)
    return " and ".join(sorted(least, key=keys.index))
