"""The saddle-point system of one large structure, sparse."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from kinematics.mobility import RANK_TOLERANCE
from msa.assembly import System
from msa.constraints import CONSISTENCY, free_unknowns, scales
from msa.diagnosis import check_held, check_residual, mechanism_error
from msa.saddle_point import CANCELLED, Unknowns
from strutwork.errors import InconsistentConstraintsError, ModelError

Array = NDArray[Any]

#: Unknowns before joints above which the default solver is sparse.
SPARSE_FROM = 900


def solve_sparse(system: System, load: Array, gaps: Array) -> Unknowns:
    """Solve the saddle-point system of a batch of one by sparse LU.

    The rank of the constraint rows is found cluster by cluster: rows that share no cluster
    cannot depend on each other.

    Parameters, returns and errors as `solve_saddle_point`; several poses are a ModelError.
    """
    if system.poses != 1:
        raise ModelError("sparse solver", f"got {system.poses} poses.", "Give it one at a time.")
    free = free_unknowns(system)
    check_held(system, free, load)
    d = scales(system)[0]
    k = sp.diags_array(d) @ system.sparse_stiffness @ sp.diags_array(d)
    size = abs(k).max() if k.nnz else 1.0
    basis, weights, target = _orthonormal_blocks(system, gaps[0], d)
    n = system.topology.size
    extra = sp.vstack([basis, sp.csr_array(free[0].T)], format="csr")
    matrix = sp.block_array([[k / size, extra.T], [extra, None]], format="csc")
    right = np.zeros((matrix.shape[0], load.shape[-1]))
    right[:n] = load[0] * d[:, None] / size
    right[n : n + len(target)] = target
    try:
        factor = splu(matrix)
        solution = factor.solve(right)
        solution += factor.solve(right - matrix @ solution)
    except RuntimeError as error:
        raise mechanism_error(system, 0) from error
    u = solution[:n] * d[:, None]
    multipliers = weights @ (solution[n : n + basis.shape[0]] * size)
    _, values = system.row_blocks
    held = sparse_rows(system, values[0]).T @ multipliers
    inner = system.sparse_stiffness @ u
    terms = CANCELLED * abs(system.sparse_stiffness) @ np.abs(u * np.any(gaps[0], axis=0))
    scaled = [np.abs(x * d[:, None]).max(initial=0.0) for x in (inner, held, load[0], terms)]
    residual = np.abs((inner + held - load[0]) * d[:, None]).max(initial=0.0)
    check_residual(np.array([residual]), np.array([max(scaled)]), "static solution")
    share = residual / (max(scaled) or 1.0)
    return Unknowns(u[None], multipliers[None], np.array([share]))


def sparse_rows(system: System, values: Array) -> sp.csr_array:
    """Constraint rows A as a sparse matrix."""
    vertex, _ = system.row_blocks
    row = np.repeat(np.arange(len(vertex)), 12).reshape(-1, 2, 6)
    column = 6 * vertex[..., None] + np.arange(6)
    moves = np.broadcast_to(vertex[..., None] >= 0, row.shape)
    return sp.csr_array(
        (values[moves], (row[moves], column[moves])),
        shape=(len(vertex), system.topology.size),
    )


def _orthonormal_blocks(
    system: System, gaps: Array, d: Array
) -> tuple[sp.csr_array, sp.csr_array, Array]:
    """Orthonormal rows, the map to multipliers of A, and right-hand side, by cluster group."""
    _, values = system.row_blocks
    a = sparse_rows(system, values[0]) @ sp.diags_array(d)
    count = a.shape[0]
    if count == 0:
        return a, sp.csr_array((0, 0)), np.zeros((0, gaps.shape[-1]))
    size = np.sqrt(np.asarray(a.multiply(a).sum(axis=1)).ravel())
    size[size == 0] = 1.0
    a = (sp.diags_array(1.0 / size) @ a).tocsr()
    # rows of two joints that share a moving cluster belong together
    touched = abs(a).sign()
    _, label = connected_components(touched @ touched.T, directed=False)
    bases, maps, targets = [], [], []
    for group in np.unique(label):
        rows = np.flatnonzero(label == group)
        block = a[rows]
        columns = np.unique(block.indices)
        left, singular, right = np.linalg.svd(block[:, columns].toarray(), full_matrices=False)
        rank = int(np.count_nonzero(singular > RANK_TOLERANCE * singular.max(initial=0.0)))
        scaled = gaps[rows] / size[rows, None]
        met = left[:, :rank] @ (left[:, :rank].T @ scaled)
        if np.abs(met - scaled).max(initial=0.0) > CONSISTENCY * max(
            np.abs(gaps).max(initial=0.0), 1e-300
        ):
            names = dict.fromkeys(system.row_labels[r].split(":")[0] for r in rows)
            raise InconsistentConstraintsError(
                f"joints {', '.join(names)}",
                "their misfits cannot all be met: these joints close a rigid loop.",
                "Give one of them its real stiffness, or drop the misfit.",
            )
        inverse = 1.0 / singular[:rank]
        basis = sp.csr_array((rank, a.shape[1])).tolil()
        basis[:, columns] = right[:rank]
        bases.append(basis.tocsr())
        lift = sp.csr_array((count, rank)).tolil()
        lift[rows] = (left[:, :rank] * inverse) / size[rows, None]
        maps.append(lift.tocsr())
        targets.append(inverse[:, None] * (left[:, :rank].T @ scaled))
    return (
        sp.vstack(bases, format="csr"),
        sp.hstack(maps, format="csr"),
        np.concatenate(targets),
    )
