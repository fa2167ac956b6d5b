"""A bull-nose cutter whose tip was measured: residues of four modes.

@book{altintas2012bullnose,
  title     = {Manufacturing Automation: Metal Cutting Mechanics, Machine Tool Vibrations,
               and CNC Design},
  author    = {Altintas, Yusuf},
  edition   = {2},
  publisher = {Cambridge University Press},
  year      = {2012},
  note      = {page 162: modes and coefficients; no printed result: values of two methods}
}
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.cutting import depth_limits, zero_order_lobes
from tests.cutting_cases import bull_nose, bull_nose_cut
from tests.semi_discretization import Cut, extrapolated

SPEEDS = np.array([5000.0, 9500.0, 10000.0, 14000.0])


@pytest.mark.parametrize(
    ("real", "values"),
    [(False, [1.028, 1.021, 1.539, 5.047]), (True, [0.973, 0.969, 1.465, 4.705])],
)
def test_zero_order_limits(real: bool, values: list[float]) -> None:
    """With the measured residues, and with their imaginary parts alone."""
    lobes = zero_order_lobes(
        bull_nose(real).receptance(np.arange(100.0, 3000.0, 0.05)), bull_nose_cut()
    )
    # four digits of values whose lines are not known, at 10000 rpm on the steep side of a lobe
    np.testing.assert_allclose(lobes.at(SPEEDS).depth * 1e3, values, rtol=5e-3)


def test_absolute_limit() -> None:
    """The depth that is stable at every speed, and where it chatters."""
    lobes = zero_order_lobes(
        bull_nose(real=False).receptance(np.arange(100.0, 3000.0, 0.05)), bull_nose_cut()
    )
    depth, frequency = lobes.absolute
    # five digits of the value
    assert depth * 1e3 == pytest.approx(1.0147, abs=5e-5)
    # lines are 0.05 Hz apart
    assert frequency == pytest.approx(1440.75, abs=0.1)


def test_limits_by_the_period_map() -> None:
    """With the imaginary parts of the residues, as a sum of real modes."""
    found = depth_limits(bull_nose(real=True), bull_nose_cut(), SPEEDS, 0.01)
    # six digits of the values
    np.testing.assert_allclose(found.depth[1:] * 1e3, [0.91480, 1.57741, 5.02938], rtol=1e-5)
    # the value of this speed is less certain: the semi-discretisation below holds the computed one
    np.testing.assert_allclose(found.depth[0] * 1e3, 0.86983, rtol=1e-3)


def test_the_semi_discretization_stands_at_the_border_there() -> None:
    """Residues of real modes are those of shapes: r = −i/(2 m ω)."""
    modes = bull_nose(real=True)
    shapes = np.sqrt(-2.0 * modes.poles.imag[:, None] * modes.loads[:, :2].imag.clip(max=0.0))
    omega = np.abs(modes.poles)
    cut = Cut(
        omega / (2.0 * np.pi),
        -modes.poles.real / omega,
        shapes,
        1319.4e6,
        788.8e6,
        0.5 * np.pi,
        np.pi,
        2,
    )
    depths = depth_limits(modes, bull_nose_cut(), SPEEDS, 0.01).depth
    found = [extrapolated(cut, n, a, 160) for n, a in zip(SPEEDS, depths, strict=True)]
    # what extrapolation from 160 and 320 steps leaves
    np.testing.assert_allclose(found, 1.0, rtol=2e-5)
