"""Dynamic stiffness: its definitions, its exact minimum, and bad input."""

from __future__ import annotations

import numpy as np
import pytest

import strutwork.fea.dynamic_stiffness
from strutwork.errors import ModelError, NumericalError
from strutwork.fea import (
    LossFactor,
    ModalRatio,
    Port,
    Rayleigh,
    blocked_dynamic_stiffness,
    frequency_response,
    minimum_dynamic_stiffness,
    worst_direction,
)
from strutwork.fea.damping import Damping
from tests.structure_cases import LIBRARY
from tests.unit.test_fea_frf import moving_ports
from tests.vibration import block_on_springs, heavy, oscillators

PORTS = [Port("tool", d) for d in "xyz"]
DAMPINGS = [ModalRatio(0.02), LossFactor(0.04), Rayleigh(3.0, 1e-7)]
X = Port("m1", "x")


def test_definitions_of_two_masses() -> None:
    """Driving point 1/|H_ii|, blocked |Z_ii|: with the other mass held Z_11 is its own."""
    k1, m1, k2, m2, eta, line = 2e5, 3.0, 9e4, 1.0, 0.05, 30.0
    ports = [X, Port("m2", "x")]
    found = frequency_response(
        oscillators((k1, m1), (k2, m2)).place(), ports, ports, [line], LossFactor(eta)
    )
    w2 = (2 * np.pi * line) ** 2
    z = (1 + 1j * eta) * np.array([[k1 + k2, -k2], [-k2, k2]]) - w2 * np.diag([m1, m2])
    h = np.linalg.inv(z)
    np.testing.assert_allclose(found.dynamic_stiffness[0], 1 / np.abs(h), rtol=1e-11)
    np.testing.assert_allclose(
        blocked_dynamic_stiffness(found.receptance)[0], np.abs(np.diag(z)), rtol=1e-11
    )
    stiffness, direction = worst_direction(found.receptance)
    assert stiffness[0] == pytest.approx(1 / np.linalg.norm(h, 2), rel=1e-12)
    moved = np.linalg.norm(found.receptance[0] @ direction[0])
    assert moved == pytest.approx(1 / stiffness[0], rel=1e-12)
    assert np.linalg.norm(direction[0]) == pytest.approx(1.0)


def test_worst_direction_is_no_stiffer_than_any_axis() -> None:
    placed = heavy("tripod machine").place()
    lines = np.linspace(5.0, 400.0, 50)
    h = frequency_response(placed, PORTS, PORTS, lines, ModalRatio(0.03)).receptance
    stiffness, _ = worst_direction(h)
    assert stiffness.shape == (6, 50)
    driving = 1 / np.abs(np.einsum("...ii->...i", h))
    assert np.all(stiffness[..., None] <= driving * (1 + 1e-12))


