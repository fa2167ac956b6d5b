"""Quality of the cells: scaled Jacobian, aspect ratio, volume; inverted cells are an error."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.mesh import CellBlock, Mesh

Array = NDArray[Any]
#: Below this a cell is as good as flat, whatever its sign.
FLAT = 1e-10
#: Cells worked on at a time: some 100 MB.
CHUNK = 10_000


@dataclass(frozen=True, repr=False)
class Quality:
    """Quality of each cell of a mesh, blocks one after another.

    Parameters
    ----------
    scaled_jacobian : (m,)
        Least over the nodes of a cell: det J over the product of the lengths of its columns,
        for tetrahedra over the largest such product of a corner, times √2 (Knupp 2000,
        Verdict). 1 is a brick or a regular tetrahedron, 0 flat, negative inverted. Of a
        quadratic cell that is inverted at a point of integration, det J there over the largest
        of those products.
    aspect_ratio : (m,)
        Ratio of the longest to the shortest edge of a hexahedron; of a tetrahedron its longest edge
        over 2√6 times the radius of the inscribed sphere. 1 is best; infinite when flat.
    volume : (m,)
        m³; negative where a cell is inside out.
    centres : (m, 3)
        Mean of the corners, m.
    """

    scaled_jacobian: Array
    aspect_ratio: Array
    volume: Array
    centres: Array

    def __repr__(self) -> str:
        return (
            f"Quality({len(self.volume)} cells: scaled Jacobian at least "
            f"{self.scaled_jacobian.min():.3g} at {_place(self.centres[self.worst])}, "
            f"aspect ratio at most {self.aspect_ratio.max():.3g}, "
            f"{len(self.inverted)} inverted, {self.volume.sum():.6g} m³)"
        )

    @property
    def worst(self) -> int:
        """Index of the cell with the least scaled Jacobian."""
        return int(np.argmin(self.scaled_jacobian))

    @property
    def inverted(self) -> NDArray[np.int64]:
        """Cells that are inverted or flat somewhere, (k,)."""
        return np.flatnonzero(~(self.scaled_jacobian > FLAT))

    def below(self, limit: float) -> NDArray[np.int64]:
        """Cells whose scaled Jacobian is below `limit`, (k,).

        Parameters
        ----------
        limit : float
            Of the scaled Jacobian, at most 1, no unit.
        """
        return np.flatnonzero(self.scaled_jacobian < limit)

    def to_dict(self) -> dict[str, Any]:
        """Counts and extremes, for reports."""
        return {
            "cells": len(self.volume),
            "inverted_cells": len(self.inverted),
            "scaled_jacobian_min": float(self.scaled_jacobian.min()),
            "scaled_jacobian_mean": float(self.scaled_jacobian.mean()),
            "worst_cell": self.worst,
            "worst_cell_centre_m": self.centres[self.worst].tolist(),
            "aspect_ratio_max": float(self.aspect_ratio.max()),
            "volume_m3": float(self.volume.sum()),
        }


def quality(mesh: Mesh) -> Quality:
    """The quality of every cell.

    Parameters
    ----------
    mesh : Mesh
        Of m cells of any kind.
    """
    parts = [
        _block_quality(mesh.points, CellBlock(b.kind, b.nodes[part], b.region[part]))
        for b in mesh.blocks
        for part in (slice(i, i + CHUNK) for i in range(0, len(b.nodes), CHUNK))
    ]
    return Quality(*(np.concatenate(values) for values in zip(*parts, strict=True)))


def check_quality(mesh: Mesh, least: float = FLAT) -> Quality:
    """The quality of a mesh that can be analysed.

    Parameters
    ----------
    mesh : Mesh
    least : float
        Least scaled Jacobian to accept, no unit.

    Raises
    ------
    ModelError
        Cells below `least`, with their count and the place of the worst.
    """
    found = quality(mesh)
    bad = np.flatnonzero(~(found.scaled_jacobian > least))
    if len(bad):
        inverted = least <= FLAT
        bent = any(b.type.order > 1 for b in mesh.blocks)
        raise ModelError(
            f"mesh {mesh.name}",
            f"{len(bad)} of {len(found.volume)} cells are "
            + ("inverted or flat" if inverted else f"below a scaled Jacobian of {least:g}")
            + f"; the worst is cell {found.worst} at {_place(found.centres[found.worst])} "
            f"with a scaled Jacobian of {found.scaled_jacobian[found.worst]:.3g}.",
            "Check the order of the nodes of these cells"
            + (", put middle nodes nearer to the middle of their edges" if bent else "")
            + ", or remesh that region.",
        )
    return found


def cell_volumes(mesh: Mesh) -> Array:
    """Volume of each cell, blocks one after another, m³, (m,); negative when inside out.

    Parameters
    ----------
    mesh : Mesh
        Of m cells of any kind.
    """
    return np.concatenate([_volumes(mesh.points, block) for block in mesh.blocks])


def _volumes(points: Array, block: CellBlock) -> Array:
    at, weights = block.type.quadrature(block.type.jacobian_degree)
    return np.asarray(np.linalg.det(_jacobians(points, block, at)) @ weights)


def _jacobians(points: Array, block: CellBlock, at: Array) -> Array:
    """Derivatives of the place, one row for each reference coordinate, (m, q, 3, 3)."""
    # centred first: coordinates far from the origin would cost digits
    places = points[block.nodes]
    places = places - places.mean(axis=1, keepdims=True)
    return np.asarray(np.einsum("qnd,mnc->mqdc", block.type.gradient(at), places))


def _block_quality(points: Array, block: CellBlock) -> tuple[Array, Array, Array, Array]:
    type_ = block.type
    jacobians = _jacobians(points, block, type_.reference)
    determinants = np.linalg.det(jacobians)
    places = points[block.nodes[:, : type_.corners]]
    edges = np.array(type_.corner_edges)
    lengths = np.linalg.norm(places[:, edges[:, 1]] - places[:, edges[:, 0]], axis=-1)
    volumes = _volumes(points, block)
    if type_.is_simplex:
        scale = _corner_products(jacobians) / sqrt(2.0)
        faces = places[:, np.array(type_.corner_faces)]
        normals = np.cross(faces[:, :, 1] - faces[:, :, 0], faces[:, :, 2] - faces[:, :, 0])
        surface = np.linalg.norm(normals, axis=-1).sum(axis=1) / 2.0
        longest, shortest = lengths.max(axis=1) * surface, 6.0 * sqrt(6.0) * np.abs(volumes)
    else:
        scale = np.linalg.norm(jacobians, axis=-1).prod(axis=-1)
        longest, shortest = lengths.max(axis=1), lengths.min(axis=1)
    scaled = np.divide(determinants, scale, out=np.zeros_like(scale), where=scale > 0)
    least = scaled.min(axis=1)
    if type_.order > 1:
        # a bent cell can be inside out where it has no node
        between = _between_nodes(points, block)
        largest = scale.max(axis=1)
        share = np.divide(between, largest, out=np.zeros_like(between), where=largest > 0)
        least = np.where(share > FLAT, least, np.minimum(least, share))
    aspect = np.divide(longest, shortest, out=np.full_like(longest, np.inf), where=shortest > 0)
    return least, aspect, volumes, places.mean(axis=1)


def _between_nodes(points: Array, block: CellBlock) -> Array:
    """Least det J of each cell over the Gauss points of stiffness and mass, (m,)."""
    degrees = (block.type.field_degree, block.type.mass_degree)
    at = np.concatenate([block.type.quadrature(degree)[0] for degree in degrees])
    return np.asarray(np.linalg.det(_jacobians(points, block, at)).min(axis=1))


def _corner_products(jacobians: Array) -> Array:
    """Largest product of the three edges at a corner of the tetrahedron that J spans."""
    a, b, c = (jacobians[..., i, :] for i in range(3))
    oa, ob, oc, ab, bc, ca = (np.linalg.norm(v, axis=-1) for v in (a, b, c, b - a, c - b, a - c))
    return np.asarray(np.max([oa * ob * oc, oa * ab * ca, ob * ab * bc, oc * bc * ca], axis=0))


def _place(centre: Array) -> str:
    return f"({', '.join(f'{v:.4g}' for v in centre)}) m"
