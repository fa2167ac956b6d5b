"""Printed results of the document beside the biglide and its third leg.

@inproceedings{chablat2003,
  author    = {Chablat, Damien and Wenger, Philippe and Majou, F{\'e}lix},
  title     = {The Optimal Design of Three Degree-of-Freedom Parallel Mechanisms for Machining
               Applications},
  booktitle = {International Conference on Advanced Robotics},
  year      = {2003}
}
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics import drive_values, jacobians
from strutwork.machines import Biglide, BiglideThirdLeg
from strutwork.papers.chablat_2003.squares import (
    ANGLES,
    amplification,
    largest_square,
    square_area,
    square_corners,
)
from strutwork.papers.chablat_2003.statements import statements
from strutwork.papers.chablat_2003.third_leg import SIDE, best_third, sines, turn_range

ROOT = Path(__file__).parents[3]
RANDOM = np.random.default_rng(3)
PLACES = RANDOM.uniform(-0.55, 0.55, (2, 40))
TURNS = RANDOM.uniform(-0.8, 1.8, 40)
MACHINE = BiglideThirdLeg()


def rows() -> NDArray[Any]:
    placement = MACHINE.place(MACHINE.poses(PLACES[0], PLACES[1], TURNS))
    return jacobians(MACHINE.linkage, placement).inverse[:, :, [0, 1, 4]]


def test_the_rows_are_eqs_2_and_4() -> None:
    """Eqs 2a, 2b and 4c in the rail frame; both are exact but for rounding: 1e-11."""
    (x, y), b = PLACES, TURNS
    ahead = x + 1.7 * (np.cos(b) - 1.0)
    sigma = np.sqrt(3.06**2 - ahead**2 - y**2)
    one, none = np.ones(40), np.zeros(40)
    wanted = [
        [one, y / np.sqrt(1 - y**2), none],
        [x / np.sqrt(1 - x**2), one, none],
        [ahead / sigma, y / sigma, 1.7 * (np.cos(b) - ahead * np.sin(b) / sigma)],
    ]
    np.testing.assert_allclose(rows(), np.moveaxis(np.array(wanted), -1, 0), rtol=0.0, atol=1e-11)


def test_parallel_singularities() -> None:
    """Section 3.1: on the unit circle with x y > 0; 1e-12 is rounding of the rows."""
    turn = np.radians([20.0, 45.0, 70.0, 200.0, 250.0])
    machine = Biglide()
    placement = machine.place(machine.poses(np.cos(turn), np.sin(turn)))
    found = jacobians(machine.linkage, placement).inverse[:, :, :2]
    assert np.abs(np.linalg.det(found)).max() < 1e-12
    other = machine.place(machine.poses(np.cos(turn), -np.sin(turn)))
    assert np.linalg.det(jacobians(machine.linkage, other).inverse[:, :, :2]).min() > 1.0


def test_serial_singularities() -> None:
    """Section 3.1: 1/|J⁻¹| falls as √(1 − y²) towards y = 1, to 1 %."""
    least = amplification(0.0, [1 - 1e-4, 1 - 1e-6])[:, 0]
    np.testing.assert_allclose(least, np.sqrt([2e-4, 2e-6]), rtol=0.01)


def test_isotropic_at_home() -> None:
    """Section 3.1: both factors are one; rounding."""
    np.testing.assert_allclose(amplification(0.0, 0.0), 1.0, atol=1e-12)


def test_position_is_decoupled() -> None:
    """Section 3.2: the first two drives are those of the plane machine; rounding."""
    plane = Biglide()
    own = drive_values(MACHINE, MACHINE.place(MACHINE.poses(PLACES[0], PLACES[1], TURNS)))[:, :2]
    wanted = drive_values(plane, plane.place(plane.poses(*PLACES)))
    np.testing.assert_allclose(own, wanted, rtol=0.0, atol=1e-15)
    assert np.abs(rows()[:, :2, 2]).max() < 1e-11


def test_singularities_of_the_third_leg() -> None:
    """Section 3.2: the two sines against the rows of the joints, to 1e-11."""
    found = sines(MACHINE, PLACES[0], PLACES[1], TURNS)
    third = rows()[:, 2]
    cosine = 1.0 / np.sqrt(1.0 + third[:, 0] ** 2 + third[:, 1] ** 2)
    np.testing.assert_allclose(found[:, 0], cosine, atol=1e-11)
    np.testing.assert_allclose(found[:, 1], third[:, 2] * cosine / 1.7, atol=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("angle", "area"),
    # exact: corner on an axis, tan² = 64/9; corner on the diagonal, tan = 2/3
    [(45.0, 128 / 73), (0.0, 16 / 13)],
)
def test_largest_squares(angle: float, area: float) -> None:
    """Section 3.3 prints about half of them; ours are exact, found to 1e-8 of the size."""
    found = largest_square(angle)
    assert found.measure == pytest.approx(area, abs=1e-6)


@pytest.mark.parametrize(("angle", "area"), [(45.0, 128 / 73), (0.0, 16 / 13)])
def test_squares_about_s(angle: float, area: float) -> None:
    """The same areas as the page shows them: 1e-6, and seen 1e-12."""
    assert square_area(angle) == pytest.approx(area, abs=1e-6)


@pytest.mark.parametrize(("angle", "area"), [(45.0, 128 / 73), (0.0, 16 / 13)])
def test_corners_of_the_squares_are_at_the_bounds(angle: float, area: float) -> None:
    """The quick form: a corner of the exact square has the amplification 3 or 1/3, to 1e-9."""
    corner = np.sqrt(area / 2.0)
    turn = np.radians(angle + 45.0 + 90.0 * np.arange(4))
    found = amplification(corner * np.cos(turn), corner * np.sin(turn))
    worst = np.maximum(found[:, 1], 1.0 / found[:, 0])
    assert worst.max() == pytest.approx(3.0, abs=1e-9)


@pytest.mark.parametrize("angle", ANGLES)
def test_squares_that_are_drawn_keep_the_bounds(angle: float) -> None:
    """Nowhere on a border beyond 3 or 1/3, and one of them is met in a corner: both to 1e-9."""
    corners = square_corners(angle)
    np.testing.assert_allclose(corners[0], corners[-1], atol=1e-12)
    sides = np.diff(corners, axis=0)
    np.testing.assert_allclose((sides**2).sum(axis=1), square_area(angle), rtol=1e-12)
    turned = np.degrees(np.arctan2(sides[:, 1], sides[:, 0])) - angle
    np.testing.assert_allclose(np.sin(np.radians(2.0 * turned)), 0.0, atol=1e-12)
    share = np.linspace(0.0, 1.0, 201)[:, None, None]
    found = amplification(*np.moveaxis(corners[:-1] + share * sides, -1, 0))
    worst = np.maximum(found[..., 1], 1.0 / found[..., 0])
    assert worst.max() <= 3.0 + 1e-9
    assert worst[0].max() == pytest.approx(3.0, abs=1e-9)


def test_bounds_as_angles() -> None:
    """Section 3.4: arcsin 0.2 is printed as 11.53°, cut to 11.5 and 78.5°: 0.05° of rounding."""
    assert np.degrees(np.arcsin(0.2)) == pytest.approx(11.5, abs=0.05)


@pytest.mark.parametrize("arm", [1.0, 1.5, 2.0])
def test_ridge(arm: float) -> None:
    """Fig. 8: L2 = 1.8 L1, drawn as a line: to a digit of the print."""
    assert best_third(arm)[0] / arm == pytest.approx(1.8, abs=0.1)


@pytest.mark.parametrize(("arm", "wanted"), [(1.0, 162.0), (1.5, 177.5), (2.0, 185.7)])
def test_ranges(arm: float, wanted: float) -> None:
    """Our digits at the best L2; more than 180° can be had, as section 3.4 says."""
    assert np.degrees(best_third(arm)[1]) == pytest.approx(wanted, abs=0.1)


def test_stricter_bounds() -> None:
    """Section 3.4: the range falls with the bounds; a finer square of places changes nothing."""
    found = turn_range(1.7, 3.06)
    assert turn_range(1.7, 3.06, threshold=0.3).width < found.width - 0.1
    x, y = (g.ravel() for g in np.meshgrid(*[np.linspace(-SIDE / 2, SIDE / 2, 21)] * 2))
    for end in (found.low, found.high):
        # the end is right to 1e-7 rad, and slopes are below one
        assert sines(MACHINE, x, y, np.asarray(end)).min() == pytest.approx(0.2, abs=1e-6)


@pytest.mark.slow
def test_every_statement_names_a_test_that_is_there() -> None:
    """The statements of the page, and what each leads to."""
    said = statements()
    assert len(said) >= 16
    for one in said:
        path, _, name = one.test.partition("::")
        assert f"def {name}(" in (ROOT / path).read_text(encoding="utf-8")
