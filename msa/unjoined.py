"""Nodes that stand at one place and that nothing joins."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.structure import PlacedStructure

#: Nodes nearer to one another than this share of the structure's size stand at one place.
NEAR = 1e-6

#: Points are sorted along this direction, in which hardly any two of a regular drawing are level.
SWEEP = np.array([0.4816, 0.5931, 0.6453])


def unjoined_nodes(placed: PlacedStructure) -> tuple[tuple[str, ...], ...]:
    """Groups of nodes at one place that hang together by nothing there.

    Two parts of a drawing that meet under two names of a node are the usual cause of a mechanism.
    Joints and springs of any kind join, and so does the ground: two supports at one place do.

    Parameters
    ----------
    placed : PlacedStructure
        At one pose, no batch axes.

    Returns
    -------
    tuple of tuple of str
        One node of each piece that meets the others there, in the order of the linkage.
    """
    structure, linkage = placed.structure, placed.structure.linkage
    points = placed.placement.positions.real
    size = float(np.ptp(points, axis=0).max(initial=0.0)) if len(points) else 0.0
    if size == 0.0 and len(points) < 2:
        return ()
    pairs = _near_pairs(points, NEAR * size)
    if not len(pairs):
        return ()
    ground = len(points)
    index, vertex = linkage.node_index, structure.vertex_of_node
    place = _labels(ground, pairs.tolist())
    ties = [tuple(index[n] for n in joint.between) for joint in linkage.joints]
    ties += [
        (index[s.nodes[0]], index[s.nodes[-1]] if len(s.nodes) == 2 else ground)
        for s in structure.springs
    ]
    ties += [(n, ground) for n in range(len(points)) if vertex[n] < 0]
    first: dict[int, int] = {}
    for n in {int(i) for i in pairs.ravel()}:
        # nodes of a rigid body are one, and so are those of an element of another kind
        ties.append((first.setdefault(int(vertex[n]), n), n))
    for element in structure.elements:
        ties += [(index[element.nodes[0]], index[n]) for n in element.nodes[1:]]
    shared = set(pairs.ravel().tolist())
    members: dict[int, list[int]] = {}
    for n in sorted(shared):
        members.setdefault(int(place[n]), []).append(n)
    # a tie counts where both its ends stand at one place, or one of them on ground
    local: dict[int, list[tuple[int, int]]] = {label: [] for label in members}
    for a, b in ties:
        ends = [int(place[n]) for n in (a, b) if n != ground]
        if shared.issuperset({a, b} - {ground}) and len(set(ends)) == 1:
            local[ends[0]].append((a, b))
    found = []
    for label, here in sorted(members.items()):
        number = {n: i for i, n in enumerate([*here, ground])}
        piece = _labels(len(number), [(number[a], number[b]) for a, b in local[label]])
        pieces = {int(piece[number[n]]): n for n in reversed(here)}
        if len(pieces) > 1:
            found.append(tuple(linkage.nodes[n] for n in sorted(pieces.values())))
    return tuple(found)


def in_words(placed: PlacedStructure, nodes: Sequence[str]) -> str:
    """What a group of `unjoined_nodes` is, with the parts that end there.

    Parameters
    ----------
    placed : PlacedStructure
    nodes : sequence of str
        A group of `unjoined_nodes`.
    """
    structure = placed.structure
    named = []
    for node in nodes:
        parts = [f"beam {b.name}" for b in structure.beams if node in b.nodes]
        parts += [
            f"body {b.name}"
            for b in (*structure.linkage.bodies, *structure.rigid)
            if node in b.nodes and len(b.nodes) > 1 and not parts
        ]
        named.append(f"{node} of {parts[0]}" if parts else node)
    listed = f"{', '.join(named[:-1])} and {named[-1]}"
    return f"nodes {listed} are at one place, and nothing joins them"


def _labels(count: int, edges: Sequence[Sequence[int]]) -> np.ndarray:
    """Number of the connected part that each of `count` items is in."""
    parent = list(range(count))

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for a, b in edges:
        parent[root(b)] = root(a)
    return np.array([root(i) for i in range(count)])


def _near_pairs(points: NDArray[Any], distance: float) -> NDArray[Any]:
    """Pairs of points (n, 3) that are at most so far apart, (p, 2).

    SciPy's tree would do it as well; loading it takes longer than checking a hexapod.
    """
    along = points @ SWEEP
    order = np.argsort(along, kind="stable")
    level, sorted_points = along[order], points[order]
    pairs = []
    for step in range(1, len(points)):
        at = np.flatnonzero(level[step:] - level[:-step] <= distance)
        if not len(at):
            break
        apart = np.linalg.norm(sorted_points[at + step] - sorted_points[at], axis=-1)
        at = at[apart <= distance]
        pairs.append(np.stack([order[at], order[at + step]], axis=-1))
    return np.sort(np.concatenate(pairs), axis=-1) if pairs else np.empty((0, 2), dtype=int)
