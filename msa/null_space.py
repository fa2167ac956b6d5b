"""Solution on the null space of the constraint rows.

Joint coordinates along the spanning forest satisfy the locked directions of the joints that
carry, without any rank decision; rows that close loops are then removed by an orthonormal
basis of their null space. What remains is symmetric and positive definite.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import State
from strutwork.kinematics.mobility import RANK_TOLERANCE
from strutwork.msa.assembly import System, system_of
from strutwork.msa.constraints import (
    check_consistent,
    free_unknowns,
    of_lone,
    orthonormal_rows,
    scales,
)
from strutwork.msa.diagnosis import check_held, mechanism_error
from strutwork.msa.structure import rigid_map
from strutwork.msa.trust import Unknowns, solve_trusted

Array = NDArray[Any]


def joint_coordinates(system: System, gaps: Array) -> tuple[Array, Array]:
    """Basis N of the motions that the carrying joints leave, and a motion that meets their gaps.

    Parameters
    ----------
    system : System
    gaps : (p, r, m)
        Misfits of the constraint rows, m and rad.

    Returns
    -------
    basis : (p, n, c)
        Displacements of the clusters per unit joint coordinate.
    particular : (p, n, m)
        Displacements that close the carrying joints' misfits.
    """
    m = gaps.shape[-1]
    if not m:
        one = of_lone(system, "_coordinates", lambda lone: joint_coordinates(lone, gaps[:1]))
        if one is not None:
            basis, particular = (np.broadcast_to(a, (system.poses, *a.shape[1:])) for a in one)
            return basis, particular
    structure = system.placed.structure
    forest = system.topology.forest
    linkage = structure.linkage
    states = linkage.states()
    row_of = {(int(j), int(d)): r for r, (j, d) in enumerate(zip(*system.row_owner, strict=True))}
    positions = system.placed.positions
    basis = np.zeros((system.poses, structure.vertex_count, 6, forest.count))
    particular = np.zeros((system.poses, structure.vertex_count, 6, m))
    for step in forest.steps:
        v = step.vertex
        if step.joint < 0:
            basis[:, v, range(6), range(step.start, step.start + 6)] = 1.0
            continue
        here = positions[:, structure.reference_nodes[v]]
        if step.parent >= 0:
            arm = here - positions[:, structure.reference_nodes[step.parent]]
            carried = rigid_map(arm)
            basis[:, v] = carried @ basis[:, step.parent]
            particular[:, v] = carried @ particular[:, step.parent]
        joint = linkage.joints[step.joint]
        # both nodes of the joint stand at one place; the cluster's own side is exact for it
        node = linkage.node_index[joint.between[1 if step.sign > 0 else 0]]
        swing = (
            step.sign * rigid_map(here - positions[:, node]) @ system.joint_frames[:, step.joint]
        )
        columns = range(step.start, step.start + len(step.free))
        basis[:, v][..., columns] += swing[..., list(step.free)]
        locked = [d for d in range(6) if states[step.joint, d] == State.LOCKED]
        rows = [row_of[step.joint, d] for d in locked]
        particular[:, v] += swing[..., locked] @ gaps[:, rows]
    n = system.topology.size
    return basis.reshape(system.poses, n, -1), particular.reshape(system.poses, n, m)


def independent_basis(system: System) -> Array:
    """Displacements of the clusters per unit of the independent coordinates, (p, n, c).

    Those of the spanning forest, less those that close loops. Columns that a pose has less than
    another are zero.

    Parameters
    ----------
    system : System
        At p poses, with n unknowns.
    """
    one = of_lone(system, "_independent", independent_basis)
    if one is not None:
        return np.broadcast_to(one, (system.poses, *one.shape[1:]))
    no_gaps = np.zeros((system.poses, len(system.row_labels), 0))
    basis, _ = joint_coordinates(system, no_gaps)
    closing = closing_rows(system)
    if not len(closing):
        return basis
    rows = system.rows[:, closing] @ basis
    size = np.linalg.norm(rows, axis=-1, keepdims=True)
    rows = rows / np.where(size == 0, 1.0, size)
    _, values, right = np.linalg.svd(rows)
    keep = np.zeros(right.shape[:2], dtype=bool)
    keep[:, : values.shape[-1]] = values > RANK_TOLERANCE * np.maximum(values[:, :1], 1e-30)
    # the least rank over the poses decides how many columns are kept for all
    null = np.swapaxes(right, -1, -2) * ~keep[:, None, :]
    return np.asarray(basis @ null[..., int(keep.sum(axis=1).min()) :])


def closing_rows(system: System) -> NDArray[np.intp]:
    """Indices of the constraint rows whose joints close a loop, (k,).

    Parameters
    ----------
    system : System
    """
    joint, _ = system.row_owner
    return np.flatnonzero(np.isin(joint, system.topology.forest.closing))


def solve_null_space(system: System, load: Array, gaps: Array) -> Unknowns:
    """Solve on the null space of the constraint rows; multipliers from the equilibrium.

    Returns and errors as `solve_saddle_point`.

    Parameters
    ----------
    system : System
    load : (p, n, m)
        F on the unknowns, N and N·m.
    gaps : (p, r, m)
        g, the misfits of the constraint rows, m and rad.
    """
    rows = orthonormal_rows(system)
    check_consistent(system, rows, gaps)
    free = free_unknowns(system)
    check_held(system, free, load)
    d = scales(system)[..., None]
    basis, _ = joint_coordinates(system, gaps[..., :0])
    closing = closing_rows(system)
    stiffness = system.stiffness
    a = system.rows[:, closing]
    reduced = symmetric_product(basis, stiffness)
    still = np.swapaxes(free / d, -1, -2)
    extra = np.concatenate([a @ basis, still @ basis], axis=1)

    def inverse(force: Array, gap: Array, poses: Any) -> tuple[Array, Array]:
        part = system if isinstance(poses, slice) else system_of(system.placed[poses])
        moved = joint_coordinates(part, gap)[1]
        target = np.concatenate([gap[:, closing] - a[poses] @ moved, -still[poses] @ moved], axis=1)
        turned = np.swapaxes(basis[poses], -1, -2) @ (force - stiffness[poses] @ moved)
        found = constrained_minimum(part, reduced[poses], extra[poses], turned, target)
        displacements = moved + basis[poses] @ found
        return displacements, multipliers(part, displacements, force)

    return solve_trusted(system, inverse, load, gaps)


def symmetric_product(basis: Array, matrix: Array) -> Array:
    """Bᵀ M B, made exactly symmetric, (p, c, c).

    Parameters
    ----------
    basis : (p, n, c)
        B, no unit, m/rad or rad/m.
    matrix : (p, n, n)
        M, symmetric: N/m, N, N·m/rad, or kg, kg·m, kg·m².
    """
    picked = _selection(basis)
    if picked is not None:
        return np.ascontiguousarray(matrix[:, picked[:, None], picked])
    product = np.swapaxes(basis, -1, -2) @ matrix @ basis
    return np.asarray((product + np.swapaxes(product, -1, -2)) / 2.0)


def _selection(basis: Array) -> NDArray[np.intp] | None:
    """The unknowns that a basis only picks, at every pose the same; None for another basis.

    A frame without moving joints has such a basis, and indexing is cheaper than two products.
    """
    if basis.shape[0] == 0 or np.count_nonzero(basis) != basis.shape[0] * basis.shape[2]:
        return None
    picked = np.asarray(basis[0].argmax(axis=0))
    alone = basis[:, picked, np.arange(basis.shape[2])]
    return picked if np.all(alone == 1.0) else None


def constrained_minimum(
    system: System, stiffness: Array, rows: Array, force: Array, target: Array
) -> Array:
    """Coordinates s of least energy ½ sᵀKs − sᵀf with rows·s = target, (p, c, m).

    Redundant rows are recognised by rank per pose.

    Parameters
    ----------
    system : System
        For messages.
    stiffness : (p, c, c)
        K, symmetric, N/m, N, N·m/rad.
    rows : (p, q, c)
        No unit, m/rad or rad/m.
    force : (p, c, m)
        f, N and N·m.
    target : (p, q, m)
        m and rad.

    Raises
    ------
    MechanismError, NumericalError
        The stiffness is not positive definite on the null space of the rows.
    """
    diagonal = np.einsum("pii->pi", stiffness)
    # below this share of the largest a stiffness is round-off of a coordinate that has none
    present = diagonal > 1e-13 * diagonal.max(axis=1, keepdims=True, initial=0.0)
    typical = (
        np.nanmedian(np.where(present, diagonal, np.nan), axis=1, keepdims=True)
        if present.any(axis=1).all()
        else np.ones((len(stiffness), 1))
    )
    scale = 1.0 / np.sqrt(np.where(present, diagonal, typical))
    k = stiffness * scale[:, :, None] * scale[:, None, :]
    f = force * scale[..., None]
    if rows.shape[1] == 0:
        return np.asarray(scale[..., None] * _definite_solve(system, k, f))
    c = rows * scale[:, None, :]
    size = np.linalg.norm(c, axis=-1, keepdims=True)
    size = np.where(size == 0, 1.0, size)
    _, values, right = np.linalg.svd(c / size)
    count = values.shape[-1]
    keep = np.zeros(right.shape[:2], dtype=bool)
    keep[:, :count] = values > RANK_TOLERANCE * np.maximum(values[:, :1], 1e-30)
    start = np.linalg.pinv(c / size, rcond=RANK_TOLERANCE) @ (target / size)
    null = np.swapaxes(right, -1, -2) * ~keep[:, None, :]
    inner = symmetric_product(null, k)
    inner[:, range(inner.shape[1]), range(inner.shape[1])] += keep
    turned = np.swapaxes(null, -1, -2) @ (f - k @ start)
    solution = start + null @ _definite_solve(system, inner, turned)
    return np.asarray(scale[..., None] * solution)


def _definite_solve(system: System, matrix: Array, right: Array) -> Array:
    try:
        # Cholesky proves that the matrix is positive definite
        np.linalg.cholesky(matrix)
        solution = np.linalg.solve(matrix, right)
        solution += np.linalg.solve(matrix, right - matrix @ solution)
    except np.linalg.LinAlgError as error:
        values = np.linalg.eigvalsh(matrix)[:, 0]
        raise mechanism_error(system, int(values.argmin())) from error
    return np.asarray(solution)


def multipliers(system: System, displacements: Array, load: Array) -> Array:
    """Multipliers that balance the structure, (p, r, m): the least solution of Aᵀ λ = F − K u.

    Parameters
    ----------
    system : System
    displacements : (p, n, m)
        u, m and rad.
    load : (p, n, m)
        F, N and N·m.
    """
    rows = orthonormal_rows(system)
    d = scales(system)[..., None]
    unbalanced = (load - system.stiffness @ displacements) * d
    return rows.multipliers(rows.basis @ unbalanced)
