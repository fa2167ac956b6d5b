"""Elements of a tooth period: which cut, and how many nodes each requires."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.cutting import period_map, spans, stability_chart
from strutwork.cutting.spans import LEAST, first_margin, spans_of
from tests.cutting_cases import bull_nose, mill, mill_tip

HELIX = np.pi / 6.0


def _uniform(found: list[spans.Span], _: float) -> list[spans.Span]:
    return found


def _fastest() -> float:
    return float(np.abs(mill_tip(2).poles).max())


def test_ramps_of_a_helix_have_fewer_nodes_than_the_cut_between() -> None:
    chip = mill(0.5, helix=HELIX).directional
    entry, cut, exit_ = spans_of(chip, _fastest(), 200.0, 2e-3, 8)
    assert entry.order == exit_.order
    assert LEAST <= entry.order <= cut.order // 2
    assert entry.length == exit_.length == pytest.approx(chip.lag * 2e-3 / (400.0 * np.pi))


def test_straight_teeth_keep_the_nodes_of_their_margin() -> None:
    (cut,) = spans_of(mill(0.5).directional, _fastest(), 200.0, 2e-3, 8)
    assert cut.order == 8 + int(np.ceil(0.5 * _fastest() * cut.length))


def test_ramps_gain_nodes_with_the_margin_so_that_a_check_sees_them() -> None:
    chip = mill(0.5, helix=HELIX).directional
    orders = [spans_of(chip, _fastest(), 200.0, 4e-3, m)[0].order for m in (6, 9, 12, 15)]
    assert np.all(np.diff(orders) > 0)


@pytest.mark.parametrize("degrees", [3.0, 30.0, 50.0])
@pytest.mark.parametrize("immersion", [0.05, 0.5, 1.0])
def test_magnitudes_are_those_of_many_nodes_on_every_element(
    immersion: float, degrees: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    process = mill(immersion, helix=np.deg2rad(degrees), teeth=3)
    depths = np.array([1e-4, 1.2e-3, 4e-3])
    for modes in (mill_tip(2), bull_nose(real=False)):
        chart = stability_chart(modes, process, [6000.0, 20000.0], depths)
        with monkeypatch.context() as patch:
            patch.setattr(spans, "_lightened", _uniform)
            many = [
                [abs(period_map(modes, process, n / 60.0, a, 24).largest(a)) for a in depths]
                for n in chart.speeds
            ]
        off = np.abs(np.abs(chart.multipliers) - many) / np.maximum(many, 1.0)
        assert off.max() < 1e-6


def test_first_margin_grows_with_the_length_and_with_what_is_asked() -> None:
    chip = mill(0.5).directional
    slow, quick = (first_margin(chip, _fastest(), n / 60.0, 4e-3, 1e-6) for n in (4e3, 2e4))
    assert slow > quick
    assert first_margin(chip, _fastest(), 4e3 / 60.0, 4e-3, 1e-9) > slow
