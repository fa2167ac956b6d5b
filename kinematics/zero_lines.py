"""Lines on which a function of two parameters is zero, through points found to rounding."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Values (m,) of the functions of these numbers (m,) at points (m, 2).
Functions = Callable[[Array, NDArray[np.intp]], Array]

#: Width at which a root is found, as a share of its bracket.
WIDTH = 1e-12


def roots_between(functions: Functions, low: Array, high: Array) -> Array:
    """A root on each of some straight ways, between ends at which the signs differ.

    By Chandrupatla's method, which never leaves the bracket.

    Parameters
    ----------
    functions : callable
        One for every way.
    low, high : (r, 2)
        Values of the parameters at the ends, in their units.

    Returns
    -------
    (r, 2)
        The points. Not a number where the function has no value on the way; an end at which it is
        zero but for rounding, whose sign was another when the ends were chosen, is the root.
    """
    # imported late: it takes a third of a small command's start
    from scipy.optimize.elementwise import find_root  # noqa: PLC0415

    if not len(low):
        return np.zeros((0, 2))

    def along(share: Array, number: Array) -> Array:
        k = number.astype(np.intp)
        return functions(low[k] + share[:, None] * (high[k] - low[k]), k)

    count = len(low)
    found = find_root(
        along,
        (np.zeros(count), np.ones(count)),
        args=(np.arange(count, dtype=float),),
        tolerances={"xatol": WIDTH, "xrtol": 0.0, "fatol": 0.0, "frtol": 0.0},
    )
    share = np.array(found.x, dtype=float)
    lost = np.flatnonzero(np.isnan(share))
    if lost.size:
        ends = np.stack([along(np.full(lost.size, end), lost) for end in (0.0, 1.0)])
        alike = ends[0] * ends[1] >= 0.0
        share[lost[alike]] = np.abs(ends[:, alike]).argmin(axis=0)
    return np.asarray(low + share[:, None] * (high - low))


def zero_lines(functions: Functions, values: Array, u: Array, v: Array) -> list[list[Array]]:
    """Lines of zeros of some functions over a grid.

    Parameters
    ----------
    functions : callable
    values : (k, l, n)
        Of every function at the grid's points; not a number where there is none.
    u, v : (k,), (l,)
        Values of the parameters, in their units, ascending.

    Returns
    -------
    list of list of (c, 2)
        For each function the points where its lines cross the sides of the cells, to 1e-12 of a
        side. A closed line ends with its first point. What comes and goes within one cell is not
        seen.
    """
    place = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    each = [_sides(values[..., k]) for k in range(values.shape[-1])]
    counts = [len(sides) for sides, _ in each]
    # all at once: a function of a machine is dear by the call
    corners = np.concatenate([c for _, c in each]) if each else np.zeros((0, 2), dtype=np.intp)
    owner = np.repeat(np.arange(len(each)), counts)
    points = roots_between(
        lambda p, i: functions(p, owner[i]), place[corners[:, 0]], place[corners[:, 1]]
    )
    parts = np.split(points, np.cumsum(counts)[:-1]) if each else []
    found = []
    for number, ((sides, _), some) in enumerate(zip(each, parts, strict=True)):
        known = {key: n for n, key in enumerate(sides)}
        links: dict[int, list[int]] = {n: [] for n in range(len(sides))}

        def one(p: Array, number: int = number) -> Array:
            return functions(p, np.full(len(p), number))

        for first, second in _within(one, values[..., number], u, v, known):
            links[first].append(second)
            links[second].append(first)
        found.append([some[way] for way in _ways(links)])
    return found


Side = tuple[int, int, int]


def _sides(values: Array) -> tuple[list[Side], NDArray[np.intp]]:
    """Sides of cells on which the sign changes: axis and lower corner; their corners' numbers."""
    above, seen = values >= 0.0, ~np.isnan(values)
    number = np.arange(values.size).reshape(values.shape)
    sides: list[Side] = []
    corners = []
    for axis in (0, 1):
        first = [slice(None)] * 2
        second = [slice(None)] * 2
        first[axis], second[axis] = slice(None, -1), slice(1, None)
        one, two = tuple(first), tuple(second)
        found = np.argwhere((above[one] != above[two]) & seen[one] & seen[two])
        sides += [(axis, int(i), int(j)) for i, j in found]
        corners.append(np.stack([number[one][tuple(found.T)], number[two][tuple(found.T)]], -1))
    return sides, np.concatenate(corners)


def _within(
    function: Callable[[Array], Array], values: Array, u: Array, v: Array, known: dict[Side, int]
) -> list[tuple[int, int]]:
    """Pairs of crossings that a line joins within a cell."""
    cells: dict[tuple[int, int], list[int]] = {}
    for (axis, i, j), n in known.items():
        before = (i, j - 1) if axis == 0 else (i - 1, j)
        for cell in ((i, j), before):
            if 0 <= cell[0] < len(u) - 1 and 0 <= cell[1] < len(v) - 1:
                cells.setdefault(cell, []).append(n)
    crossed = [cell for cell, found in cells.items() if len(found) == 4]
    centre: dict[tuple[int, int], bool] = {}
    if crossed:
        middles = np.array([[(u[i] + u[i + 1]) / 2, (v[j] + v[j + 1]) / 2] for i, j in crossed])
        centre = dict(zip(crossed, (function(middles) >= 0.0).tolist(), strict=True))
    pairs = []
    for cell, found in cells.items():
        if len(found) == 2:
            pairs.append((found[0], found[1]))
        elif len(found) == 4:
            i, j = cell
            low, high = known[0, i, j], known[0, i, j + 1]
            left, right = known[1, i, j], known[1, i + 1, j]
            # the corner of the centre's sign is joined with it, so that the others are cut off
            if (values[i, j] >= 0.0) == centre[cell]:
                pairs += [(low, right), (left, high)]
            else:
                pairs += [(low, left), (right, high)]
    return pairs


def _ways(links: dict[int, list[int]]) -> list[list[int]]:
    """Chains of linked crossings, from their ends where they have some."""
    left = dict(links)
    ways = []
    for start in sorted(links, key=lambda n: len(links[n])):
        if start not in left:
            continue
        way, here = [start], start
        closed = False
        while True:
            near = left.pop(here)
            ahead = [n for n in near if n in left]
            if not ahead:
                closed = len(way) > 2 and start in near and len(links[start]) == 2
                break
            here = ahead[0]
            way.append(here)
        ways.append([*way, start] if closed else way)
    return ways
