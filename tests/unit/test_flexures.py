from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.flexures import CircularNotch, CrossSpring, EllipticNotch, Flexure, Leaf
from strutwork.flexures.concentration import notch_in_bending, notch_in_tension
from strutwork.msa.materials import Material

STEEL = Material.isotropic(200e9, 0.3, name="steel")
HINGE = CircularNotch("hinge", STEEL, 5e-4, 10e-3, 5e-3)
LEAF = Leaf("leaf", STEEL, 5e-4, 10e-3, 40e-3)
PIVOT = CrossSpring("pivot", STEEL, 3e-4, 8e-3, 30e-3, crossing=0.3)
ALL = [HINGE, EllipticNotch("ellipse", STEEL, 5e-4, 10e-3, 8e-3, 4e-3), LEAF, PIVOT]


@pytest.mark.parametrize("flexure", ALL, ids=lambda f: f.name)
def test_stiffness_is_symmetric_and_inverts_the_compliance(flexure: Flexure) -> None:
    np.testing.assert_array_equal(flexure.stiffness, flexure.stiffness.T)
    scale = np.sqrt(np.diag(flexure.compliance))
    product = (flexure.stiffness @ flexure.compliance) / np.outer(1 / scale, scale)
    np.testing.assert_allclose(product, np.eye(6), atol=1e-9)
    assert np.linalg.eigvalsh(flexure.stiffness * np.outer(scale, scale)).min() > 0


@pytest.mark.parametrize("flexure", ALL, ids=lambda f: f.name)
def test_stress_is_even_homogeneous_and_takes_a_batch(flexure: Flexure) -> None:
    wrenches = np.random.default_rng(3).normal(size=(2, 4, 6))
    found = flexure.stress(wrenches)
    assert found.shape == (2, 4)
    np.testing.assert_allclose(flexure.stress(-2 * wrenches), 2 * found, rtol=1e-12)
    assert found[1, 2] == pytest.approx(float(flexure.stress(wrenches[1, 2])), rel=1e-12)


@pytest.mark.parametrize("flexure", ALL, ids=lambda f: f.name)
def test_at_its_stroke_a_flexure_has_the_allowable_stress(flexure: Flexure) -> None:
    assert flexure.stroke is None
    stroke = replace(flexure, allowable_stress=3e8).stroke
    assert stroke is not None
    for direction, amount in enumerate(stroke):
        # that motion under a force in its direction alone
        wrench = np.eye(6)[direction] * amount / flexure.compliance[direction, direction]
        assert float(flexure.stress(wrench)) == pytest.approx(3e8, rel=1e-9)


def test_stress_of_a_leaf_in_closed_form() -> None:
    b, t, length = 10e-3, 5e-4, 40e-3
    pulled, pushed, bent = np.eye(6)[0], np.eye(6)[1], np.eye(6)[5]
    assert float(LEAF.stress(100 * pulled)) == pytest.approx(100 / (b * t), rel=1e-12)
    assert float(LEAF.stress(0.2 * bent)) == pytest.approx(0.2 * 6 / (b * t**2), rel=1e-12)
    # guided at both ends, its moments are F L/2 there
    moment = 3.0 * length / 2 * 6 / (b * t**2)
    shear = 1.5 * 3.0 / (b * t)
    assert float(LEAF.stress(3 * pushed)) == pytest.approx(np.hypot(moment, 3**0.5 * shear))
    fillet = replace(LEAF, stress_concentration=1.4)
    assert float(fillet.stress(0.2 * bent)) == pytest.approx(1.4 * float(LEAF.stress(0.2 * bent)))


def test_stress_of_a_thin_notch_is_that_of_its_root() -> None:
    factor = notch_in_bending(0.05)
    assert float(HINGE.stress(0.1 * np.eye(6)[5])) == pytest.approx(
        factor * 0.1 * 6 / (10e-3 * 5e-4**2), rel=1e-12
    )


