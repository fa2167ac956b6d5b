"""Spanning forest of the joints: which joints carry a cluster and which close a loop.

Walking from a root over the joints, the motion of each rigid cluster is that of its carrier
plus the motion the joint leaves: joint coordinates that satisfy the locked directions without
any rank decision. Only joints that close a loop leave rows behind.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import State
from strutwork.msa.structure import Structure

Array = NDArray[Any]

ROOT, CARRIED = 0, 1


@dataclass(frozen=True)
class Step:
    """How one cluster gets its motion.

    Parameters
    ----------
    vertex : int
        The cluster.
    parent : int
        The cluster that carries it, -1 for ground; for a root of its own, -2.
    joint : int
        Index of the carrying joint, -1 for a root.
    sign : float
        +1 where the cluster is the joint's second side, −1 where it is the first; no unit.
    free : tuple of int
        Directions of the joint that are not locked: one coordinate each.
    start : int
        First coordinate of the step; a root has six.
    """

    vertex: int
    parent: int
    joint: int
    sign: float
    free: tuple[int, ...]
    start: int


@dataclass(frozen=True)
class Forest:
    """The steps in an order in which carriers come first.

    Parameters
    ----------
    steps : tuple of Step
    count : int
        Number of coordinates.
    closing : tuple of int
        Joints whose locked directions remain as rows.
    """

    steps: tuple[Step, ...]
    count: int
    closing: tuple[int, ...]

    @property
    def tree_joints(self) -> frozenset[int]:
        """Joints that carry a cluster."""
        return frozenset(s.joint for s in self.steps if s.joint >= 0)


def spanning_forest(structure: Structure) -> Forest:
    """Choose carriers so that joints with most locked directions carry (Kruskal).

    Parameters
    ----------
    structure : Structure
    """
    linkage = structure.linkage
    states = linkage.states()
    locked = (states == State.LOCKED).sum(axis=1)
    vertex, index = structure.vertex_of_node, linkage.node_index
    ends = [tuple(int(vertex[index[n]]) for n in j.between) for j in linkage.joints]
    piece = list(range(-1, structure.vertex_count))

    def root(v: int) -> int:
        while piece[v + 1] != v:
            piece[v + 1] = piece[piece[v + 1] + 1]
            v = piece[v + 1]
        return v

    neighbours: dict[int, list[tuple[int, int, float]]] = {}
    closing = []
    tied = {tie.joint for tie in linkage.ties}
    for j in sorted(range(len(linkage.joints)), key=lambda j: (-locked[j], j)):
        first, second = ends[j]
        if locked[j] == 0:
            continue
        if root(first) == root(second) or j in tied:
            # a coordinate that follows another is no direction of its joint's frame alone
            closing.append(j)
            continue
        piece[root(second) + 1] = root(first)
        neighbours.setdefault(first, []).append((second, j, 1.0))
        neighbours.setdefault(second, []).append((first, j, -1.0))
    order = [-1]
    if linkage.tool is not None:
        order.append(int(vertex[index[linkage.tool]]))
    # a cluster with many joints makes short chains when it is the root
    order += sorted(range(structure.vertex_count), key=lambda v: -len(neighbours.get(v, [])))
    steps: list[Step] = []
    count = 0
    done: set[int] = set()
    for start in order:
        if start in done:
            continue
        done.add(start)
        if start >= 0:
            steps.append(Step(start, -2, -1, 1.0, (), count))
            count += 6
        queue = [start]
        while queue:
            v = queue.pop(0)
            for other, j, sign in neighbours.get(v, []):
                if other in done:
                    continue
                done.add(other)
                free = tuple(int(d) for d in np.flatnonzero(states[j] != State.LOCKED))
                steps.append(Step(other, v, j, sign, free, count))
                count += len(free)
                queue.append(other)
    return Forest(tuple(steps), count, tuple(sorted(closing)))
