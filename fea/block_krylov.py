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

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.block_krylov_basis import EnergyBasis
from strutwork.fea.block_krylov_damping import MatrixDamping
from strutwork.fea.block_krylov_model import KrylovModel, SmallModel
from strutwork.fea.factorize import Factor, factorize

Array = NDArray[Any]
Solve = Callable[[Array], Array]

#: Share of the band's end at which a floating structure is expanded, on the negative side of ω².
FLOATING = 0.1

#: Lines on which successive bases are compared.
COMPARED = 200

#: Lines whose residual is taken.
CHECKED = 2

#: Least quotient of the first mode's ω² and the band's for a structure to be held.
HELD = 1e-8


@dataclass(frozen=True)
class KrylovOptions:
    """How a reduction runs.

    Parameters
    ----------
    tolerance : float
        Largest error of a line's receptance, Frobenius norm over Frobenius norm.
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

    Blocks are added until the error is small enough: successive bases are compared over the
    band, then the residual R of the worst lines is taken, and with it the error Rᵀ Z⁻¹ R of
    the receptance, in which the expansion's factors stand for Z.

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
    if factor is not None and options.floating:
        raise ModelError("Krylov reduction", "floats, with a factor given.", "Give no factor.")
    shift = (2.0 * np.pi * FLOATING * high) ** 2 if options.floating else 0.0
    if factor is None:
        factor = factorize(sp.csc_array(stiffness + shift * mass), options.solver)
    basis = EnergyBasis(stiffness, mass, shift, options.most)
    loads = ports if damping.ports is None else np.concatenate([ports, damping.ports], axis=1)
    search = _Search(basis, ports, damping, factor, (low, high), options.tolerance)
    seeds = [factor.solve]
    for frequency in options.expansions[1:]:
        moved = sp.csc_array(stiffness - (2.0 * np.pi * frequency) ** 2 * mass)
        seeds.append(factorize(moved, options.solver, positive=False).solve)
    starts = [basis.grow(loads, solve(loads)) for solve in seeds]
    if not options.floating:
        _require_held(basis, starts[0], high)
    error, worst = search.extend(seeds, starts)
    return KrylovModel(
        basis.vectors.copy(),
        search.small(),
        options.expansions,
        shift,
        (low, high),
        error,
        worst,
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


@dataclass
class _Search:
    """Adds blocks until the error is small."""

    basis: EnergyBasis
    ports: Array
    damping: MatrixDamping
    factor: Factor
    band: tuple[float, float]
    tolerance: float
    _damped: tuple[Array, Array] = field(init=False)

    def small(self) -> SmallModel:
        """The projected matrices."""
        b = self.basis
        v = b.vectors
        viscous, structural = self.damping.apply(b.force, b.push, v)
        self._damped = (viscous, structural)
        k, m, c, d = (
            (x + x.T) / 2.0 for x in (v.T @ y for y in (b.force, b.push, viscous, structural))
        )
        factors = (
            self.damping.loss_factor,
            self.damping.mass_rate,
            self.damping.stiffness_time,
        )
        return SmallModel(k, m, c, d, v.T @ self.ports, self.damping.proportional, factors)

    def extend(self, solves: Sequence[Solve], blocks: list[slice]) -> tuple[float, float]:
        """Error and frequency of the worst line, once it is below the tolerance."""
        before = self.small()
        enrich = self.damping.viscous is not None or self.damping.structural is not None
        lines = np.linspace(*self.band, COMPARED)
        error, worst, last = np.inf, lines[0], np.inf
        while True:
            full = self.basis.size == self.basis.most
            added = False
            for i, solve in enumerate(solves):
                if blocks[i].stop > blocks[i].start and not full:
                    push = self.basis.push[:, blocks[i]]
                    blocks[i] = self.basis.grow(push, solve(push))
                    added |= blocks[i].stop > blocks[i].start
            now = self.small()
            change, order = self._change(before, now, lines)
            before = now
            if change > 100.0 * self.tolerance and added and not (enrich and change > last / 3.0):
                last = change
                continue
            last = change
            checked = np.union1d(order[:CHECKED], self.band[1])
            errors, rest, missing = self._errors(now, checked)
            error, worst = float(errors.max()), float(checked[errors.argmax()])
            if error <= self.tolerance:
                return error, worst
            if enrich and not full:
                new = self.basis.grow(_apart(rest), _apart(missing))
                added |= new.stop > new.start
            if not added:
                break
        raise NumericalError(
            "Krylov reduction",
            f"reached an error of {error:.2g} at {worst:.4g} Hz with {self.basis.size} vectors, "
            f"for a tolerance of {self.tolerance:g}.",
            "Add expansions in the band, allow more vectors, or ask for a larger tolerance.",
        )

    def _change(self, before: SmallModel, now: SmallModel, lines: Array) -> tuple[float, Array]:
        """Largest change of a line, and lines by falling change."""
        if str(self.damping) != "none":
            own = np.sqrt(np.maximum(now.undamped[0], 0.0)) / (2.0 * np.pi)
            lines = np.union1d(lines, own[(own > self.band[0]) & (own < self.band[1])])
        new = now.receptance(lines)
        norm = np.linalg.norm(new, axis=(1, 2))
        change = np.linalg.norm(new - before.receptance(lines), axis=(1, 2)) / norm
        order = np.argsort(change)[::-1]
        return float(change[order[0]]), lines[order]

    def _errors(self, small: SmallModel, lines: Array) -> tuple[Array, Array, Array]:
        """Estimated relative error of every line, residual and missing motion (n, f m)."""
        states = small.coordinates(lines)
        b, (viscous, structural) = self.basis, self._damped
        count = self.ports.shape[1]
        omegas = np.repeat(2.0 * np.pi * lines, count)
        flat = np.concatenate(list(states), axis=1)
        rest = np.tile(self.ports, len(lines)) - (
            _parts(b.force, flat)
            + 1j * (_parts(structural, flat) + _parts(viscous, omegas * flat))
            - _parts(b.push, omegas**2 * flat)
        )
        missing = self.factor.solve(rest)
        push, force = _parts(b.mass, missing), _parts(b.stiffness, missing)
        c, d = self.damping.apply(force, push, missing)
        # what S⁻¹ leaves out of Z⁻¹ at first order
        beyond = (b.shift + omegas**2) * push - 1j * (d + omegas * c)
        errors = []
        for line, state in enumerate(states):
            own = slice(line * count, (line + 1) * count)
            size = float(np.linalg.norm(rest[:, own].T @ missing[:, own]))
            more = float(np.linalg.norm(missing[:, own].T @ beyond[:, own]))
            share = min(more / size, 0.9) if size > 0 else 0.0
            answer = float(np.linalg.norm(small.ports.T @ state))
            errors.append(size / (1.0 - share) / answer)
        return np.array(errors), rest, missing


def _parts(matrix: Any, vectors: Array) -> Array:
    """A real matrix times complex vectors, without making it complex."""
    both = matrix @ _apart(vectors)
    half = vectors.shape[1]
    return np.asarray(both[:, :half] + 1j * both[:, half:])


def _apart(vectors: Array) -> Array:
    return np.concatenate([vectors.real, vectors.imag], axis=1)
