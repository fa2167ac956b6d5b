"""Ishigami's function and its Sobol indices in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

A, B = 7.0, 0.1


def ishigami(x: Array) -> Array:
    """Ishigami and Homma (1990), of x in (-pi, pi)^3."""
    return np.asarray(
        np.sin(x[:, 0]) + A * np.sin(x[:, 1]) ** 2 + B * x[:, 2] ** 4 * np.sin(x[:, 0])
    )


def closed_form() -> dict[str, Array]:
    """Variance by variance, Saltelli et al., Sensitivity Analysis in Practice (2004), p. 196."""
    one = B * np.pi**4 / 5 + B**2 * np.pi**8 / 50 + 0.5
    two, both = A**2 / 8, B**2 * np.pi**8 * (1 / 18 - 1 / 50)
    return {
        "first": np.array([one, two, 0.0]) / (one + two + both),
        "total": np.array([one + both, two, both]) / (one + two + both),
        "second": np.array([0.0, both, 0.0]) / (one + two + both),
    }
