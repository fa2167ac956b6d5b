"""Compiled elimination for `seen_motions.SeenMotions`."""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit
from strutwork.kinematics.row_kernel import eliminate, fill_row


@jit()
def _equations(s, d, wanted, placed, seen, a):  # type: ignore[no-untyped-def]
    """Passive rows, what tool and drives do, one unit of each in turn, and what is held."""
    rows, _, made, idle = wanted
    nodes, frames, references = placed
    rank, motions, n = rows.shape[0], made.shape[0], a.shape[0]
    a[:] = 0.0
    seen[:] = 0.0
    for i in range(6):
        seen[i, s.column[s.platform] + i] = 1.0
    for i in range(d.joint.shape[0]):
        fill_row(d, i, nodes, frames, references, seen[6 + i])
    for i in range(rank):
        fill_row(s, rows[i], nodes, frames, references, a[i, :n])
    for m in range(motions):
        for i in range(made.shape[1]):
            for c in range(n):
                a[rank + m, c] += made[m, i] * seen[i, c]
        a[rank + m, n + m] = 1.0
    for i in range(idle.shape[0]):
        for c in range(n):
            a[rank + motions + i, c] = idle[i, c]


@jit()
def solve_seen(s, d, wanted, nodes, frames, references, found):  # type: ignore[no-untyped-def]
    """Motions of tool and drives at p poses; largest motion of a body, and what others leave open.

    Parameters
    ----------
    s : RowSystem
        The linkage.
    d : RowSystem
        The same with the drives' rows in place of the held ones.
    wanted : (r,) and (k,) of int, (f, 6 + a) and (i, 6 b)
        Rows that are solved for, the others, `made` and `idle` of `SeenMotions` in the order of
        columns.
    nodes : (p, n, 3)
        Places of the nodes, m.
    frames : (p, j, 3, 3)
        Joint axes as columns.
    references : (p, b, 3)
        Reference points of the bodies, m.
    found : (p, 6 + a, f), (p,) and (p,)
        Filled: the motions, over L and rad; the largest motion of a body, infinite at a singular
        pose; how far other rows are from holding.
    """
    _, others, made, _ = wanted
    motions, large, left = found
    n, f = 6 * s.column.shape[0], made.shape[0]
    a, seen, row = np.empty((n, n + f)), np.empty((made.shape[1], n)), np.empty(n)
    order, where = np.empty(n, dtype=np.int64), np.empty(n + f, dtype=np.int64)
    for p in range(nodes.shape[0]):
        _equations(s, d, wanted, (nodes[p], frames[p], references[p]), seen, a)
        large[p], left[p] = np.inf, 0.0
        if eliminate(a, n, order, where) == 0.0:
            continue
        large[p] = np.abs(a[:, n:]).max()
        for m in range(f):
            for i in range(seen.shape[0]):
                motions[p, i, m] = 0.0
                for c in range(n):
                    motions[p, i, m] += seen[i, c] * a[order[c], n + m]
        for i in range(others.shape[0]):
            fill_row(s, others[i], nodes[p], frames[p], references[p], row)
            for m in range(f):
                total = 0.0
                for c in range(n):
                    total += row[c] * a[order[c], n + m]
                left[p] = max(left[p], abs(total))
