"""Lowest modes of a large pencil by block Lanczos with one factorisation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.block_krylov_basis import EnergyBasis
from strutwork.fea.factorize import Factor, factorize
from strutwork.fea.petsc import Ranks, slepc_modes

Array = NDArray[Any]

#: Vectors a block holds: the multiplicity up to which no copy of a frequency is missed.
HELD_BLOCK, FLOATING_BLOCK = 4, 8

#: Residual of a mode in shift-invert form, relative, in energy: the square of it bounds the
#: relative error of ω² + shift but for the gap to the next.
RESIDUAL = 1e-7

#: A floating structure's shift lies between these multiples of its lowest flexible ω².
SUITABLE = (1e-5, 10.0)

#: The shift that is taken where the first does not suit.
SHIFT = 0.1

#: Share of the shift below which an ω² is that of a rigid-body mode.
RIGID = 1e-7

#: Steps after which it gives up, in multiples of what the modes would fill.
PATIENCE = 30


@dataclass(frozen=True)
class LargeModes:
    """Lowest modes of K φ = ω² M φ.

    Parameters
    ----------
    frequencies : (m,)
        Hz, rising; rigid-body modes are zero.
    vectors : (n, m)
        Mass-normalised, 1/√kg.
    residuals : (m,)
        ‖(K + shift M)⁻¹ M φ (ω² + shift) − φ‖ over ‖φ‖, in the energy of K + shift M; no unit.
    shift : float
        Of ω², rad²/s².
    factor : Factor or None
        Of K + shift M, for more solutions; None where the work was done elsewhere.
    solver : str
        What ran.
    """

    frequencies: Array
    vectors: Array
    residuals: Array
    shift: float
    factor: Factor | None
    solver: str

    def __repr__(self) -> str:
        return (
            f"<LargeModes: {len(self.frequencies)} of {len(self.vectors):,} dofs, "
            f"{self.frequencies[0]:.4g} to {self.frequencies[-1]:.4g} Hz, {self.solver}>"
        )


def lowest_modes(
    stiffness: sp.csc_array,
    mass: sp.csc_array,
    count: int,
    *,
    floating: bool = False,
    solver: str | None = None,
    counted: bool = False,
    ranks: Ranks | None = None,
) -> LargeModes:
    """Lowest modes of one large structure.

    Block Lanczos with full orthogonalisation in the energy of K + shift M and no restarts:
    a block's solutions cost little more than one, and copies of a frequency come together.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse
        N/m and kg, symmetric; the stiffness positive definite but for rigid-body modes.
    count : int
        Rigid-body modes included.
    floating : bool
        Whether the structure has rigid-body modes.
    solver : str, optional
        As `strutwork.fea.factorize.factorize`, or "slepc": the work is shared by processes under
        MPI.
    counted : bool
        Prove by Sylvester's law of inertia that none was missed; costs another factorisation.
    ranks : Ranks, optional
        For "slepc": how many processes, started how; two by default.

    Returns
    -------
    LargeModes

    Raises
    ------
    ModelError
        More modes than a third of the dofs, or a solver that cannot run.
    NumericalError
        No convergence, a stiffness that is not positive, memory that does not suffice, or a
        count that shows a missed mode.

    Notes
    -----
    Source: Grimes, Lewis and Simon (1994), SIAM Journal on Matrix Analysis and Applications
    15, 228.
    """
    n = stiffness.shape[0]
    if not 1 <= count <= n // 3:
        raise ModelError(
            "lowest modes", f"{count} of {n} dofs.", "Request from one to a third of the dofs."
        )
    shift = _first_shift(stiffness, mass) if floating else 0.0
    if solver == "slepc":
        return _slepc(stiffness, mass, count, shift, ranks or Ranks())
    factor = _factor(stiffness, mass, shift, solver)
    block = FLOATING_BLOCK if floating else HELD_BLOCK
    if floating:
        lowest = _lowest_flexible(stiffness, mass, shift, factor, block)
        if not SUITABLE[0] * lowest <= shift <= SUITABLE[1] * lowest:
            shift = SHIFT * lowest
            factor = _factor(stiffness, mass, shift, solver)
    square, vectors, residuals = _lanczos(stiffness, mass, shift, factor, count, block)
    if square[0] < -RIGID * shift or (not floating and square[0] <= 0):
        raise NumericalError(
            "lowest modes", "of a stiffness that is not positive.", "Check supports and springs."
        )
    if counted:
        _count(stiffness, mass, square, shift, solver)
    square = np.where(square > RIGID * shift, square, 0.0)
    return LargeModes(
        np.sqrt(square) / (2.0 * np.pi),
        vectors,
        residuals,
        shift,
        factor,
        f"block Lanczos, {factor.name}",
    )


def _slepc(
    stiffness: sp.csc_array, mass: sp.csc_array, count: int, shift: float, ranks: Ranks
) -> LargeModes:
    square, vectors, name = slepc_modes(stiffness, mass, count, shift, ranks)
    push = mass @ vectors
    miss = stiffness @ vectors - square * push
    residuals = np.linalg.norm(miss, axis=0) / np.linalg.norm((square + shift) * push, axis=0)
    square = np.where(square > max(RIGID * shift, 0.0), square, 0.0)
    return LargeModes(np.sqrt(square) / (2.0 * np.pi), vectors, residuals, shift, None, name)


def _first_shift(stiffness: sp.csc_array, mass: sp.csc_array) -> float:
    """A dof alone vibrates far above the structure."""
    k, m = stiffness.diagonal(), mass.diagonal()
    present = (m > 0) & (k > 1e-12 * k.max())
    if not present.any():
        raise ModelError("lowest modes", "of a structure without mass.", "Give a density.")
    return 1e-4 * float((k[present] / m[present]).min())


def _factor(
    stiffness: sp.csc_array, mass: sp.csc_array, shift: float, solver: str | None
) -> Factor:
    return factorize(sp.csc_array(stiffness + shift * mass) if shift else stiffness, solver)


def _lowest_flexible(
    stiffness: sp.csc_array, mass: sp.csc_array, shift: float, factor: Factor, block: int
) -> float:
    """An estimate of the lowest ω² that is not a rigid-body mode's."""
    square, _, _ = _lanczos(stiffness, mass, shift, factor, 7, block, residual=1e-2)
    flexible = square[square > 1e-4 * shift]
    return float(flexible[0]) if len(flexible) else shift


