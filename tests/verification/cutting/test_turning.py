"""Turning and shaping: limits in closed form.

@book{altintas2012cutting,
  title     = {Manufacturing Automation: Metal Cutting Mechanics, Machine Tool Vibrations,
               and CNC Design},
  author    = {Altintas, Yusuf},
  edition   = {2},
  publisher = {Cambridge University Press},
  year      = {2012},
  note      = {chapter 4: a_lim = −1/(2 K_f Re G) and the speeds of the lobes; exercise on
               shaping with two modes}
}

@article{hayes1950,
  title   = {Roots of the Transcendental Equation Associated with a Certain
             Difference-Differential Equation},
  author  = {Hayes, N. D.},
  journal = {Journal of the London Mathematical Society s1-25, 226-232},
  year    = {1950}
}
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.cutting import PeriodMap, TipModes, Turning, depth_limits, zero_order_lobes
from strutwork.cutting.elements import gauss, response_weights
from tests.cutting_cases import CLOSED_DEPTH, CLOSED_FREQUENCY, CLOSED_SPEEDS, one_mode, shaping


def test_one_degree_of_freedom_by_the_zero_order_method() -> None:
    """Turning: a = 2 k ζ (1 + ζ)/K_f at f √(1 + 2 ζ)."""
    lobes = zero_order_lobes(one_mode().receptance(np.linspace(252.0, 254.0, 20001)), Turning(1e9))
    depth, frequency = lobes.absolute
    # lines every 0.1 mHz about a minimum, whose error is of second order
    assert depth == pytest.approx(CLOSED_DEPTH, rel=1e-8)
    assert frequency == pytest.approx(CLOSED_FREQUENCY, abs=1e-3)


def test_one_degree_of_freedom_by_the_period_map() -> None:
    """At the speeds where a lobe touches its least depth the exact limit is the closed form."""
    found = depth_limits(one_mode(), Turning(1e9), CLOSED_SPEEDS, 0.05)
    # multipliers are certain to 1e-6, and change by about 1 over the limiting depth
    np.testing.assert_allclose(found.depth, CLOSED_DEPTH, rtol=5e-6)
    # the phase of a multiplier is as certain as its magnitude
    np.testing.assert_allclose(found.frequencies, CLOSED_FREQUENCY, atol=1e-3)
    assert set(found.kinds) == {"Hopf"}


def test_zero_order_and_period_map_agree_where_the_cut_is_steady() -> None:
    """Turning has no periodic coefficient: the zero-order method leaves nothing out."""
    speeds = np.linspace(3000.0, 9000.0, 13)
    exact = depth_limits(one_mode(), Turning(1e9), speeds, 0.2)
    lobes = zero_order_lobes(one_mode().receptance(np.linspace(240.0, 700.0, 200001)), Turning(1e9))
    # the period map is certain to 1e-6, lines are 2 mHz apart
    np.testing.assert_allclose(exact.depth, lobes.at(speeds).depth, rtol=1e-5)


def test_shaping_with_two_modes() -> None:
    """Modes at +30 and −45 degrees to the chip; no printed result: values of two methods."""
    lobes = zero_order_lobes(shaping().receptance(np.linspace(140.0, 300.0, 160001)), Turning(1e9))
    low = lobes.frequencies < 200.0
    depth, frequency = lobes.absolute
    second = np.where(low, lobes.depth[:, 0], np.inf)
    # seven digits of the values, which a period map and a semi-discretisation share
    assert depth == pytest.approx(7.184977e-3, rel=1e-6)
    # two decimals of the value
    assert frequency == pytest.approx(252.98, abs=5e-3)
    # seven digits of the values, which a period map and a semi-discretisation share
    assert second.min() == pytest.approx(9.458426e-3, rel=1e-6)
    # two decimals of the value
    assert lobes.frequencies[second.argmin()] == pytest.approx(151.49, abs=5e-3)


def test_the_period_map_finds_the_limit_of_shaping() -> None:
    """At the speed where the first lobe of the first family touches its least depth."""
    lines = np.linspace(252.9, 253.1, 200001)
    lobes = zero_order_lobes(shaping().receptance(lines), Turning(1e9))
    speeds, depth = lobes.curve(0, 1)
    at = int(depth.argmin())
    found = depth_limits(shaping(), Turning(1e9), speeds[at], 0.05)
    # multipliers are certain to 1e-6
    np.testing.assert_allclose(found.depth, 7.184977e-3, rtol=5e-6)
    assert found.modes[0] == 0


def test_hayes_border_of_a_delayed_decay() -> None:
    """x′ = a x + b x(t − 1) has the border b = −π/2 at a = 0, crossed at the frequency π/2."""
    # as a mode without inertia: x′ = −(π/2) x + (π/2) (x − x(t − 1))
    pole, order = np.array([-0.5 * np.pi + 0.0j]), 16
    weights = response_weights(pole, order, 1.0)[0].real
    times = 0.5 * (gauss(order)[0] + 1.0)
    free = np.exp(pole[0].real * times)[:, None]
    decay = np.exp(pole.real)[:, None]
    border = PeriodMap(weights[:-1], free, decay, weights[-1:]).largest(0.5 * np.pi)
    # sixteen nodes leave rounding alone
    assert abs(border) == pytest.approx(1.0, abs=1e-12)
    # sixteen nodes leave rounding alone
    assert np.angle(border) == pytest.approx(0.5 * np.pi, abs=1e-12)


def test_a_mode_of_a_tip_has_the_receptance_of_its_stiffness() -> None:
    """At a very low frequency one over k."""
    modes: TipModes = one_mode()
    static = modes.receptance([1e-3, 2e-3]).receptance[0, 0, 0]
    # the square of 1 mHz by 250 Hz, and damping to it
    assert static.real == pytest.approx(1.0 / 2.26e8, rel=1e-6)
