"""Compiled code for velocity Jacobians: legs one by one, and singular values of small matrices."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.jit import jit

Array = NDArray[Any]

#: Pivots of screws of unit size: at most ABSENT is none at all, and between that and DOUBTFUL a
#: leg is near a singularity.
ABSENT = 1e-12
DOUBTFUL = 1e-5

#: Columns whose cosine is below this are orthogonal: singular values hold to a few times it.
ORTHOGONAL = 1e-13
SWEEPS = 30
#: Squared size of a column, of the largest one's, that is nothing: its square is still a number.
NOTHING = 1e-150


@jit()
def _screws(p, leg, positions, frames, size, m):  # type: ignore[no-untyped-def]
    """Screws of a leg at the tool on (v / L, ω), as columns of m."""
    first, last = p.start[leg], p.start[leg + 1]
    for d in range(first, last):
        c = d - first
        j, k, s = p.joint[d], p.axis[d], p.sign[d]
        ex, ey, ez = s * frames[j, 0, k], s * frames[j, 1, k], s * frames[j, 2, k]
        if p.turns[d] == 1:
            ax = (positions[p.tool, 0] - positions[p.node[d], 0]) / size
            ay = (positions[p.tool, 1] - positions[p.node[d], 1]) / size
            az = (positions[p.tool, 2] - positions[p.node[d], 2]) / size
            m[0, c], m[1, c], m[2, c] = ey * az - ez * ay, ez * ax - ex * az, ex * ay - ey * ax
            m[3, c], m[4, c], m[5, c] = ex, ey, ez
        else:
            m[0, c], m[1, c], m[2, c] = ex, ey, ez
            m[3, c], m[4, c], m[5, c] = 0.0, 0.0, 0.0


@jit()
def _largest(m, row, column, end):  # type: ignore[no-untyped-def]
    """Largest entry from `row` and `column` on, its row and its column."""
    best, at, which = 0.0, row, column
    for i in range(row, 6):
        for c in range(column, end):
            if abs(m[i, c]) > best:
                best, at, which = abs(m[i, c]), i, c
    return best, at, which


@jit()
def _eliminate(m, end, order):  # type: ignore[no-untyped-def]
    """Gauss elimination of the columns before `end`, with complete pivoting.

    Factors stay below the pivots, and `order` says where the rows came from. Returns the rows
    used, and whether a pivot was neither there nor absent.
    """
    for i in range(6):
        order[i] = i
    row, doubtful = 0, False
    while row < min(6, end):
        best, at, which = _largest(m, row, row, end)
        if not best > ABSENT:
            break
        doubtful = doubtful or best < DOUBTFUL
        for i in range(6):
            m[i, row], m[i, which] = m[i, which], m[i, row]
        for c in range(end):
            m[row, c], m[at, c] = m[at, c], m[row, c]
        order[row], order[at] = order[at], order[row]
        inverse = 1.0 / m[row, row]
        for i in range(row + 1, 6):
            factor = m[i, row] * inverse
            m[i, row] = factor
            for c in range(row + 1, end):
                m[i, c] -= factor * m[row, c]
        row += 1
    return row, doubtful


@jit()
def _reciprocal(m, row, order, begin, drives, y, z):  # type: ignore[no-untyped-def]
    """Wrenches that do no work on the eliminated screws, beside their work on the drives.

    Row k of `y` has the work on each drive's screw, then the wrench; 6 − row of them.
    """
    for k in range(6 - row):
        for i in range(row):
            z[i] = -m[row + k, i]
        for i in range(row - 1, -1, -1):
            for r in range(i):
                z[r] -= z[i] * m[i, r]
        for i in range(6):
            y[k, drives + i] = 0.0
        for i in range(row):
            y[k, drives + order[i]] = z[i]
        y[k, drives + order[row + k]] = 1.0
        for d in range(drives):
            work = 0.0
            for i in range(6):
                work += y[k, drives + i] * m[i, begin + d]
            y[k, d] = work


@jit()
def _solve(y, count, width):  # type: ignore[no-untyped-def]
    """Make the first `count` columns of as many rows an identity; False near a singularity."""
    for k in range(count):
        best, at = 0.0, k
        for i in range(k, count):
            if abs(y[i, k]) > best:
                best, at = abs(y[i, k]), i
        if not best > DOUBTFUL:
            return False
        if at != k:
            for c in range(width):
                y[k, c], y[at, c] = y[at, c], y[k, c]
        inverse = 1.0 / y[k, k]
        for c in range(k, width):
            y[k, c] *= inverse
        for i in range(count):
            if i != k:
                factor = y[i, k]
                for c in range(k, width):
                    y[i, c] -= factor * y[k, c]
    return True


@jit()
def _least(y, count, drives, gram, rates):  # type: ignore[no-untyped-def]
    """Least rates of more drives than wrenches: Dᵀ (D Dᵀ)⁻¹ Yᵀ; False near a singularity.

    Rates are of screws on (v / L, ω), so that a turning drive counts at the arm L.
    """
    for k in range(count):
        for i in range(count):
            gram[k, i] = 0.0
            for d in range(drives):
                gram[k, i] += y[k, d] * y[i, d]
        for i in range(6):
            gram[k, count + i] = y[k, drives + i]
    if not _solve(gram, count, count + 6):
        return False
    for d in range(drives):
        for i in range(6):
            rates[d, i] = 0.0
            for k in range(count):
                rates[d, i] += y[k, d] * gram[k, count + i]
    return True


@jit()
def _rates_of_leg(p, leg, positions, frames, size, work):  # type: ignore[no-untyped-def]
    """Rates of a leg's drives per tool motion on (v / L, ω); False near a singularity."""
    m, order, y, z, gram, rates = work
    passive = p.passive[leg]
    drives = p.start[leg + 1] - p.start[leg] - passive
    _screws(p, leg, positions, frames, size, m)
    row, unsure = _eliminate(m, passive, order)
    wrenches = 6 - row
    # fewer drives than wrenches, and the leg lets the tool move in less than six ways
    if unsure or drives < wrenches:
        return False
    _reciprocal(m, row, order, passive, drives, y, z)
    if drives > wrenches:
        return _least(y, wrenches, drives, gram, rates)
    if not _solve(y, drives, drives + 6):
        return False
    for d in range(drives):
        for i in range(6):
            rates[d, i] = y[d, drives + i]
    return True