def _lanczos(
    stiffness: sp.csc_array,
    mass: sp.csc_array,
    shift: float,
    factor: Factor,
    count: int,
    block: int,
    residual: float = RESIDUAL,
) -> tuple[Array, Array, Array]:
    """Lowest ω², mass-normalised vectors and residuals."""
    n = stiffness.shape[0]
    basis = EnergyBasis(stiffness, mass, shift, min(n, max(PATIENCE * block, 12 * count)))
    # a start in the operator's range has no part in motions without mass
    loads = mass @ np.random.default_rng(1).normal(size=(n, min(block, n)))
    last = basis.grow(loads, factor.solve(loads))
    while True:
        known = basis.size
        push = basis.push[:, last]
        new = basis.grow(push, factor.solve(push))
        values, turn = np.linalg.eigh(basis.vectors[:, :known].T @ basis.push[:, :known])
        values, turn = values[::-1][:count], turn[:, ::-1][:, :count]
        coupling = basis.vectors[:, new].T @ push
        with np.errstate(divide="ignore", invalid="ignore"):
            residuals = np.linalg.norm(coupling @ turn[last], axis=0) / np.abs(values)
        done = new.stop == new.start
        if len(values) == count and (done or np.all(residuals <= residual)):
            break
        if done or basis.size == basis.most:
            raise NumericalError(
                "lowest modes",
                f"did not converge with {known} vectors.",
                "Request fewer; the structure may have fewer modes with mass.",
            )
        last = new
    if values.min() <= 0:
        raise NumericalError(
            "lowest modes", "has fewer modes with mass than requested.", "Ask for fewer."
        )
    shapes = basis.vectors[:, :known] @ turn / np.sqrt(values)
    return 1.0 / values - shift, shapes, residuals


def _count(
    stiffness: sp.csc_array, mass: sp.csc_array, square: Array, shift: float, solver: str | None
) -> None:
    """Compare the number of eigenvalues below the last gap with the modes found there."""
    gaps = np.diff(square) > 1e-4 * (np.abs(square[1:]) + shift)
    if not gaps.any():
        raise NumericalError("lowest modes", "are all equal: none can be counted.", "Ask for more.")
    below = int(np.flatnonzero(gaps)[-1]) + 1
    middle = float(square[below - 1] + square[below]) / 2.0
    moved = factorize(sp.csc_array(stiffness - middle * mass), solver, positive=False)
    found = moved.negative_pivots()
    if found != below:
        raise NumericalError(
            "lowest modes",
            f"{below} were found below {np.sqrt(middle) / (2 * np.pi):.4g} Hz, where there are "
            f"{found}.",
            "Request another number of modes.",
        )
