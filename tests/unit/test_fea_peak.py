"""The largest magnitude of a modal sum over a band, and its certificate.

Every maximum is compared with a grid of 200 001 lines around and between the resonances: the
exact one is never below the grid's, and no further above than the curve may rise between two
lines.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from strutwork.fea.peak import TOLERANCE, largest_magnitudes

Array = NDArray[Any]


def response(
    omega: Array, products: Array, square: Array, viscous: Array, eta: float, rigid: Array
) -> Array:
    total = np.empty(len(omega), complex)
    # so many lines at a time as the cache holds: all of hundreds of modes would take gigabytes
    for i in range(0, len(omega), 1000):
        w = omega[i : i + 1000, None]
        terms = products / (1 - w**2 * square + 1j * (w * viscous + eta))
        total[i : i + 1000] = terms.sum(axis=1)
    moving, alpha = rigid
    if moving:
        total = total + moving / (-(omega**2) + 1j * omega * alpha)
    return np.asarray(np.abs(total))


class Case:
    def __init__(
        self,
        products: Any,
        omega: Any,
        ratio: Any,
        eta: float = 0.0,
        band: tuple[float, float] = (0.0, 200.0),
        rigid: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.products = np.asarray(products, dtype=float)
        self.omega = np.asarray(omega, dtype=float)
        self.square = 1.0 / self.omega**2
        self.viscous = 2.0 * np.broadcast_to(ratio, self.omega.shape) / self.omega
        self.eta, self.band, self.rigid = eta, band, rigid

    def find(self) -> tuple[float, float, float]:
        place, value, bound = largest_magnitudes(
            self.products[None, None],
            self.square[None],
            self.viscous[None],
            self.eta,
            np.array([[self.rigid[0]]]),
            self.rigid[1],
            *self.band,
            TOLERANCE,
        )[0, 0]
        return float(place), float(value), float(bound)

    def at(self, omega: Any) -> Array:
        return response(
            np.atleast_1d(np.asarray(omega, dtype=float)),
            self.products,
            self.square,
            self.viscous,
            self.eta,
            np.array(self.rigid),
        )

    def grid(self) -> Array:
        low, high = self.band
        lines = [np.linspace(low, high, 100_001)[1 if self.rigid[0] and low == 0 else 0 :]]
        inside = self.omega[(self.omega > low) & (self.omega < high)]
        for one in inside[:20]:
            near = one * (1 + np.linspace(-0.05, 0.05, 5_001))
            lines.append(near[(near >= low) & (near <= high)])
        return np.concatenate(lines)

    def check(self) -> tuple[float, float]:
        place, value, bound = self.find()
        assert self.band[0] <= place <= self.band[1]
        assert self.at(place)[0] == pytest.approx(value, rel=1e-12)
        highest = self.at(self.grid()).max()
        assert value >= highest * (1 - 1e-12)
        # the certificate: no place exceeds the bound, and the bound is the value to 1e-6
        assert value <= bound * (1 + 1e-12)
        assert bound <= value * (1 + 2 * TOLERANCE)
        return place, value


def test_one_mode_has_its_peak_in_closed_form() -> None:
    """1/(2 ζ √(1 − ζ²)) at ω √(1 − 2 ζ²)."""
    for ratio in (1e-4, 0.01, 0.2, 0.6):
        place, value = Case([3.0], [50.0], ratio).check()
        assert value == pytest.approx(3.0 / (2 * ratio * np.sqrt(1 - ratio**2)), rel=1e-12)
        assert place == pytest.approx(50.0 * np.sqrt(1 - 2 * ratio**2), rel=1e-7)


def test_one_mode_with_a_loss_factor() -> None:
    place, value = Case([2.0], [50.0], 0.0, eta=0.05).check()
    assert value == pytest.approx(2.0 / 0.05, rel=1e-12)
    assert place == pytest.approx(50.0, rel=1e-7)


def test_beyond_ratio_one_half_root_two_the_peak_is_at_the_low_end() -> None:
    place, value = Case([1.0, 0.5], [50.0, 120.0], 0.9).check()
    assert place == 0.0
    assert value == pytest.approx(1.5, rel=1e-14)


@pytest.mark.parametrize("gap", [1e-6, 1e-3, 0.01, 0.05])
def test_two_close_peaks(gap: float) -> None:
    _, value = Case([1.0, 1.02], [60.0, 60.0 * (1 + gap)], 0.005).check()
    # never above the two peaks on top of each other
    assert value <= 2.02 / (2 * 0.005 * np.sqrt(1 - 0.005**2)) * (1 + 1e-12)
    assert value > 1.02 / (2 * 0.005)


def test_the_lower_of_two_peaks_is_not_taken() -> None:
    """The second resonance, narrow, is higher though its static share is a hundredth."""
    place, _ = Case([1.0, 0.01], [20.0, 150.0], np.array([0.2, 1e-4])).check()
    assert place == pytest.approx(150.0, rel=1e-4)


def test_a_cross_receptance_with_an_anti_resonance() -> None:
    case = Case([1.0, -0.8, 0.3], [30.0, 80.0, 140.0], 0.02)
    case.check()
    # also where the band holds the anti-resonance alone
    between = Case([1.0, 0.8], [30.0, 80.0], 0.02, band=(40.0, 70.0))
    place, _ = between.check()
    assert place in {40.0, 70.0}


@pytest.mark.parametrize(("band", "end"), [((0.0, 30.0), 30.0), ((90.0, 180.0), 90.0)])
def test_a_peak_outside_the_band_leaves_the_edge(band: tuple[float, float], end: float) -> None:
    place, _ = Case([1.0], [60.0], 0.01, band=band).check()
    assert place == end


def test_a_peak_just_inside_the_edge() -> None:
    peak = 60.0 * np.sqrt(1 - 2 * 0.01**2)
    place, _ = Case([1.0], [60.0], 0.01, band=(0.0, peak * (1 + 1e-9))).check()
    assert place == pytest.approx(peak, rel=1e-6)


def test_a_band_far_below_and_far_above() -> None:
    Case([1.0, 2.0], [60.0, 61.0], 0.01, band=(1e-6, 2e-6)).check()
    Case([1.0, 2.0], [60.0, 61.0], 0.01, band=(1e5, 1e6)).check()


def test_a_floating_port() -> None:
    """The rigid-body part falls from the low end; the resonance stands above it."""
    place, _ = Case([1e-2], [60.0], 0.001, band=(20.0, 200.0), rigid=(1.0, 0.0)).check()
    assert place == pytest.approx(60.0, rel=1e-2)
    place, _ = Case([1e-6], [60.0], 0.1, band=(1.0, 200.0), rigid=(1.0, 0.0)).check()
    assert place == 1.0
    Case([1e-2], [60.0], 0.01, band=(0.5, 200.0), rigid=(1.0, 4.0)).check()


def test_motions_without_mass_are_a_constant() -> None:
    case = Case([1.0, 0.5], [60.0, 1.0], 0.01)
    case.square = np.array([1.0 / 3600, 0.0])
    case.viscous = np.array([2 * 0.01 / 60, 0.0])
    case.check()


def test_hundreds_of_modes() -> None:
    rng = np.random.default_rng(4)
    Case(rng.uniform(0, 1, 300), np.sort(rng.uniform(5, 190, 300)), 0.003).check()


def test_more_modes_than_cells_that_may_wait() -> None:
    rng = np.random.default_rng(5)
    omega = np.sort(rng.uniform(1000.0, 1100.0, 4200))
    case = Case(np.r_[1.0, rng.uniform(0, 1e-6, 4199)], omega, 0.4, band=(0.0, 1200.0))
    _, value, bound = case.find()
    assert value >= case.at(np.linspace(0.0, 1200.0, 301)).max() * (1 - 1e-12)
    assert bound <= value * (1 + 2 * TOLERANCE)


@settings(max_examples=60)
@given(
    modes=st.lists(
        st.tuples(st.floats(-1.0, 1.0), st.floats(1.0, 180.0), st.floats(1e-3, 0.95)),
        min_size=1,
        max_size=6,
    ),
    eta=st.floats(0.0, 0.5),
    low=st.floats(0.0, 150.0),
    width=st.floats(0.1, 100.0),
)
def test_never_below_a_dense_grid(
    modes: list[tuple[float, float, float]], eta: float, low: float, width: float
) -> None:
    products, omega, ratio = (np.array(part) for part in zip(*modes, strict=True))
    if np.abs(products).max() < 1e-6:
        products = products + 1.0
    order = np.argsort(omega)
    case = Case(products[order], omega[order], ratio[order], eta, (low, low + width))
    # cross receptances may vanish almost entirely: then only the grid is asked
    place, value, bound = case.find()
    assert value >= case.at(case.grid()).max() * (1 - 1e-9)
    assert case.at(place)[0] == pytest.approx(value, rel=1e-9)
    assert bound <= value * (1 + 2 * TOLERANCE)
