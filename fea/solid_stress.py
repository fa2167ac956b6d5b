"""Strains and stresses of a solid, at the centres of its cells and at its nodes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.elasticity import elasticity
from strutwork.fea.solid_matrices import SolidMatrices
from strutwork.meshes.cells import CellType

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Order of the six components; shear strains are engineering strains γ = 2 ε.
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
#: Cells worked on at a time.
CHUNK = 4096


@dataclass(frozen=True, repr=False)
class NodalStress:
    """Stress at the nodes of each region; a node where regions meet has one in each.

    Parameters
    ----------
    regions : mapping of str to (nodes, stress)
        Nodes (k,), ascending, and stresses (..., k, 6), Pa, components xx, yy, zz, xy, xz, yz.
    node_count : int
        Nodes of the field.
    """

    regions: Mapping[str, tuple[Ints, Array]]
    node_count: int

    def __repr__(self) -> str:
        most = max(float(von_mises(s).max(initial=0.0)) for _, s in self.regions.values())
        return f"NodalStress({self.node_count} nodes, von Mises up to {most:.4g} Pa)"

    def at_nodes(self) -> Array:
        """One stress for each node, Pa, (..., n, 6).

        Where regions meet, that of the region with the larger von Mises stress.
        """
        batch = next(iter(self.regions.values()))[1].shape[:-2]
        result = np.zeros((*batch, self.node_count, 6))
        for nodes, stress in self.regions.values():
            there = result[..., nodes, :]
            larger = von_mises(stress) > von_mises(there)
            result[..., nodes, :] = np.where(larger[..., None], stress, there)
        return result


def cell_strains(matrices: SolidMatrices, displacements: Array) -> Array:
    """Strain at the centre of each cell.

    Parameters
    ----------
    matrices : SolidMatrices
    displacements : (3n,) or (3n, m)
        m.

    Returns
    -------
    (cells, 6) or (m, cells, 6)
        Components xx, yy, zz, xy, xz, yz, shear as γ.

    Raises
    ------
    ModelError
        Displacements of the wrong shape or not finite.
    """
    type_ = matrices.mesh.blocks[0].type
    centre = type_.reference[: type_.corners].mean(axis=0, keepdims=True)
    found = _strains(matrices, _checked(matrices, displacements), centre, np.eye(1))[:, :, 0]
    return np.asarray(found[0] if np.ndim(displacements) == 1 else found)


def cell_stresses(matrices: SolidMatrices, displacements: Array) -> Array:
    """Stress at the centre of each cell, Pa, in the shape of the strains of `cell_strains`.

    Parameters
    ----------
    matrices : SolidMatrices
    displacements : (3n,) or (3n, m)
        m.
    """
    strains = cell_strains(matrices, displacements)
    return np.asarray(np.einsum("cij,...cj->...ci", _laws(matrices), strains))


def nodal_stresses(matrices: SolidMatrices, displacements: Array) -> NodalStress:
    """Stress at the nodes.

    Evaluated in each cell where stresses converge fastest, at the Gauss points of one order
    less, extrapolated to its nodes and averaged, by volume, over the cells of one region:
    across regions the stress jumps.

    Source: Barlow (1976), International Journal for Numerical Methods in Engineering 10, 243.

    Parameters
    ----------
    matrices : SolidMatrices
    displacements : (3n,) or (3n, m)
        m.

    Returns
    -------
    NodalStress

    Raises
    ------
    ModelError
        Displacements of the wrong shape or not finite.
    """
    columns = _checked(matrices, displacements)
    type_ = matrices.mesh.blocks[0].type
    order = matrices.solid.order
    points, _ = type_.quadrature(2 * order - 1)
    powers = np.array(list(product(range(order), repeat=3)))
    if type_.is_simplex:
        powers = powers[powers.sum(axis=1) < order]
    outwards = _monomials(type_.reference, powers) @ np.linalg.pinv(_monomials(points, powers))
    strains = _strains(matrices, columns, points, outwards)
    stresses = np.einsum("cij,mcnj->mcni", _laws(matrices), strains)
    cells, volumes = matrices.cells, _volumes(matrices, type_)
    regions: dict[str, tuple[Ints, Array]] = {}
    for name in matrices.solid.used_regions:
        own = matrices.solid.cell_regions == matrices.solid.mesh.regions.index(name)
        nodes, place = np.unique(cells[own], return_inverse=True)
        place = place.reshape(-1, type_.size)
        weights = np.zeros(len(nodes))
        np.add.at(weights, place, volumes[own, None])
        total = np.zeros((len(nodes), columns.shape[1], 6))
        np.add.at(total, place, np.moveaxis(stresses[:, own] * volumes[own, None, None], 0, 2))
        mean = np.moveaxis(total / weights[:, None, None], 1, 0)
        regions[name] = (nodes, mean[0] if np.ndim(displacements) == 1 else mean)
    return NodalStress(MappingProxyType(regions), len(matrices.points))


def von_mises(stress: Array) -> Array:
    """Equivalent stress of von Mises, (...), Pa.

    Parameters
    ----------
    stress : (..., 6)
        Components xx, yy, zz, xy, xz, yz, Pa.
    """
    xx, yy, zz, xy, xz, yz = np.moveaxis(np.asarray(stress), -1, 0)
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(np.sqrt(normal / 2.0 + 3.0 * (xy**2 + xz**2 + yz**2)))


def principal_stresses(stress: Array) -> Array:
    """Principal stresses, largest first, (..., 3), Pa.

    Parameters
    ----------
    stress : (..., 6)
        Components xx, yy, zz, xy, xz, yz, Pa.
    """
    tensor = np.asarray(stress)[..., [[0, 3, 4], [3, 1, 5], [4, 5, 2]]]
    return np.asarray(np.linalg.eigvalsh(tensor)[..., ::-1])


def _strains(matrices: SolidMatrices, columns: Array, at: Array, outwards: Array) -> Array:
    """Strains at reference points, taken to others by `outwards` (p, q), (m, cells, p, 6)."""
    type_ = matrices.mesh.blocks[0].type
    gradient = type_.gradient(at)
    cells = matrices.cells
    fields = columns.reshape(len(matrices.points), 3, -1)
    result = np.empty((columns.shape[1], len(cells), len(outwards), 6))
    for start in range(0, len(cells), CHUNK):
        nodes = cells[start : start + CHUNK]
        jacobians = np.einsum("qnd,enc->eqdc", gradient, matrices.points[nodes])
        slopes = np.linalg.solve(jacobians, gradient.transpose(0, 2, 1)[None])
        # G[i, j] = ∂u_i / ∂x_j
        G = np.einsum("eqjn,enim->meqij", slopes, fields[nodes])
        strain = np.stack(
            [
                *(G[..., 0, 0], G[..., 1, 1], G[..., 2, 2]),
                *(G[..., i, j] + G[..., j, i] for i, j in ((0, 1), (0, 2), (1, 2))),
            ],
            axis=-1,
        )
        result[:, start : start + CHUNK] = np.einsum("pq,meqi->mepi", outwards, strain)
    return result


def _laws(matrices: SolidMatrices) -> Array:
    """Elasticity of each cell, (cells, 6, 6)."""
    solid = matrices.solid
    table = np.zeros((len(solid.mesh.regions), 6, 6))
    for name in solid.used_regions:
        table[solid.mesh.regions.index(name)] = elasticity(solid.materials[name])
    return np.asarray(table[solid.cell_regions])


def _volumes(matrices: SolidMatrices, type_: CellType) -> Array:
    at, weights = type_.quadrature(1)
    jacobians = np.einsum("qnd,enc->eqdc", type_.gradient(at), matrices.points[matrices.cells])
    return np.asarray(np.linalg.det(jacobians) @ weights)


def _monomials(at: Array, powers: Ints) -> Array:
    return np.asarray(np.prod(at[:, None, :] ** powers, axis=-1))


def _checked(matrices: SolidMatrices, displacements: Array) -> Array:
    columns = np.asarray(displacements, dtype=float)
    columns = columns[:, None] if columns.ndim == 1 else columns
    if columns.ndim != 2 or len(columns) != matrices.size or not np.isfinite(columns).all():
        raise ModelError(
            f"solid {matrices.solid.name}",
            f"its displacements have the shape {np.shape(displacements)} or are not finite.",
            f"Give {matrices.size} displacements for each load case.",
        )
    return columns
