"""Numbers of Son 2002 that follow from each other, sections 9.1 and 9.2.

@phdthesis{Son2002,
  author = {Son, Seung-Kil},
  title = {A Hybrid Type Small 5-Axis {CNC} Milling Machine},
  school = {Massachusetts Institute of Technology}, year = {2002}}

Each tolerance is half a unit of the last digit that the thesis or the arithmetic prints.
"""

from math import pi

import pytest

from strutwork.machines import MitSS1
from strutwork.papers.son_2002.calibration import MOVING_MASS
from strutwork.papers.son_2002.published import MODES, TABLE_6, table_6_row

#: Equivalent stiffness of the tilt along x, N/m, and from the tilting centre to the spindle's
#: end, m (section 9.2.1).
K_EQ, ARM = 6.46e6, 0.070

#: Tilting frequency with the spindle, Hz (eq. 66).
WITH_SPINDLE = 71.3


def measured_tilt() -> float:
    return MODES.value("spindle housing tilt", "measured")


def test_moving_mass() -> None:
    # a spindle of 7.1 kg (Appendix C) is about 6 % of it
    assert pytest.approx(118.3, abs=0.05) == 7.1 / 0.06
    assert MOVING_MASS.value == pytest.approx(118.3, abs=0.05)


def test_tilting_stiffness_and_inertia() -> None:
    torsion = K_EQ * ARM**2
    assert torsion == pytest.approx(31.65e3, abs=5)
    inertia = torsion / (2 * pi * measured_tilt()) ** 2
    assert inertia == pytest.approx(0.1278, abs=5e-5)
    assert MitSS1().housing_inertia == pytest.approx(inertia, abs=5e-5)


def test_resultant_stiffness_at_the_spindle_end() -> None:
    along_x = 1e6 * TABLE_6.value(table_6_row(-50, 30), "Kx")
    resultant = 1e-6 / (1 / along_x + 1 / K_EQ)
    assert resultant == pytest.approx(4.72, abs=5e-3)


def test_frequency_with_the_spindle_needs_this_inertia() -> None:
    assert (measured_tilt() / WITH_SPINDLE) ** 2 == pytest.approx(1.234, abs=5e-4)
