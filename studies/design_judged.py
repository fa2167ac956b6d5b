"""What the machines of a design are worth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: What became of a machine, by its code.
STATUS = ("feasible", "cannot_be", "not_finite", "outside_limits", "misses_poses")
FEASIBLE, CANNOT_BE, NOT_FINITE, OUTSIDE, MISSES = map(np.int8, range(5))

#: Violation of a machine that has no numbers: worse than any that misses a limit.
WORST = 1e6


@dataclass(frozen=True)
class Judged:
    """What n machines are worth.

    Parameters
    ----------
    values : (n, q)
        Of the quantities of a design, each in its unit, any unit; missing (NaN) without.
    status : (n,)
        Codes of `STATUS`.
    reached : (n,)
        Share of the poses, no unit.
    reasons : tuple of n str
        Why a machine is not feasible; empty where it is.
    """

    values: Array
    status: NDArray[np.int8]
    reached: Array
    reasons: tuple[str, ...]
