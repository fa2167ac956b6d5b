"""Compiled rotations of three by three numbers."""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit


@jit()
def turn_about(axes, e, angle):  # type: ignore[no-untyped-def]
    """Turn a frame about its own axis e.

    Parameters
    ----------
    axes : (3, 3)
        Columns, unit vectors; overwritten.
    e : int
        0 to 2.
    angle : float
        rad.
    """
    f = e + 1 if e < 2 else 0
    g = f + 1 if f < 2 else 0
    c, s = np.cos(angle), np.sin(angle)
    for r in range(3):
        x, y = axes[r, f], axes[r, g]
        axes[r, f] = c * x + s * y
        axes[r, g] = c * y - s * x


@jit()
def turn_by_vector(matrix, x, y, z):  # type: ignore[no-untyped-def]
    """Turn a rotation from the left about a vector by its length (Rodrigues).

    Parameters
    ----------
    matrix : (3, 3)
        Overwritten.
    x, y, z : float
        Rotation vector, rad.
    """
    square = x * x + y * y + z * z
    if square < 1e-8:
        s, c = 1.0 - square / 6.0, 0.5 - square / 24.0
    else:
        t = np.sqrt(square)
        s, half = np.sin(t) / t, np.sin(0.5 * t)
        c = 2.0 * half * half / square
    rest = 1.0 - c * square
    for k in range(3):
        a, b, d = matrix[0, k], matrix[1, k], matrix[2, k]
        along = c * (x * a + y * b + z * d)
        # R v = (1 − c |w|²) v + s (w × v) + c (w·v) w
        matrix[0, k] = rest * a + s * (y * d - z * b) + along * x
        matrix[1, k] = rest * b + s * (z * a - x * d) + along * y
        matrix[2, k] = rest * d + s * (x * b - y * a) + along * z


@jit()
def rotation_log(matrix, out, at):  # type: ignore[no-untyped-def]
    """Axis times angle, 0 to π, of a rotation, into out[at : at + 3].

    Parameters
    ----------
    matrix : (3, 3)
        Rotation matrix.
    out : (n,)
        Filled in three places, rad.
    at : int
        The first of them.
    """
    a, b, c = matrix[0, 0], matrix[1, 1], matrix[2, 2]
    trace = a + b + c
    x, y, z = (
        matrix[2, 1] - matrix[1, 2],
        matrix[0, 2] - matrix[2, 0],
        matrix[1, 0] - matrix[0, 1],
    )
    if trace > 0.0:
        # quaternion 2w = √(1 + trace), 4w (q) = (x, y, z)
        w = 0.5 * np.sqrt(1.0 + trace)
        x, y, z = x / (4.0 * w), y / (4.0 * w), z / (4.0 * w)
    elif a >= b and a >= c:
        big = 0.5 * np.sqrt(1.0 + a - b - c)
        w = x / (4.0 * big)
        x, y, z = (
            big,
            (matrix[0, 1] + matrix[1, 0]) / (4.0 * big),
            (matrix[0, 2] + matrix[2, 0]) / (4.0 * big),
        )
    elif b >= c:
        big = 0.5 * np.sqrt(1.0 + b - a - c)
        w = y / (4.0 * big)
        x, y, z = (
            (matrix[0, 1] + matrix[1, 0]) / (4.0 * big),
            big,
            (matrix[1, 2] + matrix[2, 1]) / (4.0 * big),
        )
    else:
        big = 0.5 * np.sqrt(1.0 + c - a - b)
        w = z / (4.0 * big)
        x, y, z = (
            (matrix[0, 2] + matrix[2, 0]) / (4.0 * big),
            (matrix[1, 2] + matrix[2, 1]) / (4.0 * big),
            big,
        )
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    size = np.sqrt(x * x + y * y + z * z)
    factor = 2.0 * np.arctan2(size, w) / size if size > 1e-12 else 2.0 / w
    out[at], out[at + 1], out[at + 2] = factor * x, factor * y, factor * z
