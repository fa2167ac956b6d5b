"""What a preload does to free motions, and whether the structure stands under it."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from strutwork.errors import NumericalError
from strutwork.fea.factorize import factorize
from strutwork.kinematics import mobility
from strutwork.msa.assembly import System

Array = NDArray[Any]

#: A preload that does less than this share of its largest work in a free motion leaves it free.
LEFT_FREE = 1e-9

#: A free motion falls when the preload holds it with less than this share of its largest work.
FALLS = 1e-9


def motions_left_free(free: Array, push: Array, size: Array) -> Array:
    """The free motions on which a preload acts with no force, (p, c, k), zero columns for others.

    Parameters
    ----------
    free : (p, c, k)
        Motions that cost no elastic energy, as unit coordinates, no unit; zero columns where a pose
        has fewer.
    push : (p, n, k)
        Generalised forces of the preload in them, per unit coordinate, N/m.
    size : (p,)
        Largest entry of the geometric stiffness of any part, N/m.
    """
    k = free.shape[-1]
    if k == 0:
        return free
    # columns that a pose does not have must not be taken for motions without force
    absent = ~np.any(free, axis=1)
    scale = np.where(size > 0, size, 1.0)[:, None, None]
    whole = np.concatenate([push / scale, absent[:, :, None] * np.eye(k)], axis=1)
    _, values, right = np.linalg.svd(whole, full_matrices=False)
    left = values <= LEFT_FREE
    return np.asarray(free @ (np.swapaxes(right, -1, -2) * left[:, None, :]))


def without_elastic_work(stiffness: Array, free: Array) -> Array:
    """Elastic stiffness (p, c, c) with exactly none in free motions, where rounding leaves some.

    Beside the stiffness of a machine the weight of what swings is small.

    Parameters
    ----------
    stiffness : (p, c, c)
        N/m, N, N·m/rad.
    free : (p, c, k)
        Motions that cost no elastic energy, in coordinates of any unit; zero columns where a pose
        has fewer.
    """
    back = np.linalg.pinv(free)
    rest = stiffness @ free
    cross = rest @ back
    within = np.swapaxes(back, -1, -2) @ (np.swapaxes(free, -1, -2) @ rest) @ back
    return np.asarray(stiffness - cross - np.swapaxes(cross, -1, -2) + within)


def check_stable(
    system: System,
    elastic: Array,
    geometric: Array,
    free: Array,
    rigid: Array,
    absent: NDArray[np.bool_],
) -> None:
    """Check that a structure stands under its preload.

    Parameters
    ----------
    system : System
    elastic, geometric : (p, c, c)
        N/m, N, N·m/rad.
    free : (p, c, k)
        Motions that cost no elastic energy, in coordinates of any unit.
    rigid : (p, c, k)
        Those among them that stay free, in the same unit.
    absent : (p, c)
        Coordinates that a pose does not have.

    Raises
    ------
    NumericalError
        Names the share of the preload at which it buckles, or the joints at which it falls.
    """
    whole = elastic + geometric
    diagonal = np.einsum("pii->pi", elastic) + np.abs(np.einsum("pii->pi", geometric))
    scale = 1.0 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    stiff = whole * scale[:, :, None] * scale[:, None, :]
    # what stays free is held by a unit stiffness here, to leave only what can buckle
    held = rigid / scale[..., None]
    held, values, _ = np.linalg.svd(held, full_matrices=False)
    held = held * (values > 1e-12 * np.maximum(values[:, :1], 1e-300))[:, None, :]
    stiff = stiff + held @ np.swapaxes(held, -1, -2) + absent[:, :, None] * np.eye(stiff.shape[-1])
    try:
        np.linalg.cholesky(stiff)
    except np.linalg.LinAlgError:
        pose = int(np.linalg.eigvalsh(stiff)[:, 0].argmin())
        factor = critical_factor(elastic[pose], geometric[pose], free[pose], rigid[pose])
        raise unstable(system, factor, pose) from None


def critical_factor(elastic: Array, geometric: Array, free: Array, rigid: Array) -> float:
    """Share of a preload at which the stiffness loses its positivity; 0 if a free motion falls.

    With the free motions that the preload itself holds condensed, the least α of
    (K + α G) x = 0.

    Parameters
    ----------
    elastic, geometric : (c, c)
        K and G of one pose, N/m, N, N·m/rad.
    free : (c, k)
        Motions that cost no elastic energy, in coordinates of any unit.
    rigid : (c, k)
        Those among them that stay free, in the same unit; zero columns for others.
    """
    # without coordinates that the pose does not have
    here = np.any(elastic, axis=0) | np.any(geometric, axis=0)
    k, g = elastic[here][:, here], geometric[here][:, here]
    diagonal = np.diag(k) + np.abs(np.diag(g))
    scale = 1.0 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    k, g = (m * scale[:, None] * scale for m in (k, g))
    every = _span(free[here] / scale[:, None])
    left = _span(rigid[here] / scale[:, None])
    swings = _span(every - left @ (left.T @ every))
    stiff = la.null_space(np.concatenate([every, np.zeros((len(k), 1))], axis=1).T)
    cross, own = stiff.T @ g @ swings, swings.T @ g @ swings
    k, bent = stiff.T @ k @ stiff, stiff.T @ g @ stiff
    if swings.shape[1]:
        if la.eigvalsh(own)[0] <= FALLS * np.abs(g).max():
            return 0.0
        bent = bent - cross @ la.solve(own, cross.T, assume_a="pos")
    try:
        most = float(la.eigh(-(bent + bent.T) / 2, (k + k.T) / 2, eigvals_only=True)[-1])
    except la.LinAlgError:
        return 0.0
    return 1.0 / most if most > 0 else 0.0


def _span(columns: Array) -> Array:
    """Orthonormal basis of unit-sized columns' span, absent and cancelled ones left out."""
    size = np.linalg.norm(columns, axis=0)
    present = columns[:, size > 1e-6 * size.max(initial=0.0)]
    if not present.size or size.max() < 1e-6:
        return np.zeros((len(columns), 0))
    left, values, _ = np.linalg.svd(present / np.linalg.norm(present, axis=0), full_matrices=False)
    return np.asarray(left[:, values > 1e-6])


