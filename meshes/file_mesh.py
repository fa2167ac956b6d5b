"""What a mesh file holds, before it becomes a mesh: cells in their order, sets that overlap."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.mesh import CellBlock, Faces, Mesh, Patch
from strutwork.meshes.order import without_orphans
from strutwork.meshes.regions import partition
from strutwork.meshes.rows import row_groups

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Nodes of some cells of one kind.
Block = tuple[str, Ints]
#: Coordinates beyond this are no machine's, m.
FARTHEST = 1e9
#: Solids that other programs write and that cannot be analysed here.
UNUSABLE = {
    "wedge": "a wedge (pentahedron)",
    "pyramid": "a pyramid",
    "voxel": "a voxel, whose nodes are in another order than a hexahedron's",
    "polyhedron": "a polyhedron",
}


@dataclass(frozen=True)
class FileMesh:
    """What a file holds.

    Parameters
    ----------
    points : (n, 3)
        In the unit of the file.
    solids : sequence of (kind, (m, k) int)
        Blocks of solid cells, in the file's order.
    cell_sets : mapping of str to (k,) int
        Named sets of cells, by their index over all blocks; they may overlap.
    sections : mapping of str to (k,) int
        Those that say the material: sections and properties. They decide before the others.
    helpers : mapping of str to (k,) int
        Sets that serve something else, as the cells of a surface. They decide last.
    faces : mapping of str to sequence of (kind, (f, k) int)
        Named faces.
    node_sets : mapping of str to (k,) int
    """

    points: Array
    solids: Sequence[Block]
    cell_sets: Mapping[str, Ints] = field(default_factory=dict)
    sections: Mapping[str, Ints] = field(default_factory=dict)
    helpers: Mapping[str, Ints] = field(default_factory=dict)
    faces: Mapping[str, Sequence[Block]] = field(default_factory=dict)
    node_sets: Mapping[str, Ints] = field(default_factory=dict)

    def to_mesh(self, name: str, scale: float = 1.0) -> Mesh:
        """The mesh: regions from the sets, faces turned outwards, points of no cell dropped.

        Parameters
        ----------
        name : str
        scale : float
            Of a unit of the file, m.

        Raises
        ------
        ModelError
            No solid cells; coordinates out of all proportion.
        """
        solids = [(kind, nodes) for kind, nodes in self.solids if len(nodes)]
        if not solids:
            raise ModelError(
                f"mesh {name}",
                "holds no solid cells.",
                "Export hexahedra or tetrahedra; a closed surface is meshed by "
                "`strutwork.meshes.gmsh_volumes.tetrahedra`.",
            )
        blocks, number = _by_kind(solids)
        count = len(number)
        names, label = partition(count, self.sections, self.cell_sets, self.helpers)
        region = np.empty(count, dtype=np.int64)
        region[number] = label
        ends = np.cumsum([len(nodes) for _, nodes in blocks])[:-1]
        made = tuple(
            CellBlock(kind, nodes, own)
            for (kind, nodes), own in zip(blocks, np.split(region, ends), strict=True)
        )
        patches = {name: _patch(same) for name, same in self.faces.items()}
        sets = {
            n: np.unique(cells)
            for n, cells in {**self.sections, **self.helpers, **self.cell_sets}.items()
        }
        kept = {
            n: number[cells]
            for n, cells in sets.items()
            if len(cells)
            and not (n in names and np.array_equal(cells, np.flatnonzero(label == names.index(n))))
        }
        points = np.asarray(self.points, dtype=float) * scale
        mesh = Mesh(points, made, names, self.node_sets, patches, name, kept)
        used = without_orphans(_outwards(mesh))
        farthest = float(np.abs(used.points).max())
        if farthest > FARTHEST:
            raise ModelError(
                f"mesh {name}",
                f"has a point at {farthest:.4g} m.",
                "Check the coordinates, and the unit.",
            )
        return used


def unusable(kind: str) -> str:
    """What a solid that cannot be analysed is, in words: `a wedge (pentahedron)`.

    Parameters
    ----------
    kind : str
        meshio's name of the cell type.
    """
    found = [words for key, words in UNUSABLE.items() if kind.startswith(key)]
    return found[0] if found else f"a cell of type {kind!r}"


def remedy_for(kind: str) -> str:
    """What to do about a solid that cannot be analysed.

    Parameters
    ----------
    kind : str
        meshio's name of the cell type.
    """
    if kind == "voxel":
        return "Export hexahedra, VTK's type 12."
    return "Mesh with hexahedra or tetrahedra only."


def by_tag(tags: Ints, names: Mapping[int, str], what: str, first: int = 0) -> dict[str, Ints]:
    """Cells (k,) by the number that each carries: named, or `region 4`; those of number 0 in none.

    Parameters
    ----------
    tags : (m,) int
    names : mapping of int to str
    what : str
        Word before a number without a name.
    first : int
        Index of the first cell.
    """
    return {
        names.get(tag, f"{what} {tag}"): first + np.flatnonzero(tags == tag)
        for tag in np.unique(tags).tolist()
        if tag or tag in names
    }


def _by_kind(solids: Sequence[Block]) -> tuple[list[Block], Ints]:
    """One block for each kind, and the new number of each cell."""
    kinds = list(dict.fromkeys(kind for kind, _ in solids))
    of_cell = np.repeat([kinds.index(kind) for kind, _ in solids], [len(n) for _, n in solids])
    number = np.empty(len(of_cell), dtype=np.int64)
    number[np.argsort(of_cell, kind="stable")] = np.arange(len(of_cell))
    return [(k, np.concatenate([n for kind, n in solids if kind == k])) for k in kinds], number


def _patch(faces: Sequence[Block]) -> Patch:
    kinds = dict.fromkeys(kind for kind, _ in faces)
    return Patch(
        tuple(Faces(k, np.concatenate([n for kind, n in faces if kind == k])) for k in kinds)
    )


def _outwards(mesh: Mesh) -> Mesh:
    """The mesh with the faces of patches turned as their cells have them.

    Faces on nodes that no cell has are left out: they are no surface of the solid. A face
    between two cells stays as it is.
    """
    if not mesh.patches:
        return mesh
    used = np.zeros(len(mesh.points), dtype=bool)
    sides: dict[int, list[Ints]] = {}
    for block in mesh.blocks:
        used[block.nodes] = True
        corners = np.array(block.type.corner_faces)
        sides.setdefault(corners.shape[1], []).append(
            block.nodes[:, corners].reshape(-1, corners.shape[1])
        )
    ordered = {width: np.concatenate(rows) for width, rows in sides.items()}
    patches = {}
    for name, patch in mesh.patches.items():
        kept = [Faces(f.kind, f.nodes[used[f.nodes].all(axis=1)]) for f in patch.faces]
        turned = [_turned(f, ordered.get(f.type.corners)) for f in kept if len(f.nodes)]
        if turned or not len(patch):
            patches[name] = Patch(tuple(turned))
    return replace(mesh, patches=patches)


def _turned(faces: Faces, sides: Ints | None) -> Faces:
    if sides is None:
        return faces
    corners = faces.nodes[:, : faces.type.corners]
    near = np.isin(sides, corners).all(axis=1)
    sides = sides[near]
    both = np.concatenate([sides, corners])
    # faces with the same corners, and among them those that run the same way round
    same, alike = row_groups(both)[1], row_groups(both, cyclic=True)[1]
    owned, seen = same[: len(sides)], alike[: len(sides)]
    number = np.bincount(owned, minlength=int(same.max()) + 1)[same[len(sides) :]]
    agrees = np.isin(alike[len(sides) :], seen)
    wrong = (number == 1) & ~agrees
    if not wrong.any():
        return faces
    nodes = np.array(faces.nodes)
    nodes[wrong] = nodes[wrong][:, _mirrored(faces.kind)]
    return Faces(faces.kind, nodes)


def _mirrored(kind: str) -> list[int]:
    """Local nodes of a face of that kind seen from the other side."""
    type_ = CELL_TYPES[kind]
    count = type_.corners
    turned = [0, *range(count - 1, 0, -1)]
    index = {frozenset(p): i for i, p in enumerate(type_.parents)}
    return [index[frozenset(turned[c] for c in p)] for p in type_.parents]
