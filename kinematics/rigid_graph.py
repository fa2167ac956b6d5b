"""Rank and null spaces of the rigidified linkage, piece by piece of its graph.

Bodies are the vertices and joints the edges of a graph. Referred to one point, a row of a joint is
a wrench on the difference of two bodies' twists. Two facts make large linkages small: bodies that
a joint holds in all six directions move as one; and blocks of the graph that meet in one body only
(its biconnected components) neither know each other's motions nor each other's self-stress. What is
left is one dense decomposition for every block.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.sparse_basis import sparse_basis

Array = NDArray[Any]
Ints = NDArray[np.intp]


@dataclass(frozen=True)
class RigidGraph:
    """Rows on bodies: axis · (displacement and rotation of second − first) at a point.

    Parameters
    ----------
    axes : (r, 6)
        Unit vectors in global axes, (a, 0) or (0, a).
    points : (r, 3)
        Where they act, m.
    first, second : (r,)
        Bodies of each row, −1 for ground.
    references : (b, 3)
        Reference points of the bodies, m.
    length : float
        Of a block that has none of its own, m.
    tied : tuple of ((t,) rows, (t,) ratios, RigidGraph)
        Rows that hold a second pair of bodies too, and what they take off there, by the rows of
        another graph.
    """

    axes: Array
    points: Array
    first: Ints
    second: Ints
    references: Array
    length: float
    tied: tuple[Ints, Array, RigidGraph] | None = None

    @property
    def bodies(self) -> int:
        """Number of bodies that can move."""
        return len(self.references)

    def wrenches(self, rows: Ints, centre: Array) -> Array:
        """Rows as wrenches about a point, force then moment, (k, 6).

        Parameters
        ----------
        rows : (k,) of int
            Which rows.
        centre : (3,)
            m.
        """
        result = self.axes[rows].copy()
        result[:, 3:] += np.cross(self.points[rows] - centre, result[:, :3])
        return result


@dataclass(frozen=True)
class Block:
    """One block of the graph with its rows decomposed, its carrier held.

    Parameters
    ----------
    rows : (k,)
        Indices of the rows of the graph.
    groups : (g,)
        Groups of bodies that the block moves against its carrier.
    values : (s,)
        Singular values, descending, no unit.
    right : (6 g, 6 g)
        Right singular vectors as rows, orthonormal.
    matrix : (k, 6 g)
        The rows themselves, of unit size, on twists about the centre, no unit.
    size : (k,)
        By which each row was divided, no unit.
    centre : (3,)
        m.
    length : float
        Rotations are in units of displacement at this arm, m.
    """

    rows: Ints
    groups: Ints
    values: Array
    right: Array
    matrix: Array
    size: Array
    centre: Array
    length: float


@dataclass(frozen=True)
class Blocks:
    """The decomposition of a graph.

    Parameters
    ----------
    graph : RigidGraph
    group : (b,)
        Group of every body; −1 for bodies that stand with ground.
    tree : tuple of ((6,) rows, body, carrier)
        Joints that hold two bodies together in all six directions.
    inner : (i,)
        Rows inside one group: redundant.
    blocks : tuple of Block
    below : tuple of mapping of group to (h,)
        For each block, the groups that move with each of its own: what hangs on it.
    """

    graph: RigidGraph
    group: Ints
    tree: tuple[tuple[Ints, int, int], ...]
    inner: Ints
    blocks: tuple[Block, ...]
    below: tuple[dict[int, Ints], ...]

    def rank(self, tolerance: float) -> int:
        """Rank of the rows: six for every joint of the tree, and that of every block.

        Parameters
        ----------
        tolerance : float
            Share of a block's largest singular value up to which others count as zero.
        """
        return 6 * len(self.tree) + sum(_rank(b.values, tolerance) for b in self.blocks)

    def null(self, tolerance: float) -> Array:
        """Motions that no row resists, twists about the references, (b, 6, k), m and rad.

        Parameters
        ----------
        tolerance : float
            Share of a block's largest singular value up to which others count as zero.
        """
        found = [
            self.motion(block, below, vector)
            for block, below in zip(self.blocks, self.below, strict=True)
            for vector in sparse_basis(block.right[_rank(block.values, tolerance) :].T).T
        ]
        if not found:
            return np.zeros((self.graph.bodies, 6, 0))
        return np.stack(found, axis=-1)

    def motion(self, block: Block, below: dict[int, Ints], vector: Array) -> Array:
        """Twists of all bodies about their references in a motion of one block, (b, 6).

        Parameters
        ----------
        block : Block
            One of `blocks`.
        below : dict of int to (h,) of int
            Its entry of `below`: groups that hang on each of its own.
        vector : (6 g,)
            (v, L ω) of its groups about its centre, m; L is the block's length.
        """
        groups = int(self.group.max(initial=-1)) + 1
        twists = np.zeros((groups + 1, 6))
        for own, twist in zip(block.groups, vector.reshape(-1, 6), strict=True):
            twists[below[int(own)]] = twist
        result = twists[self.group]
        result[:, 3:] /= block.length
        arms = self.graph.references - block.centre
        result[:, :3] += np.cross(result[:, 3:], arms)
        return np.asarray(result)


def _rank(values: Array, tolerance: float) -> int:
    return int(np.count_nonzero(values > tolerance * values.max(initial=0.0)))


def decompose(graph: RigidGraph) -> Blocks:
    """Hold together what six rows hold, then decompose block by block.

    Where rows tie two pairs of bodies the graph is one block, for it has no edges.

    Parameters
    ----------
    graph : RigidGraph
        The rows of one pose.
    """
    if graph.tied is not None:
        every = np.arange(graph.bodies, dtype=np.intp)
        rows = np.arange(len(graph.axes), dtype=np.intp)
        block = _decomposed(graph, rows, every, [graph.first, graph.second], -1, every)
        alone = {int(b): every[b : b + 1] for b in every}
        return Blocks(graph, every, (), rows[:0], (block,), (alone,))
    group, tree = _grouped(graph)
    ends = [np.where(side >= 0, group[side], -1) for side in (graph.first, graph.second)]
    used = np.concatenate([rows for rows, _, _ in tree]) if tree else np.zeros(0, dtype=np.intp)
    unused = np.ones(len(graph.axes), dtype=bool)
    unused[used] = False
    left = np.flatnonzero(unused)
    inside = ends[0][left] == ends[1][left]
    outer = left[~inside]
    count = int(group.max(initial=-1)) + 1
    pairs: dict[tuple[int, int], list[int]] = {}
    for r in outer:
        a, b = sorted((int(ends[0][r]), int(ends[1][r])))
        pairs.setdefault((a, b), []).append(int(r))
    blocks, below = [], []
    for carrier, own, edges in _biconnected(count, list(pairs)):
        rows = np.asarray(sorted(r for e in edges for r in pairs[e]), dtype=np.intp)
        groups = np.asarray(sorted(own), dtype=np.intp)
        blocks.append(_decomposed(graph, rows, groups, [end[rows] for end in ends], carrier, group))
        below.append({g: np.asarray(sorted(own[g]), dtype=np.intp) for g in own})
    return Blocks(graph, group, tree, left[inside], tuple(blocks), tuple(below))


def _decomposed(
    graph: RigidGraph, rows: Ints, groups: Ints, ends: list[Ints], carrier: int, group: Ints
) -> Block:
    # a point and a length of its own: nothing outside the block changes what it is measured by
    points = graph.points[rows] if len(rows) else graph.references[np.isin(group, groups)]
    centre = points.mean(axis=0)
    length = float(np.linalg.norm(points - centre, axis=1).max())
    if length == 0:
        length = graph.length
    matrix, size = _spread(graph, rows, groups, ends, carrier, (centre, length))
    if graph.tied is not None:
        at, ratio, other = graph.tied
        mine = np.arange(len(at), dtype=np.intp)
        away = [other.first, other.second]
        more, sizes = _spread(other, mine, groups, away, carrier, (centre, length))
        matrix[at] -= ratio[:, None] * more
        size[at] = np.hypot(size[at], ratio * sizes)
    matrix /= size[:, None]
    # with more rows than columns the left vectors are many and nobody reads them
    _, values, right = np.linalg.svd(matrix, full_matrices=len(rows) < matrix.shape[1])
    return Block(rows, groups, values, right, matrix, size, centre, length)


def _spread(
    graph: RigidGraph,
    rows: Ints,
    groups: Ints,
    ends: list[Ints],
    carrier: int,
    place: tuple[Array, float],
) -> tuple[Array, Array]:
    """Rows on twists of groups about a centre, rotations at a length, (k, 6 g), and sizes (k)."""
    centre, length = place
    wrenches = graph.wrenches(rows, centre)
    wrenches[:, 3:] /= length
    spread = np.zeros((len(rows), len(groups), 6))
    for side, sign in zip(ends, (-1.0, 1.0), strict=True):
        moves = np.flatnonzero(side != carrier)
        spread[moves, np.searchsorted(groups, side[moves])] += sign * wrenches[moves]
    return spread.reshape(len(rows), 6 * len(groups)), np.linalg.norm(wrenches, axis=1)


def _grouped(graph: RigidGraph) -> tuple[Ints, tuple[tuple[Ints, int, int], ...]]:
    """Groups of bodies held together in all six directions, and the joints that hold them."""
    piece = list(range(-1, graph.bodies))

    def root(v: int) -> int:
        while piece[v + 1] != v:
            piece[v + 1] = piece[piece[v + 1] + 1]
            v = piece[v + 1]
        return v

    tree = []
    pair = np.stack([graph.first, graph.second], axis=1)
    # rows of one joint stand together
    starts = np.flatnonzero(np.any(np.diff(pair, axis=0, prepend=-9) != 0, axis=1))
    for rows in np.split(np.arange(len(pair)), starts[1:]) if len(pair) else []:
        for six in [rows[i : i + 6] for i in range(0, len(rows) - 5, 6)]:
            a, b = int(pair[six[0], 0]), int(pair[six[0], 1])
            if root(a) == root(b) or not _full(graph.axes[six]):
                continue
            low, high = sorted((root(a), root(b)))
            # ground is the lowest and stays a root
            piece[high + 1] = low
            tree.append((six, b, a))
    roots = np.array([root(v) for v in range(graph.bodies)], dtype=np.intp)
    _, label = np.unique(np.append(roots, -1), return_inverse=True)
    return np.asarray(label[:-1] - 1, dtype=np.intp), tuple(tree)


def _full(axes: Array) -> bool:
    values = np.linalg.svd(axes, compute_uv=False)
    return bool(values[-1] > 1e-3 * values[0])


def _biconnected(
    count: int, edges: list[tuple[int, int]]
) -> Iterator[tuple[int, dict[int, set[int]], list[tuple[int, int]]]]:
    """Blocks of a graph (Hopcroft and Tarjan 1973) with carrier, own vertices and edges.

    Each own vertex comes with the vertices that move with it: itself and what hangs on it. A
    vertex without a way to ground is a root, whose own six freedoms are a block without edges.
    """
    around: list[list[int]] = [[] for _ in range(count + 1)]
    for a, b in edges:
        around[a].append(b)
        around[b].append(a)
    # index −1, the ground, is the last of the list
    depth, low, parent = [-1] * (count + 1), [0] * (count + 1), [-2] * (count + 1)
    found: list[tuple[int, list[int], list[tuple[int, int]]]] = []
    for start in [-1, *range(count)]:
        if depth[start] >= 0:
            continue
        if start >= 0:
            found.append((-1, [start], []))
        depth[start] = low[start] = 0
        stack: list[tuple[int, Iterator[int]]] = [(start, iter(around[start]))]
        trail: list[tuple[int, int]] = []
        while stack:
            v, rest = stack[-1]
            w = next(rest, None)
            if w is None:
                stack.pop()
                if stack:
                    u = stack[-1][0]
                    low[u] = min(low[u], low[v])
                    if low[v] >= depth[u]:
                        found.append(_closed(trail, u, v))
            elif depth[w] < 0:
                depth[w] = low[w] = depth[v] + 1
                parent[w] = v
                trail.append((v, w))
                stack.append((w, iter(around[w])))
            elif w != parent[v] and depth[w] < depth[v]:
                trail.append((v, w))
                low[v] = min(low[v], depth[w])
    hanging: dict[int, list[int]] = {}
    for i, (carrier, _, _) in enumerate(found):
        hanging.setdefault(carrier, []).append(i)
    for carrier, own, block in found:
        yield carrier, {v: _above(v, found, hanging) for v in own}, block


def _closed(
    trail: list[tuple[int, int]], carrier: int, vertex: int
) -> tuple[int, list[int], list[tuple[int, int]]]:
    """Take the edges of a finished block off the trail."""
    at = trail.index((carrier, vertex))
    block = [(min(edge), max(edge)) for edge in trail[at:]]
    del trail[at:]
    return carrier, sorted({x for edge in block for x in edge} - {carrier}), block


def _above(
    vertex: int,
    found: list[tuple[int, list[int], list[tuple[int, int]]]],
    hanging: dict[int, list[int]],
) -> set[int]:
    """A vertex and all that hangs on it."""
    result, queue = {vertex}, [vertex]
    while queue:
        for i in hanging.get(queue.pop(), []):
            new = [v for v in found[i][1] if v not in result]
            result.update(new)
            queue += new
    return result
