"""Sections against tables: second moments, Saint-Venant torsion, Cowper's coefficients.

Timoshenko, S. P., Goodier, J. N.: Theory of Elasticity, 3rd ed., McGraw-Hill 1970, section 109
(table of k1 for rectangular bars). Cowper, G. R.: The Shear Coefficient in Timoshenko's Beam
Theory, J. Appl. Mech. 33 (1966) 335-340.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from math import pi

import pytest

from strutwork.errors import ModelError
from strutwork.msa import Section, box, rectangle, rod, tube

# products and powers of doubles
ROUND_OFF = 1e-14


def shear_coefficient(section: Section, nu: float) -> tuple[float, float]:
    areas = section.shear_area(nu)
    assert areas is not None
    return areas[0] / section.area, areas[1] / section.area


def test_rod() -> None:
    section = rod(0.02)
    assert section.area == pytest.approx(pi * 1e-4, rel=ROUND_OFF)
    assert section.second_moment_y == pytest.approx(pi * 0.01**4 / 4, rel=ROUND_OFF)
    assert section.second_moment_z == section.second_moment_y
    assert section.torsion_constant == pytest.approx(pi * 0.01**4 / 2, rel=ROUND_OFF)


def test_tube_is_the_difference_of_two_rods() -> None:
    section, outer, inner = tube(0.019, 0.014), rod(0.019), rod(0.014)
    for field in ("area", "second_moment_y", "second_moment_z", "torsion_constant"):
        expected = getattr(outer, field) - getattr(inner, field)
        assert getattr(section, field) == pytest.approx(expected, rel=ROUND_OFF)


def test_second_moments_of_a_rectangle_belong_to_their_planes() -> None:
    section = rectangle(0.02, 0.05)
    # Iy bends in the x-z plane, so it takes the cube of the height along z
    assert section.second_moment_y == pytest.approx(0.02 * 0.05**3 / 12, rel=ROUND_OFF)
    assert section.second_moment_z == pytest.approx(0.05 * 0.02**3 / 12, rel=ROUND_OFF)
    assert section.area == pytest.approx(1e-3, rel=ROUND_OFF)


@pytest.mark.parametrize(
    ("ratio", "k1"),
    [
        (1.0, 0.1406),
        (1.2, 0.166),
        (1.5, 0.196),
        (2.0, 0.229),
        (2.5, 0.249),
        (3.0, 0.263),
        (4.0, 0.281),
        (5.0, 0.291),
        (10.0, 0.312),
    ],
)
def test_torsion_of_a_rectangle_is_timoshenko_and_goodiers_table(ratio: float, k1: float) -> None:
    short = 0.01
    found = rectangle(short, ratio * short).torsion_constant / (short**3 * ratio * short)
    # half a unit of the table's last digit, and a little for the table's own rounding
    assert found == pytest.approx(k1, abs=0.6e-4 if ratio == 1.0 else 0.6e-3)
    turned = rectangle(ratio * short, short).torsion_constant
    assert turned == rectangle(short, ratio * short).torsion_constant


def test_torsion_of_a_thin_strip_tends_to_a_third() -> None:
    # J = a b³ (1/3 − 0.21 b/a): T&G eq. 164
    assert rectangle(1.0, 0.001).torsion_constant / 1e-9 == pytest.approx(1 / 3 - 0.00021, abs=1e-6)


@pytest.mark.parametrize(
    ("section", "nu", "kappa"),
    [
        (rod(0.1), 0.0, 6 / 7),
        (rod(0.1), 0.3, 0.886),
        (rectangle(0.1, 0.3), 0.0, 5 / 6),
        (rectangle(0.1, 0.3), 0.3, 0.850),
        # thin round tube: 2 (1 + ν) / (4 + 3 ν)
        (tube(0.1, 0.09999), 0.3, 2.6 / 4.9),
        (tube(0.1, 0.09999), 0.0, 0.5),
        # thin square tube: 20 (1 + ν) / (48 + 39 ν)
        (box(0.1, 0.1, 1e-4), 0.3, 26 / 59.7),
        (box(0.1, 0.1, 1e-4), 0.0, 20 / 48),
        # a tube with a vanishing bore is a rod
        (tube(0.1, 1e-6), 0.3, 0.886),
    ],
)
def test_shear_coefficients_are_cowpers(section: Section, nu: float, kappa: float) -> None:
    # the paper's three digits
    for found in shear_coefficient(section, nu):
        assert found == pytest.approx(kappa, abs=6e-4)


def test_shear_of_a_flat_box_is_carried_by_its_webs() -> None:
    # 0.2 wide along y, 0.1 high along z: along y the long walls are the webs
    along_y, along_z = shear_coefficient(box(0.2, 0.1, 1e-5), 0.3)
    assert along_y > 0.5 > along_z
    # Cowper's formula at ν = 0.3, m = n = b/h = 0.1/0.2 for shear along y
    m = n = 0.09999 / 0.19999
    below = (
        12 + 72 * m + 150 * m**2 + 90 * m**3
        + 0.3 * (11 + 66 * m + 135 * m**2 + 90 * m**3)
        + 10 * n**2 * (3.3 * m + 3 * m**2)
    )  # fmt: skip
    assert along_y == pytest.approx(13 * (1 + 3 * m) ** 2 / below, rel=1e-4)
    turned = shear_coefficient(box(0.1, 0.2, 1e-5), 0.3)
    assert turned == pytest.approx((along_z, along_y), rel=1e-9)


def test_box() -> None:
    section = box(0.06, 0.10, 0.004)
    assert section.area == pytest.approx(0.06 * 0.1 - 0.052 * 0.092, rel=1e-13)
    iy = (0.06 * 0.1**3 - 0.052 * 0.092**3) / 12
    iz = (0.1 * 0.06**3 - 0.092 * 0.052**3) / 12
    assert section.second_moment_y == pytest.approx(iy, rel=1e-13)
    assert section.second_moment_z == pytest.approx(iz, rel=1e-13)
    # Bredt: J = 4 A² t / s on the middle line; the walls turn by themselves too, t³ s / 3 in all
    bredt = 4 * (0.056 * 0.096) ** 2 * 0.004 / (2 * (0.056 + 0.096))
    walls = 0.004**3 * 2 * (0.056 + 0.096) / 3
    # what the corners add is of the order of t⁴
    assert section.torsion_constant == pytest.approx(bredt + walls, rel=0.03)
    assert section.torsion_constant > bredt + walls


def test_section_from_a_table_shears_only_with_shear_areas() -> None:
    assert Section(1e-3, 1e-7, 2e-7, 3e-7).shear_area(0.3) is None
    assert Section(1e-3, 1e-7, 2e-7, 3e-7, shear_areas=(5e-4, 6e-4)).shear_area(0.1) == (5e-4, 6e-4)


@pytest.mark.parametrize(
    ("make", "problem"),
    [
        (lambda: rod(0.0, "s"), "diameter is 0.0"),
        (lambda: rod(float("nan"), "s"), "diameter is nan"),
        (lambda: tube(0.01, 0.02, "s"), "inner_diameter 0.02 m is not below outer_diameter 0.01"),
        (lambda: tube(0.01, 0.0, "s"), "inner_diameter is 0.0"),
        (lambda: rectangle(-0.01, 0.02, "s"), "width_y is -0.01"),
        (lambda: rectangle(0.01, float("inf"), "s"), "height_z is inf"),
        (lambda: box(0.01, 0.02, 0.005, "s"), "thickness 0.005 m leaves no hollow"),
        (lambda: box(0.01, 0.02, -0.001, "s"), "thickness is -0.001"),
        (lambda: Section(1.0, 1.0, 1.0, 0.0, name="s"), "J is 0.0"),
        (lambda: Section(1.0, -1.0, 1.0, 1.0, name="s"), "Iy is -1.0"),
        (lambda: Section(1.0, 1.0, 1.0, 1.0, shear_areas=(1.0, 0.0), name="s"), "shear_area_z"),
    ],
)
def test_a_wrong_size_is_refused_by_name(make: Callable[[], Section], problem: str) -> None:
    with pytest.raises(ModelError, match=re.escape(problem)) as caught:
        make()
    assert caught.value.part == "section s"
    assert caught.value.remedy
