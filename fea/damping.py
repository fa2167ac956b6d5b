"""Damping, named by the user: modal ratio, loss factor, Rayleigh, or by parts."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ModalRatio:
    """The same viscous damping ratio ζ in every mode.

    Parameters
    ----------
    ratio : float
        ζ, no unit; from 0 to below 1.

    Raises
    ------
    ModelError
        A ratio below zero, or one that is critical or beyond.
    """

    ratio: float

    def __post_init__(self) -> None:
        if not (isfinite(self.ratio) and 0 <= self.ratio < 1):
            raise ModelError(
                "damping.modal_ratio",
                f"is {self.ratio!r}.",
                "Give a ratio from 0 to below 1; at 1 and above nothing vibrates.",
            )

    def viscous(self, square: Array) -> Array:
        """Coefficient of iω in 1 − ω²μ + iωv + iη, s, for μ = 1/ω²: 2 ζ √μ, (...).

        Parameters
        ----------
        square : (...)
            μ, s².
        """
        return np.asarray(2.0 * self.ratio * np.sqrt(square))

    @property
    def structural(self) -> float:
        """η."""
        return 0.0

    @property
    def rigid(self) -> float:
        """Mass-proportional damping of rigid-body modes, 1/s."""
        return 0.0

    def __str__(self) -> str:
        return f"viscous, ratio ζ = {self.ratio:g} in every mode"


@dataclass(frozen=True)
class LossFactor:
    """Structural (hysteretic) damping: stiffness times 1 + iη; at resonance η = 2 ζ.

    Parameters
    ----------
    value : float
        η, no unit; from 0 to below 2.

    Raises
    ------
    ModelError
        A negative value, or one from 2 on (beyond critical at resonance).
    """

    value: float

    def __post_init__(self) -> None:
        if not (isfinite(self.value) and 0 <= self.value < 2):
            raise ModelError(
                "damping.loss_factor",
                f"is {self.value!r}.",
                "Give a loss factor from 0 to below 2 (twice the damping ratio at resonance).",
            )

    def viscous(self, square: Array) -> Array:
        """No viscous part: zeros, (...).

        Parameters
        ----------
        square : (...)
            μ = 1/ω², s².
        """
        return np.zeros_like(square)

    @property
    def structural(self) -> float:
        """η."""
        return self.value

    @property
    def rigid(self) -> float:
        """None: rigid-body modes do not strain."""
        return 0.0

    def __str__(self) -> str:
        return f"structural, loss factor η = {self.value:g}"


@dataclass(frozen=True)
class Rayleigh:
    """C = α M + β K.

    Parameters
    ----------
    alpha : float
        1/s.
    beta : float
        s.
    """

    alpha: float
    beta: float

    def __post_init__(self) -> None:
        if not all(isfinite(v) and v >= 0 for v in (self.alpha, self.beta)):
            raise ModelError(
                "damping.rayleigh",
                f"is alpha = {self.alpha!r}, beta = {self.beta!r}.",
                "Give zero or positive numbers, in 1/s and s.",
            )

    def viscous(self, square: Array) -> Array:
        """Coefficient of iω: α μ + β, s, (...).

        Parameters
        ----------
        square : (...)
            μ = 1/ω², s².
        """
        return np.asarray(self.alpha * square + self.beta)

    @property
    def structural(self) -> float:
        """η."""
        return 0.0

    @property
    def rigid(self) -> float:
        """α, 1/s."""
        return self.alpha

    def __str__(self) -> str:
        return f"Rayleigh, C = {self.alpha:g} M + {self.beta:g} K"


#: Damping that leaves the undamped modes uncoupled.
Damping = ModalRatio | LossFactor | Rayleigh


def modal_ratios(damping: Damping, square: Array) -> Array:
    """Equivalent viscous ratio ζ of every mode; η/2 for a loss factor, (..., m).

    One and more where a mode is damped to critical and beyond, as stiffness-proportional damping
    does from some frequency on: such a mode creeps and has no resonance.

    Parameters
    ----------
    damping : Damping
    square : (..., m)
        μ = 1/ω² of every mode, s²; zero for motions without mass.
    """
    root = np.sqrt(np.where(square > 0, square, np.inf))
    ratios = damping.viscous(square) / (2.0 * root) + damping.structural / 2.0
    return np.asarray(np.where(square > 0, ratios, 0.0))
