"""A camera from which a box fills its view, whatever its proportions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: From the box to the camera: from the right front and above.
WAY = np.array([1.24, -1.47, 1.1])

#: Half of plotly's vertical field of view, 45°, as a tangent.
TANGENT = float(np.tan(np.pi / 8))

#: Shares of half the view that the box may take: the axes' names stand below and beside it.
TOP, BOTTOM, SIDES = 0.95, 0.8, 0.76

#: Width over height of the narrowest view that is not moved farther away, as in report.js.
ASPECT = 1.15


def camera_of(ratio: Array) -> dict[str, dict[str, float]]:
    """Eye and centre for a box with the given sides about the origin, in plotly's units.

    Parameters
    ----------
    ratio : (3,)
        The scene's aspect ratio.

    Returns
    -------
    dict
        `eye` and `center`: the nearest camera on `WAY` that sees all corners between the margins.
    """
    way = WAY / np.linalg.norm(WAY)
    right = np.cross([0.0, 0.0, 1.0], way)
    right /= np.linalg.norm(right)
    up = np.cross(way, right)
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = signs * np.asarray(ratio, dtype=float) / 2.0
    depth, high, wide = corners @ way, corners @ up, np.abs(corners @ right)
    near, far = float(depth.max()) + 1e-6, 100.0 * float(np.linalg.norm(ratio))
    for _ in range(60):
        middle = (near + far) / 2.0
        if _shift(middle, depth, high, wide) is None:
            near = middle
        else:
            far = middle
    shift = _shift(far, depth, high, wide)
    centre = (shift or 0.0) * up
    eye = centre + far * way
    return {
        "eye": dict(zip("xyz", eye.tolist(), strict=True)),
        "center": dict(zip("xyz", centre.tolist(), strict=True)),
    }


def _shift(distance: float, depth: Array, high: Array, wide: Array) -> float | None:
    """How far up the camera looks so that all corners are seen; None where none does."""
    reach = TANGENT * (distance - depth)
    if np.any(wide > SIDES * ASPECT * reach):
        return None
    least = float((high - TOP * reach).max())
    most = float((high + BOTTOM * reach).min())
    return (least + most) / 2.0 if least <= most else None
