"""Velocity ellipsoids."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import velocity_ellipsoid


def test_semi_axes_of_drives_at_right_angles() -> None:
    found = velocity_ellipsoid(np.diag([1.0, 4.0, 0.5]))
    np.testing.assert_allclose(found.semi_axes, [2.0, 1.0, 0.25], rtol=1e-15)
    np.testing.assert_allclose(np.abs(found.directions), np.eye(3)[:, [2, 0, 1]], atol=1e-15)
    assert (found.condition, found.smallest, found.volume) == pytest.approx((8.0, 0.25, 0.5))


def test_velocities_at_the_tips_need_rates_of_size_one() -> None:
    random = np.random.default_rng(3)
    inverse = random.normal(size=(7, 4, 3))
    found = velocity_ellipsoid(inverse)
    tips = found.directions * found.semi_axes[..., None, :]
    rates = np.linalg.norm(inverse @ tips, axis=-2)
    np.testing.assert_allclose(rates, 1.0, rtol=1e-12)
    assert (np.diff(found.semi_axes, axis=-1) <= 0).all()
    assert found.volume.shape == (7,)


def test_drives_that_do_not_hold_the_tool_make_it_endless() -> None:
    assert velocity_ellipsoid([[1.0, 0.0], [0.0, 0.0]]).condition == np.inf


def test_rounding_is_no_drive_that_holds_the_tool() -> None:
    turned = np.array([[0.6, 0.8], [-0.8, 0.6]])
    found = velocity_ellipsoid(np.array([[1.0, 0.0], [0.0, 0.0]]) @ turned)
    assert found.condition == np.inf
    assert np.isinf(found.semi_axes).tolist() == [True, False]


def test_a_serial_singularity_leaves_an_axis_of_no_length() -> None:
    """The freedom whose rate is infinite cannot be moved; the others keep their ellipsoid."""
    inverse = np.array([[np.inf, 3.0, 0.0], [np.inf, 0.0, 4.0], [0.0, 0.0, 0.0]])
    regular = np.diag([1.0, 2.0, 4.0])
    found = velocity_ellipsoid(np.stack([inverse, regular]))
    np.testing.assert_allclose(found.semi_axes, [[1 / 3, 1 / 4, 0.0], [1.0, 1 / 2, 1 / 4]])
    np.testing.assert_allclose(np.abs(found.directions[0]), np.eye(3)[:, [1, 2, 0]], atol=1e-15)
    assert found.condition.tolist() == [np.inf, 4.0]
    assert found.volume.tolist() == [0.0, 0.125]
    every = velocity_ellipsoid(np.full((2, 2), np.inf))
    assert every.semi_axes.tolist() == [0.0, 0.0]
    assert every.condition == np.inf


@pytest.mark.parametrize(
    ("inverse", "words"),
    [(np.ones((2, 3)), r"shape \(2, 3\)"), ([[np.nan, 0.0], [0.0, 1.0]], "not numbers")],
)
def test_what_has_no_ellipsoid_is_refused(inverse: np.ndarray, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        velocity_ellipsoid(inverse)
