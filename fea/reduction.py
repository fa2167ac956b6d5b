"""Stiffness, mass and damping on the null space of the constraints.

Every solver of this package works on independent coordinates: the joint coordinates of the
spanning forest, less those that close loops. No constraint, and so no spurious frequency,
is left in the matrices.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.geometric import geometric_stiffness, largest_work
from strutwork.fea.stability import check_stable, motions_left_free, without_elastic_work
from strutwork.memory import require_dense
from strutwork.msa.assembly import System
from strutwork.msa.constraints import free_unknowns, scales
from strutwork.msa.mass import mass_contributions, mass_matrix
from strutwork.msa.null_space import independent_basis, symmetric_product
from strutwork.msa.on_coordinates import on_coordinates
from strutwork.msa.structure import rigid_map
from strutwork.stages import stage

Array = NDArray[Any]


class AllLockedError(ModelError):
    """No coordinate is left: every direction is locked."""


@dataclass(frozen=True)
class Reduced:
    """A structure on its independent coordinates at p poses.

    Parameters
    ----------
    system : System
    basis : (p, n, c)
        Displacements of the clusters per unit coordinate, no unit, m/rad or rad/m; zero columns
        where a pose has fewer coordinates than another.
    stiffness, mass : (p, c, c)
        N/m, kg and the like.
    rigid : (p, c, k)
        Motions that cost no energy, in coordinates, m and rad of any size; zero columns where a
        pose has fewer.
    """

    system: System
    basis: Array
    stiffness: Array
    mass: Array
    rigid: Array

    @property
    def size(self) -> int:
        """Number of independent coordinates c."""
        return int(self.basis.shape[-1])

    @cached_property
    def rigid_count(self) -> NDArray[np.intp]:
        """Number of rigid-body modes at every pose, (p,)."""
        return np.asarray(np.any(self.rigid, axis=1).sum(axis=-1))

    def at_poses(self, poses: NDArray[np.intp]) -> Reduced:
        """The same at some of the poses.

        Parameters
        ----------
        poses : (q,)
            Their numbers.
        """
        return Reduced(
            System(self.system.placed[poses], self.system.topology),
            self.basis[poses],
            self.stiffness[poses],
            self.mass[poses],
            self.rigid[poses],
        )

    def at_node(self, node: str) -> Array:
        """Displacement of a mesh node per unit coordinate, (p, 6, c).

        Parameters
        ----------
        node : str
            A mesh node.

        Raises
        ------
        ModelError
            An unknown node.
        """
        index = self.system.placed.structure.mesh_index
        if node not in index:
            raise ModelError(f"node {node}", "is not in the structure.", "Name one of its nodes.")
        structure = self.system.placed.structure
        vertex = structure.vertex_of_node[index[node]]
        if vertex < 0:
            return np.zeros((self.system.poses, 6, self.size))
        carried = rigid_map(self.system.placed.arms[:, index[node]])
        return np.asarray(carried @ self.basis[:, 6 * vertex : 6 * vertex + 6])

    def project(self, matrix: Array) -> Array:
        """A matrix on the unknowns brought to the coordinates, (p, c, c).

        Parameters
        ----------
        matrix : (p, n, n)
            Symmetric: N/m, N·s/m or kg, and the like of rotations.
        """
        return symmetric_product(self.basis, matrix)


def reduce_system(system: System) -> Reduced:
    """Bring stiffness, with what a preload adds, and mass to independent coordinates.

    Parameters
    ----------
    system : System

    Returns
    -------
    Reduced

    Raises
    ------
    AllLockedError
        No coordinate is left: every direction is locked.
    NumericalError
        The structure does not stand under its preload; names the critical share of it.
    """
    _require_memory(system)
    with stage(f"brings {system.topology.size:,} unknowns to independent coordinates"):
        return _reduced(system)


def _reduced(system: System) -> Reduced:
    basis = independent_basis(system)
    d = scales(system)[..., None]
    if basis.shape[-1] == 0 or not np.any(basis):
        raise AllLockedError(
            "structure",
            "has no degree of freedom: every direction is locked.",
            "Release a support, or make a joint direction elastic.",
        )
    free = free_unknowns(system)
    rigid: Array = np.zeros((system.poses, basis.shape[-1], free.shape[-1]))
    if free.shape[-1]:
        rigid = np.linalg.pinv(basis / d) @ free
        present = np.any(free, axis=1)
        rigid = rigid * present[:, None, :]
    reduced = _elastic(system, basis)
    if system.placed.stiffening is not None:
        reduced, rigid = _stiffened(system, basis, reduced, rigid)
    # a coordinate that a pose does not have gets a stiffness and no mass: no finite frequency
    absent = ~np.any(basis, axis=1)
    diagonal = np.einsum("pii->pi", reduced)
    diagonal[absent] = np.broadcast_to(diagonal.max(axis=1, keepdims=True), diagonal.shape)[absent]
    return Reduced(system, basis, reduced, _mass(system, basis), rigid)


def _elastic(system: System, basis: Array) -> Array:
    if system.lone is not None:
        return on_coordinates(system, system.contributions())
    return symmetric_product(basis, system.stiffness)


def _mass(system: System, basis: Array) -> Array:
    if system.lone is not None:
        return on_coordinates(system, mass_contributions(system))
    return symmetric_product(basis, mass_matrix(system))


def _geometric(system: System, basis: Array) -> Array:
    if system.lone is not None and system.placed.stiffening is not None:
        return on_coordinates(system, system.placed.stiffening.contributions())
    return symmetric_product(basis, geometric_stiffness(system))


def _require_memory(system: System) -> None:
    """NumericalError before matrices that do not fit."""
    n, c = system.topology.size, system.topology.forest.count
    # stiffness, mass and a product of each; the basis twice; and on the coordinates the two
    # matrices, their factors and eigenvectors
    need = 8.0 * system.poses * (3.0 * n * n + 3.0 * n * c + 6.0 * c * c)
    require_dense(
        "structure",
        f"responses with all modes: dense matrices of {c:,} coordinates at {system.poses} poses"
        if system.poses > 1
        else f"responses with all modes: dense matrices of {c:,} coordinates",
        need,
        "Divide beams into fewer elements or make stiff parts rigid bodies; the lowest modes alone "
        "(`strutwork modes`, with a modal ratio, loss factor or Rayleigh damping) need no dense "
        "matrix.",
    )


def _stiffened(system: System, basis: Array, elastic: Array, free: Array) -> tuple[Array, Array]:
    """Stiffness with what a preload adds, (p, c, c), and the motions that stay free, (p, c, k)."""
    geometric = _geometric(system, basis)
    rigid = free
    if free.shape[-1]:
        elastic = without_elastic_work(elastic, free)
        # forces in coordinates of unit size
        unit = np.linalg.norm(basis / scales(system)[..., None], axis=1)
        push = (geometric @ free) / np.where(unit > 0, unit, 1.0)[..., None]
        rigid = motions_left_free(free, push, largest_work(system))
    check_stable(system, elastic, geometric, free, rigid, ~np.any(basis, axis=1))
    return elastic + geometric, rigid
