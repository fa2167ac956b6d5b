"""Motions and states of self-stress of a large linkage, from the blocks of its graph."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.rigid_graph import Block, Blocks, RigidGraph
from strutwork.kinematics.rows import ConstraintRows, body_references

Array = NDArray[Any]
Ints = NDArray[np.intp]

#: Forces of a state of self-stress below this share of its largest are rounding.
ROUNDING = 1e-9


def rigid_graph(rows: ConstraintRows, length: float) -> RigidGraph:
    """The graph of rows of a single pose.

    Parameters
    ----------
    rows : ConstraintRows
        Of one pose, without batch axes.
    length : float
        For blocks that have none of their own, m.
    """
    linkage, positions = rows.linkage, rows.placement.positions
    tied = None
    if rows.tied is not None:
        tied = rows.tied.rows, rows.tied.ratio, rigid_graph(rows.tied.others, length)
    nodes = rows.nodes
    owner = linkage.body_of_node[nodes]
    return RigidGraph(
        rows.axes,
        positions[nodes].mean(axis=1),
        owner[:, 0],
        owner[:, 1],
        body_references(linkage, rows.placement),
        length,
        tied,
    )


def stress_states(blocks: Blocks, tolerance: float) -> list[tuple[Ints, Array]]:
    """A basis of the states of self-stress: rows (k,) and their multipliers (k,), few in each.

    Parameters
    ----------
    blocks : Blocks
        Of the rows that are held.
    tolerance : float
        Share of a block's largest singular value up to which others count as zero.
    """
    tree = _Tree(blocks)
    found = [tree.balanced(np.array([r]), np.ones(1)) for r in blocks.inner]
    for block in blocks.blocks:
        found += [tree.balanced(rows, values) for rows, values in _left_null(block, tolerance)]
    return found


def _left_null(block: Block, tolerance: float) -> list[tuple[Ints, Array]]:
    """Each row beyond the rank, balanced by those of a set of independent ones."""
    count = len(block.rows)
    largest = block.values.max(initial=0.0)
    rank = int(np.count_nonzero(block.values > tolerance * largest))
    if rank == count:
        return []
    # SciPy takes longer to load than a check of a small machine, which needs no block of many rows
    from scipy.linalg import qr  # noqa: PLC0415

    _, order = qr(block.matrix.T, mode="r", pivoting=True)
    chosen, others = order[:rank], order[rank:]
    shares = np.linalg.lstsq(block.matrix[chosen].T, block.matrix[others].T, rcond=None)[0]
    states = []
    for other, share in zip(others, shares.T, strict=True):
        taking = np.abs(share) > ROUNDING
        index = np.append(chosen[taking], other)
        states.append((block.rows[index], np.append(-share[taking], 1.0) / block.size[index]))
    return states


class _Tree:
    """The joints that hold groups together, rooted, to carry wrenches from body to body."""

    def __init__(self, blocks: Blocks) -> None:
        self.graph = blocks.graph
        around: dict[int, list[tuple[int, Ints, float]]] = {}
        for rows, second, first in blocks.tree:
            around.setdefault(first, []).append((second, rows, 1.0))
            around.setdefault(second, []).append((first, rows, -1.0))
        #: Body's carrier, the rows between, and the sign with which they act on the body.
        self.up: dict[int, tuple[int, Ints, float]] = {}
        self.depth: dict[int, int] = {}
        for start in [-1, *sorted(v for v in around if v >= 0)]:
            if start in self.depth:
                continue
            self.depth[start] = 0
            queue = [start]
            while queue:
                v = queue.pop()
                for other, rows, sign in around.get(v, []):
                    if other not in self.depth:
                        self.depth[other] = self.depth[v] + 1
                        self.up[other] = (v, rows, sign)
                        queue.append(other)

    def balanced(self, rows: Ints, values: Array) -> tuple[Ints, Array]:
        """Rows with multipliers, and those of the tree that bring every body into balance."""
        graph = self.graph
        origin = graph.points[rows[0]]
        lever = np.array([1.0] * 3 + [1.0 / graph.length] * 3)
        net: dict[int, Array] = {}
        largest = 0.0
        for r, wrench in zip(rows, values[:, None] * graph.wrenches(rows, origin), strict=True):
            largest = max(largest, float(np.abs(wrench * lever).max()))
            for body, sign in ((int(graph.first[r]), -1.0), (int(graph.second[r]), 1.0)):
                net[body] = net.get(body, np.zeros(6)) + sign * wrench
        index, forces = [rows], [values]
        waiting = {b for b in net if b in self.up}
        while waiting:
            body = max(waiting, key=lambda b: self.depth[b])
            waiting.remove(body)
            carrier, own, sign = self.up[body]
            wrench = net.pop(body)
            if np.abs(wrench * lever).max() <= ROUNDING * largest:
                continue
            index.append(own)
            forces.append(np.linalg.solve(graph.wrenches(own, origin).T, -sign * wrench))
            net[carrier] = net.get(carrier, np.zeros(6)) + wrench
            if carrier in self.up:
                waiting.add(carrier)
        found, given = np.concatenate(index), np.concatenate(forces)
        turns = np.any(graph.axes[found, 3:], axis=1)
        size = np.abs(given) * np.where(turns, 1.0 / graph.length, 1.0)
        kept = size > ROUNDING * size.max()
        order = np.argsort(found[kept])
        return found[kept][order], given[kept][order]
