from __future__ import annotations

import subprocess
import sys
from math import inf, nan, pi
from typing import Any

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from strutwork import units
from strutwork.errors import UnitError
from strutwork.units import Dimension, quantity


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("216 mm", units.LENGTH, 0.216),
        ("216mm", units.LENGTH, 0.216),
        (" -1.5e2 um ", units.LENGTH, -150e-6),
        ("3 N/um", units.STIFFNESS, 3e6),
        ("3 N/µm", units.STIFFNESS, 3e6),
        ("40 N*s/m", units.DAMPING, 40.0),
        ("40 N·s/m", units.DAMPING, 40.0),
        ("0.3 mrad", units.ANGLE, 0.3e-3),
        ("180 deg", units.ANGLE, pi),
        ("180°", units.ANGLE, pi),
        ("0.3", units.ANGLE, 0.3),
        ("1e5 N*m/rad", units.ROTATIONAL_STIFFNESS, 1e5),
        ("1e5 N*m", units.ROTATIONAL_STIFFNESS, 1e5),
        ("1 N m/deg", units.ROTATIONAL_STIFFNESS, 180 / pi),
        ("2 N*m*s/rad", units.ROTATIONAL_DAMPING, 2.0),
        ("205 GPa", units.PRESSURE, 205e9),
        ("205 kN/mm^2", units.PRESSURE, 205e9),
        ("205 kN/mm**2", units.PRESSURE, 205e9),
        ("5 kg/(m*s^2)", units.PRESSURE, 5.0),
        ("7850 kg/m^3", units.DENSITY, 7850.0),
        ("7.85 g/cm^3", units.DENSITY, 7850.0),
        ("-9.81 m/s^2", units.ACCELERATION, -9.81),
        ("2 kg*cm^2", units.INERTIA, 2e-4),
        ("5.36 1/s", units.RATE, 5.36),
        ("2 m^-1*m^2", units.LENGTH, 2.0),
        ("1 %", units.NUMBER, 0.01),
        # units that only the library knows; the inch and the pound-force are exact by definition
        ("2 inch", units.LENGTH, 0.0508),
        ("1 lbf", units.FORCE, 4.4482216152605),
        ("3 minute", units.TIME, 180.0),
        (7, units.LENGTH, 7.0),
        (-2.5, units.FORCE, -2.5),
    ],
)
def test_quantity(text: object, dimension: Dimension, expected: float) -> None:
    # four roundings at most, of factors that are themselves rounded
    assert quantity(text, dimension, "field") == pytest.approx(expected, rel=1e-15, abs=0.0)


@pytest.mark.parametrize(
    ("value", "dimension", "expected"),
    [
        ("3 kg", units.LENGTH, ['"3 kg" is a mass, not a length', "m", '"216 mm"']),
        ("3 N*m", units.FORCE, ["a moment, not a force"]),
        ("3 N/m", units.ROTATIONAL_STIFFNESS, ["not a rotational stiffness", "N*m/rad"]),
        ("3 kg^2", units.MASS, ["of dimension kg^2"]),
        ("30 deg", units.NUMBER, ["an angle, not a pure number", "plain number"]),
        ("3 rad/s", units.RATE, ["not a rate"]),
        ("216", units.LENGTH, ["a pure number, not a length"]),
        ("mm", units.LENGTH, ["not a number"]),
        ("", units.LENGTH, ["not a number"]),
        ("3 foo", units.LENGTH, ['unknown unit "foo"']),
        ("3 mm^99", units.LENGTH, ["power"]),
        ("3 mm^", units.LENGTH, ["power"]),
        ("9**9**9 m", units.LENGTH, ["not a unit"]),
        ("3 (m", units.LENGTH, ["bracket"]),
        ("3 m)", units.LENGTH, ["not a unit"]),
        ("3 N/", units.FORCE, ["not a unit"]),
        ("3 m; 4", units.LENGTH, ["not a unit"]),
        ("3 degC", units.LENGTH, ["degC"]),
        ("3 dB", units.NUMBER, ["dB"]),
        ("nan mm", units.LENGTH, ["not a number"]),
        ("1e400 mm", units.LENGTH, ["not a finite number"]),
        ("1e308 km", units.LENGTH, ["not a finite number"]),
        ("1e999999999999999999 m", units.LENGTH, ["not a finite number"]),
        ("3 " + "m" * 100, units.LENGTH, ["…"]),
        (inf, units.LENGTH, ["inf is not a finite number"]),
        (nan, units.LENGTH, ["nan is not a finite number"]),
        pytest.param(10**5000, units.LENGTH, ["not a finite number"], id="5000 digits"),
        (True, units.LENGTH, ["true is not a length"]),
        (None, units.LENGTH, ["not a length"]),
        ([1.0], units.LENGTH, ["a list is not a length"]),
        ({}, units.LENGTH, ["a table is not a length"]),
    ],
)
def test_wrong_quantity(value: object, dimension: Dimension, expected: list[str]) -> None:
    with pytest.raises(UnitError) as raised:
        quantity(value, dimension, "beams.arm.length")
    message = str(raised.value)
    assert raised.value.part == "beams.arm.length"
    assert [part for part in expected if part not in message] == [], message


