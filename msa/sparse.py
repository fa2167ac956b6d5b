"""The saddle-point system of one large structure, sparse."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from strutwork.errors import InconsistentConstraintsError, ModelError
from strutwork.kinematics.mobility import RANK_TOLERANCE
from strutwork.msa.assembly import System
from strutwork.msa.constraints import CONSISTENCY, free_unknowns, scales
from strutwork.msa.diagnosis import check_held, mechanism_error
from strutwork.msa.row_groups import row_groups, unit_rows
from strutwork.msa.triplets import Triplets
from strutwork.msa.trust import Unknowns, solve_trusted

Array = NDArray[Any]

#: Unknowns before joints above which the default solver is sparse.
SPARSE_FROM = 900


def solve_sparse(system: System, load: Array, gaps: Array) -> Unknowns:
    """Solve the saddle-point system of a batch of one by sparse LU.

    The rank of the constraint rows is computed cluster by cluster: rows that share no cluster
    cannot depend on each other. Returns and errors as `solve_saddle_point`; several poses are a
    ModelError.

    Parameters
    ----------
    system : System
        At one pose.
    load : (1, n, m)
        F on the unknowns, N and N·m.
    gaps : (1, r, m)
        g, the misfits of the constraint rows, m and rad.
    """
    if system.poses != 1:
        raise ModelError("sparse solver", f"got {system.poses} poses.", "Give it one at a time.")
    free = free_unknowns(system)
    check_held(system, free, load)
    d = scales(system)[0]
    k = sp.diags_array(d) @ system.sparse_stiffness @ sp.diags_array(d)
    size = abs(k).max() if k.nnz else 1.0
    rows = _orthonormal_blocks(system, gaps[0], d)
    n, r = system.topology.size, rows.basis.shape[0]
    extra = sp.vstack([rows.basis, sp.csr_array(free[0].T)], format="csr")
    matrix = sp.block_array([[k / size, extra.T], [extra, None]], format="csc")
    try:
        factor = splu(matrix)
    except RuntimeError as error:
        raise mechanism_error(system, 0) from error

    def inverse(force: Array, gap: Array, _: Any) -> tuple[Array, Array]:
        right = np.zeros((matrix.shape[0], force.shape[-1]))
        right[:n] = force[0] * d[:, None] / size
        right[n : n + r] = rows.lift.T @ gap[0]
        solution = factor.solve(right)
        held = rows.lift @ (solution[n : n + r] * size)
        return (solution[:n] * d[:, None])[None], held[None]

    return solve_trusted(system, inverse, load, gaps)


def sparse_rows(system: System, values: Array) -> sp.csr_array:
    """Constraint rows A as a sparse matrix, (r, n).

    Parameters
    ----------
    system : System
    values : (r, k, 6)
        Of the rows' blocks at one pose, no unit, or m of a rotation's effect on a translation.
    """
    vertex, _ = system.row_blocks
    row = np.arange(len(vertex))[:, None, None] + np.zeros((*vertex.shape, 6), dtype=np.intp)
    column = 6 * vertex[..., None] + np.arange(6)
    moves = np.broadcast_to(vertex[..., None] >= 0, row.shape)
    return sp.csr_array(
        (values[moves], (row[moves], column[moves])),
        shape=(len(vertex), system.topology.size),
    )


@dataclass(frozen=True)
class Blocks:
    """Independent rows in place of the constraint rows.

    Parameters
    ----------
    basis : (k, n) sparse
        Orthonormal, in scaled unknowns.
    lift : (r, k) sparse
        Multipliers of A from those of `basis`; its transpose brings gaps to them.
    """

    basis: sp.csr_array
    lift: sp.csr_array


def _orthonormal_blocks(system: System, gaps: Array, d: Array) -> Blocks:
    """Orthonormal rows by groups of rows that share a cluster, and the map back to those of A."""
    a = unit_rows(system, d)
    count, n, size = len(a), system.topology.size, a.size
    bases, lifts = Triplets(), Triplets()
    found = 0
    for rows, block, columns in row_groups(a):
        left, singular, right = np.linalg.svd(block, full_matrices=False)
        rank = int(np.count_nonzero(singular > RANK_TOLERANCE * singular.max(initial=0.0)))
        if np.any(gaps[rows]):
            scaled = gaps[rows] / size[rows, None]
            met = left[:, :rank] @ (left[:, :rank].T @ scaled)
            if np.abs(met - scaled).max(initial=0.0) > CONSISTENCY * np.abs(gaps).max():
                names = dict.fromkeys(system.row_labels[r].split(":")[0] for r in rows)
                raise InconsistentConstraintsError(
                    f"joints {', '.join(names)}",
                    "their misfits cannot all be met: these joints close a rigid loop.",
                    "Give one of them its real stiffness, or drop the misfit.",
                )
        kept = np.arange(found, found + rank)
        bases.add(kept, columns, right[:rank])
        lifts.add(rows, kept, left[:, :rank] / singular[:rank] / size[rows, None])
        found += rank
    return Blocks(bases.matrix((found, n)), lifts.matrix((count, found)))
