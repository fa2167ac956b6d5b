"""Meshes and materials for tests of solids: distorted hexahedra, tetrahedra cut from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations

import numpy as np

from strutwork.fea.solid import Solid
from strutwork.fea.solid_matrices import SolidMatrices, solid_matrices
from strutwork.meshes.block import block
from strutwork.meshes.boundary import boundary
from strutwork.meshes.mesh import CellBlock, Faces, Mesh, Patch
from strutwork.meshes.order import quadratic
from strutwork.msa.materials import Material

STEEL = Material.isotropic(200e9, 0.3, 8000.0, name="steel")
GRANITE = Material.isotropic(78e9, 0.25, 3000.0, name="granite")
#: Kinds of cell with orders of the field.
FIELDS = [("hexahedron", 1), ("hexahedron", 2), ("tetra", 1), ("tetra", 2)]
#: Cells that may be curved.
CURVED = ["tetra10", "hexahedron20", "hexahedron27"]


def in_tetrahedra(mesh: Mesh) -> Mesh:
    """Each hexahedron of a structured mesh cut into six tetrahedra along one diagonal (Kuhn)."""
    corner = {(0, 0, 0): 0, (1, 0, 0): 1, (1, 1, 0): 2, (0, 1, 0): 3,
              (0, 0, 1): 4, (1, 0, 1): 5, (1, 1, 1): 6, (0, 1, 1): 7}  # fmt: skip
    cut = []
    for axes in permutations(range(3)):
        place, path = [0, 0, 0], [0]
        for axis in axes:
            place[axis] = 1
            path.append(corner[place[0], place[1], place[2]])
        even = np.linalg.det(np.eye(3)[list(axes)]) > 0
        cut.append(path if even else [path[0], path[2], path[1], path[3]])
    cells = mesh.blocks[0].nodes[:, np.array(cut)].reshape(-1, 4)
    region = np.repeat(mesh.blocks[0].region, 6)
    whole = replace(mesh, blocks=(CellBlock("tetra", cells, region),), patches={})
    outer = boundary(whole).faces[0].nodes
    patches = {}
    for name, patch in mesh.patches.items():
        inside = np.isin(outer, patch.nodes).all(axis=1)
        patches[name] = Patch((Faces("triangle", outer[inside]),))
    return replace(whole, patches=patches)


def cells_of(kind: str, size: Sequence[float], divisions: Sequence[int]) -> Mesh:
    """A block of hexahedra or tetrahedra."""
    mesh = block(size, divisions)
    return mesh if kind == "hexahedron" else in_tetrahedra(mesh)


def distorted(mesh: Mesh, share: float = 0.15, seed: int = 1) -> Mesh:
    """The mesh with its inner nodes displaced at random by a share of the cells' size."""
    inner = np.ones(len(mesh.points), dtype=bool)
    inner[boundary(mesh).nodes] = False
    size = np.cbrt(np.prod(mesh.extent) / mesh.cell_count)
    if mesh.blocks[0].kind == "tetra":
        size *= np.cbrt(6.0)
    shift = share * size * np.random.default_rng(seed).uniform(-1, 1, mesh.points.shape)
    return replace(mesh, points=mesh.points + np.where(inner[:, None], shift, 0.0))


def matrices_of(mesh: Mesh, order: int = 2, material: Material = STEEL) -> SolidMatrices:
    """Matrices of a solid of one material."""
    return solid_matrices(Solid(mesh, dict.fromkeys(mesh.regions, material), order))


def in_two_regions(mesh: Mesh, names: tuple[str, str] = ("left", "right")) -> Mesh:
    """The mesh with its cells divided in the middle along x."""
    cells = mesh.blocks[0]
    centre = mesh.points[cells.nodes].mean(axis=1)[:, 0]
    region = (centre > mesh.bounds[:, 0].mean()).astype(np.int64)
    return replace(mesh, blocks=(CellBlock(cells.kind, cells.nodes, region),), regions=names)


def bent(mesh: Mesh, kind: str = "", share: float = 0.08, seed: int = 1) -> Mesh:
    """Quadratic cells whose middle nodes stand off the middle, by a share of the cells' size.

    `kind` is `tetra10`, `hexahedron20` or `hexahedron27`; by default as many nodes as there are.
    """
    made = quadratic(mesh, serendipity=kind == "hexahedron20")
    size = np.cbrt(np.prod(mesh.extent) / mesh.cell_count)
    if mesh.blocks[0].kind == "tetra":
        size *= np.cbrt(6.0)
    shift = share * size * np.random.default_rng(seed).uniform(-1, 1, made.points.shape)
    shift[: len(mesh.points)] = 0.0
    return replace(made, points=made.points + shift)
