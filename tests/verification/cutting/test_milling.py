"""Milling with one and two modes: multipliers and limits, beside a semi-discretisation.

@article{insperger2004,
  title   = {Updated semi-discretization method for periodic delay-differential equations with
             discrete delay},
  author  = {Insperger, Tamás and Stépán, Gábor},
  journal = {International Journal for Numerical Methods in Engineering 61, 117-141},
  year    = {2004},
  note    = {data of the process; no printed result: values of two independent methods}
}

@article{ding2010,
  title   = {A full-discretization method for prediction of milling stability},
  author  = {Ding, Ye and Zhu, LiMin and Zhang, XiaoJian and Ding, Han},
  journal = {International Journal of Machine Tools and Manufacture 50, 502-509},
  year    = {2010}
}
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.cutting import depth_limits, period_map, stability_chart, zero_order_lobes
from tests.cutting_cases import mill, mill_cut, mill_tip
from tests.semi_discretization import extrapolated, largest

SPEEDS = np.array([5000.0, 10000.0, 15000.0, 20000.0, 25000.0])
DEPTHS = np.array([0.2, 0.5, 1.0, 1.5]) * 1e-3
ONE_MODE = [0.8197428, 1.0739756, 1.4064735, 1.628037]


def test_multipliers_of_one_mode_in_full_immersion() -> None:
    """At 5000 rpm; the values are those of another period map to seven digits."""
    chart = stability_chart(mill_tip(1), mill(1.0), [5000.0], DEPTHS)
    # nodes are added until magnitudes change by 1e-6 of them
    np.testing.assert_allclose(np.abs(chart.multipliers[0]), ONE_MODE, rtol=1e-6)
    assert chart.change <= 1e-6


def test_semi_discretization_converges_to_them() -> None:
    """Its error falls with the square of the steps: extrapolation from 160 and 320 steps."""
    cut = mill_cut(mill(1.0), 1)
    found = [extrapolated(cut, 5000.0, depth, 160) for depth in DEPTHS]
    # what is left is of fourth order in the steps
    np.testing.assert_allclose(found, ONE_MODE, rtol=1e-5)
    errors = [largest(cut, 5000.0, 1e-3, m) - ONE_MODE[2] for m in (80, 160)]
    # second order: a quarter for twice the steps
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize(
    ("immersion", "deepest", "values"),
    [
        (0.05, 0.02, [1.8438020, 1.4869496, 1.6512136, 3.2503857, np.inf]),
        (0.1, 0.03, [0.9164364, 0.9701247, 1.3583807, 2.8361901, 19.87]),
        (0.5, 0.01, [0.1271062, 0.1810301, 0.2818420, 0.1761593, 1.6017694]),
    ],
)
def test_limiting_depths_of_two_modes(
    immersion: float, deepest: float, values: list[float]
) -> None:
    """Down-milling; the values, in mm, are those of two independent methods."""
    found = depth_limits(mill_tip(2), mill(immersion), SPEEDS, deepest)
    assert np.isinf(values[-1]) == np.isinf(found.depth[-1])
    # seven digits of the values, of which multipliers of 1e-6 leave six
    np.testing.assert_allclose(found.depth[:4] * 1e3, values[:4], rtol=2e-6)
    if np.isfinite(values[-1]):
        # as many digits as the value has
        np.testing.assert_allclose(found.depth[4] * 1e3, values[4], rtol=5e-5)


def test_limiting_depths_in_full_immersion() -> None:
    """Of 5000 rpm no value converged elsewhere; here it does."""
    found = depth_limits(mill_tip(2), mill(1.0), SPEEDS, 0.002)
    # seven digits of the values, of which multipliers of 1e-6 leave five at so small depths
    np.testing.assert_allclose(
        found.depth[1:] * 1e3, [0.0714108, 0.1144476, 0.0632216, 0.5301304], rtol=1e-5
    )
    cut = mill_cut(mill(1.0), 2)
    sides = [extrapolated(cut, 5000.0, float(found.depth[0]) * side, 160) for side in (0.99, 1.01)]
    assert sides[0] < 1.0 < sides[1]


def test_a_flip_lobe_that_the_zero_order_method_does_not_know() -> None:
    """Immersion 0.05 at 20000 rpm: the multiplier is −1, and zero order gives twice the depth."""
    process = mill(0.05)
    exact = depth_limits(mill_tip(2), process, [20000.0], 0.02)
    assert exact.kinds == ("flip",)
    # the multiplier at the border is certain to 1e-6
    assert exact.multipliers[0].real == pytest.approx(-1.0, abs=1e-6)
    # half the frequency of the teeth, an odd number of times
    assert exact.frequencies[0] == pytest.approx(1000.0, abs=1e-3)
    lobes = zero_order_lobes(mill_tip(2).receptance(np.linspace(500.0, 3000.0, 100001)), process)
    # three digits of a value whose lines are not known
    assert lobes.at([20000.0]).depth[0] * 1e3 == pytest.approx(6.82, rel=0.01)


@pytest.mark.parametrize(
    ("speed", "depth"), [(10000.0, 1e-3), (15000.0, 3e-3), (20000.0, 8e-3), (20000.0, 60e-3)]
)
def test_a_helix_of_thirty_degrees(speed: float, depth: float) -> None:
    """Beside the semi-discretisation, which adds slices along the depth; up to several pitches."""
    process = mill(0.5, helix=np.pi / 6.0)
    exact = abs(period_map(mill_tip(2), process, speed / 60.0, depth, 12).largest(depth))
    # 400 slices and 80 steps, extrapolated
    assert extrapolated(mill_cut(process, 2), speed, depth, 80) == pytest.approx(exact, rel=1e-4)