def test_ports_that_depend_on_each_other_cannot_be_blocked() -> None:
    model = block_on_springs(x=1e5, y=1e5, z=1e5, rx=1e3, ry=1e3, rz=1e3)
    x, twice = Port("body", "x"), Port("body", (2.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    found = frequency_response(model.place(), [x, twice], [x, twice], [3.0], LossFactor(0.1))
    with pytest.raises(ModelError, match="do not move independently"):
        blocked_dynamic_stiffness(found.receptance)


@pytest.mark.parametrize("ratio", [1e-3, 0.05, 0.5])
def test_one_mass_reaches_its_lower_bound(ratio: float) -> None:
    """2 ζ √(1 − ζ²) k at ω √(1 − 2 ζ²)."""
    k, m = 4e4, 1.0
    found = minimum_dynamic_stiffness(
        oscillators((k, m)).place(), [X], ModalRatio(ratio), (0.0, 100.0)
    )
    assert found.value[0] == pytest.approx(2 * ratio * np.sqrt(1 - ratio**2) * k, rel=1e-10)
    assert found.value[0] == pytest.approx(found.lower[0], rel=1e-9)
    assert found.upper[0] == pytest.approx(2 * ratio * k, rel=1e-12)
    assert found.frequency[0] == pytest.approx(
        200.0 * np.sqrt(1 - 2 * ratio**2) / (2 * np.pi), rel=1e-6
    )
    assert found.static[0] == pytest.approx(k, rel=1e-12)
    assert found.certified.all()


def test_a_loss_factor_leaves_eta_times_the_stiffness() -> None:
    found = minimum_dynamic_stiffness(
        oscillators((4e4, 1.0)).place(), [X], LossFactor(0.1), (0.0, 100.0)
    )
    np.testing.assert_allclose([found.value, found.lower, found.upper], 4e3, rtol=1e-10)


def test_heavy_damping_leaves_the_static_stiffness() -> None:
    found = minimum_dynamic_stiffness(
        oscillators((4e4, 1.0)).place(), [X], ModalRatio(0.8), (0.0, 100.0)
    )
    assert found.frequency[0] == 0.0
    assert found.value[0] == pytest.approx(4e4, rel=1e-12)


@pytest.mark.parametrize("damping", DAMPINGS, ids=str)
@pytest.mark.parametrize("name", LIBRARY)
def test_never_above_a_grid_and_between_its_bounds(name: str, damping: Damping) -> None:
    model = heavy(name)
    placed = model.place()
    assert model.tool is not None
    ports = moving_ports(placed, model.tool)
    band = (2.0, 400.0)
    if not ports:
        with pytest.raises(ModelError, match="does not move"):
            minimum_dynamic_stiffness(placed, [Port(model.tool, "x")], damping, band)
        return
    found = minimum_dynamic_stiffness(placed, ports, damping, band)
    assert found.value.shape == (*placed.batch, len(ports))
    lines = np.linspace(*band, 4001)
    h = frequency_response(placed, ports, ports, lines, damping, "all_modes").receptance
    grid = (1 / np.abs(np.einsum("...ii->...i", h))).min(axis=-2)
    assert np.all(found.value <= grid * (1 + 1e-9))
    # what it gives is on the curve
    for i, port in enumerate(ports):
        places = np.unique(found.frequency[..., i])
        there = frequency_response(placed, [port], [port], places, damping, "all_modes")
        lowest = there.dynamic_stiffness[..., 0, 0].min(axis=-1)
        np.testing.assert_allclose(lowest, found.value[..., i], rtol=1e-8)
    assert np.all(found.lower <= found.value * (1 + 1e-9))
    assert np.all(found.value <= found.upper * (1 + 1e-9))
    assert found.certified.all()
    assert np.all((found.frequency >= band[0]) & (found.frequency <= band[1]))


def test_a_grid_of_five_hertz_misses_the_minimum() -> None:
    """Why the exact minimum is wanted: what users read off a plot."""
    placed = heavy("three-legged frame").place()
    damping = ModalRatio(0.005)
    exact = minimum_dynamic_stiffness(placed, PORTS[:1], damping, (5.0, 200.0)).value[:, 0]
    lines = np.arange(5.0, 201.0, 5.0)
    h = frequency_response(placed, PORTS[:1], PORTS[:1], lines, damping, "all_modes").receptance
    grid = (1 / np.abs(h[..., 0, 0])).min(axis=1)
    assert np.all(grid >= exact)
    assert grid.max() > 2 * exact[grid.argmax()]


def test_a_floating_port_has_no_static_stiffness() -> None:
    placed = oscillators((0.0, 2.0), (2e5, 3.0)).place()
    found = minimum_dynamic_stiffness(placed, [X], ModalRatio(0.02), (5.0, 200.0))
    assert found.static[0] == found.lower[0] == 0.0
    w = 2 * np.pi * 5.0
    # at the low end the two masses move as one
    assert found.value[0] < 1.01 * 5.0 * w**2
    with pytest.raises(ModelError, match="starts at zero, where a structure that floats"):
        minimum_dynamic_stiffness(placed, [X], ModalRatio(0.02), (0.0, 200.0))
    alone = minimum_dynamic_stiffness(
        oscillators((0.0, 2.0)).place(), [X], ModalRatio(0.02), (5.0, 200.0)
    )
    assert alone.value[0] == pytest.approx(2.0 * w**2, rel=1e-12)
    assert alone.static[0] == 0.0
    assert np.isinf(alone.upper[0])


def test_struts_that_spin_do_not_make_the_tool_float() -> None:
    spinning, held = (
        minimum_dynamic_stiffness(heavy(name).place(), PORTS, ModalRatio(0.02), (0.0, 300.0))
        for name in ("hexapod, spinning struts", "hexapod")
    )
    np.testing.assert_allclose(spinning.value, held.value, rtol=1e-6)
    np.testing.assert_allclose(spinning.static, held.static, rtol=1e-8)


@pytest.mark.parametrize("band", [(10.0, 10.0), (20.0, 10.0), (-1.0, 10.0), (0.0, np.inf)])
def test_bands_that_are_none(band: tuple[float, float]) -> None:
    with pytest.raises(ModelError, match="frequency band"):
        minimum_dynamic_stiffness(oscillators((1e4, 1.0)).place(), [X], ModalRatio(0.02), band)


def test_bad_input() -> None:
    placed = oscillators((1e4, 1.0)).place()
    for damping in (ModalRatio(0.0), LossFactor(0.0), Rayleigh(0.0, 0.0)):
        with pytest.raises(ModelError, match="is zero: the dynamic stiffness falls to zero"):
            minimum_dynamic_stiffness(placed, [X], damping, (1.0, 100.0))
    with pytest.raises(ModelError, match="port m1:z: does not move"):
        minimum_dynamic_stiffness(placed, [Port("m1", "z")], ModalRatio(0.1), (1.0, 100.0))
    with pytest.raises(ModelError, match="has no mass"):
        minimum_dynamic_stiffness(
            oscillators((1e4, 0.0)).place(), [X], ModalRatio(0.1), (1.0, 100.0)
        )
    with pytest.raises(ModelError, match="at least one port"):
        minimum_dynamic_stiffness(placed, [], ModalRatio(0.1), (1.0, 100.0))


def test_a_result_that_breaks_its_bound_is_withheld(monkeypatch: pytest.MonkeyPatch) -> None:
    inner = strutwork.fea.dynamic_stiffness.largest_magnitudes

    def wrong(*arguments):  # type: ignore[no-untyped-def]
        found = inner(*arguments)
        found[..., 1] *= 0.5
        return found

    monkeypatch.setattr(strutwork.fea.dynamic_stiffness, "largest_magnitudes", wrong)
    with pytest.raises(NumericalError, match="violates its two-sided bound at pose 0"):
        minimum_dynamic_stiffness(
            oscillators((1e4, 1.0)).place(), [X], ModalRatio(0.02), (1.0, 100.0)
        )


def test_a_result_says_whether_it_is_certified() -> None:
    found = minimum_dynamic_stiffness(
        oscillators((1e4, 1.0)).place(), [X], ModalRatio(0.02), (1.0, 100.0)
    )
    assert "1 ports" in repr(found)
    assert "certified, N/m" in repr(found)


def test_mode_beyond_critical_has_no_peak() -> None:
    k, m, beta = 1e4, 1.0, 0.1
    placed = oscillators((k, m)).place()
    found = minimum_dynamic_stiffness(placed, [X], Rayleigh(0.0, beta), (2.0, 100.0))
    w = 2 * np.pi * 2.0
    # ζ = 5: the magnitude only falls, so the least stiffness is at the start of the band
    assert found.value[0] == pytest.approx(abs(k - m * w**2 + 1j * w * beta * k), rel=1e-12)
    assert found.frequency[0] == pytest.approx(2.0)
    assert found.certified.all()
