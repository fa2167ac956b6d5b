"""A large model on a small basis, with its frequency response and the error of every line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from strutwork.errors import NumericalError
from strutwork.fea.block_krylov_basis import Array
from strutwork.fea.block_krylov_model import SmallModel
from strutwork.fea.block_krylov_residual import Residual


@dataclass(frozen=True)
class KrylovModel:
    """A large model reduced by moment matching.

    Parameters
    ----------
    basis : (n, k)
        Orthonormal in the energy of the first expansion.
    small : SmallModel
    residual : Residual
        What the small model leaves out of the full system, at every frequency.
    expansions : tuple of float
        Frequencies about which moments match, Hz.
    shift : float
        (rad/s)²; the energy is that of K + shift M.
    band : (float, float)
        Hz, in which the error was searched.
    error : float
        Largest error of a line's receptance in the band, Frobenius norm over Frobenius norm: a
        bound where `residual.proven`, otherwise an estimate (`errors`); with an estimate of
        rounding where it is largest.
    worst : float
        Hz, where.
    tolerance : float
        What was asked for, as a share.
    solver : str
        Which factorisation ran.
    damping : str
        What damps, in words.
    """

    basis: Array
    small: SmallModel
    residual: Residual
    expansions: tuple[float, ...]
    shift: float
    band: tuple[float, float]
    error: float
    worst: float
    tolerance: float
    solver: str
    damping: str

    def __repr__(self) -> str:
        known = "at most" if self.residual.proven else "estimated as"
        return (
            f"<KrylovModel: {self.basis.shape[0]} dofs on {self.basis.shape[1]} vectors, "
            f"error {known} {self.error:.1e}, at {self.worst:.4g} Hz, {self.solver}>"
        )

    @property
    def proven(self) -> bool:
        """Whether `error` and `errors` are bounds; otherwise they are estimates."""
        return self.residual.proven

    def receptance(self, frequencies: ArrayLike) -> Array:
        """Displacement at every port per load at every port, (f, m, m), complex, m/N.

        The residual of every line is checked, in the band and outside of it.

        Parameters
        ----------
        frequencies : (f,)
            Hz.

        Raises
        ------
        ModelError
            Frequencies that are negative or not finite.
        NumericalError
            A line on a resonance without damping, or one whose error may exceed the tolerance:
            outside of the band, or close to a resonance without damping.
        """
        lines, found, errors = self._answer(frequencies)
        if errors.max(initial=0.0) > self.tolerance:
            at = int(errors.argmax())
            raise NumericalError(
                "Krylov reduction",
                f"may be wrong by {errors[at]:.2g}{'' if self.proven else ' (an estimate)'} at "
                f"{lines[at]:.4g} Hz, for a tolerance of "
                f"{self.tolerance:g} between {self.band[0]:g} and {self.band[1]:g} Hz.",
                "Reduce for a band that includes the line; without damping, keep lines away from "
                "resonances.",
            )
        return found

    def errors(self, frequencies: ArrayLike) -> Array:
        """Largest error of the receptance at each line, as a share in the Frobenius norm, (f,).

        It follows from the residual of the full system, rounding apart. With damping that has a
        share of K or M and takes power everywhere, it is a bound, whatever modes the basis
        lacks. Otherwise it is estimated from the modes of the basis, and may miss a resonance
        without damping that the ports hardly excite.

        Parameters
        ----------
        frequencies : (f,)
            Hz.

        Raises
        ------
        ModelError
            Frequencies that are negative or not finite.
        NumericalError
            A line on a resonance without damping.
        """
        return self._answer(frequencies)[2]

    def _answer(self, frequencies: ArrayLike) -> tuple[Array, Array, Array]:
        """Lines, receptances and errors."""
        lines = np.atleast_1d(np.asarray(frequencies, dtype=float))
        states = self.small.coordinates(lines)
        found = np.asarray(self.small.ports.T @ states)
        return lines, found, self.residual.errors(self.small, lines, states, found)

    @property
    def natural_frequencies(self) -> Array:
        """Undamped frequencies of the reduced model, Hz, (k,); zero where it floats.

        Those outside of the band are not checked, and need not be the structure's.
        """
        square, _ = self.small.undamped
        return np.asarray(np.sqrt(np.maximum(square, 0.0)) / (2.0 * np.pi))
