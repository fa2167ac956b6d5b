"""Block rational Krylov reduction of large models by moment matching.

The response to loads B at the frequency ω is spanned, about an expansion ω₀, by
S⁻¹B, S⁻¹M S⁻¹B, S⁻¹M S⁻¹M S⁻¹B, ... with S = K − ω₀²M. Shares of K and M in the damping do not
change these spaces, and single dampers are loads at their ports: with the ports among the loads
the spaces hold the damped response too, and stay real. Projection keeps the matrices symmetric,
and matches twice as many moments as it takes blocks.

Sources: Freund (2000), Journal of Computational and Applied Mathematics 123, 395; Bai (2002),
Applied Numerical Mathematics 43, 9; Beattie and Gugercin (2005), interpolatory projection of
second-order systems, IEEE CDC.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from strutwork.errors import ModelError, NumericalError, ValidityWarning
from strutwork.fea.block_krylov_basis import Array, EnergyBasis
from strutwork.fea.block_krylov_damping import MatrixDamping
from strutwork.fea.block_krylov_reduced import KrylovModel
from strutwork.fea.block_krylov_search import Search
from strutwork.fea.factorize import Factor, factorize

#: Share of the band's end at which a floating structure is expanded, on the negative side of ω².
FLOATING = 0.1

#: Least quotient of the first mode's ω² and the band's for a structure to be held.
HELD = 1e-8


@dataclass(frozen=True)
class KrylovOptions:
    """How a reduction runs.

    Parameters
    ----------
    tolerance : float
        Largest error of a line's receptance, Frobenius norm over Frobenius norm: kept at every
        line where damping has a share of K or M, otherwise estimated (`KrylovModel.errors`).
    expansions : tuple of float
        Frequencies about which moments match, Hz. The first is zero; each further one costs a
        factorisation.
    floating : bool
        Whether the structure has rigid-body modes: the first expansion then lies at a small
        negative ω².
    solver : str, optional
        As `strutwork.fea.factorize.factorize`.
    most : int
        Vectors at which it gives up.

    Raises
    ------
    ModelError
        Values out of range.
    """

    tolerance: float = 1e-8
    expansions: tuple[float, ...] = (0.0,)
    floating: bool = False
    solver: str | None = None
    most: int = 400

    def __post_init__(self) -> None:
        if not 1e-14 < self.tolerance < 1:
            raise ModelError(
                "Krylov reduction", f"tolerance is {self.tolerance!r}.", "Give one below 1."
            )
        if not self.expansions or self.expansions[0] != 0 or min(self.expansions) < 0:
            raise ModelError(
                "Krylov reduction",
                f"expansions are {self.expansions}.",
                "Give zero first, and no negative ones.",
            )


def krylov_reduction(
    stiffness: sp.csc_array,
    mass: sp.csc_array,
    ports: Array,
    band: tuple[float, float],
    damping: MatrixDamping | None = None,
    options: KrylovOptions | None = None,
    factor: Factor | None = None,
) -> KrylovModel:
    """Reduce a model to the motions that loads at its ports bring about in a band.

    Blocks are added until the error is small enough at every line of the band. With the residual
    R of the full system, the receptance is wrong by Rᵀ Z⁻¹ R; the next block gives the norm of R
    at all lines (`strutwork.fea.block_krylov_residual`), and damping bounds Z⁻¹. Lines are added
    where the error is largest between them, and at the worst ones the residual is formed in full.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse
        N/m and kg, symmetric; the stiffness positive definite but for rigid-body modes.
    ports : (n, m)
        Load on each dof per unit at each port, no unit; observed there too.
    band : (float, float)
        Hz.
    damping : MatrixDamping, optional
    options : KrylovOptions, optional
    factor : Factor, optional
        Factors of the stiffness at hand, for a structure that does not float.

    Returns
    -------
    KrylovModel

    Raises
    ------
    ModelError
        A band, ports or a factor that do not fit.
    NumericalError
        A structure that floats unsaid, or a tolerance that is not reached.

    Warns
    -----
    ValidityWarning
        The error is an estimate and no bound: no damping with a share of K or M, or damping that
        feeds power in (`KrylovModel.proven`).
    """
    options = options or KrylovOptions()
    damping = damping or MatrixDamping()
    low, high = band
    if not (np.isfinite(high) and 0 <= low < high):
        raise ModelError("Krylov reduction", f"band is {band}.", "Give 0 ≤ low < high, Hz.")
    if ports.ndim != 2 or ports.shape[0] != stiffness.shape[0] or not np.all(np.any(ports, axis=0)):
        raise ModelError(
            "Krylov reduction",
            f"ports of shape {ports.shape} for {stiffness.shape[0]} dofs, or a port without load.",
            "Give one column for each port, none of them zero.",
        )
    if options.floating and low == 0:
        raise ModelError(
            "Krylov reduction",
            f"of a floating structure in the band {band}: it has no receptance at zero.",
            "Give low above zero, Hz.",
        )
    if factor is not None and options.floating:
        raise ModelError("Krylov reduction", "floats, with a factor given.", "Give no factor.")
    shift = (2.0 * np.pi * FLOATING * high) ** 2 if options.floating else 0.0
    if factor is None:
        factor = factorize(sp.csc_array(stiffness + shift * mass), options.solver)
    basis = EnergyBasis(stiffness, mass, shift, options.most)
    loads = ports if damping.ports is None else np.concatenate([ports, damping.ports], axis=1)
    search = Search(basis, ports, damping, factor, (low, high), options.tolerance)
    seeds = [factor.solve]
    for frequency in options.expansions[1:]:
        moved = sp.csc_array(stiffness - (2.0 * np.pi * frequency) ** 2 * mass)
        seeds.append(factorize(moved, options.solver, positive=False).solve)
    starts = [basis.grow(loads, solve(loads)) for solve in seeds]
    if not options.floating:
        _require_held(basis, starts[0], high)
    found = search.extend(seeds, starts)
    if not found.residual.proven:
        warnings.warn(
            f"Krylov reduction: its error, {found.error:.1e}, is an estimate and no bound, because "
            "its damping has no share of the stiffness or the mass, or feeds power in. A resonance "
            "that the ports hardly excite may be missing. Give it such a share, however small, or "
            "compare lines with a direct solution.",
            ValidityWarning,
            stacklevel=2,
        )
    return KrylovModel(
        basis.vectors.copy(),
        found.small,
        found.residual,
        options.expansions,
        shift,
        (low, high),
        found.error,
        found.worst,
        options.tolerance,
        factor.name,
        str(damping),
    )


def _require_held(basis: EnergyBasis, block: slice, high: float) -> None:
    """The energy's Rayleigh quotients of the first block tell a structure that floats."""
    mass = np.einsum("ij,ij->j", basis.vectors[:, block], basis.push[:, block])
    if mass.max(initial=0.0) * HELD * (2.0 * np.pi * high) ** 2 > 1.0:
        raise NumericalError(
            "Krylov reduction",
            "was given a structure that floats.",
            "Hold it, or state it: KrylovOptions(floating=True).",
        )
