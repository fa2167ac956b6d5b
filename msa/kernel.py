"""The compiled kernel: assembly, elimination and tool compliance of many poses at a time.

It runs a `Program` on `LANES` poses in step, so that every scalar operation of the elimination
is one over a row of lanes that the processor does at once. Nothing in it knows a topology.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.jit import jit
from strutwork.msa.kernel_assembly import assemble, axes_and_pivots
from strutwork.msa.kernel_loops import LANES, close_loops, loops_residual, told
from strutwork.msa.program import Program

Array = NDArray[Any]

#: A pivot below this share of its diagonal entry belongs to a motion that nothing resists.
VANISHED = 1e-12

#: Rounding of one number.
EPSILON = float(np.finfo(float).eps)


@jit(contract=True)
def _eliminate(p, matrix, factor, inverse, scaled, smallest):  # type: ignore[no-untyped-def]
    """L D Lᵀ of K in place; pivots' inverses (c, w), zero where the pivot has vanished."""
    factor[:] = 0.0
    for k in range(p.fill.shape[0]):
        factor[p.fill[k]] = matrix[k]
    smallest[:] = 1.0
    for c in range(p.diagonal.shape[0]):
        diagonal = p.fill[p.diagonal[c]]
        whole = p.diagonal[c]
        for w in range(LANES):
            # 0/0 of a coordinate that nothing resists is not present either
            share = factor[diagonal, w] / matrix[whole, w]
            present = share > VANISHED
            inverse[c, w] = 1.0 / factor[diagonal, w] if present else 0.0
            smallest[w] = min(smallest[w], share) if present else smallest[w]
        start, stop = p.column_start[c], p.column_start[c + 1]
        u = p.update_start[c]
        for a in range(start, stop):
            slot = p.column_slot[a]
            for w in range(LANES):
                scaled[w] = factor[slot, w] * inverse[c, w]
            for _ in range(a - start + 1):
                target, other = p.update[u, 0], p.update[u, 2]
                u += 1
                for w in range(LANES):
                    factor[target, w] -= scaled[w] * factor[other, w]


@jit(contract=True)
def _tool_loads(p, point, axis, pivot, entry, load):  # type: ignore[no-untyped-def]
    """Unit wrenches at the tool on the coordinates, (c, 6, w); zero but for the last ones."""
    load[:] = 0.0
    for t in range(p.tool_moves.shape[0]):
        c = p.tool_moves[t]
        for w in range(LANES):
            ax, ay, az = axis[c, 0, w], axis[c, 1, w], axis[c, 2, w]
            if p.turns[c] == 1:
                px = point[p.tool_node, 0, w] - pivot[c, 0, w]
                py = point[p.tool_node, 1, w] - pivot[c, 1, w]
                pz = point[p.tool_node, 2, w] - pivot[c, 2, w]
                load[c, 0, w] = ay * pz - az * py
                load[c, 1, w] = az * px - ax * pz
                load[c, 2, w] = ax * py - ay * px
                load[c, 3, w], load[c, 4, w], load[c, 5, w] = ax, ay, az
            else:
                load[c, 0, w], load[c, 1, w], load[c, 2, w] = ax, ay, az
        if p.tool_sign[t] < 0.0:
            for d in range(6):
                for w in range(LANES):
                    load[c, d, w] = -load[c, d, w]
    s = p.spread
    for k in range(s.tool_from.shape[0]):
        c, i, e = s.tool_from[k], s.tool_to[k], s.tool_entry[k]
        for d in range(6):
            for w in range(LANES):
                load[i, d, w] += entry[e, w] * load[c, d, w]


@jit(contract=True)
def _one_wrench(p, load, force):  # type: ignore[no-untyped-def]
    """A wrench in which all six parts take part, on the coordinates (c, w)."""
    for c in range(p.diagonal.shape[0]):
        for w in range(LANES):
            force[c, w] = (
                load[c, 0, w]
                + 0.8 * load[c, 1, w]
                - 0.6 * load[c, 2, w]
                + 0.1 * load[c, 3, w]
                - 0.08 * load[c, 4, w]
                + 0.06 * load[c, 5, w]
            )


