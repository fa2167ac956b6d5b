"""What of a response between ports is no more than rounding."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: A response between two ports below this share of what either answers to itself is rounding.
#: Modes of one frequency cancel to 1e-16 over their damping ratio, seldom below 1e-6.
UNCOUPLED = 1e-9


def uncoupled(response: Array) -> NDArray[np.bool_]:
    """Pairs of ports that do not answer one another.

    The largest |H_ij| is compared with √(|H_ii| |H_jj|), each the largest over the lines: what
    H_ij was made from.

    Parameters
    ----------
    response : (..., f, q, q)
        Between all ports, at lines, complex, m/N.

    Returns
    -------
    uncoupled : (..., q, q) of bool
    """
    largest = np.abs(response).max(axis=-3)
    own = np.sqrt(np.einsum("...ii->...i", largest))
    found = largest <= UNCOUPLED * own[..., :, None] * own[..., None, :]
    return np.asarray(found & ~np.eye(response.shape[-1], dtype=bool))
