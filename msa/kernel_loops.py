"""Compiled closing of loops: dependent coordinates from the others, at many poses in step.

Every loop's rows, dependent columns first, are turned by Householder reflections (Golub and Van
Loan 2013, section 5.2), which need no pivoting: redundant rows become zero, and how far they are
from it is reported.
"""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit

#: Poses in step: every scalar operation is one over a row of lanes that the processor does at
#: once. 64 lanes of a hundred-dof frame still fit a second-level cache.
LANES = 64

#: A share of an independent coordinate below this, beside the largest, is rounding.
SNAP = 1e-13

#: A component of a rotation's arm below this share of the products it is made of is rounding.
CANCELLED = 1e-14


@jit()
def told(value, instead):  # type: ignore[no-untyped-def]
    """The value, or `instead` of NaN, which would hide in comparisons.

    Parameters
    ----------
    value : float
        Any unit.
    instead : float
        In the unit of `value`.
    """
    return instead if np.isnan(value) else value


@jit(contract=True)
def parted(p, c, ends, nodes, joint, geometry, strain):  # type: ignore[no-untyped-def]
    """Motion of a second node against a first per unit of coordinate c, (6, w).

    What would cancel but for rounding is zero: a rod's spin does not move the rod's end.

    Parameters
    ----------
    p : Program
    c : int
    ends : (2,)
        1 where the coordinate moves the first, the second node.
    nodes : (2,)
        Mesh nodes, −1 for ground.
    joint : int
        In whose axes the motion is; −1 for global ones.
    geometry : (point, frame, axis, pivot)
        (n, 3, w) in m, (j, 3, 3, w), (c, 3, w), (c, 3, w) in m.
    strain : (6, w)
        Filled: no unit, m/rad and rad/rad.
    """
    point, frame, axis, pivot = geometry
    strain[:] = 0.0
    for e in range(2):
        node = nodes[e]
        if node < 0 or ends[e] == 0:
            continue
        sign = 1.0 if e == 1 else -1.0
        if p.turns[c] == 1:
            for w in range(LANES):
                ax, ay, az = axis[c, 0, w], axis[c, 1, w], axis[c, 2, w]
                px = point[node, 0, w] - pivot[c, 0, w]
                py = point[node, 1, w] - pivot[c, 1, w]
                pz = point[node, 2, w] - pivot[c, 2, w]
                dx, dy, dz = ay * pz - az * py, az * px - ax * pz, ax * py - ay * px
                limit = CANCELLED * (abs(px) + abs(py) + abs(pz))
                strain[0, w] += sign * dx if abs(dx) > limit else 0.0
                strain[1, w] += sign * dy if abs(dy) > limit else 0.0
                strain[2, w] += sign * dz if abs(dz) > limit else 0.0
                strain[3, w] += sign * ax
                strain[4, w] += sign * ay
                strain[5, w] += sign * az
        else:
            for w in range(LANES):
                strain[0, w] += sign * axis[c, 0, w]
                strain[1, w] += sign * axis[c, 1, w]
                strain[2, w] += sign * axis[c, 2, w]
    if joint < 0:
        return
    for half in range(0, 6, 3):
        for w in range(LANES):
            x, y, z = strain[half, w], strain[half + 1, w], strain[half + 2, w]
            for d in range(3):
                strain[half + d, w] = (
                    frame[joint, 0, d, w] * x
                    + frame[joint, 1, d, w] * y
                    + frame[joint, 2, d, w] * z
                )


@jit(contract=True)
def _closing_rows(p, geometry, store, strain):  # type: ignore[no-untyped-def]
    """Rows of all loops on scaled coordinates, one loop after another, (s, w)."""
    q = p.loops
    store[:] = 0.0
    for b in range(q.loop_joint.shape[0] - 1):
        width = q.dependent_start[b + 1] - q.dependent_start[b]
        width += q.independent_start[b + 1] - q.independent_start[b]
        first_row = q.row_start[q.loop_joint[b]]
        for m in range(q.loop_joint[b], q.loop_joint[b + 1]):
            for t in range(q.touch_start[m], q.touch_start[m + 1]):
                c = q.touch_coordinate[t]
                parted(p, c, q.touch_ends[t], q.nodes[m], q.joint[m], geometry, strain)
                for r in range(q.row_start[m], q.row_start[m + 1]):
                    at = q.store_start[b] + (r - first_row) * width + q.touch_column[t]
                    size = q.row_scale[r] * q.scale[c]
                    d = q.row_direction[r]
                    for w in range(LANES):
                        store[at, w] = size * strain[d, w]


@jit(contract=True)
def _reflect(rows, height, known, width, factor, pivots, pivot, rest):  # type: ignore[no-untyped-def]
    """Make the first `known` columns of the rows triangular, in place.

    Fills `pivots` (k, w) with the diagonal; lowers `pivot` to the smallest of them, and raises
    `rest` to the largest entry of the rows below them.
    """
    for j in range(known):
        for w in range(LANES):
            factor[w] = 0.0
        for r in range(j, height):
            for w in range(LANES):
                factor[w] += rows[r, j, w] * rows[r, j, w]
        for w in range(LANES):
            size = np.sqrt(factor[w])
            head = rows[j, j, w]
            diagonal = -size if head > 0.0 else size
            pivots[j, w] = diagonal
            pivot[w] = min(pivot[w], told(size, 0.0))
            rows[j, j, w] = head - diagonal
            factor[w] = 1.0 / (size * (size + abs(head))) if size > 0.0 else 0.0
        for i in range(j + 1, width):
            for w in range(LANES):
                total = 0.0
                for r in range(j, height):
                    total += rows[r, j, w] * rows[r, i, w]
                total *= factor[w]
                for r in range(j, height):
                    rows[r, i, w] -= total * rows[r, j, w]
    for r in range(known, height):
        for i in range(known, width):
            for w in range(LANES):
                size = abs(rows[r, i, w])
                rest[w] = max(rest[w], told(size, np.inf))


