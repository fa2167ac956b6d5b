"""Least dynamic stiffness of a linear system over a band."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig, matrix_balance

from strutwork.errors import ModelError
from strutwork.fea.dynamic_stiffness import check_band
from strutwork.fea.pole_peak import PoleSum, largest_on_band
from strutwork.fea.state_space import StateSpace

Array = NDArray[Any]

#: Largest error of the sum over poles, as a share of the largest response, with which it is used.
AGREES = 1e-6


#: A static compliance below this share of the largest one of the band is rounding.
RIGID = 1e-9


@dataclass(frozen=True)
class LeastStiffness:
    """The least dynamic stiffness of one port over a band.

    Parameters
    ----------
    value : float
        min 1/|H|, N/m or N·m/rad.
    frequency : float
        Where, Hz.
    static : float
        1/H(0), N/m or N·m/rad; infinite where nothing yields for ever.
    certified : bool
        Whether it is proved to 1e-6 that nothing in the band is lower.
    """

    value: float
    frequency: float
    static: float
    certified: bool


def least_stiffness(system: StateSpace, band: tuple[float, float]) -> tuple[LeastStiffness, ...]:
    """Least driving-point dynamic stiffness of every port.

    The response is a sum over the poles, whose largest magnitude on the band is found with a
    proof (`strutwork.fea.pole_peak`).

    Parameters
    ----------
    system : StateSpace
        A stable one, whose outputs are displacements where its inputs are forces.
    band : (float, float)
        Hz.

    Raises
    ------
    ModelError
        An empty band, or poles on the imaginary axis.
    """
    check_band(*band)
    low, high = (2.0 * np.pi * f for f in band)
    balanced, similar = matrix_balance(system.a)
    values, vectors = eig(balanced)
    if np.any(values.real >= 0.0):
        raise ModelError(
            "damping",
            "is zero: the dynamic stiffness falls to zero at resonance.",
            "Give a damping ratio or a loss factor.",
        )
    left = (system.c @ similar) @ vectors
    right = np.linalg.solve(vectors, np.linalg.solve(similar, system.b).astype(complex))
    static = np.diag(system.static())
    even = np.geomspace(max(band[0], 1e-3 * band[1]), band[1], 40)
    lines = np.concatenate([even, _near(values, band)])
    sure = np.einsum("fii->fi", system.response(lines))
    found = []
    for i in range(len(system.inputs)):
        total = PoleSum(values, left[i] * right[:, i], complex(system.d[i, i]), 0.0)
        omega = 2.0 * np.pi * lines
        off = np.abs(total.derivatives(omega)[0] - sure[:, i]).max() / np.abs(sure[:, i]).max()
        place, size, proved = largest_on_band(total, low, high)
        found.append(
            LeastStiffness(
                1.0 / size,
                place / (2.0 * np.pi),
                float(1.0 / static[i]) if static[i] > RIGID * size else float("inf"),
                bool(proved and off < AGREES),
            )
        )
    return tuple(found)


def _near(values: Array, band: tuple[float, float]) -> Array:
    """Resonances in the band, Hz."""
    at = values.imag[values.imag > 0] / (2.0 * np.pi)
    return np.asarray(at[(at >= band[0]) & (at <= band[1])])
