"""Directions whose answers are the same, for instance x and y of a machine with equal legs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Answers that differ by less than this share of their largest are the same.
SAME = 1e-5


def equal_axes(answers: Sequence[NDArray[Any]], names: Sequence[str]) -> list[tuple[str, ...]]:
    """Names of directions, those with the same answer together.

    Parameters
    ----------
    answers : sequence of arrays
        Of one shape, one for each name.
    names : sequence of str

    >>> equal_axes([np.array([1.0, 2.0]), np.array([1.0, 2.0]), np.array([1.0, 9.0])], "xyz")
    [('x', 'y'), ('z',)]
    """
    groups: list[tuple[NDArray[Any], list[str]]] = []
    for name, answer in zip(names, answers, strict=True):
        for first, some in groups:
            largest = max(float(np.abs(first).max(initial=0.0)), 1e-300)
            if np.all(np.abs(answer - first) <= SAME * largest):
                some.append(name)
                break
        else:
            groups.append((answer, [name]))
    return [tuple(some) for _, some in groups]
