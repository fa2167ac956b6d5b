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


@jit()
def _screws(p, leg, positions, frames, size, m):  # type: ignore[no-untyped-def]
    """Screws of a leg at the tool on (v / L, ω), as columns, beside an identity; rows of m."""
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
    for i in range(6):
        for c in range(6):
            m[i, last - first + c] = 1.0 if i == c else 0.0


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
def _eliminate(m, end, width):  # type: ignore[no-untyped-def]
    """Gauss elimination of the columns before `end`, with complete pivoting.

    Returns the rows used, and whether a pivot was neither there nor absent.
    """
    row, doubtful = 0, False
    while row < min(6, end):
        best, at, which = _largest(m, row, row, end)
        if not best > ABSENT:
            break
        doubtful = doubtful or best < DOUBTFUL
        for i in range(6):
            m[i, row], m[i, which] = m[i, which], m[i, row]
        for c in range(width):
            m[row, c], m[at, c] = m[at, c], m[row, c]
        inverse = 1.0 / m[row, row]
        for i in range(row + 1, 6):
            factor = m[i, row] * inverse
            for c in range(row, width):
                m[i, c] -= factor * m[row, c]
        row += 1
    return row, doubtful


@jit()
def _drive_rows(m, row, begin, drives, width):  # type: ignore[no-untyped-def]
    """Make the drives' columns of the rows from `row` on an identity; False near a singularity."""
    for k in range(drives):
        best, at = 0.0, row + k
        for i in range(row + k, 6):
            if abs(m[i, begin + k]) > best:
                best, at = abs(m[i, begin + k]), i
        if not best > DOUBTFUL:
            return False
        if at != row + k:
            for c in range(begin, width):
                m[row + k, c], m[at, c] = m[at, c], m[row + k, c]
        inverse = 1.0 / m[row + k, begin + k]
        for c in range(begin, width):
            m[row + k, c] *= inverse
        for i in range(row, 6):
            if i != row + k:
                factor = m[i, begin + k]
                for c in range(begin, width):
                    m[i, c] -= factor * m[row + k, c]
    return True


@jit()
def leg_rows(p, positions, frames, inverse, length, good):  # type: ignore[no-untyped-def]
    """Inverse Jacobians of q poses; see `leg_jacobians.legs_compiled`."""
    legs = p.passive.shape[0]
    m = np.empty((6, 18))
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
        for leg in range(legs):
            if not sound:
                break
            count = p.start[leg + 1] - p.start[leg]
            drives = count - p.passive[leg]
            if drives == 0:
                # no rows, yet it must let the tool move in six ways
                _screws(p, leg, positions[q], frames[q], size, m)
                row, unsure = _eliminate(m, count, count)
                sound = row == 6 and not unsure
                continue
            width = count + 6
            _screws(p, leg, positions[q], frames[q], size, m)
            row, unsure = _eliminate(m, p.passive[leg], width)
            if (
                unsure
                or row + drives != 6
                or not _drive_rows(m, row, p.passive[leg], drives, width)
            ):
                sound = False
                break
            for k in range(drives):
                r = p.drive[p.start[leg] + p.passive[leg] + k]
                for c in range(3):
                    value, turn = m[row + k, count + c], m[row + k, count + 3 + c]
                    # rates of turning drives are per second, of sliding ones in lengths of the tool
                    inverse[q, r, c] = value / size if p.rotary[r] == 1 else value
                    inverse[q, r, 3 + c] = turn if p.rotary[r] == 1 else turn * size
        if not sound:
            inverse[q] = 0.0
        good[q] = sound


@jit()
def _turned(a, size, c, d):  # type: ignore[no-untyped-def]
    """Turn two columns (rows of a) so that they become orthogonal; False where they were."""
    dot = 0.0
    for i in range(a.shape[1]):
        dot += a[c, i] * a[d, i]
    if min(size[c], size[d]) < 1e-300 or dot * dot <= ORTHOGONAL**2 * size[c] * size[d]:
        return False
    zeta = (size[d] - size[c]) / (2.0 * dot)
    t = 1.0 / (abs(zeta) + np.sqrt(1.0 + zeta * zeta))
    t = -t if zeta < 0.0 else t
    cosine = 1.0 / np.sqrt(1.0 + t * t)
    sine = cosine * t
    for i in range(a.shape[1]):
        x, y = a[c, i], a[d, i]
        a[c, i] = cosine * x - sine * y
        a[d, i] = sine * x + cosine * y
    size[c] -= t * dot
    size[d] += t * dot
    return True


@jit()
def _squares(a, size):  # type: ignore[no-untyped-def]
    for c in range(a.shape[0]):
        size[c] = 0.0
        for i in range(a.shape[1]):
            size[c] += a[c, i] * a[c, i]


@jit()
def jacobi_values(matrices, values):  # type: ignore[no-untyped-def]
    """Singular values of (q, m, n) matrices, m ≥ n, by one-sided Jacobi (Hestenes 1958)."""
    count, rows, columns = matrices.shape
    a = np.empty((columns, rows))
    size = np.empty(columns)
    for q in range(count):
        for i in range(rows):
            for c in range(columns):
                a[c, i] = matrices[q, i, c]
        for _ in range(SWEEPS):
            _squares(a, size)
            rotated = False
            for c in range(columns - 1):
                for d in range(c + 1, columns):
                    rotated = _turned(a, size, c, d) or rotated
            if not rotated:
                break
        _squares(a, size)
        for c in range(columns):
            # sorted in, largest first
            value, at = np.sqrt(size[c]), c
            while at > 0 and values[q, at - 1] < value:
                values[q, at] = values[q, at - 1]
                at -= 1
            values[q, at] = value
