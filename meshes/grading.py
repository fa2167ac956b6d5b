"""Mesh lines: uniform, graded towards ends, and through given stops."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from math import ceil, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]


def lines(length: float, divisions: int, ratio: float = 1.0, *, both: bool = False) -> Array:
    """Mesh lines from 0 to `length`.

    Parameters
    ----------
    length : float
        m.
    divisions : int
        Number of cells.
    ratio : float
        Ratio of the last cell to the first, a geometric progression; 1 is uniform, more is finer at
        the start.
    both : bool
        Grade both ends alike: `ratio` is the middle cell over an end cell.

    Returns
    -------
    (divisions + 1,)
        The first exactly 0, the last exactly `length`.

    Raises
    ------
    ModelError
        A length or ratio that is not positive and finite, no division.
    """
    for what, value in (("length", length), ("grading ratio", ratio)):
        if not (isfinite(value) and value > 0):
            raise ModelError("mesh lines", f"the {what} is {value!r}.", "Give a positive number.")
    if divisions < 1 or int(divisions) != divisions:
        raise ModelError("mesh lines", f"divisions is {divisions!r}.", "Give a whole number.")
    if divisions == 1:
        steps = np.ones(1)
    elif both:
        # distance of a cell from its nearer end, as a share of the way to the middle
        index = np.arange(divisions)
        inwards = np.minimum(index, divisions - 1 - index)
        steps = ratio ** (inwards / max((divisions - 1) // 2, 1))
    else:
        steps = ratio ** (np.arange(divisions) / (divisions - 1))
    result = length * np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    result[-1] = length
    return np.asarray(result)


def lines_through(
    stops: Iterable[float], size: float, towards: Iterable[float] = (), ratio: float = 1.0
) -> Array:
    """Mesh lines (n,) that fall on every stop, with no cell above `size`.

    Parameters
    ----------
    stops : iterable of float
        Coordinates that a line must pass, m; at least two different ones. Those closer than
        1e-9 of the whole are taken as one.
    size : float
        Largest cell, m.
    towards : iterable of float
        Stops towards which the cells beside them shrink, m; elsewhere they are uniform between
        two stops.
    ratio : float
        Ratio of the largest to the smallest cell between two stops of which one is in `towards`.

    Raises
    ------
    ModelError
        Fewer than two different stops, a size or ratio that is not positive.
    """
    for what, value in (("cell size", size), ("grading ratio", ratio)):
        if not (isfinite(value) and value > 0):
            raise ModelError("mesh lines", f"the {what} is {value!r}.", "Give a positive number.")
    places = np.unique(np.asarray(list(stops), dtype=float))
    if len(places) < 2 or not np.isfinite(places).all():
        raise ModelError("mesh lines", f"the stops are {places.tolist()}.", "Give two or more.")
    same = 1e-9 * (places[-1] - places[0])
    places = places[np.append(True, np.diff(places) > same)]
    fine = np.asarray(list(towards), dtype=float)
    near = (np.abs(places[:, None] - fine) <= same).any(axis=1)
    pieces = [
        start + _piece(end - start, size, (bool(near[i]), bool(near[i + 1])), ratio)[:-1]
        for i, (start, end) in enumerate(pairwise(places))
    ]
    return np.concatenate([*pieces, places[-1:]])


def _piece(length: float, size: float, fine: tuple[bool, bool], ratio: float) -> Array:
    # a length that is a whole number of cells must not gain one by rounding
    count = max(1, ceil(length / size * (1.0 - 1e-9)))
    if not any(fine):
        return lines(length, count)
    while True:
        found = lines(
            length, count, 1.0 / ratio if fine == (False, True) else ratio, both=all(fine)
        )
        if np.diff(found).max() <= size * (1.0 + 1e-9):
            return found
        count += 1