@jit()
def leg_rows(p, positions, frames, inverse, length, good):  # type: ignore[no-untyped-def]
    """Inverse Jacobians of q poses; see `leg_jacobians.legs_compiled`.

    Parameters
    ----------
    p : LegChains
        The machine's legs.
    positions : (q, n, 3)
        Of the nodes, m.
    frames : (q, j, 3, 3)
        Axes of the joints as columns.
    inverse : (q, a, 6)
        Filled: no unit, m/rad, rad/m; zero where not good.
    length : (q,)
        Filled: largest distance of a leg's joint from the tool, m.
    good : (q,) of bool
        Filled: whether all pivots were large.
    """
    m, order = np.empty((6, 12)), np.empty(6, dtype=np.int64)
    y, z, gram, rates = np.empty((6, 18)), np.empty(6), np.empty((6, 12)), np.empty((12, 6))
    work = (m, order, y, z, gram, rates)
    for q in range(positions.shape[0]):
        farthest = 0.0
        for d in range(p.node.shape[0]):
            square = 0.0
            for i in range(3):
                square += (positions[q, p.tool, i] - positions[q, p.node[d], i]) ** 2
            farthest = max(farthest, square)
        size = np.sqrt(farthest) if farthest > 0.0 else 1.0
        length[q] = size
        sound = np.isfinite(size)
        for leg in range(p.passive.shape[0]):
            sound = sound and _rates_of_leg(p, leg, positions[q], frames[q], size, work)
            if not sound:
                inverse[q] = 0.0
                break
            for d in range(p.start[leg] + p.passive[leg], p.start[leg + 1]):
                k, r = d - p.start[leg] - p.passive[leg], p.drive[d]
                for c in range(3):
                    value, turn = rates[k, c], rates[k, 3 + c]
                    # rates of turning drives are per second, of sliding ones in lengths of the tool
                    inverse[q, r, c] = value / size if p.rotary[r] == 1 else value
                    inverse[q, r, 3 + c] = turn if p.rotary[r] == 1 else turn * size
        good[q] = sound


