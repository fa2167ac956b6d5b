"""A mesh: points, blocks of cells, regions, named node sets and surface patches."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.meshes.cells import CellType, cell_type

Array = NDArray[Any]
Ints = NDArray[np.int64]
Named = TypeVar("Named")


def _fixed(values: ArrayLike, dtype: type) -> Array:
    """A view of the values that cannot be written through."""
    array: Array = np.asarray(values, dtype=dtype).view()
    array.flags.writeable = False
    return array


@dataclass(frozen=True, repr=False)
class Faces:
    """Faces of one type.

    Parameters
    ----------
    kind : str
        `quad`, `quad8`, `quad9`, `triangle` or `triangle6`.
    nodes : (f, k) int
        Nodes of each face, counter-clockwise seen from outside the solid.
    """

    kind: str
    nodes: Ints

    def __post_init__(self) -> None:
        object.__setattr__(self, "nodes", _connectivity(self.kind, self.nodes, 2))

    def __repr__(self) -> str:
        return f"Faces({len(self.nodes)} {self.kind})"

    @property
    def type(self) -> CellType:
        """The cell type of the faces."""
        return cell_type(self.kind)


@dataclass(frozen=True, repr=False)
class Patch:
    """A part of a surface: faces of one or more types.

    Parameters
    ----------
    faces : tuple of Faces
        One entry for each kind.
    """

    faces: tuple[Faces, ...]

    def __repr__(self) -> str:
        kinds = ", ".join(f"{len(f.nodes)} {f.kind}" for f in self.faces)
        return f"Patch({kinds or 'empty'}, {len(self.nodes)} nodes)"

    def __len__(self) -> int:
        return sum(len(f.nodes) for f in self.faces)

    @property
    def nodes(self) -> Ints:
        """The nodes of all faces, each once, ascending, (n,)."""
        used = [f.nodes.ravel() for f in self.faces]
        return np.unique(np.concatenate(used)) if used else np.zeros(0, dtype=np.int64)


@dataclass(frozen=True, repr=False)
class CellBlock:
    """Cells of one type.

    Parameters
    ----------
    kind : str
        `hexahedron`, `hexahedron20`, `hexahedron27`, `tetra` or `tetra10`.
    nodes : (m, k) int
        Nodes of each cell in the order of VTK.
    region : (m,) int
        Index of each cell's region in `Mesh.regions`.
    """

    kind: str
    nodes: Ints
    region: Ints

    def __post_init__(self) -> None:
        object.__setattr__(self, "nodes", _connectivity(self.kind, self.nodes, 3))
        object.__setattr__(self, "region", _fixed(self.region, np.int64))
        if self.region.shape != (len(self.nodes),):
            raise ModelError(
                f"block of {self.kind}",
                f"has {len(self.nodes)} cells but regions of shape {self.region.shape}.",
                "Give one region for each cell.",
            )

    def __repr__(self) -> str:
        return f"CellBlock({len(self.nodes)} {self.kind})"

    @property
    def type(self) -> CellType:
        """The cell type of the block."""
        return cell_type(self.kind)


@dataclass(frozen=True, repr=False)
class Mesh:
    """A solid mesh.

    Parameters
    ----------
    points : (n, 3)
        m.
    blocks : tuple of CellBlock
    regions : tuple of str
        Names of the regions, by the index in `CellBlock.region`.
    node_sets : mapping of str to (k,) int
        Named sets of nodes.
    patches : mapping of str to Patch
        Named parts of surfaces.
    name : str
        For messages.
    cell_sets : mapping of str to (k,) int
        Named sets of cells that may overlap, by the index of the cell, blocks one after
        another: groups of a file that are more, or less, than a region.

    Raises
    ------
    ModelError
        Points that are not finite, a node, a cell or a region that does not exist, two regions
        of one name.
    """

    points: Array
    blocks: tuple[CellBlock, ...]
    regions: tuple[str, ...] = ("solid",)
    node_sets: Mapping[str, Ints] = field(default_factory=dict)
    patches: Mapping[str, Patch] = field(default_factory=dict)
    name: str = "mesh"
    cell_sets: Mapping[str, Ints] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _fixed(self.points, float))
        object.__setattr__(self, "blocks", tuple(self.blocks))
        object.__setattr__(self, "regions", tuple(self.regions))
        for field_ in ("node_sets", "cell_sets"):
            sets = {k: _fixed(np.unique(v), np.int64) for k, v in getattr(self, field_).items()}
            object.__setattr__(self, field_, MappingProxyType(sets))
        object.__setattr__(self, "patches", MappingProxyType(dict(self.patches)))
        self._check()

    def __repr__(self) -> str:
        cells = ", ".join(f"{len(b.nodes)} {b.kind}" for b in self.blocks)
        named = [f"{len(self.regions)} regions"]
        named += [f"{len(self.patches)} patches"] if self.patches else []
        named += [f"{len(self.node_sets)} node sets"] if self.node_sets else []
        named += [f"{len(self.cell_sets)} cell sets"] if self.cell_sets else []
        size = " × ".join(f"{s:.4g}" for s in self.extent)
        return (
            f"Mesh({self.name}: {len(self.points)} points, {cells}, {', '.join(named)}, {size} m)"
        )

    @property
    def cell_count(self) -> int:
        """Number of cells."""
        return sum(len(b.nodes) for b in self.blocks)

    @property
    def bounds(self) -> Array:
        """Lowest and highest coordinates of the points, m, (2, 3)."""
        return np.array([self.points.min(axis=0), self.points.max(axis=0)])

    @property
    def extent(self) -> Array:
        """Sizes of the bounding box, m, (3,)."""
        low, high = self.bounds
        return np.asarray(high - low)

    def patch(self, name: str) -> Patch:
        """The patch of that name; ModelError lists those there are.

        Parameters
        ----------
        name : str
            One of `patches`.
        """
        return self._named(self.patches, "patch", name)

    def node_set(self, name: str) -> Ints:
        """The nodes (k,) of the set of that name; ModelError lists those there are.

        Parameters
        ----------
        name : str
            One of `node_sets`.
        """
        return self._named(self.node_sets, "node set", name)

    @property
    def cell_regions(self) -> Ints:
        """Index of each cell's region, blocks one after another, (cells,)."""
        return np.concatenate([b.region for b in self.blocks])

    def region_cells(self, name: str) -> Ints:
        """The cells of a cell set, or of a region where no set has the name, ascending, (k,).

        A file's group that lies partly in others is a region of the cells it has alone, and a
        cell set of all of them: here it is all.

        Parameters
        ----------
        name : str
            One of `cell_sets` or `regions`.
        """
        if name in self.cell_sets:
            return self.cell_sets[name]
        self._named(dict.fromkeys((*self.regions, *self.cell_sets)), "region", name)
        return np.flatnonzero(self.cell_regions == self.regions.index(name))

    def region_nodes(self, name: str) -> Ints:
        """The nodes of the cells of a region or of a cell set, ascending, (k,).

        Parameters
        ----------
        name : str
            One of `cell_sets` or `regions`.
        """
        chosen = np.zeros(self.cell_count, dtype=bool)
        chosen[self.region_cells(name)] = True
        ends = np.cumsum([len(b.nodes) for b in self.blocks])[:-1]
        split = np.split(chosen, ends)
        used = [b.nodes[own].ravel() for b, own in zip(self.blocks, split, strict=True)]
        return np.unique(np.concatenate(used))

    def holders(self, region: str) -> tuple[str, ...]:
        """The region and the cell sets that hold all of it, the smallest first.

        Parameters
        ----------
        region : str
            One of `regions`.
        """
        self._named(dict.fromkeys(self.regions), "region", region)
        own = np.flatnonzero(self.cell_regions == self.regions.index(region))
        sets = sorted(self.cell_sets, key=lambda name: len(self.cell_sets[name]))
        held = (n for n in sets if n != region and np.isin(own, self.cell_sets[n]).all())
        return (region, *held)

    def _named(self, things: Mapping[str, Named], what: str, name: str) -> Named:
        if name not in things:
            known = ", ".join(repr(k) for k in things) or "none"
            raise ModelError(f"mesh {self.name}", f"has no {what} {name!r}.", f"It has: {known}.")
        return things[name]

    def _check(self) -> None:
        part = f"mesh {self.name}"
        if self.points.ndim != 2 or self.points.shape[1] != 3 or not len(self.points):
            raise ModelError(
                part, f"has points of shape {self.points.shape}.", "Give an array (n, 3)."
            )
        finite = np.isfinite(self.points).all(axis=1)
        if not finite.all():
            raise ModelError(
                part,
                f"point {int(np.argmin(finite))} is not finite "
                f"({int((~finite).sum())} such points).",
                "Check the coordinates.",
            )
        if not self.cell_count:
            raise ModelError(part, "has no solid cells.", "Give hexahedra or tetrahedra.")
        if len(set(self.regions)) < len(self.regions):
            raise ModelError(part, "has two regions of one name.", "Rename one of them.")
        for block in self.blocks:
            _in_range(f"{part}, {block.kind}", "node", [block.nodes], len(self.points))
            _in_range(f"{part}, {block.kind}", "region", [block.region], len(self.regions))
        for name, nodes in self.node_sets.items():
            _in_range(f"{part}, node set {name!r}", "node", [nodes], len(self.points))
        for name, cells in self.cell_sets.items():
            _in_range(f"{part}, cell set {name!r}", "cell", [cells], self.cell_count)
        for name, patch in self.patches.items():
            faces = [f.nodes for f in patch.faces]
            _in_range(f"{part}, patch {name!r}", "node", faces, len(self.points))


def _connectivity(kind: str, nodes: ArrayLike, dimension: int) -> Array:
    """The nodes as integers, of the shape that the kind asks for."""
    type_ = cell_type(kind)
    array = _fixed(nodes, np.int64)
    if type_.dimension != dimension:
        what = "a face" if dimension == 2 else "a solid cell"
        raise ModelError(f"block of {kind}", f"{kind} is not {what}.", "Choose another kind.")
    if array.ndim != 2 or array.shape[1] != type_.size:
        raise ModelError(
            f"block of {kind}",
            f"has nodes of shape {array.shape}.",
            f"Give {type_.size} nodes for each cell.",
        )
    return array


def _in_range(part: str, what: str, values: Iterable[Array], count: int) -> None:
    for array in values:
        if array.size and (array.min() < 0 or array.max() >= count):
            wrong = int(array.min()) if array.min() < 0 else int(array.max())
            raise ModelError(
                part, f"refers to {what} {wrong}; there are {count}.", f"Number {what}s from 0."
            )
