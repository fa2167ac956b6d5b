"""Trajectories: splines through samples, time laws, circles, and their smoothness."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad

from strutwork.errors import ModelError
from strutwork.kinematics.coordinates import Coordinates
from strutwork.kinematics.time_laws import (
    TimeLaw,
    circle,
    point_to_point,
    quintic,
    trapezoid,
)
from strutwork.kinematics.trajectory import lobatto, roughness, sampled
from strutwork.kinematics.turns import rotation_matrix, rotation_vector, velocity_rates

Array = NDArray[Any]

X = Coordinates(("x",))
XY = Coordinates(("x", "y"))


def test_a_quintic_comes_back_exactly() -> None:
    curve = np.polynomial.Polynomial([0.1, -0.4, 0.7, 0.3, -0.2, 0.05])
    times = np.array([0.0, 0.1, 0.35, 0.4, 0.8, 1.0, 1.1])
    path = sampled(X, times, curve(times)[:, None])
    at = np.linspace(0, 1.1, 50)
    for found, wanted in zip(path.at(at), (curve, curve.deriv(1), curve.deriv(2)), strict=True):
        np.testing.assert_allclose(found[:, 0], wanted(at), rtol=0, atol=1e-11)


def test_given_derivatives_are_kept() -> None:
    times = np.array([0.0, 0.5, 2.0])
    values = np.stack([np.sin(times), np.cos(times)], axis=1)
    rates = np.stack([np.cos(times), -np.sin(times)], axis=1)
    path = sampled(XY, times, values, rates, -values)
    for found, wanted in zip(path.at(times), (values, rates, -values), strict=True):
        np.testing.assert_allclose(found, wanted, atol=1e-12)
    # without them four samples make a cubic
    cubic = np.polynomial.Polynomial([1.0, 2.0, -3.0, 0.5])
    few = np.array([0.0, 1.0, 2.0, 3.0])
    assert sampled(X, few, cubic(few)[:, None]).at(1.5)[2][0, 0] == pytest.approx(
        cubic.deriv(2)(1.5), rel=1e-10
    )


def test_the_quadrature_is_exact_to_degree_nine() -> None:
    nodes, weights = lobatto(6)
    for power in range(10):
        assert weights @ nodes**power == pytest.approx((1 + (-1) ** power) / (power + 1), abs=1e-14)
    assert weights @ nodes**10 != pytest.approx(2 / 11, abs=1e-6)
    path = sampled(X, [0.0, 0.3, 1.0, 2.5], np.zeros((4, 1)))
    times, share = path.quadrature
    assert set(path.times) <= set(times)
    assert share @ times**9 == pytest.approx(2.5**10 / 10, rel=1e-12)


@pytest.mark.parametrize("law", [quintic(), trapezoid(), trapezoid(0.5), trapezoid(0.1)])
def test_time_laws(law: TimeLaw) -> None:
    ends = law.share(np.array([0.0, 1.0]))
    np.testing.assert_allclose(ends, [[0, 1], [0, 0], [0, 0]], atol=1e-14)
    for order in (0, 1):
        for low, high in ((0.0, 0.37), (0.2, 0.91), (0.63, 1.0)):
            points = [b for b in law.breaks if low < b < high] or None
            grown, _ = quad(
                lambda u, k=order: float(law.share(np.array([u]))[k + 1, 0]),
                low,
                high,
                points=points,
                epsabs=1e-13,
            )
            first, last = law.share(np.array([low, high]))[order]
            assert grown == pytest.approx(last - first, abs=1e-11)
    fine = law.share(np.linspace(0, 1, 1001))
    assert np.all(np.diff(fine[0]) >= 0)


def test_speeds_of_time_laws() -> None:
    fine = np.linspace(0, 1, 1001)
    assert quintic().share(fine)[1].max() == pytest.approx(15 / 8)
    assert trapezoid(0.2).share(fine)[1].max() == pytest.approx(1.25)
    steady = trapezoid(0.2).share(np.linspace(0.2, 0.8, 50))
    np.testing.assert_allclose(steady[2], 0.0, atol=1e-12)


def test_point_to_point_and_circle() -> None:
    path = point_to_point(XY, [0.1, -0.2], [0.3, 0.4], 2.0, trapezoid())
    first, last = (path.at([t]) for t in (0.0, 2.0))
    np.testing.assert_allclose(np.concatenate([first[0][0], last[0][0]]), [0.1, -0.2, 0.3, 0.4])
    assert path.at(1.0)[1][0, 0] == pytest.approx(0.2 / 2 / 0.75)
    round_ = circle(Coordinates(("x", "y", "z")), [0.1, 0.2, 0.3], 0.05, 3.0, ("z", "x"))
    values, rates, changes = round_.at(round_.times)
    away = values - [0.1, 0.2, 0.3]
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), 0.05, rtol=1e-12)
    np.testing.assert_allclose(away[0], [0, 0, 0.05], atol=1e-15)
    assert away[10, 0] > 0
    # derivatives beside differences
    step = 1e-4
    at = np.linspace(0.1, 2.9, 20)
    ahead, behind = round_.at(at + step), round_.at(at - step)
    _, rates, changes = round_.at(at)
    np.testing.assert_allclose((ahead[0] - behind[0]) / (2 * step), rates, atol=1e-7)
    np.testing.assert_allclose((ahead[1] - behind[1]) / (2 * step), changes, atol=1e-6)


def test_what_is_not_smooth_is_told() -> None:
    times = np.linspace(0, 1, 101)
    smooth = np.stack([np.sin(5 * times), np.zeros(101)], axis=1)
    assert roughness(XY, times, smooth) == ()
    noisy = smooth.copy()
    noisy[:, 1] = 0.1 * times + 1e-6 * np.random.default_rng(1).normal(size=101)
    jump = smooth.copy()
    jump[60:, 0] += 1e-3
    corner = np.stack([np.abs(times - 0.4), np.zeros(101)], axis=1)
    for rough, label, when in ((noisy, "y", None), (jump, "x", 0.6), (corner, "x", 0.4)):
        (found,) = roughness(XY, times, rough)
        assert found.label == label
        assert found.share > 0.2
        assert when is None or found.time == pytest.approx(when, abs=0.03)
        assert f"{label} is not smooth near t =" in str(found)
    # a coordinate that stands, but for its rounding
    still = np.stack([smooth[:, 0], 0.7 + 1e-16 * np.arange(101)], axis=1)
    assert roughness(XY, times, still) == ()


@pytest.mark.parametrize(
    ("times", "values", "message"),
    [
        ([0, 1, 2], np.zeros((3, 1)), "has 3 samples"),
        ([0, 1, 1, 2], np.zeros((4, 1)), "does not ascend: 1 s after 1 s"),
        ([0, 1, np.nan, 2], np.zeros((4, 1)), "does not ascend"),
        ([0, 1, 2, 3], np.zeros((4, 2)), r"values \(4, 2\) of 1 coordinates"),
        ([0, 1, 2, 3], np.array([[0.0], [np.inf], [0], [0]]), "not finite at t = 1 s"),
    ],
)
def test_samples_that_are_refused(times: Any, values: Array, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        sampled(X, times, values)


def test_paths_that_are_refused() -> None:
    times, values = np.arange(4.0), np.zeros((4, 1))
    with pytest.raises(ModelError, match="only first or only second derivatives"):
        sampled(X, times, values, values)
    with pytest.raises(ModelError, match="lasts 0"):
        point_to_point(X, [0.0], [1.0], 0.0)
    with pytest.raises(ModelError, match="not finite"):
        point_to_point(X, [0.0], [np.nan], 1.0)
    with pytest.raises(ModelError, match=r"from \(2,\) to"):
        point_to_point(X, [0.0, 1.0], [1.0], 1.0)
    with pytest.raises(ModelError, match=r"ramps of 0\.6"):
        trapezoid(0.6)
    with pytest.raises(ModelError, match="lies in x and z"):
        circle(XY, [0, 0], 0.1, 1.0, ("x", "z"))
    with pytest.raises(ModelError, match="radius of -1"):
        circle(XY, [0, 0], -1.0, 1.0)
    with pytest.raises(ModelError, match="centre of"):
        circle(XY, [0, 0, 0], 0.1, 1.0)


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-3, 0.5, 0.999, 1.001, 2.9])
def test_the_rate_of_the_left_jacobian(size: float) -> None:
    """J of ω = J v̇ and its derivative, beside differences of rotations."""
    axis = np.array([0.48, -0.6, 0.64])
    v, rate = size * axis, np.array([0.3, 0.7, -0.5])

    def jacobian(vector: Array) -> Array:
        h = 1e-3
        columns = []
        for e in np.eye(3):
            turns = [
                rotation_vector(rotation_matrix(vector + k * h * e) @ rotation_matrix(vector).T)
                for k in (-2, -1, 1, 2)
            ]
            columns.append((turns[0] - 8 * turns[1] + 8 * turns[2] - turns[3]) / (12 * h))
        return np.stack(columns, axis=-1)

    h = 1e-2
    around = [jacobian(v + k * h * rate) for k in (-2, -1, 1, 2)]
    wanted = (around[0] - 8 * around[1] + 8 * around[2] - around[3]) / (12 * h)
    # differences of differences of fourth order at steps of 1e-3 and 1e-2
    np.testing.assert_allclose(velocity_rates(v, rate), wanted, atol=1e-8)


@pytest.mark.parametrize("size", [0.0, 1e-9, 0.99e-4, 1.01e-4, 1.0])
def test_a_turn_comes_back_as_the_vector_it_was_made_of(size: float) -> None:
    # on either side of the size below which the series is used; 1e-16 is the rounding of a cosine
    vectors = size * np.array([[[0.6, -0.64, 0.48]], [[0.0, 0.0, 1.0]]])
    back = rotation_vector(rotation_matrix(vectors))
    np.testing.assert_allclose(back, vectors, rtol=1e-12, atol=2e-16)
