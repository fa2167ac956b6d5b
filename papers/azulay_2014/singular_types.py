"""Singular poses of types 1, 2 and 3 along tilts (Azulay 2014, eq. 35).

det J⁻¹ = ± (√3 R_p)³ s / ∏ ρ_i w_i, with ρ_i the distance of a platform joint from the guide's axis
and w_i the leg's own transmission. Type 2, det J⁻¹ = 0, is s = 0. Type 1, det J⁻¹ = ±∞, is ρ_i = 0,
where the carriage's angle has no bounds, or w_i = 0, where a leg stands straight or flat: of these
machines w_i has one sign all over a branch, so that it is zero at the end of reach and only there.
Type 3 is both at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines import ThreeLegs
from strutwork.papers.azulay_2014.barrier import HALVINGS, RADIUS, signed, tilted

Array = NDArray[Any]

#: Steps of tilt to 180° and of roll over a third of a turn.
TILTS, ROLLS = 361, 48


@dataclass(frozen=True)
class SingularTilts:
    """Where a machine is singular on a hemisphere, tilts from the pole in rad.

    Parameters
    ----------
    parallel : tuple of (low, high)
        Type 2: one entry for each zero of s along a tilt, over all rolls.
    on_axis : float or None
        Type 1: a joint of the platform on the guide's axis, at the roll that points it against
        the tilt: tan of it is R_p over the radius. None where the other legs do not reach.
    end_of_reach : (low, high) or None
        Type 1: a leg straight or flat, over the rolls at which reach ends; None where it does not.
    both : float
        How near type 3 comes: the least |s| over all type 1 poses, over the largest |s| at the
        pole. Zero where s changes sign along them, infinite where there are none.
    """

    parallel: tuple[tuple[float, float], ...]
    on_axis: float | None
    end_of_reach: tuple[float, float] | None
    both: float


def singular_tilts(machine: ThreeLegs, radius: float = RADIUS) -> SingularTilts:
    """All three types over tilts to 180° and all rolls.

    Parameters
    ----------
    machine : ThreeLegs
    radius : float
        Of the hemisphere, m.
    """
    tilt = np.linspace(0.0, np.pi, TILTS)
    roll = np.arange(ROLLS) * (2.0 * np.pi / 3.0 / ROLLS)

    def s_at(t: Array, r: Array) -> Array:
        return signed(machine, tilted(machine, t, r, radius))

    s = s_at(tilt[:, None], roll)
    reached = np.isfinite(s)
    on_axis = float(np.arctan2(machine.platform_radius, radius))
    # leg 1 points against the tilt; on the axis itself its carriage has no angle
    at_axis = float(s_at(np.array(on_axis - 1e-9), np.array(np.pi)))
    # where reach is lost, and where it comes back
    borders = [
        _between(tilt, roll, change, lambda t, r: np.isfinite(s_at(t, r)))
        for change in (reached[:-1] & ~reached[1:], ~reached[:-1] & reached[1:])
    ]
    along = [np.asarray(s_at(held, r)) for held, r in borders]
    crossed = any(len(np.unique(np.sign(values))) > 1 for values in along)
    ends = np.concatenate([held for held, _ in borders])
    serial = np.abs(np.concatenate([*along, [at_axis] if np.isfinite(at_axis) else []]))
    return SingularTilts(
        _parallel(tilt, roll, s, s_at),
        on_axis if np.isfinite(at_axis) else None,
        (float(ends.min()), float(ends.max())) if ends.size else None,
        0.0 if crossed else float(serial.min(initial=np.inf) / np.abs(s[0]).max()),
    )


def _between(
    tilt: Array, roll: Array, change: NDArray[np.bool_], good: Callable[[Array, Array], Array]
) -> tuple[Array, Array]:
    """Tilts at which `good` changes, on its good side, and their rolls; `change` by steps."""
    at, k = np.nonzero(change)
    one, other, turn = tilt[at], tilt[at + 1], roll[k]
    first = good(one, turn)
    held, gone = np.where(first, one, other), np.where(first, other, one)
    for _ in range(HALVINGS):
        middle = 0.5 * (held + gone)
        fine = good(middle, turn)
        held, gone = np.where(fine, middle, held), np.where(fine, gone, middle)
    return held, turn


def _parallel(
    tilt: Array, roll: Array, s: Array, s_at: Callable[[Array, Array], Array]
) -> tuple[tuple[float, float], ...]:
    """Zeros of s: the first along each tilt, then the second, as least and largest over rolls."""
    # of a pose out of reach the product is not a number, and is no change
    change = s[:-1] * s[1:] < 0
    order = np.cumsum(change, axis=0)
    found = []
    for n in range(1, int(order.max()) + 1):
        # the side of the pole counts as good, of an even zero the other one
        side = float(np.sign(s[0, 0])) * (-1) ** (n - 1)

        def good(t: Array, r: Array, side: float = side) -> Array:
            return np.asarray(np.sign(s_at(t, r)) == side)

        below, _ = _between(tilt, roll, change & (order == n), good)
        found.append((float(below.min()), float(below.max())))
    return tuple(found)
