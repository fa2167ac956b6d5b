"""Matrices of a small basis, with their frequency response."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import eigh

from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]

#: Frequency lines solved at once where damping couples the modes.
LINES = 128


@dataclass(frozen=True)
class SmallModel:
    """Matrices of k generalised coordinates.

    Parameters
    ----------
    stiffness, mass, viscous, structural : (k, k)
        Symmetric, N/m, kg, N·s/m and N/m times the squared size of the coordinates; the dynamic
        stiffness is K + iD + iωC − ω²M.
    ports : (k, m)
        Loads per unit of each port, of the coordinates' own unit.
    proportional : bool
        Whether C and D are `factors` times K and M.
    factors : (3,)
        Loss factor (no unit), mass rate, 1/s, stiffness time, s.
    """

    stiffness: Array
    mass: Array
    viscous: Array
    structural: Array
    ports: Array
    proportional: bool
    factors: tuple[float, float, float]

    def __repr__(self) -> str:
        return f"<SmallModel: {len(self.mass)} coordinates, {self.ports.shape[1]} ports>"

    def receptance(self, frequencies: ArrayLike) -> Array:
        """Displacement at every port per load at every port, (f, m, m), complex.

        Parameters
        ----------
        frequencies : (f,)
            Hz.

        Raises
        ------
        NumericalError
            A line on a resonance without damping.
        """
        states = self.coordinates(frequencies)
        return np.asarray(np.swapaxes(self.ports, 0, 1) @ states)

    def coordinates(self, frequencies: ArrayLike) -> Array:
        """Generalised coordinates per load at every port, (f, k, m), complex.

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
        lines = np.atleast_1d(np.asarray(frequencies, dtype=float))
        if lines.ndim != 1 or not np.all(np.isfinite(lines) & (lines >= 0)):
            raise ModelError(
                "frequency lines", "are negative or not finite.", "Give Hz, zero or more."
            )
        states = self._uncoupled(lines) if self.proportional else self._coupled(lines)
        if not np.all(np.isfinite(states)):
            raise NumericalError(
                "frequency response",
                "a line coincides with a resonance without damping.",
                "Give damping, or move the line.",
            )
        return states

    def _uncoupled(self, lines: Array) -> Array:
        square, vectors = self.undamped
        w = 2.0 * np.pi * lines[:, None]
        eta, rate, time = self.factors
        dynamic = square * (1.0 + 1j * eta + 1j * w * time) + 1j * w * rate - w**2
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            states = vectors @ ((vectors.T @ self.ports) / dynamic[..., None])
            # modes are exact beside the highest ω² only: once more with what they leave
            force, push = self.stiffness @ states, self.mass @ states
            w = w[..., None]
            left = self.ports - (1.0 + 1j * (eta + w * time)) * force - (1j * rate - w) * w * push
            return np.asarray(states + vectors @ ((vectors.T @ left) / dynamic[..., None]))

    def _coupled(self, lines: Array) -> Array:
        # in the undamped modes the matrices are of one size, which pivoting wants
        square, vectors = self.undamped
        size = 1.0 / np.sqrt(np.maximum(np.abs(square), 1e-12 * np.abs(square).max()))
        turn = vectors * size
        k, m, c, d = (
            turn.T @ x @ turn for x in (self.stiffness, self.mass, self.viscous, self.structural)
        )
        loads = (turn.T @ self.ports).astype(complex)
        states = np.empty((len(lines), *loads.shape), dtype=complex)
        for start in range(0, len(lines), LINES):
            w = 2.0 * np.pi * lines[start : start + LINES, None, None]
            try:
                states[start : start + LINES] = np.linalg.solve(
                    k + 1j * (d + w * c) - w**2 * m, loads
                )
            except np.linalg.LinAlgError:
                states[start : start + LINES] = np.nan
        return np.asarray(turn @ states)

    @cached_property
    def undamped(self) -> tuple[Array, Array]:
        """ω² of the undamped model, (k,), rad²/s², rising, and mass-normalised vectors, (k, k)."""
        square, vectors = eigh(self.stiffness, self.mass)
        return square, vectors