@jit()
def _rounds(columns):  # type: ignore[no-untyped-def]
    """Each pair of columns once, (rounds, pairs of a round, 2): a tournament's circle.

    The pairs of a round share no column, so that the processor turns them at the same time. With
    an odd number the dummy `columns` stands still: its pair is (c, c).
    """
    even = columns + columns % 2
    pairs = np.empty((even - 1, even // 2, 2), dtype=np.int64)
    for r in range(even - 1):
        for k in range(even // 2):
            c = even - 1 if k == 0 else (r + k) % (even - 1)
            d = (r - k) % (even - 1)
            pairs[r, k, 0] = min(c, d)
            pairs[r, k, 1] = min(c, d) if max(c, d) == columns else max(c, d)
    return pairs


@jit()
def _sweep(a, size, pairs, tangent):  # type: ignore[no-untyped-def]
    """Turn each pair of columns (rows of a) so that it becomes orthogonal; False where all were."""
    rotated = False
    for r in range(pairs.shape[0]):
        for k in range(pairs.shape[1]):
            c, d = pairs[r, k, 0], pairs[r, k, 1]
            dot = 0.0
            for i in range(a.shape[1]):
                dot += a[c, i] * a[d, i]
            small = min(size[c], size[d]) < NOTHING
            if c == d or small or dot * dot <= ORTHOGONAL**2 * size[c] * size[d]:
                tangent[k] = 0.0
                continue
            rotated = True
            # t = sign(ζ) / (|ζ| + √(1 + ζ²)) with ζ = gap / 2 dot, and one division
            gap, twice = size[d] - size[c], 2.0 * dot
            t = abs(twice) / (abs(gap) + np.sqrt(gap * gap + twice * twice))
            t = -t if (gap < 0.0) != (dot < 0.0) else t
            tangent[k] = t
            size[c] -= t * dot
            size[d] += t * dot
        for k in range(pairs.shape[1]):
            t = tangent[k]
            if t != 0.0:
                c, d = pairs[r, k, 0], pairs[r, k, 1]
                cosine = 1.0 / np.sqrt(1.0 + t * t)
                sine = cosine * t
                for i in range(a.shape[1]):
                    x, y = a[c, i], a[d, i]
                    a[c, i] = cosine * x - sine * y
                    a[d, i] = sine * x + cosine * y
    return rotated


@jit()
def _squares(a, size):  # type: ignore[no-untyped-def]
    for c in range(a.shape[0]):
        size[c] = 0.0
        for i in range(a.shape[1]):
            size[c] += a[c, i] * a[c, i]


@jit()
def _longest(a, begin):  # type: ignore[no-untyped-def]
    """Largest square of the rows from `begin` on, and which row it is."""
    best, at = -1.0, begin
    for c in range(begin, a.shape[0]):
        square = 0.0
        for i in range(a.shape[1]):
            square += a[c, i] * a[c, i]
        if square > best:
            best, at = square, c
    return best, at


@jit()
def _triangle(a, m):  # type: ignore[no-untyped-def]
    """R of a Gram-Schmidt elimination of the rows of a, the longest first, into rows of m.

    R has the singular values of a, and its rows are so nearly orthogonal that half the sweeps
    are left (Drmač and Veselić 2008).
    """
    columns, rows = a.shape
    m[:, :] = 0.0
    for k in range(columns):
        best, at = _longest(a, k)
        if at != k:
            for i in range(rows):
                a[k, i], a[at, i] = a[at, i], a[k, i]
            # R's columns may stand in any order, its finished rows must keep to theirs
            for j in range(k):
                m[j, k], m[j, at] = m[j, at], m[j, k]
        if not best > 0.0:
            break
        m[k, k] = np.sqrt(best)
        inverse = 1.0 / m[k, k]
        for i in range(rows):
            a[k, i] *= inverse
        for c in range(k + 1, columns):
            dot = 0.0
            for i in range(rows):
                dot += a[k, i] * a[c, i]
            m[k, c] = dot
            for i in range(rows):
                a[c, i] -= dot * a[k, i]


@jit()
def jacobi_values(matrices, values):  # type: ignore[no-untyped-def]
    """Singular values of (q, m, n) matrices, m ≥ n, by one-sided Jacobi (Hestenes 1958).

    Parameters
    ----------
    matrices : (q, m, n)
        All entries of one unit, m ≥ n.
    values : (q, n)
        Filled, largest first, in the unit of the entries.
    """
    count, rows, columns = matrices.shape
    a, triangle = np.empty((columns, rows)), np.empty((columns, columns))
    size, pairs = np.empty(columns), _rounds(columns)
    tangent = np.empty(pairs.shape[1])
    for q in range(count):
        for i in range(rows):
            for c in range(columns):
                a[c, i] = matrices[q, i, c]
        _triangle(a, triangle)
        # squares of squares of any unit stay in range
        unit = triangle[0, 0] if triangle[0, 0] > 0.0 else 1.0
        for c in range(columns):
            for i in range(columns):
                triangle[c, i] /= unit
        for _ in range(SWEEPS):
            _squares(triangle, size)
            if not _sweep(triangle, size, pairs, tangent):
                break
        _squares(triangle, size)
        for c in range(columns):
            # sorted in, largest first
            value, at = unit * np.sqrt(size[c]), c
            while at > 0 and values[q, at - 1] < value:
                values[q, at] = values[q, at - 1]
                at -= 1
            values[q, at] = value
