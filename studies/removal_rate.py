"""Deflection of machines of different sizes that remove material at the same rate.

Son, A Hybrid Type Small 5-Axis CNC Milling Machine, MIT 2002, section 3.2, eqs 16 to 24. The
accelerated masses, not the cutting forces, set the size of the drives; the drives' force grows
with a power n of the machine's size; so a larger machine of n above 3 may feed faster, cuts less
deep at the same removal rate, and is pushed less.

The thesis finds n as the exponent of a motor's torque, which a lead screw turns into force: that
holds for screws of the same lead. Where the lead grows with the machine, n is less by one.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]

#: Exponents n of the drives' force: of equal deflection at any size, of electric motors by their
#: volume, of industrial brushless servo-actuators (Son 2002, section 3.2 and 3.4).
ACTUATOR_EXPONENTS = (1.0, 3.0, 3.5)


def removal_rate(depth: ArrayLike, width: ArrayLike, feed: ArrayLike) -> Array:
    """Material removal rate d w f, (...), m³/s (Son 2002, eq. 16).

    Parameters
    ----------
    depth, width : (...)
        Of cut, m.
    feed : (...)
        Feed rate, m/s.
    """
    product = np.asarray(depth, dtype=float) * np.asarray(width, dtype=float)
    return np.asarray(product * np.asarray(feed, dtype=float))


def cutting_force(depth: ArrayLike, specific_energy: ArrayLike, constants: ArrayLike) -> Array:
    """Cutting force √(c_x² + c_y²) d ρ_s, (...), N (Son 2002, eqs 17 and 18).

    Parameters
    ----------
    depth : (...)
        Of cut, m.
    specific_energy : (...)
        Cutting energy per volume removed, J/m³.
    constants : (..., 2)
        c_x and c_y, m: shares of the width of cut, which is fixed.
    """
    size = np.linalg.norm(np.asarray(constants, dtype=float), axis=-1)
    energy = np.asarray(specific_energy, dtype=float)
    return np.asarray(size * np.asarray(depth, dtype=float) * energy)


def cutting_force_at_rate(
    rate: ArrayLike,
    feed: ArrayLike,
    width: ArrayLike,
    specific_energy: ArrayLike,
    constants: ArrayLike,
) -> Array:
    """Cutting force at a given removal rate, (...), N; it falls with 1/f (Son 2002, eq. 19).

    Parameters
    ----------
    rate : (...)
        Removal rate, m³/s.
    feed : (...)
        Feed rate, m/s.
    width : (...)
        Of cut, m.
    specific_energy : (...)
        Cutting energy per volume removed, J/m³.
    constants : (..., 2)
        c_x and c_y, m, as `cutting_force`.
    """
    area = np.asarray(width, dtype=float) * np.asarray(feed, dtype=float)
    return cutting_force(np.asarray(rate, dtype=float) / area, specific_energy, constants)


def actuator_force(mass: ArrayLike, feed: ArrayLike, radius: ArrayLike) -> Array:
    """Force that keeps a mass on a curve, m f²/r, (...), N (Son 2002, eq. 20).

    Parameters
    ----------
    mass : (...)
        To be moved, kg; ρ L_c³ of a machine of the size L_c.
    feed : (...)
        Largest feed rate, m/s.
    radius : (...)
        Least radius of curvature, m.
    """
    square = np.asarray(feed, dtype=float) ** 2
    return np.asarray(np.asarray(mass, dtype=float) * square / np.asarray(radius, dtype=float))


def largest_feed(force: ArrayLike, mass: ArrayLike, radius: ArrayLike) -> Array:
    """Feed rate that a drive's force allows, √(F r/m), (...), m/s (Son 2002, eq. 20 the other way).

    Parameters
    ----------
    force : (...)
        Of the drive, N.
    mass : (...)
        To be moved, kg.
    radius : (...)
        Least radius of curvature, m.
    """
    work = np.asarray(force, dtype=float) * np.asarray(radius, dtype=float)
    return np.asarray(np.sqrt(work / np.asarray(mass, dtype=float)))


@dataclass(frozen=True)
class RemovalExponents:
    """Powers of a machine's size at the same removal rate.

    Parameters
    ----------
    actuator : float
        n of the drives' force (Son 2002, eq. 21); like all four, no unit.
    feed : float
        Of the largest feed rate (eq. 22), no unit.
    cutting_force : float
        Of the cutting force (eqs 19 and 22), no unit.
    deflection : float
        Of the static deflection (eq. 23), no unit.
    """

    actuator: float
    feed: float
    cutting_force: float
    deflection: float


def removal_exponents(actuator: float, stiffness: float = 1.0) -> RemovalExponents:
    """How feed, cutting force and deflection change with size (Son 2002, eqs 21 to 23).

    Parameters
    ----------
    actuator : float
        n, no unit: the drives' force grows with L^n.
    stiffness : float
        Exponent of the static stiffness, no unit; 1 for geometric similarity (eqs 14 and 15).

    Returns
    -------
    RemovalExponents
        Feed (n − 3)/2, cutting force −(n − 3)/2, deflection −(n − 3)/2 − stiffness, which for
        similarity is −(n − 1)/2.

    Raises
    ------
    ModelError
        An exponent that is not finite.
    """
    for name, value in (("actuator", actuator), ("stiffness", stiffness)):
        if not isfinite(value):
            raise ModelError(f"exponent of the {name}", f"is {value!r}.", "Give a number.")
    feed = (actuator - 3.0) / 2.0
    return RemovalExponents(actuator, feed, -feed, -feed - stiffness)


def frequency_exponent(stiffness: float = 1.0, mass: float = 3.0) -> float:
    """Of √(K/M): −1 for geometric similarity (Son 2002, eq. 24).

    Parameters
    ----------
    stiffness, mass : float
        Exponents of K and M, no unit.
    """
    return (stiffness - mass) / 2.0


def relative_deflection(factors: ArrayLike, stiffness: ArrayLike, actuator: float) -> Array:
    """Deflection at the same removal rate beside that of the machine of factor 1 (eq. 23).

    Parameters
    ----------
    factors : (f,)
        Sizes beside the machine's own, no unit.
    stiffness : (f, ...)
        Static stiffness of each beside the machine's own, dimensionless.
    actuator : float
        n of the drives' force, no unit.

    Returns
    -------
    deflection : (f, ...)
        Dimensionless.
    """
    sizes = np.asarray(factors, dtype=float)
    ratio = np.asarray(stiffness, dtype=float)
    force = sizes ** removal_exponents(actuator).cutting_force
    return np.asarray(force.reshape(-1, *[1] * (ratio.ndim - 1)) / ratio)