@jit(contract=True)
def _substitute(p, factor, inverse, force, x):  # type: ignore[no-untyped-def]
    """Solve L D Lᵀ x = f, (c, w)."""
    count = p.diagonal.shape[0]
    for c in range(count):
        for w in range(LANES):
            x[c, w] = force[c, w]
    for c in range(count):
        for a in range(p.column_start[c], p.column_start[c + 1]):
            row, slot = p.column_row[a], p.column_slot[a]
            for w in range(LANES):
                x[row, w] -= factor[slot, w] * inverse[c, w] * x[c, w]
    for c in range(count - 1, -1, -1):
        for w in range(LANES):
            x[c, w] *= inverse[c, w]
        for a in range(p.column_start[c], p.column_start[c + 1]):
            row, slot = p.column_row[a], p.column_slot[a]
            for w in range(LANES):
                x[c, w] -= factor[slot, w] * inverse[c, w] * x[row, w]


@jit(contract=True)
def _left(p, matrix, x, r):  # type: ignore[no-untyped-def]
    """Take K x off r, (c, w)."""
    for k in range(p.entry_row.shape[0]):
        i, j = p.entry_row[k], p.entry_column[k]
        for w in range(LANES):
            r[i, w] -= matrix[k, w] * x[j, w]
        if i != j:
            for w in range(LANES):
                r[j, w] -= matrix[k, w] * x[i, w]


@jit(contract=True)
def _error(p, matrix, inverse, force, x, left, change, share):  # type: ignore[no-untyped-def]
    """Error of x by its correction, (w): root of the work of the one by that of the other.

    By the inequality of Schwarz the compliance along the wrench is as exact as this. Roundings
    may cancel in one correction and not in the answer: the error is never taken for less than
    what the last digit of every stiffness does to the work. Of a coordinate whose pivot vanished
    nothing is corrected: what is left on it is a share of the largest force, each with the
    stiffness of its coordinate scaled to one.
    """
    count = p.diagonal.shape[0]
    whole, off = np.zeros(LANES), np.zeros(LANES)
    last, size = np.zeros(LANES), np.zeros(LANES)
    for c in range(count):
        for w in range(LANES):
            stiff = matrix[p.diagonal[c], w]
            whole[w] += force[c, w] * x[c, w]
            off[w] += abs(left[c, w] * change[c, w])
            last[w] += EPSILON * stiff * x[c, w] * x[c, w]
            # a force on a coordinate that nothing resists is no size, but an error
            size[w] = max(size[w], abs(force[c, w]) / np.sqrt(stiff)) if stiff > 0.0 else size[w]
    for w in range(LANES):
        share[w] = np.sqrt(off[w] / whole[w]) if off[w] > 0.0 else 0.0
        share[w] = max(share[w], last[w] / whole[w]) if last[w] > 0.0 else share[w]
    for c in range(count):
        for w in range(LANES):
            stiff = matrix[p.diagonal[c], w]
            one = abs(left[c, w])
            # a coordinate of which neither a stiffness nor a load is known is idle
            if inverse[c, w] == 0.0 and one != 0.0:
                one = one / np.sqrt(stiff) / size[w] if stiff > 0.0 else np.inf
                share[w] = max(share[w], told(one, np.inf))
    for w in range(LANES):
        share[w] = told(share[w], np.inf)


@jit(contract=True)
def _compliance(p, factor, inverse, load, result):  # type: ignore[no-untyped-def]
    """C = Yᵀ D⁻¹ Y with L Y = loads; only the tool's coordinates take part, (6, 6, w)."""
    if p.tool_touches.shape[0] > 0:
        for c in range(p.tool_touches[0], p.diagonal.shape[0]):
            for a in range(p.column_start[c], p.column_start[c + 1]):
                row, slot = p.column_row[a], p.column_slot[a]
                for k in range(6):
                    for w in range(LANES):
                        load[row, k, w] -= factor[slot, w] * inverse[c, w] * load[c, k, w]
    result[:] = 0.0
    for t in range(p.tool_touches.shape[0]):
        c = p.tool_touches[t]
        for i in range(6):
            for j in range(i + 1):
                for w in range(LANES):
                    result[i, j, w] += load[c, i, w] * load[c, j, w] * inverse[c, w]


