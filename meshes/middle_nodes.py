"""Middle nodes that a file leaves out: put half-way along their edge."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.rows import row_groups

Array = NDArray[Any]
Ints = NDArray[np.int64]


def filled(points: Array, blocks: Sequence[tuple[str, Ints]]) -> tuple[Array, list[Ints]]:
    """Points (p, 3) and nodes (m, k) of the blocks with the nodes that lack, which are -1.

    An edge has one middle node: that of a neighbour where one gives it, else a new one.

    Parameters
    ----------
    points : (n, 3)
        In any unit, that of the file.
    blocks : sequence of (kind, (m, k) int)
    """
    made = [np.array(nodes) for _, nodes in blocks]
    if not any((nodes < 0).any() for nodes in made):
        return points, made
    ends, middles, places = [], [], []
    for index, ((kind, _), nodes) in enumerate(zip(blocks, made, strict=True)):
        for column, parents in enumerate(CELL_TYPES[kind].parents):
            if len(parents) == 2:
                ends.append(nodes[:, list(parents)])
                middles.append(nodes[:, column])
                places.append((index, column))
    edges, given = np.concatenate(ends), np.concatenate(middles)
    first, group = row_groups(edges)
    middle = np.full(len(first), -1)
    np.maximum.at(middle, group, given)
    wanted = np.zeros(len(first), dtype=bool)
    wanted[group[given < 0]] = True
    new = wanted & (middle < 0)
    middle[new] = len(points) + np.arange(int(new.sum()))
    more = points[edges[first[new]]].mean(axis=1)
    found = np.where(given < 0, middle[group], given)
    for (index, column), values in zip(
        places, np.split(found, np.cumsum([len(m) for m in middles])[:-1]), strict=True
    ):
        made[index][:, column] = values
    return np.concatenate([points, more]), made
