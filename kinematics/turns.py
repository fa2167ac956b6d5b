"""Rotation vectors of stacks of rotations, and their derivative."""

from __future__ import annotations

from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.frames import cross_matrix

Array = NDArray[Any]

#: Below this, rad, two terms of the series of a turn are all that doubles can tell.
SMALL_TURN = 1e-4


def rotation_matrix(vector: Array) -> Array:
    """Rotation about a vector by its length in rad, (..., 3) to (..., 3, 3) (Rodrigues).

    Parameters
    ----------
    vector : (..., 3)
        rad.
    """
    turn = np.linalg.norm(vector, axis=-1)[..., None, None]
    k = cross_matrix(vector)
    # sin t / t and (1 − cos t) / t², finite at zero
    s, c = np.sinc(turn / np.pi), 0.5 * np.sinc(turn / (2.0 * np.pi)) ** 2
    return np.asarray(np.eye(3) + s * k + c * (k @ k))


def rotation_vector(matrix: Array) -> Array:
    """Axis times angle, 0 to π, of rotations, (..., 3, 3) to (..., 3).

    Parameters
    ----------
    matrix : (..., 3, 3)
        Rotation matrices.
    """
    flat = np.reshape(matrix, (-1, 3, 3))
    if np.abs(flat - np.eye(3)).max(initial=0.0) < SMALL_TURN:
        # sin t times the axis; of arcsin t the two terms that doubles can tell
        skew = 0.5 * np.stack([flat[:, 2, 1], flat[:, 0, 2], flat[:, 1, 0]], axis=-1)
        skew -= 0.5 * np.stack([flat[:, 1, 2], flat[:, 2, 0], flat[:, 0, 1]], axis=-1)
        sine = np.sum(skew**2, axis=-1, keepdims=True)
        return np.asarray((skew * (1.0 + sine / 6.0)).reshape(*matrix.shape[:-2], 3))
    # imported late: it takes a third of a small command's start
    from scipy.spatial.transform import Rotation  # noqa: PLC0415

    return np.asarray(Rotation.from_matrix(flat).as_rotvec().reshape(*matrix.shape[:-2], 3))


def vector_rates(vector: Array) -> Array:
    """Matrix from the angular velocity to the rate of the rotation vector, (..., 3, 3).

    ω is in the axes in which the rotation acts, R' = [ω]× R. Inverse of the left Jacobian of
    SO(3): 1 − [v]×/2 + (1/t² − (1 + cos t)/(2 t sin t)) [v]×², t = |v| (Solà et al. 2018, eq. 146).

    Parameters
    ----------
    vector : (..., 3)
        rad, shorter than a whole turn.
    """
    t = np.linalg.norm(vector, axis=-1)[..., None, None]
    k = cross_matrix(vector)
    small = t < 1e-2
    safe = np.where(small, 1.0, t)
    exact = 1.0 / safe**2 - (1.0 + np.cos(safe)) / (2.0 * safe * np.sin(safe))
    share = np.where(small, 1.0 / 12.0 + t**2 / 720.0, exact)
    return np.asarray(np.eye(3) - 0.5 * k + share * (k @ k))


def velocity_rates(vector: Array, rate: Array) -> Array:
    """Time derivative of the matrix from a rotation vector's rate to ω, (..., 3, 3).

    That matrix is the left Jacobian of SO(3), 1 + b [v]× + c [v]×², b = (1 − cos t)/t²,
    c = (t − sin t)/t³, t = |v| (Solà et al. 2018, eq. 145).

    Parameters
    ----------
    vector : (..., 3)
        rad.
    rate : (..., 3)
        Its time derivative, rad/s.
    """
    t = np.linalg.norm(vector, axis=-1)
    small = t < 1.0
    power, safe = np.where(small, t, 0.0) ** 2, np.where(small, 1.0, t)
    sine, cosine = np.sin(safe), np.cos(safe)
    b, c = (1.0 - cosine) / safe**2, (safe - sine) / safe**3
    slope_b = (safe * sine - 2.0 * (1.0 - cosine)) / safe**4
    slope_c = (3.0 * sine - 2.0 * safe - safe * cosine) / safe**5
    # below 1 rad by series, whose ninth term is below rounding, where the quotients cancel
    near = np.zeros((4, *t.shape))
    for i in range(9):
        sign, even = (-1.0) ** i, float(factorial(2 * i + 2))
        odd = even * (2 * i + 3)
        near[0] += sign * power**i / even
        near[1] += sign * power**i / odd
        if i:
            near[2] += sign * 2 * i * power ** (i - 1) / even
            near[3] += sign * 2 * i * power ** (i - 1) / odd
    b, c, slope_b, slope_c = (
        np.where(small, series, closed)[..., None, None]
        for series, closed in zip(near, (b, c, slope_b, slope_c), strict=True)
    )
    along = np.sum(vector * rate, axis=-1)[..., None, None]
    k, change = cross_matrix(vector), cross_matrix(rate)
    return np.asarray(
        along * (slope_b * k + slope_c * (k @ k)) + b * change + c * (change @ k + k @ change)
    )
