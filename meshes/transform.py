"""Meshes moved, mapped, joined, and their coincident points merged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from strutwork.errors import ModelError
from strutwork.meshes.mesh import CellBlock, Faces, Mesh, Patch
from strutwork.meshes.quality import check_quality

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Points closer than this share of the mesh's diagonal are one, unless a tolerance is given.
COINCIDENT = 1e-9


def moved(
    mesh: Mesh, rotation: ArrayLike | None = None, translation: ArrayLike | None = None
) -> Mesh:
    """The mesh rotated about the origin, then translated.

    Parameters
    ----------
    mesh : Mesh
    rotation : (3, 3) or None
        Rotation matrix.
    translation : (3,) or None
        m.

    Raises
    ------
    ModelError
        A matrix that is not a rotation.
    """
    turn = np.eye(3) if rotation is None else np.asarray(rotation, dtype=float)
    shift = np.zeros(3) if translation is None else np.asarray(translation, dtype=float)
    proper = turn.shape == (3, 3) and np.allclose(turn @ turn.T, np.eye(3), atol=1e-9)
    if not (proper and np.linalg.det(turn) > 0):
        raise ModelError(
            f"mesh {mesh.name}", "is rotated by a matrix that is not a rotation.",
            "Give an orthonormal matrix with determinant 1, or use `mapped`.",
        )  # fmt: skip
    return replace(mesh, points=mesh.points @ turn.T + shift)


def mapped(mesh: Mesh, function: Callable[[Array], Array]) -> Mesh:
    """The mesh with its points moved by a function: sheared, tapered, bent.

    Parameters
    ----------
    mesh : Mesh
    function : callable
        Takes the points (n, 3) and returns the new ones, m.

    Raises
    ------
    ModelError
        The function inverts cells, or returns another shape or what is not finite.
    """
    points = np.asarray(function(np.array(mesh.points)), dtype=float)
    if points.shape != mesh.points.shape:
        raise ModelError(
            f"mesh {mesh.name}",
            f"its map returns the shape {points.shape}.",
            f"Return points of the shape {mesh.points.shape}.",
        )
    result = replace(mesh, points=points)
    check_quality(result)
    return result


def joined(*meshes: Mesh, tolerance: float | None = None, name: str = "joined") -> Mesh:
    """Several meshes as one; points that coincide are merged.

    Regions, patches, node sets and cell sets of the same name become one.

    Parameters
    ----------
    *meshes : Mesh
    tolerance : float or None
        Distance below which points are one, m; by default 1e-9 of the diagonal.
    name : str
        Name of the result.

    Raises
    ------
    ModelError
        No mesh given; a merge that would collapse a cell.
    """
    if not meshes:
        raise ModelError(f"mesh {name}", "joins nothing.", "Give at least one mesh.")
    offsets = np.cumsum([0, *(len(m.points) for m in meshes)])
    regions = tuple(dict.fromkeys(region for m in meshes for region in m.regions))
    blocks: list[CellBlock] = []
    patches: dict[str, Patch] = {}
    sets: dict[str, Ints] = {}
    cell_sets: dict[str, Ints] = {}
    first_cells = np.cumsum([0, *(m.cell_count for m in meshes)])
    for mesh, first in zip(meshes, first_cells[:-1], strict=True):
        for label, cells in mesh.cell_sets.items():
            cell_sets[label] = np.concatenate([cell_sets.get(label, cells[:0]), cells + first])
    for mesh, offset in zip(meshes, offsets[:-1], strict=True):
        index = np.array([regions.index(region) for region in mesh.regions])
        blocks += [CellBlock(b.kind, b.nodes + offset, index[b.region]) for b in mesh.blocks]
        for label, patch in mesh.patches.items():
            faces = tuple(Faces(f.kind, f.nodes + offset) for f in patch.faces)
            before = patches.get(label, Patch(()))
            patches[label] = _by_kind(Patch((*before.faces, *faces)))
        for label, nodes in mesh.node_sets.items():
            sets[label] = np.concatenate([sets.get(label, nodes[:0]), nodes + offset])
    points = np.concatenate([m.points for m in meshes])
    cell_sets = {label: _cells_by_kind(blocks)[cells] for label, cells in cell_sets.items()}
    together = Mesh(points, _blocks_by_kind(blocks), regions, sets, patches, name, cell_sets)
    return merged(together, tolerance)


def merged(mesh: Mesh, tolerance: float | None = None) -> Mesh:
    """The mesh with points that coincide merged into the first of them.

    Parameters
    ----------
    mesh : Mesh
    tolerance : float or None
        m; by default 1e-9 of the diagonal.

    Raises
    ------
    ModelError
        The merge would collapse a cell: the tolerance is not below its edges.
    """
    group = coincident_groups(mesh, tolerance)
    count = int(group.max()) + 1
    if count == len(mesh.points):
        return mesh
    first = np.full(count, len(mesh.points))
    np.minimum.at(first, group, np.arange(len(group)))
    # keep the order of the points: number the groups by their first point
    rank = np.empty(count, dtype=np.int64)
    rank[np.argsort(first)] = np.arange(count)
    result = renumbered(mesh, mesh.points[np.sort(first)], rank[group])
    for block in result.blocks:
        ordered = np.sort(block.nodes, axis=1)
        collapsed = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
        if collapsed.any():
            cell = int(np.argmax(collapsed))
            place = ", ".join(f"{v:.4g}" for v in result.points[block.nodes[cell]].mean(axis=0))
            raise ModelError(
                f"mesh {mesh.name}",
                f"merging coincident points collapses {int(collapsed.sum())} cells of type "
                f"{block.kind}, the first at ({place}) m.",
                "Use a tolerance below the shortest edge.",
            )
    return result


def coincident_groups(mesh: Mesh, tolerance: float | None = None) -> Ints:
    """The group of coincident points that each point belongs to, (n,).

    Parameters
    ----------
    mesh : Mesh
        Of n points.
    tolerance : float, optional
        Distance up to which points coincide, m; default 1e-9 of the diagonal.
    """
    reach = COINCIDENT * float(np.linalg.norm(mesh.extent)) if tolerance is None else tolerance
    if not (np.isfinite(reach) and reach >= 0):
        raise ModelError(
            f"mesh {mesh.name}", f"the tolerance is {tolerance!r} m.", "Give zero or more."
        )
    pairs = cKDTree(mesh.points).query_pairs(reach, output_type="ndarray")
    size = len(mesh.points)
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(size, size))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def renumbered(mesh: Mesh, points: Array, number: Ints) -> Mesh:
    """The mesh on other points.

    Parameters
    ----------
    mesh : Mesh
        Of n points.
    points : (k, 3)
        The new points, m.
    number : (n,) of int
        New number of each old point.
    """
    return replace(
        mesh,
        points=points,
        blocks=tuple(CellBlock(b.kind, number[b.nodes], b.region) for b in mesh.blocks),
        node_sets={name: number[nodes] for name, nodes in mesh.node_sets.items()},
        patches={
            name: Patch(tuple(Faces(f.kind, number[f.nodes]) for f in patch.faces))
            for name, patch in mesh.patches.items()
        },
    )


def _by_kind(patch: Patch) -> Patch:
    kinds = dict.fromkeys(f.kind for f in patch.faces)
    return Patch(
        tuple(
            Faces(kind, np.concatenate([f.nodes for f in patch.faces if f.kind == kind]))
            for kind in kinds
        )
    )


def _blocks_by_kind(blocks: list[CellBlock]) -> tuple[CellBlock, ...]:
    kinds = dict.fromkeys(b.kind for b in blocks)
    chosen = {kind: [b for b in blocks if b.kind == kind] for kind in kinds}
    return tuple(
        CellBlock(
            kind, np.concatenate([b.nodes for b in same]), np.concatenate([b.region for b in same])
        )
        for kind, same in chosen.items()
    )


def _cells_by_kind(blocks: list[CellBlock]) -> Ints:
    """Number that each cell has once blocks of one kind are put together."""
    kind = [list(dict.fromkeys(b.kind for b in blocks)).index(b.kind) for b in blocks]
    order = np.argsort(np.repeat(kind, [len(b.nodes) for b in blocks]), kind="stable")
    number = np.empty(len(order), dtype=np.int64)
    number[order] = np.arange(len(order))
    return number
