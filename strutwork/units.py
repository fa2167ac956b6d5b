"""Quantities at the boundary: a bare number is in SI, a string carries its unit.

The common units stand in a table of their own, because building pint's registry takes longer
than checking a small model; pint is loaded when a unit is met that the table does not know.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal, DecimalException
from functools import lru_cache
from math import isfinite, pi
from typing import Any

from strutwork.errors import UnitError

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", re.DOTALL)
_TOKEN = re.compile(r"\s*(\*\*|[*/^()·]|[+-]?\d+|[^\W\d_][^\W\d]*|[°%])")
_LONGEST = 80

#: Largest magnitude of a quantity in SI units, and of a length, m. Beyond them products of a few
#: quantities leave the range of doubles, and nothing that is built comes near.
LARGEST, LONGEST = 1e30, 1e9

#: Magnitudes below these, SI, count as 0, for the same reason; a length below a femtometre is no
#: length of anything built, and an arm that short would look like a direction of its own.
SMALLEST, SHORTEST = 1e-60, 1e-15

#: Powers of m, kg, s and rad.
Powers = tuple[int, int, int, int]


@dataclass(frozen=True)
class Dimension:
    """What a field measures.

    Parameters
    ----------
    name : str
        With its article, for messages: "a length".
    unit : str
        The SI unit of a bare number; empty for a pure number.
    example : str
        A string a reader could have written.
    powers : (int, int, int)
        Powers of m, kg and s.
    angle : tuple of int
        Powers of rad that are accepted: an angle counts as a number where it may.
    """

    name: str
    unit: str
    example: str
    powers: tuple[int, int, int]
    angle: tuple[int, ...] = (0,)


NUMBER = Dimension("a pure number", "", "0.3", (0, 0, 0))
ANGLE = Dimension("an angle", "rad", "30 deg", (0, 0, 0), (0, 1))
LENGTH = Dimension("a length", "m", "216 mm", (1, 0, 0))
AREA = Dimension("an area", "m^2", "36 cm^2", (2, 0, 0))
SECOND_MOMENT = Dimension("a second moment of area", "m^4", "492 cm^4", (4, 0, 0))
TIME = Dimension("a time", "s", "2 ms", (0, 0, 1))
RATE = Dimension("a rate", "1/s", "5.36 1/s", (0, 0, -1))
FREQUENCY = Dimension("a frequency", "Hz", "800 Hz", (0, 0, -1))
MASS = Dimension("a mass", "kg", "0.5 kg", (0, 1, 0))
INERTIA = Dimension("a moment of inertia", "kg*m^2", "2 kg*cm^2", (2, 1, 0))
DENSITY = Dimension("a density", "kg/m^3", "7850 kg/m^3", (-3, 1, 0))
ACCELERATION = Dimension("an acceleration", "m/s^2", "9.81 m/s^2", (1, 0, -2))
SPEED = Dimension("a speed", "m/s", "30 m/min", (1, 0, -1))
TURNING_SPEED = Dimension("a turning speed", "rad/s", "60 deg/s", (0, 0, -1), (0, 1))
FORCE = Dimension("a force", "N", "100 N", (1, 1, -2))
POWER = Dimension("a power", "W", "750 W", (2, 1, -3))
TURNING_ACCELERATION = Dimension(
    "an angular acceleration", "rad/s^2", "30 deg/s^2", (0, 0, -2), (0, 1)
)
MOMENT = Dimension("a moment", "N*m", "2 N*m", (2, 1, -2))
LINE_LOAD = Dimension("a force per length", "N/m", "3 N/mm", (0, 1, -2))
PRESSURE = Dimension("a modulus", "Pa", "205 GPa", (-1, 1, -2))
STIFFNESS = Dimension("a stiffness", "N/m", "3 N/um", (0, 1, -2))
ROTATIONAL_STIFFNESS = Dimension(
    "a rotational stiffness", "N*m/rad", "1e5 N*m/rad", (2, 1, -2), (0, -1)
)
COUPLING_STIFFNESS = Dimension("a coupling stiffness", "N/rad", "2e4 N/rad", (1, 1, -2), (0, -1))
DAMPING = Dimension("a viscous damping", "N*s/m", "40 N*s/m", (0, 1, -1))
ROTATIONAL_DAMPING = Dimension(
    "a rotational viscous damping", "N*m*s/rad", "2 N*m*s/rad", (2, 1, -1), (0, -1)
)


def quantity(value: object, dimension: Dimension, field: str) -> float:
    """Read one quantity.

    Parameters
    ----------
    value : number or str
        A number in the SI unit of `dimension`, or a string of a number and a unit.
    dimension : Dimension
    field : str
        Path of the field, named in an error.

    Returns
    -------
    float
        In SI units; 0 for less than `SMALLEST`, or than `SHORTEST` m.

    Raises
    ------
    UnitError
        Not a number, not finite, beyond `LARGEST` or, as a length, beyond `LONGEST`, an unknown
        unit, or a unit of another dimension.
    """
    if isinstance(value, str):
        return _from_text(value, dimension, field)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise UnitError(field, f"{shown(value)} is not {dimension.name}.", _hint(dimension))
    try:
        number = float(value)
    except OverflowError:
        number = float("inf")
    return _in_range(number, value, dimension, field)


def _in_range(number: float, value: object, dimension: Dimension, field: str) -> float:
    if not isfinite(number):
        raise UnitError(field, f"{shown(value)} is not a finite number.", _hint(dimension))
    length = dimension.powers == LENGTH.powers
    largest, smallest = (LONGEST, SHORTEST) if length else (LARGEST, SMALLEST)
    if abs(number) > largest:
        limit = f"{largest:g} {dimension.unit}".strip()
        raise UnitError(
            field,
            f"{shown(value)} is beyond {limit}, the largest that is accepted.",
            _hint(dimension),
        )
    return number if abs(number) >= smallest else 0.0


def _from_text(text: str, dimension: Dimension, field: str) -> float:
    match = _NUMBER.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None:
        raise UnitError(
            field, f"{shown(text)} is not {dimension.name}: it is not a number.", _hint(dimension)
        )
    digits, unit = match.groups()
    try:
        factor, powers = _unit(unit)
    except ValueError as error:
        raise UnitError(
            field, f"{shown(text)} is not {dimension.name}: {error}.", _hint(dimension)
        ) from None
    if powers[:3] != dimension.powers or powers[3] not in dimension.angle:
        found = _named(powers)
        raise UnitError(field, f"{shown(text)} is {found}, not {dimension.name}.", _hint(dimension))
    try:
        # decimal arithmetic: "216 mm" is the double nearest to 0.216
        number = float(Decimal(digits) * factor)
    except (DecimalException, OverflowError):
        number = float("inf")
    return _in_range(number, text, dimension, field)


def _hint(dimension: Dimension) -> str:
    if not dimension.unit:
        return "Give a plain number."
    return f'Give a number in {dimension.unit}, or a string with its unit: "{dimension.example}".'


def shown(value: object) -> str:
    """Show a value of a file, briefly, for a message.

    Parameters
    ----------
    value : object
        As the file's reader returns it: text, number, truth, list, table or None.
    """
    if isinstance(value, str):
        return f'"{value if len(value) <= _LONGEST else value[:60] + "…"}"'
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, dict):
        return "a table"
    if value is None:
        return "nothing"
    # Python refuses to print integers of thousands of digits
    if isinstance(value, int) and abs(value) > 10**18:
        return "an integer beyond 1e18"
    return str(value)


def _named(powers: Powers) -> str:
    for known in (
        *(NUMBER, ANGLE, LENGTH, AREA, TIME, RATE, MASS, INERTIA, DENSITY, ACCELERATION),
        *(FORCE, PRESSURE, STIFFNESS, ROTATIONAL_STIFFNESS, DAMPING, ROTATIONAL_DAMPING),
    ):
        if known.powers == powers[:3] and powers[3] == known.angle[-1]:
            return known.name
    if powers == (2, 1, -2, 0):
        return MOMENT.name
    units = zip(("m", "kg", "s", "rad"), powers, strict=True)
    return "of dimension " + " ".join(f"{unit}^{power}" for unit, power in units if power)


_PI = Decimal(repr(pi))
_UNITS: dict[str, tuple[Decimal, Powers]] = {
    name: (Decimal(factor), powers)
    for names, factor, powers in (
        ("m", "1", (1, 0, 0, 0)),
        ("cm", "1e-2", (1, 0, 0, 0)),
        ("mm", "1e-3", (1, 0, 0, 0)),
        ("um µm μm", "1e-6", (1, 0, 0, 0)),
        ("nm", "1e-9", (1, 0, 0, 0)),
        ("kg", "1", (0, 1, 0, 0)),
        ("g", "1e-3", (0, 1, 0, 0)),
        ("s", "1", (0, 0, 1, 0)),
        ("ms", "1e-3", (0, 0, 1, 0)),
        ("min", "60", (0, 0, 1, 0)),
        ("h", "3600", (0, 0, 1, 0)),
        ("Hz", "1", (0, 0, -1, 0)),
        ("N", "1", (1, 1, -2, 0)),
        ("kN", "1e3", (1, 1, -2, 0)),
        ("MN", "1e6", (1, 1, -2, 0)),
        ("J", "1", (2, 1, -2, 0)),
        ("W", "1", (2, 1, -3, 0)),
        ("kW", "1e3", (2, 1, -3, 0)),
        ("Pa", "1", (-1, 1, -2, 0)),
        ("MPa", "1e6", (-1, 1, -2, 0)),
        ("GPa", "1e9", (-1, 1, -2, 0)),
        ("rad", "1", (0, 0, 0, 1)),
        ("mrad", "1e-3", (0, 0, 0, 1)),
        ("urad µrad μrad", "1e-6", (0, 0, 0, 1)),
        ("%", "1e-2", (0, 0, 0, 0)),
    )
    for name in names.split()
} | {
    "deg": (_PI / 180, (0, 0, 0, 1)),
    "°": (_PI / 180, (0, 0, 0, 1)),
    "rpm": (_PI / 30, (0, 0, -1, 1)),
}


@lru_cache(maxsize=512)
def _unit(text: str) -> tuple[Decimal, Powers]:
    """Factor to SI and powers of a unit such as N*m/rad or kg/(m*s^2)."""
    tokens: list[str] = []
    at = 0
    while at < len(text):
        match = _TOKEN.match(text, at)
        if match is None:
            raise ValueError(f'"{text}" is not a unit')
        tokens.append("^" if match[1] == "**" else "*" if match[1] == "·" else match[1])
        at = match.end()
    if not tokens:
        return Decimal(1), (0, 0, 0, 0)
    result, rest = _product(tokens, text)
    if rest:
        raise ValueError(f'"{text}" is not a unit')
    return result


def _product(tokens: list[str], text: str) -> tuple[tuple[Decimal, Powers], list[str]]:
    factor, powers = Decimal(1), (0, 0, 0, 0)
    sign = 1
    while True:
        (part, part_powers), tokens = _factor(tokens, text)
        factor = factor * part if sign > 0 else factor / part
        powers = _sum(powers, part_powers, sign)
        if not tokens or tokens[0] == ")":
            return (factor, powers), tokens
        sign = -1 if tokens[0] == "/" else 1
        # a space between two units multiplies
        tokens = tokens[1:] if tokens[0] in "*/" else tokens


def _factor(tokens: list[str], text: str) -> tuple[tuple[Decimal, Powers], list[str]]:
    if not tokens:
        raise ValueError(f'"{text}" is not a unit')
    head, rest = tokens[0], tokens[1:]
    if head == "(":
        (factor, powers), rest = _product(rest, text)
        if not rest:
            raise ValueError(f'"{text}" lacks a closing bracket')
        rest = rest[1:]
    elif head == "1":
        factor, powers = Decimal(1), (0, 0, 0, 0)
    elif head[0].isalpha() or head in "°%":
        factor, powers = _UNITS[head] if head in _UNITS else _from_pint(head)
    else:
        raise ValueError(f'"{text}" is not a unit')
    if rest and rest[0] == "^":
        if len(rest) < 2 or not re.fullmatch(r"[+-]?\d", rest[1]):
            raise ValueError(f'"{text}" has a power that is not a whole number below ten')
        power = int(rest[1])
        return (factor**power, _sum((0, 0, 0, 0), powers, power)), rest[2:]
    return (factor, powers), rest


def _sum(first: Powers, second: Powers, times: int) -> Powers:
    a, b, c, d = (x + times * y for x, y in zip(first, second, strict=True))
    return a, b, c, d


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint  # noqa: PLC0415 - slow to import, seldom needed

    return pint.UnitRegistry()


def _from_pint(name: str) -> tuple[Decimal, Powers]:
    import pint  # noqa: PLC0415 - slow to import, seldom needed

    try:
        one = _registry().Quantity(1.0, name).to_base_units()
        two = _registry().Quantity(2.0, name).to_base_units()
    except (pint.PintError, AttributeError, ValueError, TypeError, SyntaxError):
        raise ValueError(f'unknown unit "{name}"') from None
    powers = dict.fromkeys(("meter", "kilogram", "second", "radian"), 0)
    for unit, power in one.unit_items():
        if unit not in powers or power != int(power):
            raise ValueError(f'"{name}" is not a unit of length, mass, time or angle')
        powers[unit] = int(power)
    # decibels and degrees Celsius have no factor
    if abs(two.magnitude - 2.0 * one.magnitude) > 1e-12 * abs(two.magnitude):
        raise ValueError(f'"{name}" has no zero to count from')
    m, kg, s, rad = powers.values()
    return Decimal(repr(float(one.magnitude))), (m, kg, s, rad)
