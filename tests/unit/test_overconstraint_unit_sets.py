"""Shapes of tolerance zones: support, extreme points, and samples that fill them evenly."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import qmc

from strutwork.overconstraint import Ball, Disc, Interval, PlaneZone, UnitSet

Array = NDArray[Any]

SETS: tuple[UnitSet, ...] = (Interval(), Disc(), Ball(), PlaneZone())
every = pytest.mark.parametrize("shape", SETS, ids=lambda s: type(s).__name__)


def points(shape: UnitSet, power: int = 14) -> Array:
    return np.asarray(qmc.Sobol(shape.dimension, scramble=True, rng=7).random_base2(power))


def size(shape: UnitSet, z: Array) -> Array:
    """Gauge of the set: 1 on its surface."""
    if isinstance(shape, PlaneZone):
        return np.asarray(np.abs(z).sum(axis=-1))
    return np.asarray(np.linalg.norm(z, axis=-1))


@every
def test_samples_lie_in_the_set_and_on_its_surface(shape: UnitSet) -> None:
    uniform = points(shape)
    inside, edge = shape.inside(uniform), shape.surface(uniform)
    assert inside.shape == edge.shape == uniform.shape
    assert size(shape, inside).max() <= 1 + 1e-12
    np.testing.assert_allclose(size(shape, edge), 1.0, rtol=1e-12)


@every
def test_support_is_the_largest_product_over_the_set(shape: UnitSet) -> None:
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(200, shape.dimension))
    support = shape.support(directions)
    products = directions @ shape.surface(points(shape, 12)).T
    assert np.all(products <= support[:, None] * (1 + 1e-12))
    # 4096 points leave a few degrees between them, and miss the octahedron's corners by 2 %
    assert np.all(products.max(axis=1) >= 0.97 * support)


@every
def test_extreme_point_is_in_the_set_and_reaches_the_support(shape: UnitSet) -> None:
    directions = np.random.default_rng(2).normal(size=(5, 40, shape.dimension))
    extreme = shape.extreme(directions)
    np.testing.assert_allclose(size(shape, extreme), 1.0, rtol=1e-12)
    np.testing.assert_allclose(
        (directions * extreme).sum(-1), shape.support(directions), rtol=1e-12
    )


@every
def test_gauge_is_one_on_the_surface_and_linear_in_the_scale(shape: UnitSet) -> None:
    z = np.random.default_rng(3).normal(size=(50, shape.dimension))
    np.testing.assert_allclose(shape.gauge(z), size(shape, z), rtol=1e-12)
    np.testing.assert_allclose(shape.gauge(-2.5 * z), 2.5 * shape.gauge(z), rtol=1e-12)


@every
def test_no_direction_has_no_extreme_point(shape: UnitSet) -> None:
    nothing = np.zeros((2, shape.dimension))
    np.testing.assert_array_equal(shape.extreme(nothing), 0.0)
    np.testing.assert_array_equal(shape.support(nothing), 0.0)


# E zᵢ² of the uniform distribution, and of the share of the radius: P(gauge ≤ s) = sᵈ
MOMENTS = {"Interval": 1 / 3, "Disc": 1 / 4, "Ball": 1 / 5, "PlaneZone": 1 / 10}
# on the surface: one end or the other, circle, sphere, faces of the octahedron
EDGES = {"Interval": 1.0, "Disc": 1 / 2, "Ball": 1 / 3, "PlaneZone": 1 / 6}


@every
def test_samples_are_even_in_the_set(shape: UnitSet) -> None:
    z = shape.inside(points(shape))
    name, d = type(shape).__name__, shape.dimension
    # 16384 Sobol points: the moments are within a few parts in ten thousand
    covariance = z.T @ z / len(z)
    np.testing.assert_allclose(covariance, MOMENTS[name] * np.eye(d), atol=1e-3)
    np.testing.assert_allclose(z.mean(axis=0), 0.0, atol=1e-3)
    shells = np.sort(size(shape, z)) ** d
    np.testing.assert_allclose(shells, (np.arange(len(z)) + 0.5) / len(z), atol=5e-3)


@every
def test_samples_are_even_on_the_surface(shape: UnitSet) -> None:
    z = shape.surface(points(shape))
    name, d = type(shape).__name__, shape.dimension
    np.testing.assert_allclose(z.T @ z / len(z), EDGES[name] * np.eye(d), atol=2e-3)
    assert shape.surface_variance == EDGES[name]
    np.testing.assert_allclose(z.mean(axis=0), 0.0, atol=2e-3)


def test_plane_zone_samples_are_even_to_the_fourth_moment() -> None:
    """|z₁|, |z₂|, |z₃| and what is left of 1 are Dirichlet(1, 1, 1, 1), on a face (1, 1, 1)."""
    inside, edge = (
        np.abs(f(points(PlaneZone()))) for f in (PlaneZone().inside, PlaneZone().surface)
    )
    np.testing.assert_allclose(inside.mean(axis=0), 1 / 4, atol=1e-3)
    np.testing.assert_allclose(edge.mean(axis=0), 1 / 3, atol=1e-3)
    for i in range(3):
        pair = inside[:, i] * inside[:, (i + 1) % 3]
        assert pair.mean() == pytest.approx(1 / 20, abs=5e-4)
        assert (pair**2).mean() == pytest.approx(4 / 840, abs=2e-4)
        pair = edge[:, i] * edge[:, (i + 1) % 3]
        assert pair.mean() == pytest.approx(1 / 12, abs=5e-4)


def test_every_sign_pattern_of_a_plane_zone_is_as_likely() -> None:
    for z in (PlaneZone().inside(points(PlaneZone())), PlaneZone().surface(points(PlaneZone()))):
        octant = (z > 0) @ np.array([1, 2, 4])
        np.testing.assert_allclose(np.bincount(octant, minlength=8) / len(z), 1 / 8, atol=2e-3)