@jit()
def run(p, positions, frames, start, stop, compliance, quality):  # type: ignore[no-untyped-def]
    """Tool compliance of the poses start to stop.

    Parameters
    ----------
    p : Program
    positions : (q, n, 3)
        Mesh nodes, m.
    frames : (q, j, 3, 3)
        Of the joints, then of the bodies where these carry axes; no unit.
    start, stop : int
        Range of the poses.
    compliance : (q, 6, 6)
        Filled; m/N, 1/N, rad/(N·m).
    quality : (q, 4)
        Filled, no unit: smallest pivot as a share of its diagonal entry, error share, and of the
        loops' rows, which are of order one, the smallest pivot and what redundant ones keep.
    """
    nodes, joints = positions.shape[1], frames.shape[1]
    count = p.axis_joint.shape[0]
    most = widest = 1
    for item in range(p.touch_start.shape[0] - 1):
        most = max(most, p.touch_start[item + 1] - p.touch_start[item])
        widest = max(widest, p.spread.width[item])
    point = np.empty((nodes, 3, LANES))
    frame = np.empty((joints, 3, 3, LANES))
    axis, pivot = np.empty((count, 3, LANES)), np.empty((count, 3, LANES))
    geometry = (point, frame, axis, pivot)
    work = (
        np.empty((2, 3, LANES)),
        np.empty((3, 3, LANES)),
        np.empty(LANES),
        np.empty((most, 6, LANES)),
        np.empty((widest, 6, LANES)),
        np.empty((6, LANES)),
    )
    store = np.empty((p.loops.store_start[-1], LANES))
    entry = np.empty((p.loops.entry_start[-1], LANES))
    loop_work = (
        np.empty((p.loops.most_rows, p.loops.most_columns, LANES)),
        np.empty((p.loops.most_columns, LANES)),
        np.empty(LANES),
        np.empty(LANES),
        np.empty((6, LANES)),
    )
    loop_pivot, rest = np.empty(LANES), np.empty(LANES)
    total = np.empty((3, LANES))
    matrix = np.empty((p.fill.shape[0], LANES))
    factor = np.empty((p.slots, LANES))
    inverse, x = np.empty((count, LANES)), np.empty((count, LANES))
    force, r, change = (
        np.empty((count, LANES)),
        np.empty((count, LANES)),
        np.empty((count, LANES)),
    )
    load = np.empty((count, 6, LANES))
    result = np.empty((6, 6, LANES))
    scaled, smallest, share = np.empty(LANES), np.empty(LANES), np.empty(LANES)
    for base in range(start, stop, LANES):
        for w in range(LANES):
            pose = min(base + w, stop - 1)
            for n in range(nodes):
                for k in range(3):
                    point[n, k, w] = positions[pose, n, k]
            for j in range(joints):
                for k in range(3):
                    for d in range(3):
                        frame[j, k, d, w] = frames[pose, j, k, d]
        axes_and_pivots(p, point, frame, axis, pivot)
        close_loops(p, geometry, store, entry, loop_work, loop_pivot, rest)
        assemble(p, geometry, entry, matrix, work)
        _eliminate(p, matrix, factor, inverse, scaled, smallest)
        _tool_loads(p, point, axis, pivot, entry, load)
        _one_wrench(p, load, force)
        r[:] = force
        _substitute(p, factor, inverse, r, x)
        _left(p, matrix, x, r)
        _substitute(p, factor, inverse, r, change)
        _error(p, matrix, inverse, force, x, r, change, share)
        loops_residual(p, store, entry, x, share, total, scaled)
        _compliance(p, factor, inverse, load, result)
        for w in range(min(LANES, stop - base)):
            quality[base + w, 0], quality[base + w, 1] = smallest[w], share[w]
            quality[base + w, 2], quality[base + w, 3] = loop_pivot[w], rest[w]
            for i in range(6):
                for j in range(i + 1):
                    compliance[base + w, i, j] = compliance[base + w, j, i] = result[i, j, w]


def run_program(
    program: Program, positions: Array, frames: Array, compliance: Array, quality: Array
) -> None:
    """Call the compiled `run` over all poses of the arrays, with types.

    Parameters
    ----------
    program : Program
    positions : (q, n, 3)
        Mesh nodes, m.
    frames : (q, j, 3, 3)
        Of the joints, then of the bodies where these carry axes; no unit.
    compliance : (q, 6, 6)
        Filled; m/N, 1/N, rad/(N·m).
    quality : (q, 4)
        Filled as by `run`, no unit.
    """
    run(program, positions, frames, 0, len(positions), compliance, quality)
