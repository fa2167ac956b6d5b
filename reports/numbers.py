"""Numbers as a reader wants them: few digits, honest signs, units apart."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, isfinite, log10

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
    """A number with a fixed number of decimals."""
    text = f"{value:.{decimals}f}"
    return text.replace("-", MINUS)


def clean(values: Sequence[float], digits: int = 3) -> str:
    """A vector in one line; entries that are only rounding beside its largest show as 0."""
    floor_ = 1e-9 * max(abs(v) for v in values)
    return ", ".join(significant(0.0 if abs(v) <= floor_ else v, digits) for v in values)


def micro(value: float, digits: int = 3) -> str:
    """A stiffness in N/m, written in N/µm."""
    return significant(value / NEWTON_PER_MICROMETRE, digits)


def percent(value: float, decimals: int = 1) -> str:
    """A difference in percent with its sign."""
    text = f"{value:+.{decimals}f} %"
    return text.replace("-", MINUS)


def share(value: float) -> str:
    """A share of one in percent."""
    return f"{100 * value:.1f} %"


def count(number: int, singular: str, plural: str = "") -> str:
    """A number with its noun: 1 pose, 317 poses."""
    return f"{number} {singular if number == 1 else plural or singular + 's'}"
