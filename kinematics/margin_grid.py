"""A margin over a grid of task coordinates, and where its edges cross the border."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.margins import Margins, joined

Array = NDArray[Any]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]

#: Margins of points (p, d).
MarginFunction = Callable[[Array], Margins]
#: Told how many poses of about how many are done.
Told = Callable[[int, int], None]

#: Fewest points along an axis: every second one must still make two cells.
FEWEST = 5
#: Poses asked at once.
PIECE = 4096
#: Halvings of an edge that crosses the border: its place is known to 1/8192 of a cell.
HALVINGS = 12


@dataclass(frozen=True)
class Crossings:
    """Edges of a grid from a good point to one that is not.

    Parameters
    ----------
    low : (e, d) of int
        Grid point at the lower end of each edge.
    axis : (e,) of int
        Along which it runs.
    share : (e,)
        Share of it at which the border is, 0 at the lower end.
    reason : (e,) of int
        Index into `reasons`: what ends the workspace there.
    reasons : tuple of str
    """

    low: Indices
    axis: Indices
    share: Array
    reason: Indices
    reasons: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<Crossings: {len(self.axis)} edges>"


@dataclass(frozen=True)
class MarginGrid:
    """Margins at the points of a grid, and its crossings.

    Parameters
    ----------
    directions : tuple of str
    axes : tuple of (n,)
        Evenly spaced, m and rad, an odd number along each.
    margins : Margins
        Of the shape of the grid.
    crossings : Crossings
    """

    directions: tuple[str, ...]
    axes: tuple[Array, ...]
    margins: Margins
    crossings: Crossings

    def __repr__(self) -> str:
        good = int(np.count_nonzero(self.good))
        return f"<MarginGrid: {' x '.join(map(str, self.good.shape))} poses, {good} good>"

    @property
    def good(self) -> Mask:
        """True where a point is good, of the shape of the grid."""
        return self.margins.good

    @cached_property
    def step(self) -> Array:
        """Size of a cell, (d,), m and rad."""
        return np.array([axis[1] - axis[0] for axis in self.axes])

    @cached_property
    def border(self) -> Array:
        """Places of the crossings, (e, d), m and rad."""
        start = np.array([axis[0] for axis in self.axes])
        place = self.crossings.low.astype(float)
        rows = np.arange(len(place))
        place[rows, self.crossings.axis] += self.crossings.share
        return np.asarray(start + place * self.step)

    def coarse(self) -> MarginGrid:
        """Every second point; an edge of it crosses where one of its halves does.

        An edge whose halves both cross has two good or two bad ends and is none.
        """
        good = self.good[(slice(None, None, 2),) * len(self.axes)]
        c = self.crossings
        rows = np.arange(len(c.axis))
        along = c.low[rows, c.axis]
        others = c.low % 2
        others[rows, c.axis] = 0
        on = others.sum(axis=1) == 0
        low = c.low // 2
        share = 0.5 * (along % 2 + c.share)
        high = low.copy()
        high[rows, c.axis] += 1
        on[on] &= good[tuple(low[on].T)] != good[tuple(high[on].T)]
        axes = tuple(axis[::2] for axis in self.axes)
        every = (slice(None, None, 2),) * len(self.axes)
        margins = Margins(
            self.margins.value[every], self.margins.reason[every], self.margins.reasons
        )
        crossings = Crossings(low[on], c.axis[on], share[on], c.reason[on], c.reasons)
        return MarginGrid(self.directions, axes, margins, crossings)


def grid_points(axes: Sequence[Array]) -> Array:
    """All points of a grid, the last axis fastest, (p, d).

    Parameters
    ----------
    axes : sequence of (n,)
        Values along each direction, m or rad.
    """
    return np.stack([g.ravel() for g in np.meshgrid(*axes, indexing="ij")], axis=-1)


def margin_grid(
    directions: Sequence[str],
    axes: Sequence[Array],
    margin: MarginFunction,
    *,
    halvings: int = HALVINGS,
    at_once: bool = False,
    told: Told | None = None,
) -> MarginGrid:
    """Ask a margin at every point of a grid and find the border on every edge that crosses it.

    All edges are halved at once. What a margin does between two neighbours of one kind is not
    seen: a gap narrower than a cell may be missed.

    Parameters
    ----------
    directions : sequence of str
    axes : sequence of (n,)
        m or rad; one to three, evenly spaced, an odd number of at least `FEWEST` along each.
    margin : callable
        From points (p, d) to their `Margins`.
    halvings : int
    at_once : bool
        Whether the margin wants all points of the grid together.
    told : callable, optional

    Raises
    ------
    ModelError
        Another number of axes or points, or values that do not rise evenly.
    """
    check_axes(directions, axes)
    shape = tuple(len(axis) for axis in axes)
    points = grid_points(axes)
    found = margin(points) if at_once else asked(margin, points, told)
    margins = Margins(found.value.reshape(shape), found.reason.reshape(shape), found.reasons)
    crossings = _crossings(axes, margins, margin, halvings)
    return MarginGrid(tuple(directions), tuple(axes), margins, crossings)


def check_axes(directions: Sequence[str], axes: Sequence[Array]) -> None:
    """Refuse axes that make no grid for a level set.

    Parameters
    ----------
    directions : sequence of str
        Names, for messages.
    axes : sequence of (n,)
        Values along each, m or rad.

    Raises
    ------
    ModelError
        As `margin_grid`.
    """
    if not 1 <= len(axes) <= 3 or len(axes) != len(directions):
        raise ModelError(
            "workspace", f"has {len(axes)} directions.", "Name one, two or three of them."
        )
    for name, axis in zip(directions, axes, strict=True):
        if len(axis) < FEWEST or len(axis) % 2 == 0:
            raise ModelError(
                f"workspace in {name}",
                f"has {len(axis)} points.",
                f"Give an odd number of at least {FEWEST}: every second one bounds the error.",
            )
        step = np.diff(axis)
        if not np.all(np.isfinite(axis)) or step[0] <= 0 or np.ptp(step) > 1e-6 * step[0]:
            raise ModelError(
                f"workspace in {name}",
                "is not evenly spaced and ascending.",
                "Give numpy.linspace(low, high).",
            )


def asked(margin: MarginFunction, points: Array, told: Told | None = None) -> Margins:
    """Margins of many points, some at a time, (p,).

    Parameters
    ----------
    margin : callable
        From points (p, d) to their `Margins`.
    points : (p, d)
        m and rad.
    told : callable, optional
        Called with the number of points done and that of all.
    """
    several = []
    for first in range(0, len(points), PIECE):
        several.append(margin(points[first : first + PIECE]))
        if told is not None:
            told(min(first + PIECE, len(points)), len(points))
    return joined(several)


def _crossings(
    axes: Sequence[Array], margins: Margins, margin: MarginFunction, halvings: int
) -> Crossings:
    good = margins.good
    lows, along = [], []
    for k in range(good.ndim):
        ahead = np.moveaxis(good, k, 0)
        turned = np.moveaxis(ahead[1:] != ahead[:-1], 0, k)
        lows.append(np.argwhere(turned))
        along.append(np.full(len(lows[-1]), k, dtype=np.intp))
    low, axis = np.concatenate(lows), np.concatenate(along)
    rows = np.arange(len(low))
    high = low.copy()
    high[rows, axis] += 1
    starts = np.stack([axes[k][low[:, k]] for k in range(good.ndim)], axis=-1)
    ends = np.stack([axes[k][high[:, k]] for k in range(good.ndim)], axis=-1)
    # shares of the good and of the bad end
    inside = np.where(good[tuple(low.T)], 0.0, 1.0)
    outside = 1.0 - inside
    bad = np.where(good[tuple(low.T)][:, None], high, low)
    words = list(margins.reasons)
    reason = margins.reason[tuple(bad.T)]
    for _ in range(halvings if len(low) else 0):
        middle = 0.5 * (inside + outside)
        found = asked(margin, starts + middle[:, None] * (ends - starts))
        words += [word for word in found.reasons if word not in words]
        number = np.array([words.index(word) for word in found.reasons], dtype=np.intp)
        reason = np.where(found.good, reason, number[found.reason])
        inside = np.where(found.good, middle, inside)
        outside = np.where(found.good, outside, middle)
    return Crossings(low, axis, 0.5 * (inside + outside), reason, tuple(words))
