"""Vectors, frames and poses; every function takes leading batch axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]

#: Below this many numbers a part, the calls of `gathered` cost more than they save.
FEW = 1000


def cross_matrix(vector: ArrayLike) -> Array:
    """Matrix [v]× with [v]× w = v × w, (..., 3) to (..., 3, 3).

    Parameters
    ----------
    vector : (..., 3)
        v, in any unit, real or complex; the matrix has the same.
    """
    v = np.asarray(vector)
    matrix = np.zeros((*v.shape, 3), dtype=v.dtype if v.dtype.kind in "fc" else float)
    matrix[..., 0, 1], matrix[..., 0, 2] = -v[..., 2], v[..., 1]
    matrix[..., 1, 0], matrix[..., 1, 2] = v[..., 2], -v[..., 0]
    matrix[..., 2, 0], matrix[..., 2, 1] = -v[..., 1], v[..., 0]
    return matrix


def vector(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """Vectors of three coordinates that broadcast, (...) to (..., 3).

    Each coordinate lies together in memory, as in all that is computed from such vectors:
    operations run along the batch and not in threes.

    Parameters
    ----------
    x, y, z : (...)
        Coordinates in one unit, real or complex.
    """
    parts = np.broadcast_arrays(x, y, z)
    result = np.empty((*parts[0].shape, 3), np.result_type(float, *parts), order="F")
    for k, part in enumerate(parts):
        result[..., k] = part
    return result


def frame(x: Array, y: Array, z: Array) -> Array:
    """Three vectors as columns, (..., 3) to (..., 3, 3); memory as in `vector`.

    Parameters
    ----------
    x, y, z : (..., 3)
        The columns, in one unit; unit vectors for a rotation.
    """
    parts = np.broadcast_arrays(x, y, z)
    result = np.empty((*parts[0].shape, 3), np.result_type(float, *parts), order="F")
    for k, part in enumerate(parts):
        for i in range(3):
            result[..., i, k] = part[..., i]
    return result


def dot(a: Array, b: Array) -> Array:
    """Scalar products of vectors, (..., 3) to (...).

    Parameters
    ----------
    a, b : (..., 3)
        In any unit, complex ones not conjugated.
    """
    return np.asarray(a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2])


def cross(a: Array, b: Array) -> Array:
    """Vector products, (..., 3); memory as in `vector`.

    Parameters
    ----------
    a, b : (..., 3)
        In any unit, real or complex.
    """
    return vector(
        a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
        a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
        a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
    )


def turned(rotation: Array, points: Array) -> Array:
    """Points of a body, (k, 3), turned by its rotations (..., 3, 3), (..., k, 3).

    Memory as in `vector`.

    Parameters
    ----------
    rotation : (..., 3, 3)
        Rotation matrices.
    points : (k, 3)
        In any unit, counted from the point about which the body turns.
    """
    batch = rotation.shape[:-2]
    r = np.ascontiguousarray(np.moveaxis(rotation.reshape(-1, 3, 3), 0, -1))[:, None]
    q = points[..., None]
    # not by BLAS: a pose has the same digits alone as in a batch
    result = r[:, :, 0] * q[:, 0] + r[:, :, 1] * q[:, 1] + r[:, :, 2] * q[:, 2]
    return np.asarray(result.T.reshape(*batch, len(points), 3))


def gathered(parts: Sequence[Array], item: int) -> Array:
    """`parts`, whose last `item` axes are one item, side by side before these, (..., k, item).

    As numpy.stack, which copies items of three numbers one by one: this copies along the batch.

    Parameters
    ----------
    parts : sequence of (..., item)
        Arrays that broadcast against each other, in any unit.
    item : int
        How many of the last axes are one item: 1 for vectors, 2 for matrices.
    """
    shape = np.broadcast_shapes(*(part.shape for part in parts))
    batch, tail = shape[: len(shape) - item], shape[len(shape) - item :]
    kind = np.result_type(*parts)
    result = np.empty((*batch, len(parts), *tail), kind)
    if result.size < FEW * len(parts):
        return np.stack([np.broadcast_to(part, shape) for part in parts], axis=-1 - item)
    for k, part in enumerate(parts):
        for place in np.ndindex(*tail):
            result[(..., k, *place)] = part[(..., *place)]
    return result


def angle(y: ArrayLike, x: ArrayLike) -> Array:
    """Angle of the point (x, y), rad; for complex arguments the analytic continuation.

    The imaginary part carries first derivatives, so that a complex step through inverse
    kinematics is exact (Squire and Trapp 1998).

    Parameters
    ----------
    y, x : (...)
        Coordinates in one unit, real or complex.
    """
    y, x = np.broadcast_arrays(y, x)
    real = np.arctan2(y.real, x.real)
    if not (np.iscomplexobj(x) or np.iscomplexobj(y)):
        return np.asarray(real)
    square = x.real**2 + y.real**2
    return np.asarray(real + 1j * (x.real * y.imag - y.real * x.imag) / square)


def rotation_z(turn: ArrayLike) -> Array:
    """Rotation about z by `turn`, rad, (...) to (..., 3, 3).

    Parameters
    ----------
    turn : (...)
        rad, real or complex.
    """
    t = np.asarray(turn)
    zero, one = np.zeros_like(t), np.ones_like(t)
    c, s = np.cos(t), np.sin(t)
    return np.stack(
        [
            np.stack([c, -s, zero], -1),
            np.stack([s, c, zero], -1),
            np.stack([zero, zero, one], -1),
        ],
        -2,
    )


def rotation_y(turn: ArrayLike) -> Array:
    """Rotation about y by `turn`, rad, (...) to (..., 3, 3).

    Parameters
    ----------
    turn : (...)
        rad, real or complex.
    """
    t = np.asarray(turn)
    zero, one = np.zeros_like(t), np.ones_like(t)
    c, s = np.cos(t), np.sin(t)
    return np.stack(
        [
            np.stack([c, zero, s], -1),
            np.stack([zero, one, zero], -1),
            np.stack([-s, zero, c], -1),
        ],
        -2,
    )


def rotation_x(turn: ArrayLike) -> Array:
    """Rotation about x by `turn`, rad, (...) to (..., 3, 3).

    Parameters
    ----------
    turn : (...)
        rad, real or complex.
    """
    t = np.asarray(turn)
    zero, one = np.zeros_like(t), np.ones_like(t)
    c, s = np.cos(t), np.sin(t)
    return np.stack(
        [
            np.stack([one, zero, zero], -1),
            np.stack([zero, c, -s], -1),
            np.stack([zero, s, c], -1),
        ],
        -2,
    )


def axes_frame(axis: ArrayLike, second_axis: ArrayLike | None = None, part: str = "joint") -> Array:
    """Joint axes as columns x, y, z.

    z is `axis`; x is `second_axis` made perpendicular to it, or global x so made, or global y
    where the axis is along x; y = z × x.

    Parameters
    ----------
    axis : (..., 3)
        Any length but zero, any unit.
    second_axis : (..., 3), optional
        Not along `axis`; any unit.
    part : str
        Named in an error.

    Returns
    -------
    frames : (..., 3, 3)

    Raises
    ------
    ModelError
        An axis of zero length, or a second axis along the first.
    """
    axis = np.asarray(axis)
    axis = axis if axis.dtype.kind in "fc" else axis.astype(float)
    length = np.sqrt(dot(axis, axis))[..., None]
    if np.any(np.abs(length) < 1e-300):
        raise ModelError(part, "has an axis of zero length.", "Give the axis a direction.")
    z = axis / length
    if second_axis is None:
        along_x = np.abs(z[..., :1]) > 1 - 1e-12
        second = np.where(along_x, np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    else:
        second = np.asarray(second_axis)
    x = second - dot(second, z)[..., None] * z
    length = np.sqrt(dot(x, x))[..., None]
    size = np.sqrt((dot(second, np.conj(second))).real)[..., None]
    if np.any(np.abs(length) <= 1e-9 * size):
        raise ModelError(
            part,
            "has a second axis of zero length or along its axis.",
            "Give a second axis that is not parallel to the axis.",
        )
    x = x / length
    return frame(x, cross(z, x), z)


def tangent_rotation(normal: ArrayLike, roll: ArrayLike) -> Array:
    """Rotation R = Rz(α) Ry(β) Rz(γ) whose z axis is `normal` (Azulay 2014, section 2).

    Parameters
    ----------
    normal : (..., 3)
        Unit vector; α and β are its azimuth and its angle from z. At β = 0, α is zero.
    roll : (...)
        The Euler angle γ, rad, the roll about the normal.

    Returns
    -------
    rotation : (..., 3, 3)
    """
    n = np.asarray(normal, dtype=float)
    alpha = np.arctan2(n[..., 1], n[..., 0])
    beta = np.arctan2(np.hypot(n[..., 0], n[..., 1]), n[..., 2])
    return np.asarray(rotation_z(alpha) @ rotation_y(beta) @ rotation_z(roll))
