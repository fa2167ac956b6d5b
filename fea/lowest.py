"""The few lowest natural frequencies of many poses."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.eigen import MASSLESS, solve_eigen
from strutwork.fea.eigen_work import with_true_work
from strutwork.fea.modes import CHUNK, lowest
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.msa.assembly import system_of
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: Residual, as a share of the largest eigenvalue, at which the subspace has converged.
CONVERGED = 1e-12

#: Rounds of subspace iteration before a pose is solved whole.
ROUNDS = 8

#: Vectors of a subspace at least: the lowest modes of a machine with six legs are close.
VECTORS = 16


def natural_frequencies(placed: PlacedStructure, count: int = 10) -> tuple[Array, Array]:
    """Lowest frequencies and mode shapes in independent coordinates, nothing more.

    Subspace iteration with the fourth power of L⁻¹ M L⁻ᵀ (K = L Lᵀ), checked by its residual at
    every pose; those that do not converge, and a stack that floats or is small, are solved whole.

    Parameters
    ----------
    placed : PlacedStructure
    count : int
        Modes, rigid-body modes included.

    Returns
    -------
    frequencies : (..., count)
        Hz, ascending; infinite where a pose has fewer.
    vectors : (..., c, count)
        Mass-normalised, in the coordinates of `strutwork.fea.reduction.reduce_system`.

    Raises
    ------
    ModelError
        A count below one, no mass, or every direction locked.
    NumericalError
        Modes whose strain energy is not certain (`strutwork.fea.eigen_work`); names the pose.
    """
    if count < 1:
        raise ModelError("frequencies", f"{count} asked for.", "Request at least one.")
    system = system_of(placed)
    found = [
        _lowest(reduce_system(system_of(system.placed[start : start + CHUNK])), count)
        for start in range(0, system.poses, CHUNK)
    ]
    frequencies, vectors = (np.concatenate(arrays) for arrays in zip(*found, strict=True))
    batch = placed.batch
    return (
        frequencies.reshape((*batch, *frequencies.shape[1:])),
        vectors.reshape((*batch, *vectors.shape[1:])),
    )


def _lowest(reduced: Reduced, count: int) -> tuple[Array, Array]:
    block = max(2 * count + 4, VECTORS)
    small = reduced.size < 3 * block
    found = None if small or reduced.rigid.shape[-1] else _subspace(reduced, count, block)
    return lowest(solve_eigen(reduced), count) if found is None else found


def _subspace(reduced: Reduced, count: int, block: int) -> tuple[Array, Array] | None:
    diagonal = np.einsum("pii->pi", reduced.stiffness)
    if np.any(diagonal <= 0) or np.any(np.einsum("pii->p", reduced.mass) <= 0):
        return None
    scale = 1.0 / np.sqrt(diagonal)
    outer = scale[:, :, None] * scale[:, None, :]
    try:
        lower = np.linalg.cholesky(reduced.stiffness * outer)
    except np.linalg.LinAlgError:
        return None
    inverse = np.linalg.inv(lower)
    product = inverse @ (reduced.mass * outer) @ np.swapaxes(inverse, -1, -2)
    square = product @ product
    fourth = square @ square
    # any start with a part in every mode will do; a fixed one makes results repeatable
    start = np.random.default_rng(20140).normal(size=(reduced.size, block))
    vectors = np.linalg.qr(fourth @ start)[0]
    values = np.zeros((len(product), count))
    ritz = np.zeros((*product.shape[:2], count))
    done = np.zeros(len(product), dtype=bool)
    for _ in range(ROUNDS):
        vectors = np.linalg.qr(fourth @ vectors)[0]
        image = product @ vectors
        found, turn = np.linalg.eigh(np.swapaxes(vectors, -1, -2) @ image)
        found, turn = found[:, : -count - 1 : -1], turn[:, :, : -count - 1 : -1]
        turned = vectors @ turn
        residual = np.abs(image @ turn - turned * found[:, None, :]).max(axis=(1, 2))
        if np.any(found <= MASSLESS * found[:, :1]):
            # fewer modes than asked: what is left has no mass
            return None
        # each pose keeps what it converged to, whatever poses are solved beside it
        now = ~done & (residual <= CONVERGED * found[:, 0])
        values[now], ritz[now] = found[now], turned[now]
        done |= now
        if done.all():
            break
    if not done.any():
        return None
    shapes = scale[..., None] * (np.swapaxes(inverse, -1, -2) @ ritz)
    shapes, values = with_true_work(reduced, shapes, values)
    omega = 1.0 / np.sqrt(np.where(done[:, None], values, 1.0))
    frequencies, shapes = omega / (2.0 * np.pi), shapes * omega[:, None, :]
    if not done.all():
        rest = lowest(solve_eigen(reduced.at_poses(np.flatnonzero(~done))), count)
        frequencies[~done], shapes[~done] = rest
    return frequencies, shapes
