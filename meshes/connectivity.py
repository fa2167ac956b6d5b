"""What hangs together: parts without a common node, orphans, doubles, collapsed cells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from strutwork.errors import ModelError
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.rows import row_groups
from strutwork.meshes.transform import coincident_groups

Array = NDArray[Any]
Ints = NDArray[np.int64]


@dataclass(frozen=True, repr=False)
class Connectivity:
    """Connectivity of the cells of a mesh.

    Parameters
    ----------
    part_of_point : (n,) int
        The part that each point belongs to, -1 for orphans. Cells of one part share nodes.
    part_regions : tuple of tuple of str
        Regions of the cells of each part.
    orphans : (k,) int
        Points that no cell uses.
    coincident : (k,) int
        Points at the place of an earlier one.
    collapsed : (k,) int
        Cells that use a node twice; blocks one after another.
    doubled : (k,) int
        Cells with the nodes of an earlier one.
    """

    part_of_point: Ints
    part_regions: tuple[tuple[str, ...], ...]
    orphans: Ints
    coincident: Ints
    collapsed: Ints
    doubled: Ints

    def __repr__(self) -> str:
        return (
            f"Connectivity({len(self.part_regions)} parts, {len(self.orphans)} orphans, "
            f"{len(self.coincident)} coincident points, {len(self.collapsed)} collapsed and "
            f"{len(self.doubled)} doubled cells)"
        )

    def to_dict(self) -> dict[str, Any]:
        """Counts, for reports."""
        return {
            "parts": [list(regions) for regions in self.part_regions],
            "orphans": len(self.orphans),
            "coincident_points": len(self.coincident),
            "collapsed_cells": len(self.collapsed),
            "doubled_cells": len(self.doubled),
        }


def connectivity(mesh: Mesh, tolerance: float | None = None) -> Connectivity:
    """Connectivity of the cells of a mesh.

    Parameters
    ----------
    mesh : Mesh
        Any, also of several bodies.
    tolerance : float, optional
        Distance up to which points coincide, m; default as for `strutwork.meshes.transform.merged`.
    """
    size = len(mesh.points)
    links = [
        (np.repeat(b.nodes[:, :1], b.type.size - 1, axis=1), b.nodes[:, 1:]) for b in mesh.blocks
    ]
    start = np.concatenate([a.ravel() for a, _ in links])
    end = np.concatenate([b.ravel() for _, b in links])
    graph = coo_array((np.ones(len(start)), (start, end)), shape=(size, size))
    label = connected_components(graph, directed=False)[1]
    used = np.zeros(size, dtype=bool)
    used[start] = used[end] = True
    parts = np.full(size, -1, dtype=np.int64)
    parts[used] = np.unique(label[used], return_inverse=True)[1]
    seen: list[set[int]] = [set() for _ in range(int(parts.max()) + 1)]
    collapsed, doubled = [], []
    for block in mesh.blocks:
        pairs = np.unique(np.stack([parts[block.nodes[:, 0]], block.region]), axis=1)
        for part, region in pairs.T:
            seen[part].add(int(region))
        ordered = np.sort(block.nodes, axis=1)
        collapsed.append((ordered[:, 1:] == ordered[:, :-1]).any(axis=1))
        again = np.ones(len(ordered), dtype=bool)
        again[row_groups(ordered)[0]] = False
        doubled.append(again)
    group = coincident_groups(mesh, tolerance)
    first = np.zeros(size, dtype=bool)
    first[np.unique(group, return_index=True)[1]] = True
    return Connectivity(
        parts,
        tuple(tuple(mesh.regions[i] for i in sorted(found)) for found in seen),
        np.flatnonzero(~used),
        np.flatnonzero(~first),
        np.flatnonzero(np.concatenate(collapsed)),
        np.flatnonzero(np.concatenate(doubled)),
    )


def check_connectivity(mesh: Mesh, tolerance: float | None = None) -> Connectivity:
    """Connectivity of the cells of a mesh that is one body.

    Parameters
    ----------
    mesh : Mesh
        Of one body.
    tolerance : float, optional
        As for `connectivity`, m.

    Raises
    ------
    ModelError
        Parts without a common node, by the names of their regions and how far they are
        apart; collapsed or doubled cells; points that no cell uses. Coincident points of one
        part may be a crack on purpose and are only reported.
    """
    found = connectivity(mesh, tolerance)
    part = f"mesh {mesh.name}"
    if len(found.part_regions) > 1:
        raise _apart(mesh, found)
    for cells, what, remedy in (
        (found.collapsed, "use a node twice", "Remesh that region, or use tetrahedra there."),
        (found.doubled, "have the nodes of another", "Delete the copies."),
    ):
        if len(cells):
            raise ModelError(part, f"{len(cells)} cells {what}, the first is {cells[0]}.", remedy)
    if len(found.orphans):
        raise ModelError(
            part,
            f"{len(found.orphans)} points belong to no cell, the first is {found.orphans[0]}.",
            "Drop them with `strutwork.meshes.without_orphans`.",
        )
    return found


def _apart(mesh: Mesh, found: Connectivity) -> ModelError:
    """The error for the first part and the one nearest to it."""
    mine = mesh.points[found.part_of_point == 0]
    others = np.flatnonzero(found.part_of_point > 0)
    distance, nearest = cKDTree(mine).query(mesh.points[others])
    closest = int(np.argmin(distance))
    other = int(found.part_of_point[others[closest]])
    names = [_named(found.part_regions[i]) for i in (0, other)]
    where = ", ".join(f"{v:.4g}" for v in mine[nearest[closest]])
    count = len(found.part_regions)
    more = f"; there are {count} such parts" if count > 2 else ""
    return ModelError(
        f"mesh {mesh.name}",
        f"{names[0]} and {names[1]} have no common node{more}. They are nearest at ({where}) m, "
        f"{distance[closest]:.3g} m apart.",
        "Merge coincident points with `strutwork.meshes.merged` and a tolerance, make the mesh "
        "lines of both agree, or analyse each part as its own solid.",
    )


def _named(regions: tuple[str, ...]) -> str:
    many = "regions " if len(regions) > 1 else "region "
    return many + ", ".join(repr(name) for name in regions)
