"""Limits of stability: what they tell apart, what changes them, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.cutting import (
    Cutter,
    DepthLimits,
    LobeLimits,
    Milling,
    ProcessDamping,
    TipModes,
    Turning,
    best_pockets,
    depth_limits,
    kind_of,
    period_map,
    removal_rates,
    stability_chart,
    zero_order_lobes,
)
from strutwork.cutting.elements import gauss, lagrange, response_weights
from strutwork.errors import ModelError, NumericalError
from tests.cutting_cases import (
    CHIP,
    FREQUENCY,
    RATIO,
    STIFFNESS,
    bull_nose,
    mill,
    mill_tip,
    one_mode,
)


def test_weights_of_elements_against_a_closed_form() -> None:
    """A load t² on a mode, by the polynomial and its exponential."""
    for pole in (-3.0 + 40.0j, -0.1 + 0.5j, -2000.0 + 9000.0j):
        order, length = 9, 0.02
        weights = response_weights(np.array([pole]), order, length)[0]
        times = np.append(0.5 * length * (gauss(order)[0] + 1.0), length)
        found = weights @ times[:-1] ** 2
        z = pole * times
        expected = (2.0 * np.exp(z) - 2.0 - 2.0 * z - z**2) / pole**3
        # the closed form loses digits where the pole is slow
        np.testing.assert_allclose(found, expected, atol=1e-7 * np.abs(found).max())


def test_lagrange_polynomials_at_and_between_nodes() -> None:
    nodes, _ = gauss(7)
    np.testing.assert_allclose(lagrange(7, nodes), np.eye(7), atol=1e-13)
    at = np.linspace(-1.0, 1.0, 11)
    np.testing.assert_allclose(lagrange(7, at) @ nodes**5, at**5, atol=1e-13)


def test_kinds_of_multipliers() -> None:
    assert [kind_of(m) for m in (0.99 + 0j, -1.1 + 0j, 1.1 + 0j, 0.5 + 1j)] == [
        "stable",
        "flip",
        "period-one",
        "Hopf",
    ]


def test_without_depth_the_multipliers_are_those_of_the_free_modes() -> None:
    modes = bull_nose(real=True)
    found = period_map(modes, mill(0.3), 100.0, 1e-3, 8).multipliers(1e-12)
    largest = np.sort(np.abs(found))[::-1][:8:2]
    period = 1.0 / 200.0
    expected = np.sort(np.exp(modes.poles.real * period))[::-1]
    np.testing.assert_allclose(largest, expected, rtol=1e-6)


def test_damping_by_the_flank_is_damping_of_the_mode() -> None:
    """Turning along the mode: the flank adds b C/V to its viscous damping."""
    flank = ProcessDamping(2e6, friction=0.0)
    process = Turning(1e9, diameter=0.05, damping=flank)
    speed = 1800.0
    limit = depth_limits(one_mode(), process, [speed], 0.05)
    omega = 2.0 * np.pi * FREQUENCY
    added = limit.depth[0] * 2e6 / (np.pi * 0.05 * speed / 60.0)
    ratio = RATIO + 0.5 * added * omega / STIFFNESS
    shape = [[omega / np.sqrt(STIFFNESS), 0.0, 0.0]]
    plain = TipModes.from_modes([FREQUENCY], [ratio], shape)
    again = depth_limits(plain, Turning(1e9), [speed], 0.05)
    assert again.depth[0] == pytest.approx(limit.depth[0], rel=1e-5)
    assert limit.depth[0] > 1.2 * depth_limits(one_mode(), Turning(1e9), [speed], 0.05).depth[0]


def test_damping_by_the_flank_raises_the_limit_most_at_low_speed() -> None:
    process = replace(mill(0.3), damping=ProcessDamping(2e4))
    speeds = [3000.0, 12000.0]
    with_it = depth_limits(mill_tip(2), process, speeds, 0.02).depth
    without = depth_limits(mill_tip(2), mill(0.3), speeds, 0.02).depth
    gain = with_it / without
    assert gain[0] > gain[1] > 1.0


def test_a_round_tip_knows_neither_the_feed_nor_up_from_down() -> None:
    """Turned about the axis, the arc of down-milling is that of up-milling."""
    down = mill(0.3)
    up = replace(down, way="up")

    def limit(modes: TipModes, process: Milling) -> float:
        return float(depth_limits(modes, process, [12000.0], 0.05).depth[0])

    round_tip = mill_tip(2)
    expected = limit(round_tip, down)
    assert limit(round_tip, up) == pytest.approx(expected, rel=1e-5)
    assert limit(round_tip.turned(0.6), down) == pytest.approx(expected, rel=1e-5)
    flat_tip = mill_tip(1)
    expected = limit(flat_tip, down)
    assert limit(flat_tip, up) != pytest.approx(expected, rel=0.01)
    assert limit(flat_tip.turned(0.6), down) != pytest.approx(expected, rel=0.01)


def test_a_steady_helix_has_the_zero_order_limit() -> None:
    """Where the helix lags by a pitch over the limiting depth, nothing is periodic."""
    speed = 9000.0
    lobes = zero_order_lobes(mill_tip(2).receptance(np.arange(500.0, 4000.0, 0.02)), mill(0.5))
    depth = lobes.at([speed]).depth[0]
    helix = float(np.arctan(0.5 * 0.02 * np.pi / depth))
    exact = depth_limits(mill_tip(2), mill(0.5, helix=helix), [speed], 0.01).depth[0]
    assert exact == pytest.approx(depth, rel=1e-4)


def test_a_lead_angle_brings_the_axis_of_the_tool_in() -> None:
    """A tip that moves along its axis alone chatters with a lead angle, and not without."""
    axial = TipModes.from_modes([300.0], [0.02], [[0.0, 0.0, 1.0]])
    plain = Milling(Cutter(0.05, 3), CHIP, 0.6)
    with pytest.raises(ModelError, match="no direction that changes the chip"):
        depth_limits(axial, plain, [3000.0], 0.01)
    with pytest.raises(ModelError, match="no direction that changes the chip"):
        zero_order_lobes(axial.receptance([100.0, 200.0, 300.0]), plain)
    inclined = replace(plain, cutter=Cutter(0.05, 3, lead=np.pi / 4.0))
    exact = depth_limits(axial, inclined, [3000.0], 0.5)
    lobes = zero_order_lobes(axial.receptance(np.arange(100.0, 2000.0, 0.05)), inclined)
    # constant but for entry and exit, the mean holds well at this immersion
    assert np.isfinite(exact.depth[0])
    assert exact.depth[0] == pytest.approx(lobes.at([3000.0]).depth[0], rel=0.2)


def test_families_of_full_rank_agree_with_those_of_the_plane() -> None:
    """A vanishing lead adds a third family that hardly matters."""
    modes = bull_nose(real=False)
    response = modes.receptance(np.arange(300.0, 2000.0, 0.5))
    plane = mill(0.5)
    tilted = replace(plane, cutter=replace(plane.cutter, lead=0.5 * np.pi - 1e-5))
    a, b = (zero_order_lobes(response, p).absolute for p in (plane, tilted))
    assert a == pytest.approx(b, rel=1e-3)


def test_a_chart_agrees_with_the_limits() -> None:
    speeds = np.array([10000.0, 20000.0])
    limits = depth_limits(mill_tip(2), mill(0.1), speeds, 0.01)
    depths = np.sort(np.outer(limits.depth, [0.995, 1.005]).ravel())
    chart = stability_chart(mill_tip(2), mill(0.1), speeds, depths)
    for row, limit in enumerate(limits.depth):
        near = np.abs(depths / limit - 1.0) < 0.01
        assert chart.stable[row, near].tolist() == [True, False]
    assert set(chart.kinds.ravel()) <= {"stable", "Hopf", "flip", "period-one"}
    assert "StabilityChart" in repr(chart)


def test_lobes_beyond_the_band_of_the_response_are_refused() -> None:
    lobes = zero_order_lobes(mill_tip(2).receptance(np.linspace(500.0, 1500.0, 500)), mill(0.5))
    with pytest.raises(ModelError, match="its band ends at 1500 Hz"):
        lobes.at([60_000.0])
    assert lobes.at([30_000.0]).depth.shape == (1,)


def test_a_response_that_limits_nothing_has_no_absolute_depth() -> None:
    """Far below the resonance the oriented receptance is nowhere negative."""
    lobes = zero_order_lobes(one_mode().receptance(np.linspace(1.0, 100.0, 50)), Turning(1e9))
    depth, frequency = lobes.absolute
    assert np.isinf(depth)
    assert np.isnan(frequency)


def test_an_absolute_limit_at_the_end_of_the_band_is_seen() -> None:
    """The least depth is at 253 Hz."""
    ends = {270.0: False, 252.5: True}
    for end, edge in ends.items():
        lobes = zero_order_lobes(one_mode().receptance(np.linspace(200.0, end, 500)), Turning(1e9))
        assert lobes.at_edge == edge


def test_zero_order_lobes_refuse_process_damping() -> None:
    process = replace(mill(0.5), damping=ProcessDamping(1e4))
    with pytest.raises(ModelError, match="leave process damping out"):
        zero_order_lobes(mill_tip(2).receptance([100.0, 200.0]), process)


def test_multipliers_that_do_not_converge_are_an_error_and_no_number() -> None:
    with pytest.raises(NumericalError, match="do not converge at a depth of"):
        stability_chart(mill_tip(2), mill(1.0), [5000.0], [1e-3], tolerance=1e-18)
    with pytest.raises(NumericalError, match="do not converge at a depth of"):
        depth_limits(mill_tip(2), mill(1.0), [5000.0], 1e-3, tolerance=1e-18)


def test_a_speed_so_low_that_the_map_is_too_large() -> None:
    with pytest.raises(NumericalError, match="Ask for higher speeds"):
        depth_limits(mill_tip(2), mill(1.0), [50.0], 1e-3)


@pytest.mark.parametrize("speeds", [[], [0.0], [-1.0], [np.nan], [np.inf]])
def test_speeds_that_are_none(speeds: list[float]) -> None:
    with pytest.raises(ModelError, match="spindle speeds"):
        depth_limits(mill_tip(1), mill(0.5), speeds, 1e-3)
    with pytest.raises(ModelError):
        depth_limits(mill_tip(1), mill(0.5), [1000.0], 0.0)


def test_best_pockets_are_the_peaks_of_the_removal_rate() -> None:
    speeds = np.arange(1.0, 8.0) * 1e3
    depth = np.array([1.0, 3.0, 1.0, 1.0, 4.0, 1.0, 1.0]) * 1e-3
    limits = LobeLimits(speeds, depth, speeds, np.zeros(7, dtype=int))
    found = best_pockets(limits, mill(0.5), 1e-4)
    assert [p.speed for p in found] == [5000.0, 7000.0, 2000.0]
    assert found[0].removal_rate == pytest.approx(
        float(removal_rates(mill(0.5), 5000.0, 4e-3, 1e-4))
    )
    assert len(best_pockets(limits, mill(0.5), 1e-4, count=1)) == 1


def test_pockets_take_the_deepest_trial_where_nothing_is_unstable() -> None:
    speeds = np.array([1e3, 2e3, 3e3])
    depth = np.array([1e-3, np.inf, 1e-3])
    none = np.zeros(3)
    exact = DepthLimits(speeds, depth, none, ("Hopf", "stable", "Hopf"), none, none, 5e-3)
    assert best_pockets(exact, mill(0.5), 1e-4)[0].depth == 5e-3
    with pytest.raises(ModelError, match="no limit at 2000 rpm"):
        best_pockets(LobeLimits(speeds, depth, none, none), mill(0.5), 1e-4)
    with pytest.raises(ModelError, match="rising"):
        best_pockets(replace(exact, speeds=speeds[::-1]), mill(0.5), 1e-4)
