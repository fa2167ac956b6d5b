"""How far the third leg turns the tool over a whole square (section 3.4)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.biglide_third_leg import BiglideThirdLeg
from strutwork.papers.chablat_2003.published import SQUARES, THRESHOLD

Array = NDArray[Any]

#: Side of the square over which the document turns the tool, m: solution (b), as printed.
SIDE = float(np.sqrt(SQUARES.values[1].value))
#: Points over half a turn of β, and over the step in which a bound is met, twice: the end is
#: right to 1e-7 rad.
COARSE, FINE = 91, 31
#: Lengths at which the ridge is looked for, m.
ARMS = (1.0, 1.5, 2.0)


def sines(machine: BiglideThirdLeg, x: Array, y: Array, turn: Array) -> Array:
    """What eqs 4a and 4b bound, from the places of the machine's joints.

    Parameters
    ----------
    machine : BiglideThirdLeg
    x, y, turn : (...)
        Of the tool, m and rad; broadcast.

    Returns
    -------
    sines : (..., 2)
        The cosine of the angle σ between third leg and rail, and the signed sine of the angle γ
        between third leg and arm, positive on home's side of the singularity; −1 where the leg
        does not reach.
    """
    placement = machine.place(machine.poses(x, y, turn))
    index = machine.linkage.node_index
    foot, end, centre = (
        placement.positions[..., index[n], :] for n in ("rod3/foot", "arm/end", "tool")
    )
    joints = [j.name for j in machine.linkage.joints]
    rail = placement.frames[..., joints.index("carriage3/guide"), :, 2]
    axis = placement.frames[..., joints.index("arm/hinge"), :, 2]
    leg, arm = (end - foot) / machine.third_length, (end - centre) / machine.arm_length
    found = np.stack([(leg * rail).sum(-1), (leg * np.cross(axis, arm)).sum(-1)], axis=-1)
    return np.where(placement.reachable[..., None], found, -1.0)


@dataclass(frozen=True)
class TurnRange:
    """How far the tool can turn everywhere on a square, without leaving β = 0.

    Parameters
    ----------
    low, high : float
        Ends, rad; both 0 where β = 0 is not allowed itself.
    """

    low: float
    high: float

    @property
    def width(self) -> float:
        """Of the range, rad."""
        return self.high - self.low


def turn_range(
    arm: float, third: float, side: float = SIDE, threshold: float = THRESHOLD
) -> TurnRange:
    """Range of β connected to 0 in which both bounds hold at every place of a square about S.

    Both sines are least at a corner of the square or in the middle of a side: σ cos β − X sin β is
    concave in X and y where cos β ≥ 0, and convex with its lowest point negative where cos β < 0.

    Parameters
    ----------
    arm, third : float
        L₁ and L₂, m.
    side : float
        Of the square, along the rails, m.
    threshold : float
    """
    try:
        machine = BiglideThirdLeg(arm_length=arm, third_length=third)
    except ModelError:
        return TurnRange(0.0, 0.0)
    half = side / 2.0
    x, y = (g.ravel() for g in np.meshgrid([-half, 0.0, half], [0.0, half]))

    def slack(turn: Array) -> Array:
        return np.asarray(sines(machine, x, y, turn[:, None]).min(axis=(1, 2)) - threshold)

    ends = [_first_end(slack, sign) for sign in (-1.0, 1.0)]
    return TurnRange(*ends)


def _first_end(slack: Callable[[Array], Array], sign: float) -> float:
    """Where a slack over β, begun at 0, first falls to nothing, rad; a whole half turn at most."""
    low, high = 0.0, np.pi
    found = np.zeros(0)
    for points in (COARSE, FINE, FINE):
        turn = np.linspace(low, high, points)
        found = slack(sign * turn)
        if found[0] < 0.0:
            return 0.0
        if (found >= 0.0).all():
            return sign * high
        first = int(np.argmax(found < 0.0))
        low, high = float(turn[first - 1]), float(turn[first])
        found = found[first - 1 : first + 1]
    return sign * (low + (high - low) * float(found[0] / (found[0] - found[1])))


@cache
def best_third(arm: float, side: float = SIDE, threshold: float = THRESHOLD) -> tuple[float, float]:
    """Length of the third leg that turns the tool farthest, m, and its range, rad.

    The range has one top over L₂/L₁ between 1 and 3; golden sections find it to 1e-3.
    """
    ratio = (np.sqrt(5.0) - 1.0) / 2.0

    def width(share: float) -> float:
        return turn_range(arm, share * arm, side, threshold).width

    low, high = 1.2, 3.0
    inner = [high - ratio * (high - low), low + ratio * (high - low)]
    widths = [width(s) for s in inner]
    while high - low > 1e-3:
        if widths[0] < widths[1]:
            low, inner = inner[0], [inner[1], inner[0] + ratio * (high - inner[0])]
            widths = [widths[1], width(inner[1])]
        else:
            high, inner = inner[1], [inner[1] - ratio * (inner[1] - low), inner[0]]
            widths = [width(inner[0]), widths[0]]
    share = 0.5 * (low + high)
    return share * arm, width(share)


@cache
def range_map(side: float = SIDE) -> tuple[Array, Array, Array]:
    """Ranges of β over L₁ and L₂ as in Fig. 8.

    Returns
    -------
    arms, thirds : (n,), (m,)
        L₁ and L₂, m.
    ranges : (m, n)
        rad.
    """
    arms, thirds = np.linspace(1.0, 3.0, 9), np.linspace(1.0, 4.5, 15)
    found = [[turn_range(a, t, side).width for a in arms] for t in thirds]
    return arms, thirds, np.array(found)