def critical_factor_sparse(elastic: sp.csc_array, geometric: sp.csc_array, free: int) -> float:
    """As `critical_factor`, for a large structure whose last coordinates are its free motions.

    Parameters
    ----------
    elastic, geometric : (c, c) sparse
        K and G, N/m, N, N·m/rad.
    free : int
        Number of those coordinates.
    """
    n = elastic.shape[0] - free
    cross, own = geometric[:n, n:].toarray(), geometric[n:, n:].toarray()
    values, turn = la.eigh((own + own.T) / 2) if free else (np.zeros(0), np.zeros((0, 0)))
    largest = float(abs(geometric).max())
    cross = cross @ turn
    swings = values > FALLS * largest
    if np.any(values < -FALLS * largest) or np.any(
        np.abs(cross[:, ~swings]) > np.sqrt(FALLS) * largest
    ):
        return 0.0
    bent, give = geometric[:n, :n], cross[:, swings] / values[swings]

    def press(vector: Array) -> Array:
        return np.asarray(give @ (cross[:, swings].T @ vector) - bent @ vector)

    held = sp.csc_array(elastic[:n, :n])
    try:
        found = eigsh(
            LinearOperator(held.shape, matvec=press, dtype=float),
            k=1,
            M=held,
            Minv=LinearOperator(held.shape, matvec=factorize(held).solve, dtype=float),
            which="LA",
            return_eigenvectors=False,
            v0=np.random.default_rng(1).normal(size=n),
        )
    except (NumericalError, ArpackNoConvergence):
        return 0.0
    return 1.0 / float(found[0]) if found[0] > 0 else 0.0


def unstable(system: System, factor: float, pose: int) -> NumericalError:
    """The error for a structure that does not stand under its preload.

    Parameters
    ----------
    system : System
    factor : float
        Share of the preload at which it buckles; zero where it falls.
    pose : int
        Its place in the batch.
    """
    stiffening = system.placed.stiffening
    case = "" if stiffening is None else stiffening.case
    where = f" at pose {pose}" if system.poses > 1 else ""
    if factor > 0:
        return NumericalError(
            "structure",
            f'buckles under its preload "{case}"{where}: the critical load is {factor:.4g} of it.',
            (
                "Lower the preload, stiffen the parts in compression, or check the sign: tension "
                "is positive."
            ),
        )
    linkage = system.placed.structure.linkage
    found = mobility(linkage, system.placed.placement[pose])
    names = dict.fromkeys(
        f"{joint} in {direction}" for motion in found.motions for joint, direction in motion.joints
    )
    part = "joints " + ", ".join(names) if names else "structure"
    return NumericalError(
        part,
        f'the structure collapses under its preload "{case}"{where}: it is not stable in a motion '
        "that no stiffness resists, however small the load.",
        "Lock, drive or spring one of these directions, or reverse the load.",
    )
