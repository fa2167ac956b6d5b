"""Largest shapes: beside closed forms of textbooks and of Chablat's biglide, and Delta."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.inscribed_shape import InscribedShape, box_of, plane_turn
from strutwork.kinematics.largest_shape import LargestShape, largest_shape
from strutwork.kinematics.margin_grid import margin_grid
from strutwork.kinematics.margins import Margins, of_slacks

Array = NDArray[Any]


#: A grid reaches a little less far on one side.
OFF = 0.97


def amplification(inverse: Array, low: float, high: float) -> Margins:
    """Velocity amplifications between bounds, of inverse Jacobians."""
    values = np.linalg.svd(inverse, compute_uv=False)
    # of J⁻¹ = 1/σ(J)
    return of_slacks(
        {
            "least amplification": 1.0 / low / values[:, 0] - 1.0,
            "largest amplification": high * values[:, -1] - 1.0,
        }
    )


def biglide(points: Array) -> Margins:
    """Legs of length one on rails along x and y; amplifications from 1/3 to 3."""
    inside = (np.abs(points) < 1.0).all(axis=1)
    x, y = np.where(inside[:, None], points, 0.0).T
    inverse = np.ones((len(points), 2, 2))
    inverse[:, 0, 1], inverse[:, 1, 0] = y / np.sqrt(1 - y**2), x / np.sqrt(1 - x**2)
    # the side of the singularity on which S is
    same = np.where(inside, np.linalg.det(inverse), -1.0)
    kept = amplification(inverse, 1 / 3, 3.0)
    return of_slacks(
        {
            "amplification": np.where(inside, kept.value, -1.0),
            "singularity": np.where(inside, same, -1.0),
        }
    )


def largest(
    margin: Callable[[Array], Margins],
    shape: InscribedShape,
    half: float,
    centre: Array | None = None,
    accuracy: float = 1e-8,
) -> LargestShape:
    d = shape.half.size
    count = {1: 21, 2: 41, 3: 21}[d]
    # none of its points is a centre that is sought
    axis = np.linspace(-half, half * OFF, count)
    grid = margin_grid("xyz"[:d], [axis] * d, margin)
    return largest_shape(grid, margin, shape, centre=centre, accuracy=accuracy)


# exact: corner on an axis, tan² = 64/9; corner on the diagonal, tan = 2/3 (areas)
@pytest.mark.parametrize(
    ("angle", "area", "tolerance"),
    [
        (45.0, 128 / 73, 1e-6),
        (0.0, 16 / 13, 1e-6),
        pytest.param(15.0, 1.2847, 1e-4, marks=pytest.mark.slow),
        pytest.param(30.0, 1.4549, 1e-4, marks=pytest.mark.slow),
    ],
)
@pytest.mark.parametrize("anywhere", [False, True])
def test_squares_of_the_biglide(
    angle: float, area: float, tolerance: float, anywhere: bool
) -> None:
    shape = InscribedShape("box", np.ones(2), plane_turn(np.radians(angle)))
    found = largest(biglide, shape, 1.1, None if anywhere else np.zeros(2))
    assert found.measure == pytest.approx(area, abs=tolerance)
    # the best centre is S; where a square touches on opposite sides it is sharp
    assert np.abs(found.centre).max() < 1e-3
    assert found.confirmed > 6000
    assert biglide(found.critical[None]).value[0] == pytest.approx(0.0, abs=1e-6)


def test_the_largest_square_in_a_triangle() -> None:
    # right angle at the origin, legs 1 and 2: side = 1·2/(1 + 2)
    def triangle(points: Array) -> Margins:
        return of_slacks(
            {"x": points[:, 0], "y": points[:, 1], "slope": 1 - points[:, 0] - points[:, 1] / 2}
        )

    found = largest(triangle, box_of([1, 1]), 2.2, accuracy=1e-7)
    np.testing.assert_allclose(found.sides, 2 / 3, atol=1e-6)
    np.testing.assert_allclose(found.centre, 1 / 3, atol=1e-6)


def test_the_largest_circle_in_a_triangle() -> None:
    def triangle(points: Array) -> Margins:
        return of_slacks(
            {"x": points[:, 0], "y": points[:, 1], "slope": 1 - points[:, 0] / 3 - points[:, 1] / 4}
        )

    # of 3, 4 and 5: the radius of the inscribed circle is 1
    found = largest(triangle, InscribedShape("ball", np.ones(2)), 4.2, accuracy=1e-7)
    assert found.size == pytest.approx(1.0, abs=1e-6)
    np.testing.assert_allclose(found.centre, 1.0, atol=1e-5)


def test_shapes_in_a_ball_and_a_gantry() -> None:
    def ball(points: Array) -> Margins:
        return of_slacks({"ball": 1.0 - np.linalg.norm(points - [0.1, 0.2, -0.1], axis=1)})

    cube = largest(ball, box_of([2, 2, 2]), 1.5, accuracy=1e-5)
    assert cube.size == pytest.approx(1 / np.sqrt(3), rel=2e-5)
    # of all cylinders of height and diameter alike
    cylinder = largest(ball, InscribedShape("cylinder", np.ones(3)), 1.5, accuracy=1e-5)
    assert cylinder.size == pytest.approx(1 / np.sqrt(2), rel=2e-5)

    travel = np.array([[-0.4, 0.5], [-0.31, 0.27], [-0.2, 0.1]])

    def gantry(points: Array) -> Margins:
        slack = np.concatenate([points - travel[:, 0], travel[:, 1] - points], axis=1)
        return of_slacks({f"limit {k}": slack[:, k] for k in range(6)})

    box = largest(gantry, box_of(np.ptp(travel, axis=1)), 0.7, accuracy=1e-9)
    np.testing.assert_allclose(box.sides, np.ptp(travel, axis=1), rtol=1e-8)
    np.testing.assert_allclose(box.centre, travel.mean(axis=1), atol=1e-8)
    assert box.reason.startswith("limit")


def test_the_grid_ends_the_shape() -> None:
    found = largest(lambda p: of_slacks({"all": np.ones(len(p))}), box_of([1, 1]), 0.5)
    assert found.measure == pytest.approx((0.5 + 0.5 * OFF) ** 2, rel=1e-9)
    assert found.reason == "the grid ends"


def delta(points: Array, apart: float, length: float = 0.8) -> Array:
    """Inverse Jacobian of a linear Delta, rails along z, at places in x and y."""
    x, y = points.T
    root = np.sqrt(3) / 2
    arms = np.stack(
        [
            np.stack([x + apart * root, y + apart / 2], axis=-1),
            np.stack([x, y - apart], axis=-1),
            np.stack([x - apart * root, y + apart / 2], axis=-1),
        ],
        axis=1,
    )
    height = np.sqrt(length**2 - (arms**2).sum(axis=-1))
    return np.concatenate([arms / height[..., None], np.ones((len(points), 3, 1))], axis=-1)


def condition(points: Array, apart: float, length: float = 0.8) -> Array:
    return np.linalg.cond(delta(points, apart, length))


@pytest.mark.parametrize(
    ("length", "apart", "worst"),
    [
        (0.8, 0.480, 2.4591),
        (0.8, 0.4873, 2.4556),
        (0.7, 0.4017, 2.7112),
        (0.9, 0.5732, 2.2683),
        (1.0, 0.6592, 2.1245),
    ],
)
def test_the_square_of_the_linear_delta_that_keeps_a_condition(
    length: float, apart: float, worst: float
) -> None:
    def kept(points: Array) -> Margins:
        return of_slacks({"condition": worst / condition(points, apart, length) - 1.0})

    found = largest(kept, box_of([1, 1]), 0.2, np.zeros(2))
    # the table's values are of a square of 300 mm, critical at its corners
    d = 1e-6
    corner = np.array([[0.15, 0.15], [0.15 + d, 0.15 + d]])
    slope = float(np.diff(condition(corner, apart, length))[0] / d)
    assert found.sides[0] == pytest.approx(0.3, abs=2 * 1e-4 / abs(slope))
    np.testing.assert_allclose(np.abs(found.critical), found.sides / 2, rtol=1e-6)
    assert condition(found.critical[None], apart, length)[0] == pytest.approx(worst, rel=1e-6)


def test_wrong_shapes() -> None:
    with pytest.raises(ModelError, match="halves"):
        InscribedShape("box", np.array([1.0, 0.0]))
    with pytest.raises(ModelError, match="rotation"):
        InscribedShape("box", np.ones(2), np.ones((2, 2)))
    with pytest.raises(ModelError, match="cylinder"):
        InscribedShape("cylinder", np.ones(2))
    grid = margin_grid("xy", [np.linspace(-1, 1, 11)] * 2, biglide)
    with pytest.raises(ModelError, match="as many"):
        largest_shape(grid, biglide, box_of([1, 1, 1]))
    with pytest.raises(ModelError, match="centre"):
        largest(biglide, box_of([1, 1]), 1.1, np.array([1.05, 0.0]))
    with pytest.raises(ModelError, match="no good pose"):
        largest(lambda p: of_slacks({"none": -np.ones(len(p))}), box_of([1, 1]), 1.0)
