"""Frames: the axes of the model file's conventions, and rotations against SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.kinematics import (
    angle,
    axes_frame,
    cross_matrix,
    rotation_y,
    rotation_z,
    tangent_rotation,
)
from strutwork.kinematics.frames import cross, dot, frame, gathered, turned, vector

# round-off of a few products of numbers of order one
TINY = 1e-14
X, Y, Z = np.eye(3)


@pytest.mark.parametrize(
    ("axis", "x", "y"),
    [
        (Z, X, Y),
        (-Z, X, -Y),
        (2.0 * Y, X, -Z),
        (X, Y, Z),
        (-X, Y, -Z),
        (X + Z, (X - Z) / np.sqrt(2), Y),
    ],
)
def test_without_a_second_axis_x_is_global_x_or_global_y(
    axis: np.ndarray, x: np.ndarray, y: np.ndarray
) -> None:
    frame = axes_frame(axis)
    np.testing.assert_allclose(frame[:, 2], axis / np.linalg.norm(axis), atol=TINY)
    np.testing.assert_allclose(frame[:, 0], x, atol=TINY)
    np.testing.assert_allclose(frame[:, 1], y, atol=TINY)


def test_a_second_axis_is_made_perpendicular_to_the_first() -> None:
    frame = axes_frame(Z, Y + 3 * Z)
    np.testing.assert_allclose(frame, np.column_stack([Y, -X, Z]), atol=TINY)


def test_frames_of_a_batch_are_rotations_and_equal_those_of_one() -> None:
    axes = np.random.default_rng(1).normal(size=(4, 5, 3))
    frames = axes_frame(axes)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=TINY * 10)
    np.testing.assert_allclose(
        frames @ np.swapaxes(frames, -1, -2), np.broadcast_to(np.eye(3), frames.shape), atol=TINY
    )
    np.testing.assert_array_equal(frames[2, 3], axes_frame(axes[2, 3]))


@pytest.mark.parametrize(
    ("axis", "second", "problem"),
    [(np.zeros(3), None, "axis of zero length"), (Z, -2 * Z, "second axis"), (Z, 0 * X, "second")],
)
def test_an_axis_without_direction_is_refused(
    axis: np.ndarray, second: np.ndarray | None, problem: str
) -> None:
    with pytest.raises(ModelError, match=problem) as caught:
        axes_frame(axis, second, part="joint R1")
    assert caught.value.part == "joint R1"


def test_rotations_turn_as_scipys_do() -> None:
    turns = np.linspace(-4, 4, 9)
    for make, axis in ((rotation_y, Y), (rotation_z, Z)):
        expected = Rotation.from_rotvec(turns[:, None] * axis).as_matrix()
        np.testing.assert_allclose(make(turns), expected, atol=TINY)


def test_tangent_rotation_is_the_zyz_sequence_with_z_along_the_normal() -> None:
    alpha, beta, gamma = 0.7, 1.1, -0.4
    normal = [np.sin(beta) * np.cos(alpha), np.sin(beta) * np.sin(alpha), np.cos(beta)]
    rotation = tangent_rotation(normal, gamma)
    expected = Rotation.from_euler("ZYZ", [alpha, beta, gamma]).as_matrix()
    np.testing.assert_allclose(rotation, expected, atol=TINY)
    np.testing.assert_allclose(rotation[:, 2], normal, atol=TINY)


def test_cross_matrix_multiplies_as_the_cross_product() -> None:
    v, w = np.random.default_rng(2).normal(size=(2, 7, 3))
    product = (cross_matrix(v) @ w[..., None])[..., 0]
    np.testing.assert_allclose(product, np.cross(v, w), atol=TINY)


def test_angle_carries_the_derivative_of_a_complex_step() -> None:
    # the step is so small that its square vanishes: the derivative is exact to round-off
    step = 1e-200
    turns = np.array([-3.0, -1.0, 0.5, 2.0])
    y, x = np.sin(turns + 1j * step), np.cos(turns + 1j * step)
    np.testing.assert_allclose(angle(y, x).imag / step, 1.0, rtol=1e-14)
    np.testing.assert_allclose(angle(y, x).real, turns, rtol=1e-14)
    assert angle(1.0, 1.0) == pytest.approx(np.pi / 4, rel=1e-15)


@pytest.mark.parametrize("batch", [(), (7,), (3, 400)])
@pytest.mark.parametrize("kind", [float, complex])
def test_vectors_along_the_batch_are_numpys(batch: tuple[int, ...], kind: type) -> None:
    random = np.random.default_rng(4)
    a, b = (random.normal(size=(*batch, 3)) + 0.1 * kind(1) for _ in range(2))
    np.testing.assert_array_equal(vector(a[..., 0], a[..., 1], a[..., 2]), a)
    np.testing.assert_array_equal(cross(a, b), np.cross(a, b))
    np.testing.assert_allclose(dot(a, b), (a * b).sum(-1), rtol=1e-13, atol=1e-14)
    np.testing.assert_array_equal(frame(a, b, a), np.stack([a, b, a], axis=-1))
    rotation = random.normal(size=(*batch, 3, 3)) * kind(1)
    points = random.normal(size=(4, 3))
    found = turned(rotation, points)
    np.testing.assert_allclose(found, np.einsum("...ij,kj->...ki", rotation, points), atol=1e-13)
    parts = [frame(a, b, a), np.eye(3), rotation]
    whole = np.stack([np.broadcast_to(part, rotation.shape) for part in parts], axis=-3)
    found = gathered(parts, 2)
    np.testing.assert_array_equal(found, whole)
    assert found.flags.c_contiguous


def test_a_turned_point_has_the_same_digits_alone_as_in_a_batch() -> None:
    random = np.random.default_rng(4)
    rotation, points = random.normal(size=(1001, 3, 3)), random.normal(size=(6, 3))
    whole = turned(rotation, points)
    for k in (0, 500, 1000):
        np.testing.assert_array_equal(turned(rotation[k], points), whole[k])
