"""Stiffness and mass of a solid, with its nodes, patches and rigid motions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.elastic_terms import assembler
from strutwork.fea.solid import Solid
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.surface_integrals import nodal_areas

Array = NDArray[Any]
Ints = NDArray[np.int64]


@dataclass(frozen=True, repr=False)
class SolidMatrices:
    """The matrices of a solid. Degree of freedom 3 i + c is direction c (x, y, z) of node i.

    Parameters
    ----------
    solid : Solid
    mesh : Mesh
        The mesh of the field, with its patches and node sets: the nodes of the solid's mesh
        first and in its order, then those in the middle of edges, faces and cells.
    stiffness : (3n, 3n) sparse
        N/m.
    mass_matrix : (3n, 3n) sparse or None
        Consistent mass, kg; None where a density is missing.
    """

    solid: Solid
    mesh: Mesh
    stiffness: sp.csc_array
    mass_matrix: sp.csc_array | None

    def __repr__(self) -> str:
        return (
            f"SolidMatrices({self.solid.name}: {len(self.points)} nodes, {self.size} degrees of "
            f"freedom, {self.stiffness.nnz} entries)"
        )

    @property
    def points(self) -> Array:
        """All nodes of the field, m, (n, 3)."""
        return self.mesh.points

    @property
    def size(self) -> int:
        """Number of degrees of freedom, 3n."""
        return 3 * len(self.points)

    @property
    def cells(self) -> Ints:
        """Nodes of the cells of the field in the order of VTK, (m, k)."""
        return np.concatenate([b.nodes for b in self.mesh.blocks])

    @property
    def mass(self) -> sp.csc_array:
        """Consistent mass, kg, (3n, 3n).

        Raises
        ------
        ModelError
            A region's material has no density.
        """
        if self.mass_matrix is None:
            for region in self.solid.used_regions:
                material = self.solid.materials[region]
                if material.density is None:
                    raise ModelError(
                        f"solid {self.solid.name}, region {region!r}",
                        f"its material {material.name} has no density.",
                        "Give the material a density: mass is needed here.",
                    )
        return self.mass_matrix

    def patch(self, name: str) -> tuple[Ints, Array]:
        """Nodes of a patch and the area that belongs to each.

        Parameters
        ----------
        name : str

        Returns
        -------
        nodes : (m,) int
            Ascending.
        weights : (m,)
            Integral of each node's shape function over the patch, m²; they add up to its area.
            Zero at the corners of quadratic triangles.

        Raises
        ------
        ModelError
            No patch of that name.
        """
        return nodal_areas(self.mesh, self.mesh.patch(name))

    def nodes_of_set(self, name: str) -> Ints:
        """Nodes of a node set or, when there is none of that name, of a patch; ascending, (k,).

        Parameters
        ----------
        name : str
        """
        if name not in self.mesh.node_sets and name in self.mesh.patches:
            return self.mesh.patches[name].nodes
        return self.mesh.node_set(name)

    def rigid_modes(self, about: Array | None = None) -> Array:
        """Displacements of the six rigid motions: x, y, z, and rotations about them, (3n, 6).

        Parameters
        ----------
        about : (3,) or None
            A point of the axes of rotation, m; by default the origin.
        """
        arm = self.points - (np.zeros(3) if about is None else np.asarray(about, dtype=float))
        modes = np.zeros((len(arm), 3, 6))
        modes[:, range(3), range(3)] = 1.0
        for axis in range(3):
            modes[:, :, 3 + axis] = np.cross(np.eye(3)[axis], arm)
        return modes.reshape(-1, 6)

    @cached_property
    def total_mass(self) -> float:
        """Mass of the solid, kg."""
        return float(self.mass.sum()) / 3.0

    @cached_property
    def center_of_mass(self) -> Array:
        """Centre of mass, m, (3,)."""
        shares = np.asarray(self.mass.sum(axis=0)).reshape(-1, 3)[:, 0]
        return np.asarray(shares @ self.points / shares.sum())

    def structural_damping(self) -> sp.csc_array:
        """Imaginary part of the stiffness: loss factor times stiffness by regions, (n, n), N/m.

        A material without a loss factor has none.
        """
        factors = {r: self.solid.materials[r].loss_factor or 0.0 for r in self.solid.used_regions}
        if len(set(factors.values())) == 1:
            return self.stiffness * next(iter(factors.values()))
        return assembler(self.solid).stiffness(factors)


def solid_matrices(solid: Solid) -> SolidMatrices:
    """Stiffness and consistent mass of a solid, assembled by SfePy where its cells are linear.

    Gauss quadrature exact to twice the order of the field in each direction, so that a free
    solid has its six rigid motions and no other without energy.

    Parameters
    ----------
    solid : Solid

    Returns
    -------
    SolidMatrices

    Raises
    ------
    NumericalError
        Matrices that are not finite.
    """
    parts = assembler(solid)
    stiffness = parts.stiffness()
    mass = parts.mass() if solid.has_density else None
    return SolidMatrices(solid, parts.field_mesh(), stiffness, mass)
