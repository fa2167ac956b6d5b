"""Numbers as a reader wants them: few digits, honest signs, units apart."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, isfinite, log10
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]

#: A number up to this share of the largest it stands beside is shown as 0.
ROUNDING = 1e-9

#: Rounding that cancelled products of forces and arms leave, as a share of force times length.
CANCELLED = 1e-13

NEWTON_PER_MICROMETRE = 1e6
MINUS = "\N{MINUS SIGN}"


def significant(value: float, digits: int = 3) -> str:
    """A number rounded to significant digits, without an exponent where it stays readable.

    >>> significant(4.7096)
    '4.71'
    >>> significant(0.000123456), significant(-216.0), significant(317)
    ('1.23e-4', '−216', '317')
    """
    if not isfinite(value):
        return "infinite" if value > 0 else f"{MINUS}infinite" if value < 0 else "none"
    if value == 0:
        return "0"
    exponent = floor(log10(abs(float(f"{value:.{digits - 1}e}"))))
    if -4 < exponent < digits + 2:
        text = f"{value:.{max(0, digits - 1 - exponent)}f}"
    else:
        mantissa, power = f"{value:.{digits - 1}e}".split("e")
        text = f"{mantissa}e{int(power)}"
    return text.replace("-", MINUS, 1) if value < 0 else text


def fixed(value: float, decimals: int) -> str:
    """A number with a fixed number of decimals; no sign where it rounds to zero.

    >>> fixed(-2.5, 1), fixed(-0.04, 1)
    ('−2.5', '0.0')
    """
    text = f"{value:.{decimals}f}"
    return text.replace("-", "" if _zero(text) else MINUS)


def clean(values: Sequence[float], digits: int = 3) -> str:
    """A vector in one line; entries that are only rounding beside its largest show as 0."""
    return ", ".join(significant(float(v), digits) for v in without_rounding(values))


def without_rounding(values: ArrayLike, scale: ArrayLike = 0.0) -> Array:
    """Numbers of one kind, with 0 for those that are only rounding.

    Parameters
    ----------
    values : array
        Of one unit.
    scale : broadcastable to values
        What else they were made from, in the same unit; counts beside their own largest.

    Returns
    -------
    array
        Entries up to `ROUNDING` of the largest are 0; infinite ones stay and set no scale.

    >>> without_rounding([2.6e7, -0.0065, 3e5]).tolist()
    [26000000.0, 0.0, 300000.0]
    """
    numbers = np.array(values, dtype=float)
    finite = np.abs(numbers[np.isfinite(numbers)])
    level = ROUNDING * np.maximum(finite.max(initial=0.0), scale)
    return np.where(np.abs(numbers) <= level, 0.0, numbers)


def six_without_rounding(table: ArrayLike, arm: float, beside: ArrayLike | None = None) -> Array:
    """Wrenches or twists of one table, with 0 for what is only rounding.

    Parameters
    ----------
    table : (n, 6)
        Forces and moments, or displacements and rotations; SI.
    arm : float
        Size of the second three per unit of the first: for wrenches the length of the structure,
        m, for twists one over it. Where they cancel, each leaves its rounding in the other.
    beside : (k, 6), optional
        Other numbers of the kind from the same solution.

    Returns
    -------
    (n, 6)
    """
    numbers = np.asarray(table, dtype=float).reshape(-1, 6)
    every = numbers if beside is None else np.concatenate([numbers, np.reshape(beside, (-1, 6))])
    known = np.abs(np.nan_to_num(every))  # a force that is not determined is NaN
    first = known[:, :3].max(initial=0.0)
    second = known[:, 3:].max(initial=0.0)
    share = CANCELLED / ROUNDING
    return np.concatenate(
        [
            without_rounding(numbers[:, :3], max(first, share * second / arm)),
            without_rounding(numbers[:, 3:], max(second, share * first * arm)),
        ],
        axis=1,
    )


def matrix_without_rounding(matrix: ArrayLike) -> Array:
    """A 6x6 compliance or stiffness with 0 for what is rounding beside its diagonal.

    A diagonal entry that is rounding beside the others of its unit belongs to a direction that
    does not take part: its row and column are 0.
    """
    numbers = np.array(matrix, dtype=float)
    blocks = np.abs(np.diag(numbers)).reshape(2, -1)
    still = (blocks <= CANCELLED * blocks.max(axis=1, keepdims=True)).ravel()
    numbers[still] = numbers[:, still] = 0.0
    scale = np.sqrt(np.abs(np.diag(numbers)))
    return np.where(np.abs(numbers) <= ROUNDING * np.outer(scale, scale), 0.0, numbers)


def micro(value: float, digits: int = 3) -> str:
    """A stiffness in N/m, written in N/µm."""
    return significant(value / NEWTON_PER_MICROMETRE, digits)


def percent(value: float, decimals: int = 1) -> str:
    """A difference in percent with its sign; none where it rounds to zero.

    >>> percent(3.14), percent(-0.04), percent(-2.0)
    ('+3.1 %', '0.0 %', '−2.0 %')
    """
    text = f"{value:+.{decimals}f} %"
    return text[1:] if _zero(text) else text.replace("-", MINUS)


def share(value: float) -> str:
    """A share of one in percent."""
    return f"{fixed(100 * value, 1)} %"


def _zero(text: str) -> bool:
    """Whether a number was rounded to zero."""
    return not any(digit in text for digit in "123456789")


def times(factor: float) -> str:
    """A factor of exaggeration in two digits.

    >>> times(0.2), times(543.0), times(9987.0) == f"10{chr(0x202F)}000"
    ('0.2', '540', True)
    """
    whole = float(f"{factor:.2g}")
    text = f"{whole:,.0f}" if whole >= 10.0 else f"{whole:g}"
    return text.replace(",", "\N{NARROW NO-BREAK SPACE}")


def count(number: int, singular: str, plural: str = "") -> str:
    """A number with its noun: 1 pose, 317 poses."""
    return f"{number} {singular if number == 1 else plural or singular + 's'}"
