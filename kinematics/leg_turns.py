"""Compiled rotations of three by three numbers."""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit


@jit()
def turn_about(axes, i, e, angle):  # type: ignore[no-untyped-def]
    """Turn the frame `axes[i]` about its own axis e."""
    f, g = (e + 1) % 3, (e + 2) % 3
    c, s = np.cos(angle), np.sin(angle)
    for r in range(3):
        x, y = axes[i, r, f], axes[i, r, g]
        axes[i, r, f] = c * x + s * y
        axes[i, r, g] = c * y - s * x


@jit()
def turn_by_vector(matrix, i, x, y, z, work):  # type: ignore[no-untyped-def]
    """Turn the rotation `matrix[i]` from the left about a vector by its length (Rodrigues)."""
    square = x * x + y * y + z * z
    if square < 1e-8:
        s, c = 1.0 - square / 6.0, 0.5 - square / 24.0
    else:
        t = np.sqrt(square)
        s, half = np.sin(t) / t, np.sin(0.5 * t)
        c = 2.0 * half * half / square
    a, b, d = matrix[i, 0, 0], matrix[i, 0, 1], matrix[i, 0, 2]
    for k in range(3):
        a, b, d = matrix[i, 0, k], matrix[i, 1, k], matrix[i, 2, k]
        along = c * (x * a + y * b + z * d)
        # R v = v + s (w × v) + c (w (w·v) − |w|² v)
        rest = 1.0 - c * square
        work[0, k] = rest * a + s * (y * d - z * b) + along * x
        work[1, k] = rest * b + s * (z * a - x * d) + along * y
        work[2, k] = rest * d + s * (x * b - y * a) + along * z
    for r in range(3):
        for k in range(3):
            matrix[i, r, k] = work[r, k]


@jit()
def rotation_log(matrix, out, at):  # type: ignore[no-untyped-def]
    """Axis times angle, 0 to π, of a rotation, into out[at : at + 3]."""
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
