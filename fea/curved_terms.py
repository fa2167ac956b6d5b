"""Matrices of isoparametric quadratic cells, whose edges and faces may be curved.

SfePy maps cells by their corners alone. Here the shape functions of all nodes map the cell, so
that displacements and geometry are of one order: linear fields are exact on any cell (Irons
1966), and the mass is that of the curved body.

Source: Zienkiewicz, Taylor, Zhu (2013), The Finite Element Method, 7th ed., chapter 5.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.fea.elasticity import elasticity, thermal_stress
from strutwork.fea.solid import Solid
from strutwork.meshes.cells import CellType
from strutwork.meshes.mesh import Mesh

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Entries of cell matrices that are held at a time: 8 MB, which stay in the cache.
CHUNK_ENTRIES = 1_000_000
#: Component of the six for each pair of directions.
PAIRS = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])


@dataclass(frozen=True, repr=False)
class CurvedAssembler:
    """A solid of quadratic cells and how to assemble it.

    Parameters
    ----------
    solid : Solid
        Of `tetra10`, `hexahedron20` or `hexahedron27`.
    """

    solid: Solid

    def __repr__(self) -> str:
        return f"CurvedAssembler({self.solid.name}: {len(self.solid.mesh.points)} nodes)"

    def field_mesh(self) -> Mesh:
        """The mesh of the field: the solid's own."""
        return self.solid.mesh

    def stiffness(self, weights: dict[str, float] | None = None) -> sp.csc_array:
        """Stiffness, N/m, (3n, 3n).

        Parameters
        ----------
        weights : dict of region to float, optional
            Factor on each region's share, no unit; one where it is not named.
        """
        type_ = self._type
        points = len(type_.quadrature(type_.field_degree)[1])

        def blocks(region: str, cells: Ints) -> Array:
            law = elasticity(self.solid.materials[region]) * (weights or {}).get(region, 1.0)
            # C[a, c, b, d]: ∂u_a / ∂x_c works on the stress of ∂u_b / ∂x_d
            full = law[PAIRS[:, :, None, None], PAIRS]
            by_slopes = full.transpose(1, 3, 0, 2).reshape(9, 9)
            slopes, volumes = self._slopes(cells)
            scaled = np.sqrt(volumes)[..., None, None] * slopes.transpose(0, 1, 3, 2)
            flat = scaled.reshape(len(cells), points, -1)
            # Σ w det J ∂N_i/∂x_c ∂N_j/∂x_d, the same for every law
            products = (flat.transpose(0, 2, 1) @ flat).reshape(-1, type_.size, 3, type_.size, 3)
            return np.asarray(products.transpose(0, 1, 3, 2, 4).reshape(-1, 9) @ by_slopes)

        return self._assembled(blocks, 3)

    def mass(self) -> sp.csc_array:
        """Consistent mass, kg, (3n, 3n), exact for the mapped cells."""
        type_ = self._type
        at, quadrature = type_.quadrature(type_.mass_degree)
        gradient, shape = type_.gradient(at), type_.shape(at)
        products = np.einsum("qi,qj->qij", shape, shape).reshape(len(at), -1)

        def blocks(region: str, cells: Ints) -> Array:
            _, volumes = self._mapped(cells, gradient, quadrature)
            density = self.solid.materials[region].density
            return np.asarray((density * volumes @ products).reshape(-1, 1))

        one = self._assembled(blocks, 1)
        return sp.csc_array(sp.kron(one, sp.eye_array(3)))

    def conduction(self, conductivities: Mapping[str, float]) -> sp.csc_array:
        """Conduction of heat, W/K, (n, n).

        Parameters
        ----------
        conductivities : mapping of region to float
            W/(m K).
        """

        def blocks(region: str, cells: Ints) -> Array:
            slopes, volumes = self._slopes(cells)
            scaled = np.sqrt(conductivities[region] * volumes)[..., None, None] * slopes
            flat = scaled.reshape(len(cells), -1, self._type.size)
            return np.asarray((flat.transpose(0, 2, 1) @ flat).reshape(-1, 1))

        return self._assembled(blocks, 1)

    def expansion(self, changes: Array, coefficients: Mapping[str, float]) -> Array:
        """Loads of the thermal strain, ∫ Bᵀ D α T 1 dV, N, (3n,).

        Parameters
        ----------
        changes : (n,)
            Change of temperature at the nodes of the field, K.
        coefficients : mapping of region to float
            Of expansion, 1/K.
        """
        at, _ = self._type.quadrature(self._type.field_degree)
        shape = self._type.shape(at)
        loads = np.zeros((len(self.solid.mesh.points), 3))
        for region, cells in self._chunks():
            nodes = self.solid.cells[cells]
            slopes, volumes = self._slopes(cells)
            # of an isotropic material the stress is a pressure
            stress = thermal_stress(self.solid.materials[region], coefficients[region])[0]
            weights = stress * volumes * (np.asarray(changes)[nodes] @ shape.T)
            np.add.at(loads, nodes, np.einsum("eq,eqdn->end", weights, slopes))
        return loads.ravel()

    def _slopes(self, cells: Ints) -> tuple[Array, Array]:
        """Derivatives of the shape functions (e, q, 3, n), and weights times det J (e, q)."""
        at, quadrature = self._type.quadrature(self._type.field_degree)
        gradient = self._type.gradient(at)
        jacobians, volumes = self._mapped(cells, gradient, quadrature)
        return np.linalg.solve(jacobians, gradient.transpose(0, 2, 1)[None]), volumes

    @property
    def _type(self) -> CellType:
        return self.solid.mesh.blocks[0].type

    def _mapped(self, cells: Ints, gradient: Array, quadrature: Array) -> tuple[Array, Array]:
        """Jacobians (e, q, 3, 3) and weights times det J (e, q) of some cells.

        `check_quality` has seen that det J is positive at these points.
        """
        places = self.solid.mesh.points[self.solid.cells[cells]]
        # centred first: coordinates far from the origin would cost digits
        places = places - places.mean(axis=1, keepdims=True)
        jacobians = np.einsum("qnd,enc->eqdc", gradient, places)
        return jacobians, np.linalg.det(jacobians) * quadrature

    @cached_property
    def _pattern(self) -> tuple[Array, Array, Array]:
        """Columns and row starts of the pairs of nodes, and the pair of each cell's pairs."""
        n, cells = len(self.solid.mesh.points), self.solid.cells
        keys, place = np.unique(
            (cells[:, :, None] * n + cells[:, None, :]).ravel(), return_inverse=True
        )
        rows, columns = np.divmod(keys, n)
        starts = np.append(0, np.cumsum(np.bincount(rows, minlength=n)))
        small = np.int32 if 9 * len(keys) < np.iinfo(np.int32).max else np.int64
        return columns.astype(small), starts.astype(small), place.reshape(len(cells), -1)

    def _assembled(self, blocks: Callable[[str, Ints], Array], width: int) -> sp.csc_array:
        """The sum over the cells; `blocks` gives (e k k, width²) of some cells of a region."""
        columns, starts, place = self._pattern
        values = np.zeros((width**2, len(columns)))
        for region, cells in self._chunks():
            pairs = place[cells].ravel()
            for component, found in zip(values, blocks(region, cells).T, strict=True):
                np.add.at(component, pairs, np.ascontiguousarray(found))
        if not np.isfinite(values).all():
            raise NumericalError(
                f"solid {self.solid.name}",
                "its matrices are not finite.",
                "Check the size of its cells and the units of its materials.",
            )
        size = width * (len(starts) - 1)
        by_pair = np.ascontiguousarray(values.T).reshape(-1, width, width)
        found = sp.bsr_array((by_pair, columns, starts), shape=(size, size)).tocsr()
        # rows of a symmetric matrix are its columns
        return sp.csc_array((found.data, found.indices, found.indptr), shape=found.shape)

    def _chunks(self) -> Iterator[tuple[str, Ints]]:
        """Cells of one region, few enough at a time."""
        region = self.solid.cell_regions
        most = max(1, CHUNK_ENTRIES // (9 * self._type.size**2))
        for index in np.unique(region):
            own = np.flatnonzero(region == index)
            for start in range(0, len(own), most):
                yield self.solid.mesh.regions[index], own[start : start + most]
