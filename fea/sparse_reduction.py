"""Stiffness and mass of one large structure on its independent coordinates, sparse."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import qr
from scipy.sparse.csgraph import connected_components

from strutwork.errors import ModelError
from strutwork.fea.eigen import rigid_modes
from strutwork.fea.factorize import factorize
from strutwork.fea.geometric import largest_work
from strutwork.fea.stability import motions_left_free
from strutwork.kinematics.mobility import RANK_TOLERANCE
from strutwork.msa.assembly import System
from strutwork.msa.constraints import free_unknowns, scales
from strutwork.msa.mass import sparse_mass
from strutwork.msa.null_space import closing_rows
from strutwork.msa.sparse import sparse_rows
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]

#: Entries of unit closing rows below this are rounding.
ROUNDING = 1e-13


@dataclass(frozen=True)
class SparseReduced:
    """A structure at one pose on its independent coordinates.

    Parameters
    ----------
    system : System
    basis : (n, c) sparse
        Displacements of the clusters per unit coordinate, no unit, m/rad or rad/m.
    stiffness, mass : (c, c) sparse
        N/m, kg and the like of rotations.
    rigid : (c, k)
        Rigid-body modes, orthonormal in the mass.
    geometric : (c, c) sparse or None
        What a preload adds, N/m and the like; the stiffness holds it.
    free : int
        Under a preload, how many of the last coordinates are motions without elastic work.
    """

    system: System
    basis: sp.csc_array
    stiffness: sp.csc_array
    mass: sp.csc_array
    rigid: Array
    geometric: sp.csc_array | None = None
    free: int = 0

    def __repr__(self) -> str:
        return f"<SparseReduced: {self.size} coordinates, {self.rigid.shape[1]} rigid-body modes>"

    @property
    def size(self) -> int:
        """Number of independent coordinates c."""
        return int(self.basis.shape[1])


def reduce_sparse(system: System) -> SparseReduced:
    """Bring stiffness, with what a preload adds, and mass of one pose to independent coordinates.

    Joint coordinates along the spanning forest; rows that close loops are removed by an
    orthonormal basis of their null space, loop by loop: rows that share no coordinate do
    not know each other.

    Parameters
    ----------
    system : System

    Raises
    ------
    ModelError
        Several poses, no mass, a free motion without mass, or every direction locked.
    """
    if system.poses != 1:
        raise ModelError("sparse modes", f"of {system.poses} poses.", "Give one at a time.")
    basis = _loops_closed(system, _joint_basis(system))
    if basis.shape[1] == 0:
        raise ModelError(
            "structure",
            "has no degree of freedom: every direction is locked.",
            "Release a support, or make a joint direction elastic.",
        )
    free = _rigid(system, basis)
    geometric = None
    if system.placed.stiffening is None:
        stiffness, rigid = _product(basis, system.sparse_stiffness), free
    else:
        basis, stiffness, geometric, rigid = _stiffened(system, basis, free)
    mass = _product(basis, sparse_mass(system))
    if not mass.diagonal().sum() > 0:
        raise ModelError(
            "structure", "has no mass.", "Give materials a density, or add masses: modes need them."
        )
    gram, largest = (rigid.T @ (mass @ rigid))[None], np.array([mass.diagonal().max()])
    rigid = rigid_modes(system, rigid[None], gram, largest)[0]
    return SparseReduced(system, basis, stiffness, mass, rigid, geometric, free.shape[1])


def _stiffened(
    system: System, basis: sp.csc_array, free: Array
) -> tuple[sp.csc_array, sp.csc_array, sp.csc_array, Array]:
    """Basis, stiffness with a preload, what the preload adds, and the motions it leaves free.

    Free motions become coordinates of their own, in which elastic stiffness is exactly none:
    the rounding of a machine's stiffness would drown the weight of what swings.
    """
    stiffening = system.placed.stiffening
    if stiffening is None:
        raise ValueError("no preload")
    k = free.shape[1]
    elastic = _product(basis, system.sparse_stiffness)
    if k:
        replaced = qr(free.T, mode="r", pivoting=True)[1][:k]
        kept = np.setdiff1d(np.arange(basis.shape[1]), replaced)
        nothing = sp.csc_array((k, k))
        elastic = sp.csc_array(sp.block_diag([elastic[kept][:, kept], nothing]))
        basis = sp.csc_array(sp.hstack([basis[:, kept], sp.csc_array(basis @ free)]))
        free = np.eye(basis.shape[1])[:, -k:]
    geometric = _product(basis, system.sparse_sum(stiffening.contributions()))
    scaled = sp.csc_array(sp.diags_array(1.0 / scales(system)[0]) @ basis)
    unit = np.sqrt(np.asarray(scaled.power(2).sum(axis=0)).ravel())
    push = (geometric @ free) / np.where(unit > 0, unit, 1.0)[:, None]
    rigid = motions_left_free(free[None], push[None], largest_work(system))[0]
    rigid = rigid[:, np.any(rigid, axis=0)]
    return basis, sp.csc_array(elastic + geometric), geometric, rigid


def _product(basis: sp.csc_array, matrix: sp.csc_array) -> sp.csc_array:
    product = basis.T @ matrix @ basis
    return sp.csc_array((product + product.T) / 2.0)


def _joint_basis(system: System) -> sp.csc_array:
    """Displacements of the clusters per unit joint coordinate, (n, c)."""
    structure = system.placed.structure
    linkage, forest = structure.linkage, system.topology.forest
    positions = system.placed.positions[0]
    here = positions[structure.reference_nodes]
    blocks: dict[int, tuple[NDArray[np.intp], Array]] = {-1: (np.zeros(0, np.intp), np.eye(6, 0))}
    rows, columns, values = [], [], []
    for step in forest.steps:
        v = step.vertex
        if step.joint < 0:
            own, block = np.arange(step.start, step.start + 6), np.eye(6)
        else:
            inherited, carrier = blocks[step.parent]
            if step.parent >= 0:
                carrier = rigid_map(here[v] - here[step.parent]) @ carrier
            between = linkage.joints[step.joint].between
            node = linkage.node_index[between[1 if step.sign > 0 else 0]]
            swing = rigid_map(here[v] - positions[node]) @ system.joint_frames[0, step.joint]
            own = np.concatenate(
                [inherited, np.arange(step.start, step.start + len(step.free))]
            ).astype(np.intp)
            block = np.concatenate([carrier, step.sign * swing[:, list(step.free)]], axis=1)
        blocks[v] = (own, block)
        rows.append(np.repeat(np.arange(6 * v, 6 * v + 6), len(own)))
        columns.append(np.tile(own, 6))
        values.append(block.ravel())
    shape = (system.topology.size, forest.count)
    if not rows:
        return sp.csc_array(shape)
    triplets = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return sp.coo_array(triplets, shape=shape).tocsc()


def _loops_closed(system: System, basis: sp.csc_array) -> sp.csc_array:
    """The basis less the coordinates that rows closing loops take."""
    closing = closing_rows(system)
    if not len(closing):
        return basis
    rows = sp.csr_array(sparse_rows(system, system.row_blocks[1][0])[closing] @ basis)
    size = np.sqrt(np.asarray(rows.multiply(rows).sum(axis=1)).ravel())
    rows = sp.csr_array(sp.diags_array(1.0 / np.where(size == 0, 1.0, size)) @ rows)
    rows.data[np.abs(rows.data) < ROUNDING] = 0.0
    rows.eliminate_zeros()
    touched = abs(rows).sign()
    _, label = connected_components(touched @ touched.T, directed=False)
    used = np.unique(rows.indices)
    free = np.setdiff1d(np.arange(basis.shape[1]), used)
    pieces = [basis[:, free]]
    for group in np.unique(label):
        block = rows[np.flatnonzero(label == group)]
        columns = np.unique(block.indices)
        if not len(columns):
            continue
        _, values, right = np.linalg.svd(block[:, columns].toarray())
        rank = int(np.count_nonzero(values > RANK_TOLERANCE * values[0]))
        pieces.append(sp.csc_array(basis[:, columns] @ sp.csc_array(right[rank:].T)))
    return sp.csc_array(sp.hstack(pieces))


def _rigid(system: System, basis: sp.csc_array) -> Array:
    """Motions that cost no energy, in coordinates, (c, k)."""
    free = free_unknowns(system)[0]
    if not free.shape[-1]:
        return np.zeros((basis.shape[1], 0))
    scaled = sp.csc_array(sp.diags_array(1.0 / scales(system)[0]) @ basis)
    normal = factorize(sp.csc_array(scaled.T @ scaled))
    found = normal.solve(scaled.T @ free)
    return np.asarray(found + normal.solve(scaled.T @ (free - scaled @ found)))