@pytest.mark.parametrize("name", sorted(set(units._UNITS) - {"%", "°"}))
def test_table_agrees_with_the_library(name: str) -> None:
    factor, powers = units._UNITS[name]
    found, found_powers = units._from_pint(name)
    assert powers == found_powers
    # the library multiplies prefixes in doubles
    assert float(factor) == pytest.approx(float(found), rel=4e-16, abs=0.0)


def test_every_example_has_the_dimension_it_stands_for() -> None:
    declared = [d for d in vars(units).values() if isinstance(d, Dimension)]
    assert len(declared) == 25
    registry: Any = pint.UnitRegistry()
    for dimension in declared:
        assert quantity(f"1 {dimension.unit}", dimension, "field") == 1.0
        library = (
            registry.Quantity(dimension.example.replace("1/s", "Hz")).to_base_units().magnitude
        )
        assert quantity(dimension.example, dimension, "field") == pytest.approx(
            library, rel=1e-14, abs=0.0
        )


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=-1e9, max_value=1e9))
def test_a_unit_multiplies(number: float) -> None:
    # each reading is rounded once; what is too small to count is none
    read = quantity(f"{number!r} mm", units.LENGTH, "field")
    assert read == pytest.approx(number * 1e-3, rel=4e-16, abs=units.SHORTEST)
    least = 0.0 if abs(number) < units.SHORTEST else number
    assert quantity(f"{number!r} m", units.LENGTH, "field") == least


def test_library_stays_unloaded_for_common_units() -> None:
    program = (
        "import sys; from strutwork import units as u;"
        "print(u.quantity('3 N/um', u.STIFFNESS, ''), 'pint' in sys.modules);"
        "print(u.quantity('3 minute', u.TIME, ''), 'pint' in sys.modules)"
    )
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert run.stdout.split() == ["3000000.0", "False", "180.0", "True"]


@pytest.mark.parametrize(
    ("value", "dimension"),
    [
        (1e300, units.LENGTH),
        ("1e5 Mm", units.LENGTH),
        (-2e9, units.LENGTH),
        (2e30, units.STIFFNESS),
        ("1e30 N/um", units.STIFFNESS),
    ],
)
def test_what_leaves_the_range_of_doubles_in_products_is_refused(
    value: object, dimension: Dimension
) -> None:
    with pytest.raises(UnitError, match="the largest that is accepted"):
        quantity(value, dimension, "field")


def test_magnitudes_that_nothing_has_count_as_none() -> None:
    assert quantity(1e-31, units.LENGTH, "field") == 0.0
    assert quantity("5e-324 N/m", units.STIFFNESS, "field") == 0.0
    # a wire of a micrometre: I = 5e-26 m^4
    assert quantity(5e-26, units.SECOND_MOMENT, "field") == 5e-26
