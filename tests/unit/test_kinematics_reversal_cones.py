"""Cones of feeds that turn no drive back."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics.reversal_cones import cone, sectors

Array = NDArray[Any]


def test_cone_of_the_thesis() -> None:
    """Son 2002, eqs 30 and 34: α + 2β ≥ 0, α − β ≤ 0, 2α + 3β ≥ 0; rays (1, 1) and (−3, 2)."""
    gradient = np.array([[1.0, 2.0], [1.0, -1.0], [2.0, 3.0]])
    found = np.degrees(cone(gradient, [1, -1, 1]))
    assert found == pytest.approx([45.0, np.degrees(np.arctan2(2, -3))], abs=1e-12)
    # α + 2β ≥ 0 bounds nothing
    assert np.degrees(cone(gradient[1:], [-1, 1])) == pytest.approx(found, abs=1e-12)
    _, signs = sectors(gradient)
    assert len(signs) == len(np.unique(signs, axis=0)) == 6


def test_cones_against_every_direction() -> None:
    random = np.random.default_rng(4)
    around = np.linspace(-np.pi, np.pi, 20001)
    way = np.stack([np.cos(around), np.sin(around)], axis=-1)
    for _ in range(200):
        gradient = random.normal(size=(4, 2))
        signs = random.choice([-1, 1], size=4)
        low, high = cone(gradient, signs)
        inside = np.all(signs * (way @ gradient.T) >= 0, axis=-1)
        if np.isnan(low):
            # a cone narrower than the step between directions may hide
            assert not inside.any()
            continue
        apart = (around - (low + high) / 2 + np.pi) % (2 * np.pi) - np.pi
        clear = np.abs(np.abs(apart) - (high - low) / 2) > 1e-9
        assert np.array_equal(inside[clear], (np.abs(apart) < (high - low) / 2)[clear])
        angles, patterns = sectors(gradient)
        assert len(patterns) <= 8
        assert angles[:, 1] - angles[:, 0] == pytest.approx(
            [np.ptp(cone(gradient, p)) for p in patterns], abs=1e-9
        )


def test_a_drive_that_stands_still_bounds_no_cone() -> None:
    assert cone([[0.0, 0.0], [0.0, 1.0]], [1, 1]) == pytest.approx([0.0, np.pi])
    assert cone([[0.0, 0.0]], [1]) == pytest.approx([-np.pi, np.pi])
    _, signs = sectors([[0.0, 0.0], [0.0, 1.0]])
    assert sorted(signs[:, 1]) == [-1, 1]
    assert not signs[:, 0].any()
