"""Adds blocks to a Krylov basis until the error is small at every line of a band."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.fea.block_krylov_basis import Array, EnergyBasis
from strutwork.fea.block_krylov_damping import MatrixDamping
from strutwork.fea.block_krylov_model import SmallModel
from strutwork.fea.block_krylov_residual import Residual, beyond, residual
from strutwork.fea.factorize import Factor

Solve = Callable[[Array], Array]

#: Lines of the band that are compared first, beside the resonances.
COMPARED = 200

#: Largest errors between whose neighbours more lines are put, how many, and how often.
PEAKS, BETWEEN, TIMES = 3, 9, 2

#: Squared size, in tolerances, from which a direction of the residuals is added to the basis, and
#: how many at once.
ENOUGH, MORE = 0.1, 12

#: Share of the tolerance that is used: the rest is for what lies between lines.
USED = 0.8

#: Change between successive bases, in tolerances, below which the residual is worth its solutions.
NEAR = 100.0

#: Rounding of a product, with a margin: errors measured in extended precision were below half.
ROUNDED = 4.0 * 2.0**-53


@dataclass(frozen=True)
class Found:
    """A small model whose error is below the tolerance.

    Parameters
    ----------
    small : SmallModel
    residual : Residual
        What it leaves out.
    error : float
        Largest of a line's receptance, Frobenius norm over Frobenius norm.
    worst : float
        Hz, where.
    """

    small: SmallModel
    residual: Residual
    error: float
    worst: float


@dataclass
class Search:
    """Adds blocks until the error is small.

    Parameters
    ----------
    basis : EnergyBasis
        It holds the answers S⁻¹ to all loads: those at the ports and at single dampers.
    ports : (n, m)
        Load on each dof per unit at each port, no unit.
    damping : MatrixDamping
    factor : Factor
        Of S = K + shift M.
    band : (float, float)
        Hz.
    tolerance : float
        Largest error of a line's receptance, as a share.
    """

    basis: EnergyBasis
    ports: Array
    damping: MatrixDamping
    factor: Factor
    band: tuple[float, float]
    tolerance: float
    _damped: tuple[Array, ...] = field(init=False, default=())
    _answers: dict[str, Array] = field(init=False, default_factory=dict)
    _enriched: list[slice] = field(init=False, default_factory=list)

    def small(self) -> SmallModel:
        """The projected matrices."""
        b = self.basis
        v, known = b.vectors, self._damped[0].shape[1] if self._damped else 0
        new = self.damping.apply(b.force[:, known:], b.push[:, known:], v[:, known:])
        before = self._damped or (v[:, :0], v[:, :0])
        viscous, structural = (np.hstack(x) for x in zip(before, new, strict=True))
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

    @property
    def enriches(self) -> bool:
        """Whether damping leaves the spaces that loads and masses span."""
        return self.damping.viscous is not None or self.damping.structural is not None

    def extend(self, solves: Sequence[Solve], blocks: list[slice]) -> Found:
        """The model once its error is below the tolerance.

        Parameters
        ----------
        solves : sequence of callable
            Solutions at each expansion, that of S first.
        blocks : list of slice
            Where the first block of each stands in the basis; changed.

        Raises
        ------
        NumericalError
            A tolerance that is not reached, or that is below rounding.
        """
        error, worst = np.inf, self.band[1]
        before: SmallModel | None = None
        last, added = np.inf, True
        while not self.basis.truncated:
            small = self.small()
            change = self._change(before, small) if self.enriches and before else np.inf
            push = self.basis.push[:, blocks[0]]
            ahead = self.factor.solve(push) if push.shape[1] else push
            # matrices cost a solution for every vector: not before the bases agree
            settled = change <= NEAR * self.tolerance or change > last / 3.0
            checked, added = settled or not self.enriches or not added, False
            if checked:
                directions = self._directions(push, ahead)
                rest = residual(self.basis, self.damping, small, directions, self._damped)
                errors, lines = self._errors(small, rest)
                error, worst = float(errors.max()), float(lines[errors.argmax()])
                if error <= USED * self.tolerance:
                    return self._verified(Found(small, rest, error, worst), lines)
                if self.enriches:
                    added = self._enrich(small, rest, directions, lines)
            before, last = small, change
            for i, solve in enumerate(solves):
                if blocks[i].stop > blocks[i].start:
                    push = self.basis.push[:, blocks[i]]
                    blocks[i] = self.basis.grow(push, ahead if i == 0 else solve(push))
                    added |= blocks[i].stop > blocks[i].start
            if checked and not added:
                break
        raise NumericalError(
            "Krylov reduction",
            f"reached an error of {error:.2g} at {worst:.4g} Hz with {self.basis.size} vectors, "
            f"for a tolerance of {self.tolerance:g}.",
            "Add expansions in the band, allow more vectors, or ask for a larger tolerance.",
        )

    def _lines(self, small: SmallModel) -> Array:
        lines = np.linspace(*self.band, COMPARED)
        if str(self.damping) == "none":
            return lines
        own = np.sqrt(np.maximum(small.undamped[0], 0.0)) / (2.0 * np.pi)
        return np.union1d(lines, own[(own > self.band[0]) & (own < self.band[1])])

    def _change(self, before: SmallModel, now: SmallModel) -> float:
        """Largest change of a line."""
        lines = self._lines(now)
        new = now.receptance(lines)
        norm = np.linalg.norm(new, axis=(1, 2))
        change = np.linalg.norm(new - before.receptance(lines), axis=(1, 2)) / norm
        return float(change.max())

    def _errors(self, small: SmallModel, rest: Residual) -> tuple[Array, Array]:
        """Errors and their lines, with lines added around the largest errors."""

        def at(lines: Array) -> Array:
            states = small.coordinates(lines)
            return rest.errors(small, lines, states, small.ports.T @ states)

        lines = self._lines(small)
        errors = at(lines)
        for _ in range(TIMES if str(self.damping) != "none" else 0):
            peaks = _peaks(errors)[:PEAKS]
            ends = [(lines[max(p - 1, 0)], lines[min(p + 1, len(lines) - 1)]) for p in peaks]
            more = np.setdiff1d([np.linspace(*e, BETWEEN + 2) for e in ends], lines)
            order = np.argsort(np.r_[lines, more])
            errors, lines = np.r_[errors, at(more)][order], np.r_[lines, more][order]
        return errors, lines

    def _directions(self, push: Array, ahead: Array) -> Array:
        """What S⁻¹ of the model's matrices times the basis adds to it.

        All but the last block's masses, motions that were added, and damping matrices lies in the
        basis: also for further expansions, since S v = M u with S = K − ω²M makes K⁻¹M v the sum
        of such terms of u.
        """
        given = self.damping.viscous, self.damping.structural
        # with their shares of K and M, which add nothing of their own
        loads = {str(i): x for i, x in enumerate(self._damped) if given[i] is not None}
        if self._enriched:
            parts = [self.basis.push[:, s] for s in self._enriched]
            loads["mass"] = np.concatenate(parts, axis=1)
        answers = [self._answered(name, x) for name, x in loads.items()]
        return beyond(
            self.basis,
            np.concatenate([push, *loads.values()], axis=1),
            np.concatenate([ahead, *answers], axis=1),
        )

    def _answered(self, name: str, loads: Array) -> Array:
        """S⁻¹ loads, of which the first columns are known."""
        known = self._answers.get(name, loads[:, :0])
        if loads.shape[1] > known.shape[1]:
            new = self.factor.solve(np.ascontiguousarray(loads[:, known.shape[1] :]))
            known = np.concatenate([known, new], axis=1)
        self._answers[name] = known
        return known

    def _enrich(self, small: SmallModel, rest: Residual, directions: Array, lines: Array) -> bool:
        """Add the directions in which lines lack most; returns whether there were any."""
        states = small.coordinates(lines)
        weights = rest.gain(small, lines) / np.linalg.norm(small.ports.T @ states, axis=(1, 2))
        # so weighted, a line's squared norm is its error
        missing = np.sqrt(weights)[:, None, None] * rest.coordinates(small, lines, states)
        turn, sizes, _ = np.linalg.svd(
            _apart(np.concatenate(list(missing), axis=1)), full_matrices=False
        )
        wanted = sizes**2 > ENOUGH * self.tolerance
        block = directions @ turn[:, wanted][:, :MORE]
        new = self.basis.grow(self.basis.energy(block), block)
        self._enriched.append(new)
        return bool(new.stop > new.start)

    def _verified(self, found: Found, lines: Array) -> Found:
        """The model, after the residual of the full system at its worst lines."""
        small, rest = found.small, found.residual
        states = small.coordinates(lines)
        # where motions are largest beside what they make at the ports, rounding is
        swing = np.linalg.norm(states, axis=(1, 2)) ** 2
        swing /= np.linalg.norm(small.ports.T @ states, axis=(1, 2))
        checked = np.union1d(found.worst, lines[swing.argmax()])
        errors = self._formed(small, rest, checked)
        error, worst = float(errors.max()), float(checked[errors.argmax()])
        if not error <= self.tolerance:
            raise NumericalError(
                "Krylov reduction",
                f"leaves an error of {error:.2g} at {worst:.4g} Hz by rounding, for a tolerance "
                f"of {self.tolerance:g}.",
                "Ask for a larger tolerance, or check the scale of stiffnesses and masses.",
            )
        return Found(small, rest, *max((found.error, found.worst), (error, worst)))

    def _formed(self, small: SmallModel, rest: Residual, lines: Array) -> Array:
        """Errors from residuals of the full system, rounding included, (f,)."""
        b, (viscous, structural) = self.basis, self._damped
        states, count = small.coordinates(lines), self.ports.shape[1]
        flat = np.concatenate(list(states), axis=1)
        omegas = np.repeat(2.0 * np.pi * lines, count)
        left = np.tile(self.ports, len(lines)) - (
            _parts(b.force, flat)
            + 1j * (_parts(structural, flat) + _parts(viscous, omegas * flat))
            - _parts(b.push, omegas**2 * flat)
        )
        missing, within = self.factor.solve(left), _parts(b.vectors.T, left)
        # each product of K is rounded by its own share of its own size, at random
        moved = np.abs(_parts(b.vectors, flat)) ** 2
        rounded = b.stiffness.power(2) @ moved
        errors = []
        for line, (state, gain) in enumerate(zip(states, rest.gain(small, lines), strict=True)):
            own = slice(line * count, (line + 1) * count)
            beyond_basis = gain * np.vdot(left[:, own], missing[:, own]).real
            rounding = float(np.linalg.norm(state.T @ within[:, own]))
            rounding += ROUNDED * float(np.sqrt(np.sum(moved[:, own].T @ rounded[:, own])))
            errors.append((beyond_basis + rounding) / np.linalg.norm(small.ports.T @ state))
        return np.array(errors)


def _peaks(errors: Array) -> NDArray[np.intp]:
    """Local maxima, the largest first."""
    inner = np.r_[errors[0], errors, errors[-1]]
    peaks = np.flatnonzero((inner[1:-1] >= inner[:-2]) & (inner[1:-1] >= inner[2:]))
    return np.asarray(peaks[np.argsort(errors[peaks])[::-1]])


def _parts(matrix: Any, vectors: Array) -> Array:
    """A real matrix times complex vectors, without making it complex."""
    both = matrix @ _apart(vectors)
    half = vectors.shape[1]
    return np.asarray(both[:, :half] + 1j * both[:, half:])


def _apart(vectors: Array) -> Array:
    return np.concatenate([vectors.real, vectors.imag], axis=1)