@jit(contract=True)
def close_loops(p, geometry, store, entry, work, smallest, rest):  # type: ignore[no-untyped-def]
    """Shares of independent in dependent coordinates, by entries.

    Parameters
    ----------
    p : Program
    geometry : (point, frame, axis, pivot)
        As `parted`.
    store : (s, w)
        Filled with the rows of all loops on scaled coordinates; of order one, no unit.
    entry : (x, w)
        Filled; no unit, m/rad or rad/m.
    work : tuple of arrays
        Overwritten: rows (r, c, w), pivots (c, w), factor (w), largest (w), strain (6, w).
    smallest : (w,)
        Filled with the smallest pivot, of rows and coordinates of order one; no unit.
    rest : (w,)
        Filled with the largest entry that the redundant rows keep, no unit.
    """
    q = p.loops
    rows, pivots, factor, largest, strain = work
    smallest[:] = 1.0
    rest[:] = 0.0
    _closing_rows(p, geometry, store, strain)
    for b in range(q.loop_joint.shape[0] - 1):
        known = q.dependent_start[b + 1] - q.dependent_start[b]
        others = q.independent_start[b + 1] - q.independent_start[b]
        width = known + others
        height = q.row_start[q.loop_joint[b + 1]] - q.row_start[q.loop_joint[b]]
        for r in range(height):
            for i in range(width):
                for w in range(LANES):
                    rows[r, i, w] = store[q.store_start[b] + r * width + i, w]
        _reflect(rows, height, known, width, factor, pivots, smallest, rest)
        for i in range(others):
            for w in range(LANES):
                largest[w] = 1.0
            for j in range(known - 1, -1, -1):
                at = q.entry_start[b] + j * others + i
                for w in range(LANES):
                    entry[at, w] = -rows[j, known + i, w]
                for k in range(j + 1, known):
                    other = q.entry_start[b] + k * others + i
                    for w in range(LANES):
                        entry[at, w] -= rows[j, k, w] * entry[other, w]
                for w in range(LANES):
                    entry[at, w] /= pivots[j, w]
                    largest[w] = max(largest[w], abs(entry[at, w]))
            inward = q.scale[q.independent[q.independent_start[b] + i]]
            for j in range(known):
                at = q.entry_start[b] + j * others + i
                outward = q.scale[q.dependent[q.dependent_start[b] + j]]
                for w in range(LANES):
                    x = entry[at, w]
                    # NaN is kept
                    entry[at, w] = 0.0 if abs(x) < SNAP * largest[w] else x * outward / inward


@jit(contract=True)
def loops_residual(p, store, entry, x, share, total, size):  # type: ignore[no-untyped-def]
    """Raise `share` to the largest miss of a closing row, of the largest terms of its loop.

    Parameters
    ----------
    p : Program
    store : (s, w)
        Rows from `close_loops`, no unit.
    entry : (x, w)
        From `close_loops`; no unit, m/rad or rad/m.
    x : (c, w)
        Coordinates, m and rad; completed by the dependent ones.
    share : (w,)
        Raised in place, no unit.
    total : (3, w)
        Overwritten.
    size : (w,)
        Overwritten.
    """
    q = p.loops
    for b in range(q.loop_joint.shape[0] - 1):
        first, second = q.dependent_start[b], q.independent_start[b]
        known = q.dependent_start[b + 1] - first
        others = q.independent_start[b + 1] - second
        for j in range(known):
            c = q.dependent[first + j]
            for w in range(LANES):
                x[c, w] = 0.0
            for i in range(others):
                at, other = q.entry_start[b] + j * others + i, q.independent[second + i]
                for w in range(LANES):
                    x[c, w] += entry[at, w] * x[other, w]
        height = q.row_start[q.loop_joint[b + 1]] - q.row_start[q.loop_joint[b]]
        width = known + others
        size[:] = 0.0
        total[0] = 0.0
        for r in range(height):
            for w in range(LANES):
                total[1, w] = 0.0
                total[2, w] = 0.0
            for i in range(width):
                c = q.dependent[first + i] if i < known else q.independent[second + i - known]
                at = q.store_start[b] + r * width + i
                for w in range(LANES):
                    term = store[at, w] * x[c, w] / q.scale[c]
                    total[1, w] += term
                    total[2, w] += abs(term)
            for w in range(LANES):
                miss = abs(total[1, w])
                total[0, w] = max(total[0, w], told(miss, np.inf))
                size[w] = max(size[w], total[2, w])
        for w in range(LANES):
            one = total[0, w] / size[w] if size[w] > 0.0 else 0.0
            share[w] = max(share[w], one)
