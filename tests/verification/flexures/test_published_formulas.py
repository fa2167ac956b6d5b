"""Flexures: the closed forms that were published for notches, leaves and pivots.

@article{parosweisbord1965,
  title   = {How to Design Flexure Hinges},
  author  = {Paros, J. M. and Weisbord, L.},
  journal = {Machine Design},
  volume  = {37},
  pages   = {151--156},
  year    = {1965}
}

@article{smith1997,
  title   = {Elliptical Flexure Hinges},
  author  = {Smith, S. T. and Badami, V. G. and Dale, J. S. and Xu, Y.},
  journal = {Review of Scientific Instruments},
  volume  = {68},
  pages   = {1474--1483},
  year    = {1997}
}

@article{haringx1949,
  title   = {The Cross-Spring Pivot as a Constructional Element},
  author  = {Haringx, J. A.},
  journal = {Applied Scientific Research},
  volume  = {A1},
  pages   = {313--332},
  year    = {1949}
}

@article{wittrick1951,
  title   = {The Properties of Crossed Flexure Pivots, and the Influence of the Point at Which the
             Strips Cross},
  author  = {Wittrick, W. H.},
  journal = {Aeronautical Quarterly},
  volume  = {2},
  pages   = {272--292},
  year    = {1951}
}

@article{brouwer2013,
  title   = {Large Deflection Stiffness Analysis of Parallel Prismatic Leaf-Spring Flexures},
  author  = {Brouwer, D. M. and Meijaard, J. P. and Jonker, J. B.},
  journal = {Precision Engineering},
  volume  = {37},
  pages   = {505--521},
  year    = {2013}
}
"""

from __future__ import annotations

from math import sqrt, tanh

import numpy as np
import pytest

from strutwork.flexures import CircularNotch, CrossSpring, EllipticNotch, Leaf
from strutwork.flexures.closed_forms import (
    axial_compliance,
    cross_spring_stiffness,
    rotational_compliance,
    rotational_compliance_thin,
)
from strutwork.msa.materials import Material

STEEL = Material.isotropic(200e9, 0.3, name="steel")
E, G = STEEL.youngs_modulus, STEEL.shear_modulus
B, R = 10e-3, 5e-3


def circular(thickness: float, height: float | None = None) -> CircularNotch:
    return CircularNotch("hinge", STEEL, thickness, B, R, height=height, bending="beam")


@pytest.mark.parametrize("thickness", [1e-6, 1e-4, 1e-3, 4e-3])
@pytest.mark.parametrize("share", [None, 0.3, 0.9])
def test_circular_notch_by_paros_and_weisbord(thickness: float, share: float | None) -> None:
    """Quadrature of the same integral, also where the notch is cut less deep than its radius."""
    height = None if share is None else thickness + 2 * R * share
    found = np.diag(circular(thickness, height).compliance)
    assert found[5] == pytest.approx(
        rotational_compliance(E, B, thickness, R, height), rel=1e-9, abs=0
    )
    assert found[0] == pytest.approx(axial_compliance(E, B, thickness, R, height), rel=1e-9, abs=0)
    # about y the thickness enters as in extension
    assert found[4] == pytest.approx(12 / B**2 * found[0], rel=1e-9, abs=0)


def test_thin_circular_notch_by_the_simplified_formula() -> None:
    found = circular(1e-5).compliance[5, 5]
    # the error of 9 π √R/(2 E b t^2.5) is of the order of t/R = 0.002
    assert found == pytest.approx(rotational_compliance_thin(E, B, 1e-5, R), rel=1e-3)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0, 4.0])
def test_elliptic_notch_is_the_circular_one_times_its_ratio(ratio: float) -> None:
    """Smith et al.: the compliance of R = a_y times a_x/a_y."""
    found = EllipticNotch("hinge", STEEL, 5e-4, B, ratio * R, R, bending="beam").compliance
    assert found[5, 5] == pytest.approx(
        ratio * rotational_compliance(E, B, 5e-4, R), rel=1e-9, abs=0
    )
    assert found[0, 0] == pytest.approx(ratio * axial_compliance(E, B, 5e-4, R), rel=1e-9, abs=0)


@pytest.mark.parametrize("crossing", [0.0, 0.13, 0.5, 0.8])
@pytest.mark.parametrize("leaves", [2, 3])
def test_cross_spring_pivot_without_load(crossing: float, leaves: int) -> None:
    """Haringx's 2 E I/L, and Wittrick's for leaves that cross elsewhere."""
    pivot = CrossSpring(
        "pivot", STEEL, 3e-4, B, 60e-3, crossing=crossing, leaves=leaves, bending="beam"
    )
    # shear, which the formula leaves out, is a share (t/L)² of the deflection
    expected = cross_spring_stiffness(E, B, 3e-4, 60e-3, crossing)
    assert pivot.stiffness[5, 5] == pytest.approx(expected, rel=2e-4)


def test_leaf_by_timoshenko() -> None:
    length, t = 40e-3, 5e-4
    found = np.diag(Leaf("leaf", STEEL, t, B, length, bending="beam").compliance)
    inertia, area = B * t**3 / 12, B * t
    sheared = length * (12 + 11 * 0.3) / (10 * 1.3 * G * area)
    assert found[5] == pytest.approx(length / (E * inertia), rel=1e-12, abs=0)
    assert found[1] == pytest.approx(length**3 / (12 * E * inertia) + sheared, rel=1e-12, abs=0)
    assert found[2] == pytest.approx(length**3 / (E * t * B**3) + sheared, rel=1e-12, abs=0)
    plate = np.diag(Leaf("leaf", STEEL, t, B, length, bending="plate").compliance)
    assert plate[5] == pytest.approx(found[5] * (1 - 0.3**2), rel=1e-12, abs=0)


@pytest.mark.parametrize("width", [2e-3, 10e-3, 40e-3])
def test_torsion_of_a_leaf_that_cannot_warp(width: float) -> None:
    """G J/L over 1 - tanh(z)/z, z = k L/2, k² = G J/(E b³ t³/144): constrained warping."""
    length, t = 40e-3, 2e-4
    found = Leaf("leaf", STEEL, t, width, length, bending="beam").compliance[3, 3]
    torsion = G * width * t**3 / 3 * (1 - 0.63 * t / width)
    z = sqrt(torsion / (E * (width * t) ** 3 / 144)) * length / 2
    # the published formula has no shear of the strips, and J to first order in t/b
    assert found == pytest.approx(length / torsion * (1 - tanh(z) / z), rel=3e-3)


def test_long_leaf_has_the_torsion_of_saint_venant() -> None:
    found = Leaf("leaf", STEEL, 1e-3, 2e-3, 2.0).compliance[3, 3]
    # b/t = 2: J = 0.2287 b t³ (Timoshenko and Goodier, table 7); ends stiffen by b/L
    assert found == pytest.approx(2.0 / (G * 0.2287 * 2e-3 * 1e-9), rel=1e-3)
