"""Checks of numbers that a process is given by."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]


def positive(part: str, name: str, value: float) -> None:
    """Refuse a number that is not finite and above zero.

    Parameters
    ----------
    part, name : str
        For the message.
    value : float
        Of any unit.

    Raises
    ------
    ModelError
    """
    if not (math.isfinite(value) and value > 0):
        raise ModelError(part, f"has the {name} {value:g}.", "Give a finite number above zero.")


def not_negative(part: str, name: str, value: float) -> None:
    """Refuse a number that is not finite or below zero.

    Parameters
    ----------
    part, name : str
        For the message.
    value : float
        Of any unit.

    Raises
    ------
    ModelError
    """
    if not (math.isfinite(value) and value >= 0):
        raise ModelError(part, f"has the {name} {value:g}.", "Give a finite number, zero or more.")


def positive_list(name: str, values: ArrayLike, unit: str) -> Array:
    """Values as an array (n,), all of them finite and above zero.

    Parameters
    ----------
    name : str
    values : (n,)
        Of any unit.
    unit : str
        For the message.

    Raises
    ------
    ModelError
    """
    found = np.atleast_1d(np.asarray(values, dtype=float))
    if found.ndim != 1 or not found.size or not np.all(np.isfinite(found) & (found > 0)):
        raise ModelError(name, "are empty, not finite or not positive.", f"Give them in {unit}.")
    return found
