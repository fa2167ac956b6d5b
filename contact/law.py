"""The force of a contact by its approach: Q = C δⁿ while it is closed, none while it is open."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class Elastic:
    """An elastic body.

    Parameters
    ----------
    youngs_modulus : float
        Pa.
    poissons_ratio : float
        No unit.
    """

    youngs_modulus: float
    poissons_ratio: float

    @property
    def plane(self) -> float:
        """E / (1 − ν²), Pa."""
        return self.youngs_modulus / (1.0 - self.poissons_ratio**2)


#: Bearing steel, as the literature on rolling bearings assumes it (30·10⁶ psi).
STEEL = Elastic(207e9, 0.3)


@dataclass(frozen=True)
class ContactLaw:
    """Q = C δⁿ of a closed contact.

    Parameters
    ----------
    constant : float
        C, N over the nth power of m; its unit follows from n.
    exponent : float
        n, no unit: 3/2 of point contact, 10/9 of line contact.

    Raises
    ------
    ModelError
        A constant that is not positive and finite, an exponent below one.
    """

    constant: float
    exponent: float = 1.5

    def __post_init__(self) -> None:
        if not (isfinite(self.constant) and self.constant > 0.0 and self.exponent >= 1.0):
            raise ModelError(
                "contact",
                f"has the constant {self.constant!r} and the exponent {self.exponent!r}.",
                "Give a positive constant and an exponent of at least one.",
            )

    def force(self, approach: ArrayLike) -> Array:
        """Force that presses the bodies together, (...), N; none where the approach is negative.

        Parameters
        ----------
        approach : (...)
            m.
        """
        return np.asarray(self.constant * _closed(approach) ** self.exponent)

    def slope(self, approach: ArrayLike) -> Array:
        """Derivative of the force, (...), N/m.

        Parameters
        ----------
        approach : (...)
            m.
        """
        closed = _closed(approach)
        return np.asarray(self.exponent * self.constant * closed ** (self.exponent - 1.0))

    def energy(self, approach: ArrayLike) -> Array:
        """Energy that the contact stores, (...), J.

        Parameters
        ----------
        approach : (...)
            m.
        """
        power = self.exponent + 1.0
        return np.asarray(self.constant * _closed(approach) ** power / power)

    def approach(self, force: ArrayLike) -> Array:
        """Approach under a force, (...), m.

        Parameters
        ----------
        force : (...)
            At least zero, N.
        """
        return np.asarray((np.asarray(force) / self.constant) ** (1.0 / self.exponent))


def in_series(first: ContactLaw, second: ContactLaw) -> ContactLaw:
    """Two contacts of one exponent that bear the same force, as of a ball in two grooves.

    Parameters
    ----------
    first, second : ContactLaw

    Raises
    ------
    ModelError
        Their exponents differ.
    """
    n = first.exponent
    if second.exponent != n:
        raise ModelError(
            "contacts in series", "have two exponents.", "Point and line contact do not combine."
        )
    sum_ = first.constant ** (-1.0 / n) + second.constant ** (-1.0 / n)
    return ContactLaw(sum_**-n, n)


def _closed(approach: ArrayLike) -> Array:
    value = np.asarray(approach)
    return np.where(value.real > 0.0, value, 0.0)
