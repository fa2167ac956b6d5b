"""Motion carried along rigid arms, and vectors turned into the axes of a body."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def turned_back(rotation: Array, vector: Array) -> Array:
    """Rᵀ v, (..., 3).

    Parameters
    ----------
    rotation : (..., 3, 3)
        R, no unit.
    vector : (..., 3)
        v, of any unit, which is kept; m for an arm.
    """
    return np.asarray(np.einsum("...ji,...j->...i", rotation, vector))


def rigid_map(arm: Array) -> Array:
    """Twist at the end of a rigid arm from the twist at its start, (..., 6, 6).

    Parameters
    ----------
    arm : (..., 3)
        From start to end, m.
    """
    result = np.zeros((*arm.shape[:-1], 6, 6), dtype=np.result_type(arm, float))
    result[..., range(6), range(6)] = 1.0
    x, y, z = arm[..., 0], arm[..., 1], arm[..., 2]
    result[..., 0, 4], result[..., 0, 5] = z, -y
    result[..., 1, 3], result[..., 1, 5] = -z, x
    result[..., 2, 3], result[..., 2, 4] = y, -x
    return result
