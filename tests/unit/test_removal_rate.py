"""The argument at constant removal rate, step by step, against its closed-form exponents."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.studies.removal_rate import (
    actuator_force,
    cutting_force,
    cutting_force_at_rate,
    frequency_exponent,
    largest_feed,
    relative_deflection,
    removal_exponents,
    removal_rate,
)

SIZES = np.geomspace(0.2, 5.0, 7)


def slope(values: np.ndarray) -> float:
    slopes = np.diff(np.log(values)) / np.diff(np.log(SIZES))
    assert np.ptp(slopes) < 1e-12
    return float(slopes[0])


@pytest.mark.parametrize("actuator", [1.0, 2.0, 3.0, 3.5])
@pytest.mark.parametrize("stiffness", [1.0, 0.4])
def test_exponents_are_those_of_the_steps(actuator: float, stiffness: float) -> None:
    feed = largest_feed(2450.0 * SIZES**actuator, 500.0 * SIZES**3, 0.02)
    assert actuator_force(500.0 * SIZES**3, feed, 0.02) == pytest.approx(2450.0 * SIZES**actuator)
    force = cutting_force_at_rate(4e-8, feed, 2e-4, 6e9, (1.6e-4, 1.2e-4))
    deflection = force / (5e7 * SIZES**stiffness)
    found = removal_exponents(actuator, stiffness)
    assert slope(feed) == pytest.approx(found.feed, abs=1e-12)
    assert slope(force) == pytest.approx(found.cutting_force, abs=1e-12)
    assert slope(deflection) == pytest.approx(found.deflection, abs=1e-12)
    ratio = relative_deflection(SIZES, SIZES**stiffness, actuator)
    assert ratio == pytest.approx(deflection / np.interp(1.0, SIZES, deflection), rel=1e-9)


def test_the_force_at_a_rate_is_that_of_its_depth() -> None:
    depth, width, feed = 3e-4, 2e-4, np.array([0.02, 0.1])
    rate = removal_rate(depth, width, feed)
    assert rate == pytest.approx([1.2e-9, 6e-9])
    at_rate = cutting_force_at_rate(rate, feed, width, 6e9, (3e-4, 4e-4))
    assert at_rate == pytest.approx(float(cutting_force(depth, 6e9, (3e-4, 4e-4))))
    assert at_rate == pytest.approx(5e-4 * 3e-4 * 6e9)


def test_relative_deflection_of_many_axes() -> None:
    stiffness = np.stack([SIZES, SIZES**0.5], axis=-1)
    found = relative_deflection(SIZES, stiffness, 3.5)
    assert found.shape == (7, 2)
    assert slope(found[:, 0]) == pytest.approx(-1.25)
    assert slope(found[:, 1]) == pytest.approx(-0.75)


def test_frequency() -> None:
    assert frequency_exponent() == -1.0
    assert frequency_exponent(0.0) == -1.5


@pytest.mark.parametrize("value", [nan, inf])
def test_exponents_that_are_none(value: float) -> None:
    with pytest.raises(ModelError, match="actuator"):
        removal_exponents(value)
    with pytest.raises(ModelError, match="stiffness"):
        removal_exponents(3.0, value)
