"""Lowest modes of one large structure by shift-invert Lanczos."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from strutwork.errors import MechanismError, ModelError, NumericalError
from strutwork.fea.factorize import Factor, factorize
from strutwork.fea.sparse_reduction import SparseReduced
from strutwork.fea.stability import critical_factor_sparse, unstable
from strutwork.msa.diagnosis import mechanism_error

Array = NDArray[Any]

#: Independent coordinates above which one pose is solved sparse.
SPARSE_FROM = 1200

#: Share of the lowest flexible ω² by which the shift of a floating structure lies below zero.
SHIFT = 0.1

#: A shift between these multiples of the lowest flexible ω² is used as it is.
SUITABLE = (1e-4, 10.0)

#: Residual of a mode in shift-invert form, a bound of the relative error of ω² + shift.
RESIDUAL = 1e-7

#: Eigenvalues closer than this share count as equal.
EQUAL = 1e-7


@dataclass(frozen=True)
class LowestModes:
    """Lowest modes of a sparse pencil.

    Parameters
    ----------
    frequencies : (m,)
        Hz, rigid-body modes first with zero.
    vectors : (c, m)
        Mass-normalised, 1/√kg.
    solver : str
    """

    frequencies: Array
    vectors: Array
    solver: str


def lanczos_suits(reduced: SparseReduced, count: int) -> bool:
    """Whether the modes asked for are few enough for Lanczos.

    Parameters
    ----------
    reduced : SparseReduced
    count : int
        Modes, rigid-body modes included.
    """
    massive = int(np.count_nonzero(reduced.mass.diagonal() > 0))
    return 3 * count <= min(massive, reduced.size)


def sparse_modes(reduced: SparseReduced, count: int) -> LowestModes:
    """Lowest modes of one pose.

    Rigid-body modes come from the kinematics and are kept out of the iteration. A floating
    structure is factorised at a small negative shift, chosen from a first estimate of its
    lowest flexible frequency: at zero its stiffness is singular, and one of a pair of equal
    frequencies gets lost. Lanczos' method may miss copies of an equal frequency, so
    the iteration is repeated without what it found, until nothing lower appears.

    Parameters
    ----------
    reduced : SparseReduced
    count : int
        Rigid-body modes included.

    Returns
    -------
    LowestModes

    Raises
    ------
    ModelError
        More modes than a third of those that have mass.
    MechanismError, NumericalError
        No convergence, a residual that is not small, or a stiffness that is not positive.
    """
    if not lanczos_suits(reduced, count):
        raise ModelError(
            "sparse modes",
            f"{count} of {reduced.size} are too many for Lanczos' method.",
            "Request fewer than a third, or omit the method.",
        )
    rigid = reduced.rigid[:, :count]
    flexible = count - reduced.rigid.shape[1]
    if reduced.geometric is None:
        if flexible <= 0:
            return LowestModes(np.zeros(count), rigid, "kinematics")
        return _lowest_modes(reduced, flexible)
    try:
        # one flexible mode at least tells whether the structure stands under its preload
        found = _lowest_modes(reduced, max(flexible, 1))
        return LowestModes(found.frequencies[:count], found.vectors[:, :count], found.solver)
    except (MechanismError, NumericalError) as error:
        elastic = sp.csc_array(reduced.stiffness - reduced.geometric)
        share = critical_factor_sparse(elastic, reduced.geometric, reduced.free)
        raise unstable(reduced.system, share, 0) from error


def _lowest_modes(reduced: SparseReduced, flexible: int) -> LowestModes:
    """Rigid-body modes, and as many flexible ones as asked."""
    rigid = reduced.rigid
    shift, factor, solve = _factorised(reduced)
    if reduced.geometric is not None and factor.negative_pivots():
        raise mechanism_error(reduced.system, 0)
    values, vectors = _lanczos(reduced, solve, shift, reduced.rigid, flexible)
    while values.min() > 0.0:
        known = np.concatenate([reduced.rigid, vectors], axis=1)
        more, beside = _lanczos(reduced, solve, shift, known, min(4, flexible), 1e-10)
        missed = more < values.max() * (1.0 - 10.0 * EQUAL)
        if not missed.any():
            break
        values = np.concatenate([values, more[missed]])
        vectors = np.concatenate([vectors, beside[:, missed]], axis=1)
        order = np.argsort(values, kind="stable")[:flexible]
        values, vectors = values[order], vectors[:, order]
    if values.min() <= 0.0:
        raise mechanism_error(reduced.system, 0)
    _check(reduced, solve, shift, values, vectors)
    return LowestModes(
        np.concatenate([np.zeros(rigid.shape[1]), np.sqrt(values) / (2.0 * np.pi)]),
        np.concatenate([rigid, vectors], axis=1),
        f"Lanczos, {factor.name}",
    )


def _factorised(reduced: SparseReduced) -> tuple[float, Factor, Callable[[Array], Array]]:
    """A shift ≥ 0, the factors of K + shift M, and their solution operator."""
    shift = 0.0
    if reduced.rigid.shape[1]:
        stiffness, mass = reduced.stiffness.diagonal(), reduced.mass.diagonal()
        present = (mass > 0) & (stiffness > 1e-12 * stiffness.max())
        if not present.any():
            raise ModelError("sparse modes", "of a structure without stiffness.", "Use dense.")
        # a single coordinate alone vibrates higher than the structure: begin well below it
        shift = 1e-4 * float((stiffness[present] / mass[present]).min())
    factor, solve = _factor(reduced, shift)
    if shift:
        first, _ = _lanczos(reduced, solve, shift, reduced.rigid, 1, 1e-3)
        lowest = float(first[0])
        if lowest > 0 and not SUITABLE[0] * lowest <= shift <= SUITABLE[1] * lowest:
            shift = SHIFT * lowest
            factor, solve = _factor(reduced, shift)
    return shift, factor, solve


def _factor(reduced: SparseReduced, shift: float) -> tuple[Factor, Callable[[Array], Array]]:
    matrix = sp.csc_array(reduced.stiffness + shift * reduced.mass)
    diagonal = matrix.diagonal()
    if not np.all(diagonal > 0):
        raise mechanism_error(reduced.system, 0)
    scale = 1.0 / np.sqrt(diagonal)
    try:
        factor = factorize(sp.csc_array(sp.diags_array(scale) @ matrix @ sp.diags_array(scale)))
    except NumericalError as error:
        raise mechanism_error(reduced.system, 0) from error
    return factor, lambda right: scale * factor.solve(scale * right)


def _lanczos(
    reduced: SparseReduced,
    solve: Callable[[Array], Array],
    shift: float,
    known: Array,
    count: int,
    tolerance: float = 0.0,
) -> tuple[Array, Array]:
    """The `count` lowest ω² and their shapes in the M-orthogonal complement of `known`."""
    mass = reduced.mass
    push = mass @ known

    def without_known(vector: Array) -> Array:
        return np.asarray(vector - known @ (push.T @ vector))

    def inverse(right: Array) -> Array:
        return without_known(solve(np.asarray(right).ravel()))

    random = np.random.default_rng(1).normal(size=reduced.size)
    # a start in the operator's range has no part in motions without mass
    start = inverse(mass @ random)
    vectors_kept = min(max(2 * count + 1, 20), reduced.size - 1)
    try:
        values, vectors = eigsh(
            mass,
            k=count,
            M=mass,
            sigma=-shift,
            OPinv=LinearOperator(mass.shape, matvec=inverse, dtype=float),
            v0=start,
            ncv=vectors_kept,
            tol=tolerance,
        )
    except ArpackNoConvergence as error:
        raise NumericalError(
            "modes", "did not converge.", "Request fewer, or use the dense method."
        ) from error
    order = np.argsort(values, kind="stable")
    return values[order], vectors[:, order]


def _check(
    reduced: SparseReduced,
    solve: Callable[[Array], Array],
    shift: float,
    values: Array,
    vectors: Array,
) -> None:
    """Withhold modes whose residual ‖(K + shift M)⁻¹ M φ (ω² + shift) − φ‖ in M is not small.

    It bounds the relative distance of ω² + shift to an eigenvalue (Parlett 1998, theorem
    4.5.1, in the inner product of M).
    """
    for value, vector in zip(values, vectors.T, strict=True):
        miss = solve(reduced.mass @ vector) * (value + shift) - vector
        size = float(np.sqrt(max(miss @ (reduced.mass @ miss), 0.0)))
        if not size <= RESIDUAL:
            raise NumericalError(
                "modes",
                f"the residual of the mode at {np.sqrt(max(value, 0.0)) / (2 * np.pi):.4g} Hz is "
                f"{size:.2g}, above {RESIDUAL:g}: the modes are withheld.",
                "Stiffnesses or masses differ too much for this precision.",
            )
