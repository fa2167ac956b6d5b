"""Undamped eigenproblem on independent coordinates, for stacks of small systems."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.eigen_work import with_true_work
from strutwork.fea.reduction import Reduced
from strutwork.msa.assembly import System
from strutwork.msa.diagnosis import mechanism_error
from strutwork.msa.null_space import symmetric_product
from strutwork.stages import stage

Array = NDArray[Any]

#: Modes whose ω₁²/ω² is below this have no mass that can be told from rounding.
MASSLESS = 1e-14

#: Cubed coordinates a second of a dense eigenproblem, by which its time is foreseen.
CUBES = 4e8


@dataclass(frozen=True)
class Eigen:
    """All modes of p systems.

    With K φ = ω² M φ written as M ψ = μ K ψ, μ = 1/ω², the modes that matter most are the
    best determined, and parts without mass cost nothing: their μ is zero.

    Parameters
    ----------
    flexibility : (p, c, m)
        ψ, columns normalised to ψᵀ K ψ = 1, ordered by rising frequency.
    square : (p, m)
        μ = 1/ω², s²; zero for motions without mass.
    rigid : (p, c, k)
        Rigid-body modes, normalised to φᵀ M φ = 1, 1/√kg; zero columns where a pose has fewer.
    """

    flexibility: Array
    square: Array
    rigid: Array

    @property
    def circular(self) -> Array:
        """Circular frequencies ω of the flexible modes, rad/s, (p, m); infinite without mass."""
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / np.sqrt(self.square))

    @property
    def finite(self) -> NDArray[np.bool_]:
        """Modes that have mass, (p, m)."""
        return np.asarray(self.square > 0)


def solve_eigen(reduced: Reduced) -> Eigen:
    """All modes of every pose.

    Parameters
    ----------
    reduced : Reduced
        At p poses.

    Raises
    ------
    ModelError
        No mass, or a free motion without mass.
    MechanismError, NumericalError
        The stiffness is not positive definite beside the rigid-body modes, or known too badly.
    """
    mass, stiffness = reduced.mass, reduced.stiffness
    if not np.all(np.einsum("pii->p", mass) > 0):
        raise ModelError(
            "structure", "has no mass.", "Give materials a density, or add masses: modes need them."
        )
    rigid = rigid_modes(
        reduced.system,
        reduced.rigid,
        symmetric_product(reduced.rigid, mass),
        np.einsum("pii->pi", mass).max(axis=1),
    )
    basis = None
    if rigid.shape[-1]:
        if np.any(reduced.rigid_count != rigid.shape[-1]):
            return _one_by_one(reduced)
        # coordinates on which M makes no work with the rigid-body modes
        q, _ = np.linalg.qr(mass @ rigid, mode="complete")
        basis = q[:, :, rigid.shape[-1] :]
        mass = np.swapaxes(basis, -1, -2) @ mass @ basis
        stiffness = np.swapaxes(basis, -1, -2) @ stiffness @ basis
    poses, size = stiffness.shape[:2]
    with stage(f"finds all modes of {size:,} coordinates", poses * size**3 / CUBES):
        vectors, square = _pencil(reduced, stiffness, mass)
    if basis is not None:
        vectors = basis @ vectors
    return Eigen(*with_true_work(reduced, vectors, square), rigid)


def _pencil(reduced: Reduced, stiffness: Array, mass: Array) -> tuple[Array, Array]:
    diagonal = np.einsum("pii->pi", stiffness)
    if np.any(diagonal <= 0):
        raise mechanism_error(reduced.system, int(np.argwhere(diagonal <= 0)[0][0]))
    scale = 1.0 / np.sqrt(diagonal)
    outer = scale[:, :, None] * scale[:, None, :]
    try:
        lower = np.linalg.cholesky(stiffness * outer)
    except np.linalg.LinAlgError as error:
        worst = np.linalg.eigvalsh(stiffness * outer)[:, 0].argmin()
        raise mechanism_error(reduced.system, int(worst)) from error
    inverse = np.linalg.inv(lower)
    product = inverse @ (mass * outer) @ np.swapaxes(inverse, -1, -2)
    values, vectors = np.linalg.eigh((product + np.swapaxes(product, -1, -2)) / 2.0)
    values, vectors = values[:, ::-1], vectors[:, :, ::-1]
    square = np.where(values > MASSLESS * values[:, :1], values, 0.0)
    return scale[..., None] * (np.swapaxes(inverse, -1, -2) @ vectors), square


def rigid_modes(system: System, rigid: Array, gram: Array, largest: Array) -> Array:
    """Rigid motions made orthonormal in the mass, (p, c, k).

    Parameters
    ----------
    system : System
    rigid : (p, c, k)
        Motions that cost no energy, in coordinates, m and rad.
    gram : (p, k, k)
        Their mass, kg.
    largest : (p,)
        Largest mass of a coordinate, kg, beside which the rest is rounding.

    Raises
    ------
    ModelError
        A free motion without mass.
    """
    if rigid.shape[-1] == 0:
        return rigid
    values, vectors = np.linalg.eigh(gram)
    present = np.any(rigid, axis=1).sum(axis=-1)
    order = np.arange(rigid.shape[-1])
    # absent columns have no mass and sort first
    real = order[None, :] >= rigid.shape[-1] - present[:, None]
    largest = np.maximum(values[:, -1], largest * np.abs(rigid).max(axis=(1, 2)) ** 2)
    massless = real & (values <= MASSLESS * largest[:, None])
    if np.any(massless):
        raise ModelError(
            "structure",
            "has a free motion without mass: "
            + str(mechanism_error(system, int(np.argwhere(massless)[0][0]))),
            "Give what moves a mass or an inertia about that axis, or hold it; two dashpots in "
            "series are one, of 1/(1/c₁ + 1/c₂).",
        )
    size = np.where(real, 1.0 / np.sqrt(np.where(values > 0, values, 1.0)), 0.0)
    return np.asarray(rigid @ vectors * size[:, None, :])


def _one_by_one(reduced: Reduced) -> Eigen:
    """Poses with different numbers of rigid-body modes, in groups of one number each."""
    poses, size, most = reduced.rigid.shape
    vectors = np.zeros((poses, size, size))
    square = np.zeros((poses, size))
    rigid = np.zeros((poses, size, most))
    for count in np.unique(reduced.rigid_count):
        chosen = np.flatnonzero(reduced.rigid_count == count)
        part = reduced.at_poses(chosen)
        part = replace(part, rigid=_compressed(part.rigid, int(count)))
        found = solve_eigen(part)
        m = found.square.shape[1]
        vectors[chosen, :, :m] = found.flexibility
        square[chosen, :m] = found.square
        rigid[chosen, :, : int(count)] = found.rigid
    return Eigen(vectors, square, rigid)


def _compressed(rigid: Array, count: int) -> Array:
    present = np.any(rigid, axis=1)
    return np.stack([one[:, mask][:, :count] for one, mask in zip(rigid, present, strict=True)])
