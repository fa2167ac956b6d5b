"""Residuals of a reduced model at every frequency, and what they bound.

With S = K + shift M, the residual R of a line leaves out of the full system only what S⁻¹ makes
of M, C and D times the basis and the basis lacks. That does not depend on the frequency: one block
of solutions gives the residual's norm in S⁻¹ at every line, from small matrices. The projection
leaves R no component in the basis, so the receptance is wrong by exactly Rᵀ Z⁻¹ R, which is at most
the squared norm times the norm of S^½ Z⁻¹ S^½. The latter is at most one over the distance of
S^-½ Z S^-½'s field of values from zero, which damping keeps away from it.

Sources: Feng, Antoulas and Benner (2017), ESAIM: Mathematical Modelling and Numerical Analysis 51,
2127, for bounds from residuals; Horn and Johnson (1991), Topics in Matrix Analysis, chapter 1, for
the field of values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from strutwork.fea.block_krylov_basis import Array, EnergyBasis
from strutwork.fea.block_krylov_damping import MatrixDamping
from strutwork.fea.block_krylov_model import SmallModel

#: Squared share of an answer's energy, once its part in the basis is taken off, that is rounding.
ROUNDING = 1e-20

#: Eigenvalue of the Gram matrix of unit vectors below which they are linearly dependent.
COLLINEAR = 1e-13

#: Eigenvalue above which one step of orthonormalisation is as good as two.
APART = 1e-6

#: Share of the largest below which a negative eigenvalue of a damping matrix is rounding.
NEGATIVE = 1e-9


@dataclass(frozen=True)
class Residual:
    """Coordinates of S⁻¹ R beyond the basis, orthonormal in the energy of S.

    Parameters
    ----------
    shift : float
        (rad/s)²; S = K + shift M.
    mass : (p, k)
        Of S⁻¹ M V, where V is the basis, s².
    viscous, structural : (p, k)
        Of S⁻¹ C V, s, and S⁻¹ D V, no unit, both without the shares of K and M.
    proven : bool
        Whether damping bounds what a residual causes: it has a share of K or M, and all of it
        takes power.
    """

    shift: float
    mass: Array
    viscous: Array
    structural: Array
    proven: bool

    def coordinates(self, small: SmallModel, lines: Array, states: Array) -> Array:
        """Of S⁻¹ R, (f, p, m), complex, the square root of J per unit of load.

        Parameters
        ----------
        small : SmallModel
        lines : (f,)
            Hz.
        states : (f, k, m)
            Generalised coordinates, as `SmallModel.coordinates` returns them, of the same unit.
        """
        eta, rate, time = small.factors
        w = 2.0 * np.pi * lines[:, None, None]
        own = self.shift * (1.0 + 1j * (eta + w * time)) + w**2 - 1j * w * rate
        rest = own * (self.mass @ states)
        if self.structural.any():
            rest = rest - 1j * (self.structural @ states)
        if self.viscous.any():
            rest = rest - 1j * w * (self.viscous @ states)
        return np.asarray(rest)

    def errors(self, small: SmallModel, lines: Array, states: Array, answers: Array) -> Array:
        """Largest error of each line's receptance, Frobenius norm over Frobenius norm, (f,).

        Parameters
        ----------
        small : SmallModel
        lines : (f,)
            Hz.
        states : (f, k, m)
            Generalised coordinates, the square root of J per unit of load.
        answers : (f, m, m)
            Receptances, m/N and the like.
        """
        squared = np.sum(np.abs(self.coordinates(small, lines, states)) ** 2, axis=(1, 2))
        return np.asarray(self.gain(small, lines) * squared / np.linalg.norm(answers, axis=(1, 2)))

    def gain(self, small: SmallModel, lines: Array) -> Array:
        """Norm of S^½ Z⁻¹ S^½, (f,), no unit: a bound, or that of the modes in the basis.

        Parameters
        ----------
        small : SmallModel
        lines : (f,)
            Hz.
        """
        w = 2.0 * np.pi * lines
        eta, rate, time = small.factors
        if not self.proven:
            return self._gain_of_modes(small, w)
        # real and least imaginary part of x*Zx, linear in x*Mx where x*Sx is one
        across, level = self.shift + w**2, eta + w * time
        slope = w * rate - level * self.shift
        most = 1.0 / self.shift if self.shift > 0 else np.inf
        steep = across**2 + slope**2
        nearest = np.divide(across - level * slope, steep, out=np.zeros_like(w), where=steep > 0)
        where = np.clip(nearest, 0.0, most)
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / np.hypot(1.0 - across * where, level + slope * where))

    def _gain_of_modes(self, small: SmallModel, w: Array) -> Array:
        square, vectors = small.undamped
        c, d = (
            np.einsum("ij,ij->j", vectors, x @ vectors) for x in (small.viscous, small.structural)
        )
        dynamic = square - w[:, None] ** 2 + 1j * (d + w[:, None] * c)
        with np.errstate(divide="ignore"):
            return np.asarray(((np.abs(square) + self.shift) / np.abs(dynamic)).max(axis=1))


def beyond(basis: EnergyBasis, loads: Array, answers: Array) -> Array:
    """What answers S⁻¹ loads add to the basis, orthonormal in its energy, (n, p).

    Parameters
    ----------
    basis : EnergyBasis
    loads : (n, q)
        N, N·m.
    answers : (n, q)
        m and rad.
    """
    size = np.einsum("ij,ij->j", answers, loads)
    answers = answers[:, size > 0] / np.sqrt(size[size > 0])
    for _ in range(2):
        weights = basis.force.T @ answers + basis.shift * (basis.push.T @ answers)
        answers -= basis.vectors @ weights
    for least in (ROUNDING, 0.0):
        gram = answers.T @ basis.energy(answers)
        # columns of one size: what the eigenvalues drop is then what is collinear
        size = gram.diagonal()
        kept = size > least
        root = np.sqrt(size[kept])
        gram = gram[np.ix_(kept, kept)] / root[:, None] / root
        values, turn = np.linalg.eigh((gram + gram.T) / 2.0)
        fresh = values > COLLINEAR
        answers = answers[:, kept] @ (turn[:, fresh] / root[:, None] / np.sqrt(values[fresh]))
        if values[fresh].min(initial=1.0) > APART:
            break
    return np.asarray(answers)


def residual(
    basis: EnergyBasis,
    damping: MatrixDamping,
    small: SmallModel,
    directions: Array,
    damped: Sequence[Array],
) -> Residual:
    """Residual of a model whose answers beyond the basis lie in some directions.

    Parameters
    ----------
    basis : EnergyBasis
    damping : MatrixDamping
    small : SmallModel
        Projected on the basis.
    directions : (n, p)
        As `beyond` returns them, m and rad per square root of J.
    damped : two of (n, k)
        C V and D V, N·s and N, and N·m s and N·m, per square root of J.
    """
    mass = directions.T @ basis.push
    eta, rate, time = small.factors
    # K V is S V, which directions do not know, less shift M V
    viscous, structural = (
        np.zeros_like(mass) if matrix is None else directions.T @ whole - share * mass
        for matrix, whole, share in (
            (damping.viscous, damped[0], rate - time * basis.shift),
            (damping.structural, damped[1], -eta * basis.shift),
        )
    )
    proven = any(small.factors) and damping.takes_power and _positive(small)
    return Residual(basis.shift, mass, viscous, structural, proven)


def _positive(small: SmallModel) -> bool:
    """Whether nothing in the basis draws power from the damping."""
    eta, rate, time = small.factors
    shares = (
        small.viscous - rate * small.mass - time * small.stiffness,
        small.structural - eta * small.stiffness,
    )
    for matrix, whole in zip(shares, (small.viscous, small.structural), strict=True):
        values = np.linalg.eigvalsh(matrix)
        if values[0] < -NEGATIVE * np.abs(whole).max():
            return False
    return True
