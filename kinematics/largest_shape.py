"""The largest box, ball or cylinder within a workspace, about a centre or anywhere.

Along rays from a centre the border is found by halving, and finer and finer about the nearest
places, where the shape will touch it. There the border is taken as flat: a linear program moves the
centre to where the shape may grow most, within a distance in which this holds (sequential linear
programming with a trust region; Nocedal and Wright 2006, section 18.5). The border of the
grid says where to begin: each of its points keeps the shape from being larger than its gauge there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.kinematics.inscribed_shape import InscribedShape
from strutwork.kinematics.margin_grid import MarginFunction, MarginGrid, asked
from strutwork.kinematics.shape_touch import ROUGH, ShapeSearch, Touch

Array = NDArray[Any]

#: Points along each side of the cube that confirms a result.
CONFIRM = {1: 101, 2: 81, 3: 21}
#: Centres to begin at, and good points of the grid among which they are sought.
STARTS, SEEDS = 4, 3000
#: Renewed searches after a bad point was found.
ROUNDS = 10


@dataclass(frozen=True)
class LargestShape:
    """The largest shape found, and what limits its size.

    Parameters
    ----------
    shape : InscribedShape
    centre : (d,)
        m and rad.
    size : float
        Of the shape, no unit; its halves are `size * shape.half`.
    bound : float
        Size that the border, taken as flat where the shape touches it, allows near the result; no
        unit.
    critical : (d,)
        Point on its border that is nearest to being bad, m and rad.
    reason : str
        What is at its bound there.
    confirmed : int
        Points of a grid over the shape, border included, that are good.
    """

    shape: InscribedShape
    centre: Array
    size: float
    bound: float
    critical: Array
    reason: str
    confirmed: int

    def __repr__(self) -> str:
        return f"<LargestShape: {self.shape.kind}, size {self.size:.6g}, at {self.centre.tolist()}>"

    @property
    def sides(self) -> Array:
        """Whole sizes along the shape's own directions, (d,), m and rad."""
        return np.asarray(2.0 * self.size * self.shape.half)

    @property
    def measure(self) -> float:
        """Length, area or volume."""
        return float(self.shape.measure * self.size**self.shape.half.size)


def largest_shape(
    grid: MarginGrid,
    margin: MarginFunction,
    shape: InscribedShape,
    *,
    centre: ArrayLike | None = None,
    accuracy: float = 1e-4,
) -> LargestShape:
    """The largest shape within a workspace, found to an accuracy and confirmed on a grid.

    What lies beyond the grid counts as outside. Anywhere, the best of several local searches is
    returned: the shape is good, and none was found to be larger.

    Parameters
    ----------
    grid : MarginGrid
        Of the same margin: where to begin.
    margin : callable
    shape : InscribedShape
        Its proportions; the size is sought.
    centre : (d,), optional
        m and rad; anywhere by default.
    accuracy : float
        Of the size, as a share of it.

    Raises
    ------
    ModelError
        Another number of directions, a centre outside the workspace or beyond the grid, or no good
        point at all.
    NumericalError
        The grid is too coarse for the workspace's gaps.
    """
    low, high = (np.array([axis[k] for axis in grid.axes]) for k in (0, -1))
    if shape.half.size != low.size:
        raise ModelError(
            "shape",
            f"has {shape.half.size} directions, the workspace {low.size}.",
            "Give as many.",
        )
    search = ShapeSearch(margin, shape, low, high, accuracy)
    if centre is not None:
        middle = np.asarray(centre, dtype=float)
        if search.within(middle) <= 0.0 or not margin(middle[None]).good[0]:
            raise ModelError(
                "shape",
                f"has its centre {middle.tolist()} outside the workspace or its grid.",
                "Give a centre inside, m and rad, or none.",
            )
        return _about(search, middle)
    return _anywhere(search, grid)


def _about(search: ShapeSearch, centre: Array) -> LargestShape:
    most = search.within(centre)
    for _ in range(ROUNDS):
        touch = search.touched(centre, most, search.accuracy)
        size = float(touch.size[0]) if len(touch.size) else most
        result, bad = _confirmed(search, centre, size, touch, size)
        if not bad.size:
            return result
        # a bad point between the rays: what is nearer than it is sought again
        most = float(search.shape.gauge(bad - centre).min())
    raise _lost()


def _anywhere(search: ShapeSearch, grid: MarginGrid) -> LargestShape:
    seeds = _seeds(grid)
    cloud = grid.border
    for _ in range(ROUNDS):
        room = _allowed(search, cloud, seeds)
        order = np.argsort(-room, kind="stable")
        starts = _spread(search.shape, seeds[order], float(room[order[0]]))
        found = [search.climbed(start, ROUGH) for start in starts]
        first = max(found, key=lambda one: one[1])
        centre, size, touch, bound = search.climbed(first[0])
        result, bad = _confirmed(search, centre, size, touch, bound)
        if not bad.size:
            return result
        cloud = np.concatenate([cloud, bad])
        seeds = np.concatenate([seeds, np.array([one[0] for one in found])])
    raise _lost()


def _allowed(search: ShapeSearch, cloud: Array, centres: Array) -> Array:
    """Size that points of the border and the grid's ends allow about centres, (m,)."""
    found = np.array([search.within(c) for c in centres])
    for k, centre in enumerate(centres):
        found[k] = min(found[k], search.shape.gauge(cloud - centre).min(initial=np.inf))
    return found


def _seeds(grid: MarginGrid) -> Array:
    good = np.argwhere(grid.good)
    if not good.size:
        raise ModelError(
            "shape", "finds no good pose in the grid.", "Move the grid, or use a finer one."
        )
    good = good[:: -(-len(good) // SEEDS)]
    return np.stack([axis[good[:, k]] for k, axis in enumerate(grid.axes)], axis=-1)


def _spread(shape: InscribedShape, seeds: Array, size: float) -> list[Array]:
    """The first of some seeds that lie apart."""
    chosen: list[Array] = []
    for seed in seeds:
        if all(shape.gauge(seed - other) > 0.5 * size for other in chosen):
            chosen.append(seed)
        if len(chosen) == STARTS:
            break
    return chosen


def _confirmed(
    search: ShapeSearch, centre: Array, size: float, touch: Touch, bound: float
) -> tuple[LargestShape, Array]:
    """A result, and the points of a fine grid over it that are bad, (k, d)."""
    shape, size = search.shape, size * (1.0 - 1e-12)
    inside, least = shape.filled(CONFIRM[len(centre)]), size * (1.0 - search.accuracy)
    while True:
        points = centre + size * inside
        bad = points[~asked(search.margin, points).good]
        nearest = float(shape.gauge(bad - centre).min(initial=np.inf))
        if nearest > size * (1.0 + 1e-9) or nearest < least:
            break
        # within the accuracy it may shrink
        size = nearest * (1.0 - 0.1 * search.accuracy)
    if len(touch.size):
        critical = centre + size * touch.rays[0]
        beyond = search.margin(touch.points[:1])
        reason = beyond.reasons[int(beyond.reason[0])]
    else:
        rim = centre + size * shape.border(CONFIRM[len(centre)])
        ends = np.minimum(rim - search.low, search.high - rim).min(axis=1)
        critical, reason = rim[int(ends.argmin())], "the grid ends"
    result = LargestShape(shape, centre, size, bound, critical, reason, len(points))
    return result, bad


def _lost() -> NumericalError:
    return NumericalError(
        "shape",
        f"contains bad points wherever it is placed, in {ROUNDS} attempts.",
        "Use a finer grid: the workspace has gaps that this one does not resolve.",
    )
