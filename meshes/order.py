"""Linear and quadratic cells of the same mesh, and uniform refinement."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.cells import CELL_TYPES, CellType
from strutwork.meshes.mesh import CellBlock, Faces, Mesh, Patch
from strutwork.meshes.rows import row_groups
from strutwork.meshes.transform import renumbered

Array = NDArray[Any]
Ints = NDArray[np.int64]
FULL = {
    "hexahedron": "hexahedron27", "quad": "quad9", "tetra": "tetra10", "triangle": "triangle6"
}  # fmt: skip
SERENDIPITY = {**FULL, "hexahedron": "hexahedron20", "quad": "quad8"}


def quadratic(mesh: Mesh, *, serendipity: bool = False) -> Mesh:
    """The mesh with quadratic cells; new nodes are at the midpoints of their corners.

    A new node joins a node set when all its corners are in it.

    Parameters
    ----------
    mesh : Mesh
        Of linear cells.
    serendipity : bool
        Twenty-node hexahedra, without nodes in the middle of faces and cells, in place of
        those with 27.

    Raises
    ------
    ModelError
        The mesh has quadratic cells.
    """
    _require_linear(mesh)
    kinds = SERENDIPITY if serendipity else FULL
    owners: list[CellBlock | Faces] = [*mesh.blocks]
    owners += [f for patch in mesh.patches.values() for f in patch.faces]
    targets = [CELL_TYPES[kinds[owner.kind]] for owner in owners]
    nodes = [
        np.zeros((len(o.nodes), t.size), np.int64) for o, t in zip(owners, targets, strict=True)
    ]
    sets = {name: [found] for name, found in mesh.node_sets.items()}
    points = [mesh.points]
    for own, owner, target in zip(nodes, owners, targets, strict=True):
        own[:, : target.corners] = owner.nodes
    total = len(mesh.points)
    for width in sorted({len(p) for t in targets for p in t.parents[t.corners :]}):
        rows, places = [], []
        for i, (owner, target) in enumerate(zip(owners, targets, strict=True)):
            columns = [c for c, p in enumerate(target.parents) if len(p) == width]
            for column in columns:
                rows.append(owner.nodes[:, list(target.parents[column])])
                places.append((i, column))
        first, group = row_groups(np.concatenate(rows))
        parents = np.concatenate(rows)[first]
        ends = np.cumsum([len(r) for r in rows])[:-1]
        for (i, column), numbers in zip(places, np.split(group, ends), strict=True):
            nodes[i][:, column] = total + numbers
        points.append(mesh.points[parents].mean(axis=1))
        for name, found in mesh.node_sets.items():
            sets[name].append(total + np.flatnonzero(np.isin(parents, found).all(axis=1)))
        total += len(parents)
    return _rebuilt(mesh, np.concatenate(points), [t.name for t in targets], nodes, sets)


def linear(mesh: Mesh) -> Mesh:
    """The mesh with only its corner nodes; curved edges become straight.

    Parameters
    ----------
    mesh : Mesh
        Of cells of any kind.
    """
    corners = {k: t.corners for k, t in CELL_TYPES.items()}
    lowered = replace(
        mesh,
        blocks=tuple(
            CellBlock(b.type.linear_kind, b.nodes[:, : corners[b.kind]], b.region)
            for b in mesh.blocks
        ),
        patches={
            name: Patch(
                tuple(Faces(f.type.linear_kind, f.nodes[:, : corners[f.kind]]) for f in p.faces)
            )
            for name, p in mesh.patches.items()
        },
    )
    return without_orphans(lowered)


def without_orphans(mesh: Mesh) -> Mesh:
    """The mesh without points that no cell uses, also in its node sets.

    Parameters
    ----------
    mesh : Mesh
        Of cells of any kind.
    """
    used = np.zeros(len(mesh.points), dtype=bool)
    for block in mesh.blocks:
        used[block.nodes] = True
    for patch in mesh.patches.values():
        used[patch.nodes] = True
    if used.all():
        return mesh
    sets = {name: nodes[used[nodes]] for name, nodes in mesh.node_sets.items()}
    number = np.cumsum(used) - 1
    return renumbered(replace(mesh, node_sets=sets), mesh.points[used], number)


def refined(mesh: Mesh) -> Mesh:
    """The mesh with every edge halved: eight cells for one, four faces for one.

    Parameters
    ----------
    mesh : Mesh
        Of linear cells.

    Raises
    ------
    ModelError
        The mesh has quadratic cells.
    """
    fine = quadratic(mesh)
    owners: list[CellBlock | Faces] = [*fine.blocks]
    owners += [f for patch in fine.patches.values() for f in patch.faces]
    kinds = [owner.type.linear_kind for owner in owners]
    nodes = [
        owner.nodes[:, _children(owner.kind)].reshape(-1, CELL_TYPES[kind].size)
        for owner, kind in zip(owners, kinds, strict=True)
    ]
    sets = {name: [found] for name, found in fine.node_sets.items()}
    made = _rebuilt(replace(mesh, cell_sets={}), fine.points, kinds, nodes, sets)
    # every cell, of any kind, has eight children
    children = {k: (8 * c[:, None] + np.arange(8)).ravel() for k, c in mesh.cell_sets.items()}
    return replace(made, cell_sets=children)


def _rebuilt(
    mesh: Mesh, points: Array, kinds: list[str], nodes: list[Ints], sets: dict[str, list[Ints]]
) -> Mesh:
    """The mesh with other cells and faces, given blocks first, then patches."""
    made = iter(zip(kinds, nodes, strict=True))
    blocks = []
    for block in mesh.blocks:
        kind, cells = next(made)
        times = len(cells) // max(len(block.nodes), 1)
        blocks.append(CellBlock(kind, cells, np.repeat(block.region, times)))
    patches = {
        name: Patch(tuple(Faces(*next(made)) for _ in patch.faces))
        for name, patch in mesh.patches.items()
    }
    joined_sets = {name: np.concatenate(found) for name, found in sets.items()}
    return replace(
        mesh, points=points, blocks=tuple(blocks), node_sets=joined_sets, patches=patches
    )


@cache
def _children(kind: str) -> Ints:
    """Nodes of the cells that halving the edges of a quadratic cell makes, (children, k)."""
    type_ = CELL_TYPES[kind]
    if type_.is_simplex:
        return _simplex_children(type_)
    corners = np.array(type_.reference_corners)
    wanted = np.array(
        [(corners + octant) / 2.0 for octant in product((0, 1), repeat=type_.dimension)]
    )
    same = (wanted[:, :, None, :] == type_.reference).all(axis=-1)
    return np.asarray(same.argmax(axis=-1))


def _simplex_children(type_: CellType) -> Ints:
    """One child at each corner, and those in the middle.

    The octahedron in the middle of a tetrahedron is cut along the line between the edges
    0-1 and 2-3.
    """
    middle = {frozenset(p): i for i, p in enumerate(type_.parents)}
    count = type_.corners
    children = [[middle[frozenset((c, d))] for d in range(count)] for c in range(count)]
    if type_.dimension == 2:
        return np.array([*children, [middle[frozenset(p)] for p in ((0, 1), (1, 2), (2, 0))]])
    ring = [middle[frozenset(p)] for p in ((1, 2), (0, 2), (0, 3), (1, 3))]
    ends = [middle[frozenset(p)] for p in ((0, 1), (2, 3))]
    children += [[*ends, ring[i], ring[(i + 1) % 4]] for i in range(4)]
    found = np.array(children)
    edges = type_.reference[found[:, 1:]] - type_.reference[found[:, :1]]
    inside_out = np.linalg.det(edges) < 0
    found[inside_out] = found[inside_out][:, [0, 1, 3, 2]]
    return found


def _require_linear(mesh: Mesh) -> None:
    high = [b.kind for b in mesh.blocks if b.kind != b.type.linear_kind]
    if high:
        raise ModelError(
            f"mesh {mesh.name}",
            f"has cells of type {high[0]}, which are quadratic already.",
            "Refine and raise the order of linear cells; `linear` drops the middle nodes.",
        )
