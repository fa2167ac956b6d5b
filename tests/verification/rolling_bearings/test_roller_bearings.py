"""Deflection of cylindrical roller bearings: a standard's formula beside Palmgren's.

@techreport{iso16281,
  author      = {{ISO}},
  title       = {{ISO/TS} 16281: Rolling bearings. Methods for calculating the modified reference
                 rating life for universally loaded bearings},
  year        = {2008}
}
@book{palmgren1959ball,
  author    = {Palmgren, Arvid},
  title     = {Ball and Roller Bearing Engineering},
  publisher = {SKF Industries},
  edition   = {3},
  year      = {1959}
}

The standard's spring constant of a roller between two raceways is 35 948 l^(8/9) N/mm^(10/9);
Palmgren's formula, which is computed here, has the same exponents and 3.84e-5 Q^0.9 / l^0.8 mm for
one raceway, which makes 40 300. Both smooth what was measured, and no rollers of finite length have
an exact solution: 12 % of the stiffness is their distance. No measured curve with the geometry of
its bearing was at hand.
"""

from __future__ import annotations

import pytest

from strutwork.contact import CylindricalRollers

#: Between two formulas for the same contact.
FORMULAS = 0.13


@pytest.mark.parametrize("length", [6e-3, 13.6e-3, 30e-3])
def test_spring_constant_of_the_standard(length: float) -> None:
    law = CylindricalRollers(6, length).law()
    found = law.constant * 1e-3 ** (10.0 / 9.0)
    assert found == pytest.approx(35_948 * (1e3 * length) ** (8.0 / 9.0), rel=FORMULAS)


@pytest.mark.parametrize("force", [100.0, 1000.0, 10_000.0])
def test_approach_of_one_raceway_in_palmgrens_units(force: float) -> None:
    law = CylindricalRollers(6, 10e-3).law()
    # the formula itself, to rounding
    assert 1e3 * law.approach(force) == pytest.approx(2 * 3.84e-5 * force**0.9 / 10**0.8, rel=1e-9)