def test_concentration_of_shallow_and_of_sharp_notches() -> None:
    # 1 + 2β/5 and 1 + 2β/3 for a large radius, 4/(3π/2) √β... for a small one
    assert notch_in_bending(1e-9) == pytest.approx(1.0, abs=1e-9)
    assert notch_in_bending(1.001e-3) == pytest.approx(notch_in_bending(0.999e-3), rel=1e-6)
    assert notch_in_tension(1e-6) == pytest.approx(1 + 2e-6 / 3, rel=1e-9)
    assert notch_in_bending(1e6) == pytest.approx(8 / (3 * pi) * 1e3, rel=1e-2)
    assert notch_in_tension(1e6) == pytest.approx(4 / pi * 1e3, rel=1e-2)


def test_leaf_buckles_by_euler() -> None:
    force = pi**2 * LEAF.strip.bending_modulus * 10e-3 * 5e-4**3 / 12 / 40e-3**2
    assert float(LEAF.compression([-force, 0, 0, 0, 0, 0])) == pytest.approx(1.0, rel=1e-9)
    assert float(LEAF.compression([force, 0, 0, 0, 0, 0])) == 0.0


def test_pivot_shares_a_pull_between_its_leaves() -> None:
    even = replace(PIVOT, crossing=0.5, leaves=3)
    # outer leaves of half the width carry half as much each, so all have the same stress
    stress = float(even.stress([100, 0, 0, 0, 0, 0]))
    leaf = 100 / (2 * np.cos(pi / 4))
    # and as they stretch they also bend, by (t/L)² of the pull and 3 t/L of its stress
    assert leaf / (8e-3 * 3e-4) < stress < (1 + 3 * 0.01) * leaf / (8e-3 * 3e-4)
    # pulled along x all leaves are stretched, pushed across it half of them are compressed
    assert float(even.compression([100, 0, 0, 0, 0, 0])) == 0.0
    assert float(even.compression([0, 100, 0, 0, 0, 0])) > 0.0


def test_pivot_is_stiffest_about_its_crossing_in_the_middle() -> None:
    found = [replace(PIVOT, crossing=c).stiffness[5, 5] for c in (0.3, 0.5, 0.7)]
    assert found[0] == pytest.approx(found[2], rel=1e-9)
    assert found[1] < found[0]


def test_plates_by_their_proportions_or_as_stated() -> None:
    assert not LEAF.plate
    assert replace(LEAF, width=20e-3).plate
    assert not replace(LEAF, width=20e-3, bending="beam").plate
    assert replace(LEAF, bending="plate").plate
    assert replace(HINGE, width=40e-3).plate
    assert not replace(HINGE, width=2e-3).plate


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: replace(HINGE, radius=0.0), "radius"),
        (lambda: replace(HINGE, material=Material(200e9, 60e9)), "isotropic"),
        (lambda: replace(HINGE, thickness=float("nan")), "thickness"),
        (lambda: replace(HINGE, thickness=12e-3), "no hinge"),
        (lambda: replace(HINGE, height=4e-4), "height"),
        (lambda: replace(HINGE, height=20e-3), "height"),
        (lambda: replace(LEAF, allowable_stress=-1.0), "allowable_stress"),
        (lambda: replace(LEAF, stress_concentration=0.5), "stress_concentration"),
        (lambda: replace(PIVOT, spacing=7e-3), "overlap"),
        (lambda: replace(PIVOT, crossing=1.2), "crossing"),
        (lambda: replace(PIVOT, angle=pi), "angle"),
        (lambda: replace(PIVOT, leaves=4), "leaves"),
    ],
)
def test_sizes_that_make_no_flexure_are_errors(make: object, words: str) -> None:
    with pytest.raises(ModelError, match=words) as caught:
        make()  # type: ignore[operator]
    assert caught.value.part.startswith("flexure ")


@pytest.mark.parametrize(
    ("flexure", "words"),
    [
        (replace(HINGE, thickness=3e-3), "radius at its root"),
        (replace(HINGE, width=4e-4), "about y"),
        (replace(LEAF, length=4e-3), "8 times its thickness"),
        (replace(PIVOT, angle=0.3), "17.2°"),
    ],
)
def test_sizes_outside_the_verified_range_are_said(flexure: Flexure, words: str) -> None:
    assert any(words in doubt for doubt in flexure.doubts)


@pytest.mark.parametrize("flexure", ALL, ids=lambda f: f.name)
def test_usual_sizes_raise_no_doubt(flexure: Flexure) -> None:
    assert flexure.doubts == ()
