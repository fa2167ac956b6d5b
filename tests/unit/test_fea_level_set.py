"""Frequencies at which a receptance has a given magnitude."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import (
    LossFactor,
    ModalModel,
    ModalRatio,
    Port,
    Rayleigh,
    exceeds,
    level_crossings,
    minimum_dynamic_stiffness,
    modal_model,
)
from strutwork.fea.damping import Damping
from tests.vibration import heavy, oscillators

DAMPINGS = [ModalRatio(0.03), LossFactor(0.05), Rayleigh(2.0, 1e-6)]
BAND = (0.0, 600.0)


@cache
def model_of(damping: Damping) -> ModalModel:
    placed = heavy("serial arm").place()[1]
    return modal_model(placed, [Port("tool", d) for d in "xyz"], damping)


@pytest.mark.parametrize("damping", DAMPINGS, ids=str)
@pytest.mark.parametrize("port", [0, 1, 2])
def test_crossings_are_all_the_grid_sees(damping: Damping, port: int) -> None:
    model = model_of(damping)
    lines = np.linspace(*BAND, 60_001)
    magnitude = np.abs(model.receptance(lines)[0, :, port, port])
    for share in (0.1, 0.5, 0.9, 0.999):
        level = share * magnitude.max()
        found = level_crossings(model, port, level)
        there = np.abs(model.receptance(found)[0, :, port, port])
        # eigenvalues of the pencil are good to about 1e-9
        np.testing.assert_allclose(there, level, rtol=1e-5)
        signs = np.flatnonzero(np.diff(np.sign(magnitude - level)))
        seen = lines[signs]
        inside = found[found < BAND[1]]
        assert len(inside) == len(seen)
        np.testing.assert_allclose(inside, seen, atol=2 * (lines[1] - lines[0]))
        assert exceeds(model, port, level, BAND)


@pytest.mark.parametrize(
    ("name", "damping"),
    # the pencil has four rows for each mode: 124 and 336
    [
        *(("serial arm", d) for d in DAMPINGS),
        pytest.param("three-legged frame", DAMPINGS[0], marks=pytest.mark.slow),
    ],
    ids=str,
)
def test_above_the_largest_magnitude_there_are_none(name: str, damping: Damping) -> None:
    """A certificate of the minimum dynamic stiffness that shares nothing with its search."""
    placed = heavy(name).place()
    ports = [Port("tool", d) for d in "xyz"]
    minimum = minimum_dynamic_stiffness(placed, ports, damping, BAND)
    model = modal_model(placed, ports, damping)
    for pose in (0, 3):
        for port in range(3):
            largest = 1.0 / minimum.value[pose, port]
            assert not exceeds(model, port, largest * (1 + 1e-6), BAND, pose)
            assert exceeds(model, port, largest * (1 - 1e-6), BAND, pose)


def test_one_mode_in_closed_form() -> None:
    """|1 − x + iη| = 1/level: x = 1 ± √(level⁻² − η²), x = (ω/ω₀)²."""
    model = modal_model(oscillators((1e4, 1.0)).place(), [Port("m1", "x")], LossFactor(0.1))
    level = 4.0 / 1e4
    found = level_crossings(model, 0, level)
    expected = 100.0 / (2 * np.pi) * np.sqrt(1 + np.array([-1, 1]) * np.sqrt(0.25**2 - 0.1**2))
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    assert len(level_crossings(model, 0, 10.1 / 1e4)) == 0


def test_a_band_without_the_peak_is_not_exceeded() -> None:
    model = modal_model(oscillators((1e4, 1.0)).place(), [Port("m1", "x")], LossFactor(0.1))
    level = 4.0 / 1e4
    assert exceeds(model, 0, level, (10.0, 20.0))
    assert not exceeds(model, 0, level, (0.0, 13.0))
    assert not exceeds(model, 0, level, (18.0, 500.0))


def test_rigid_body_modes_and_levels_that_are_none() -> None:
    model = modal_model(
        oscillators((0.0, 1.0), (1e4, 2.0)).place(), [Port("m1", "x")], LossFactor(0.1)
    )
    with pytest.raises(ModelError, match="rigid-body mode"):
        level_crossings(model, 0, 1e-4)
    held = modal_model(oscillators((1e4, 1.0)).place(), [Port("m1", "x")], LossFactor(0.1))
    for level in (0.0, -1.0, np.nan):
        with pytest.raises(ModelError, match="level"):
            level_crossings(held, 0, level)
