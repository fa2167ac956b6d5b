"""What a limiting depth is worth: removal rates, and the speeds between lobes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.cutting.limits import DepthLimits
from strutwork.cutting.numbers import positive
from strutwork.cutting.process import Milling, Process
from strutwork.cutting.zero_order import LobeLimits
from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class Pocket:
    """A speed at which a cut removes most among its neighbours.

    Parameters
    ----------
    speed : float
        rpm.
    depth : float
        Limiting depth, m.
    removal_rate : float
        m³/s.
    """

    speed: float
    depth: float
    removal_rate: float


def removal_rates(process: Process, speeds: ArrayLike, depth: ArrayLike, feed: float) -> Array:
    """Material removed per time, (...), m³/s.

    Milling: depth times radial depth times feed speed. Turning: depth times feed times cutting
    speed.

    Parameters
    ----------
    process : Process
    speeds : (...)
        rpm.
    depth : (...)
        m.
    feed : float
        Per tooth, m.

    Raises
    ------
    ModelError
        A feed that is not positive, turning without a diameter.
    """
    positive("process", "feed per tooth", feed)
    passes = np.asarray(speeds, dtype=float) / 60.0 * process.teeth
    if isinstance(process, Milling):
        width = process.immersion * process.cutter.diameter
    elif process.diameter is None:
        raise ModelError(
            "turning", "has no diameter.", "Give the diameter of the surface that is cut."
        )
    else:
        width = np.pi * process.diameter
    return np.asarray(np.asarray(depth, dtype=float) * width * feed * passes)


def best_pockets(
    limits: DepthLimits | LobeLimits, process: Process, feed: float, count: int = 3
) -> tuple[Pocket, ...]:
    """The speeds of largest removal rate among their neighbours, best first.

    Where no depth is unstable, the deepest that was tried counts.

    Parameters
    ----------
    limits : DepthLimits or LobeLimits
        At rising speeds.
    process : Process
    feed : float
        Per tooth, m.
    count : int
        Pockets at most.

    Raises
    ------
    ModelError
        Speeds that do not rise, fewer than three, or zero-order limits without a limit at a speed.
    """
    speeds, depth = limits.speeds, limits.depth
    if len(speeds) < 3 or np.any(np.diff(speeds) <= 0):
        raise ModelError(
            "best pockets", "need three rising speeds or more.", "Sort the speeds, or give more."
        )
    if isinstance(limits, DepthLimits):
        depth = np.minimum(depth, limits.deepest)
    elif not np.all(np.isfinite(depth)):
        raise ModelError(
            "best pockets",
            f"have no limit at {speeds[~np.isfinite(depth)][0]:g} rpm.",
            "Give a response of a wider band, or leave that speed out.",
        )
    rate = removal_rates(process, speeds, depth, feed)
    padded = np.concatenate([[-np.inf], rate, [-np.inf]])
    peaks = np.flatnonzero((padded[1:-1] >= padded[:-2]) & (padded[1:-1] > padded[2:]))
    best = sorted(peaks, key=lambda i: -rate[i])[:count]
    return tuple(Pocket(float(speeds[i]), float(depth[i]), float(rate[i])) for i in best)
