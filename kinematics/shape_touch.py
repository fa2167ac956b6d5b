"""Where a growing shape touches the border of a workspace, and how it grows farther."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.inscribed_shape import InscribedShape
from strutwork.kinematics.margin_grid import MarginFunction, asked

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Rays along each side of the shape's cube, and points looked at along each.
RAYS, ALONG = {1: 3, 2: 41, 3: 11}, 12
#: Places that are looked at more closely, how far apart, and how much farther than the nearest.
CLOSELY, APART, FARTHER = 10, 0.25, 1.15
#: Steps of the centre from one start.
STEPS = 60
#: Parts into which an interval with the border in it is divided, again and again.
PARTS = 8
#: Accuracy of the first steps.
ROUGH = 1e-3
#: Angle between the rays that a border's slope is taken from, and how sharply they are halved.
SLOPE, SHARP = 1e-4, 1e-12
#: Flat pieces of the border that a step knows.
PIECES = 80


@dataclass(frozen=True)
class Touch:
    """Where a growing shape touches the border, the nearest place first.

    Parameters
    ----------
    size : (k,)
        Largest good sizes, no unit.
    rays : (k, d)
        To the border of the shape of size one, m and rad.
    points : (k, d)
        Beside the border, on its bad side, m and rad.
    """

    size: Array
    rays: Array
    points: Array


@dataclass(eq=False)
class ShapeSearch:
    """A shape in a workspace and within the bounds of its grid.

    Parameters
    ----------
    margin : callable
    shape : InscribedShape
    low, high : (d,)
        Ends of the grid, m and rad.
    accuracy : float
        Of the size, as a share of it.
    """

    margin: MarginFunction
    shape: InscribedShape
    low: Array
    high: Array
    accuracy: float

    def within(self, centre: Array) -> float:
        """Size that the grid allows about a centre.

        Parameters
        ----------
        centre : (d,)
            m and rad.
        """
        reach = self.shape.support(np.eye(len(centre)))
        room = np.minimum(self.high - centre, centre - self.low)
        return float((room / reach).min())

    def touched(self, centre: Array, most: float, accuracy: float) -> Touch:
        """Nearest places of the border up to a size; none where all is good.

        Parameters
        ----------
        centre : (d,)
            m and rad.
        most : float
            The size, no unit.
        accuracy : float
            Of sizes, as a share of them.
        """
        d = len(centre)
        rays = self.shape.border(RAYS[d])
        steps = np.arange(1, ALONG + 1) / ALONG * most
        points = centre + steps[:, None, None] * rays
        margins = asked(self.margin, points.reshape(-1, d))
        good = margins.good.reshape(ALONG, -1)
        first = np.where(good.all(axis=0), ALONG, (~good).argmax(axis=0))
        # rays without a bad point may have one beside them: where the margin is least
        least = margins.value.reshape(ALONG, -1)[-1]
        order = np.lexsort((least, first))
        near = order[self._apart(rays[order])]
        size, rays, clear = self._closely(
            centre,
            rays[near],
            steps[np.minimum(first[near], ALONG - 1)],
            first[near] == ALONG,
            accuracy,
        )
        size, rays = size[~clear], rays[~clear]
        inner, outer = self._halved(centre, rays, np.zeros(len(size)), size)
        order = np.argsort(inner, kind="stable")
        return Touch(inner[order], rays[order], (centre + outer[:, None] * rays)[order])

    def _apart(self, rays: Array) -> list[int]:
        """The first of some rays that are not next to one another."""
        chosen: list[int] = []
        for k, ray in enumerate(rays):
            if not chosen or (self.shape.gauge(rays[chosen] - ray) > APART).all():
                chosen.append(k)
            if len(chosen) == CLOSELY:
                break
        return chosen

    def _closely(
        self, centre: Array, rays: Array, size: Array, clear: Mask, accuracy: float
    ) -> tuple[Array, Array, Mask]:
        """Bad sizes about rays, closer and closer, where they are least; clear of any or not."""
        d = len(centre)
        star = np.stack(np.meshgrid(*[[-1.0, 0.0, 1.0]] * d, indexing="ij"), -1).reshape(-1, d)
        star = (star * self.shape.half) @ self.shape.turn.T
        rays, size, clear = rays.copy(), size.copy(), clear.copy()
        reach = np.full(len(rays), 2.0 / (RAYS[d] - 1))
        sharp = max(0.01 * accuracy, SHARP)
        while True:
            at = np.flatnonzero((reach > 0.1 * accuracy) & self._counts(rays, size, clear, reach))
            if not at.size:
                keep = self._counts(rays, size, clear, reach)
                return size[keep], rays[keep], clear[keep]
            about = self.shape.fitted(rays[at, None] + reach[at, None, None] * star)
            margins = asked(self.margin, (centre + size[at, None, None] * about).reshape(-1, d))
            bad = ~margins.good.reshape(about.shape[:2])
            hit = bad.any(axis=1)
            least = margins.value.reshape(bad.shape).argmin(axis=1)
            smaller, first = self._less(centre, about, size[at], bad, sharp)
            gained = smaller < size[at]
            moved = gained | clear[at]
            chosen = np.where(hit, first, least)
            rays[at[moved]] = about[moved, chosen[moved]]
            size[at] = smaller
            clear[at[hit]] = False
            reach[at[~gained]] *= 0.5

    def _counts(self, rays: Array, size: Array, clear: Mask, reach: Array) -> Mask:
        """Rays that are neither too far nor next to one that is as near."""
        far = ~clear & (size > FARTHER * size[~clear].min(initial=np.inf))
        counts = np.asarray(~far)
        for k in np.argsort(size, kind="stable"):
            if counts[k]:
                near = self.shape.gauge(rays - rays[k]) <= min(2.0 * float(reach[k]), 0.1)
                near[k] = False
                counts &= ~(near & (clear == clear[k]))
        return counts

    def _less(
        self, centre: Array, rays: Array, size: Array, bad: Mask, sharp: float
    ) -> tuple[Array, NDArray[np.intp]]:
        """Smaller bad sizes along bad rays of several, (k, m, d), and which ray it is, (k,)."""
        some, which = np.nonzero(bad)
        first = bad.argmax(axis=1)
        if not some.size:
            return size, first
        # gains of all orders at once: the next star goes on from what is found
        gaps = np.append(2.0 ** np.arange(np.log2(sharp), 0.0), 0.99)
        tried = size[some, None] * (1.0 - gaps)
        points = centre + tried[..., None] * rays[some, which][:, None]
        good = asked(self.margin, points.reshape(-1, len(centre))).good.reshape(tried.shape)
        least = np.where(good, np.inf, tried).min(axis=1, initial=np.inf)
        size = size.copy()
        for row, ray, found in zip(some, which, least, strict=True):
            if found < size[row]:
                size[row], first[row] = found, ray
        return size, first

    def _halved(self, centre: Array, rays: Array, low: Array, high: Array) -> tuple[Array, Array]:
        """Good and bad sizes along rays, brought together."""
        low, high = low.copy(), high.copy()
        parts = np.arange(PARTS + 1) / PARTS
        for _ in range(20):
            wide = np.flatnonzero(high - low > SHARP * high)
            if not wide.size:
                break
            levels = low[wide, None] + parts * (high - low)[wide, None]
            points = centre + levels[:, 1:-1, None] * rays[wide, None]
            good = asked(self.margin, points.reshape(-1, len(centre))).good
            bad = np.pad(~good.reshape(len(wide), -1), ((0, 0), (0, 1)), constant_values=True)
            first = bad.argmax(axis=1)
            rows = np.arange(len(wide))
            low[wide], high[wide] = levels[rows, first], levels[rows, first + 1]
        return low, high

    def slopes(self, centre: Array, touch: Touch) -> Array:
        """Normals of the border where it is touched, to the bad side, (k, d).

        Parameters
        ----------
        centre : (d,)
            m and rad.
        touch : Touch
            Its k places, as `touched` gives them for this centre.
        """
        k, d = touch.rays.shape
        beside = SLOPE * np.concatenate([np.eye(d), -np.eye(d)])
        beside = (beside * self.shape.half) @ self.shape.turn.T
        rays = self.shape.fitted(touch.rays[:, None] + beside).reshape(-1, d)
        size = np.repeat(touch.size, 2 * d)
        if not k:
            return np.zeros((0, d))
        _, outer = self._halved(centre, rays, 0.9 * size, 1.1 * size)
        points = (centre + outer[:, None] * rays).reshape(k, 2 * d, d)
        _, _, right = np.linalg.svd(points - points.mean(axis=1, keepdims=True))
        normals = right[:, -1]
        side = (normals * (touch.points - centre)).sum(axis=1)
        return np.asarray(normals * np.where(side < 0.0, -1.0, 1.0)[:, None])

    def stepped(
        self, normals: Array, points: Array, centre: Array, size: float, trust: float
    ) -> tuple[Array, float]:
        """Centre near one, (d,), and the size there, that a flat border allows.

        Parameters
        ----------
        normals : (m, d)
            Of the pieces of border, to the bad side, of any length, in any unit.
        points : (m, d)
            One of each piece, m and rad.
        centre : (d,)
            m and rad.
        size : float
            Of the shape about it, no unit.
        trust : float
            How far the centre may move, as a share of the shape.
        """
        from scipy.optimize import linprog  # noqa: PLC0415 - only this search needs it

        d = len(centre)
        away = trust * size * self.shape.support(np.eye(d))
        rows = np.concatenate([normals, np.eye(d), -np.eye(d)])
        ends = np.concatenate([(normals * points).sum(axis=-1), self.high, -self.low])
        # in sizes of the shape, so that the program's tolerances mean the same everywhere
        solved = linprog(
            np.append(np.zeros(d), -1.0),
            A_ub=np.column_stack([rows * away, self.shape.support(rows) * size]) / size,
            b_ub=(ends - rows @ centre) / size,
            bounds=[(-1.0, 1.0)] * d + [(0.0, None)],
        )
        if solved.status != 0:
            return centre, size
        return centre + away * solved.x[:d], float(solved.x[d]) * size

    def climbed(
        self, start: Array, final: float | None = None
    ) -> tuple[Array, float, Touch, float]:
        """Centre (d,) and size to which steps from a start lead, where it touches, and the bound.

        Parameters
        ----------
        start : (d,)
            Centre to begin at, m and rad.
        final : float, optional
            Accuracy of the size at the end, as a share of it; default `accuracy`.
        """
        centre, most = start, self.within(start)
        final = self.accuracy if final is None else final
        # the first steps are long: where they end need not be known to the last digit
        accuracy = max(ROUGH, final)
        size, touch = self._size(centre, most, accuracy)
        normals, points = self.slopes(centre, touch), touch.points
        trust, bound = 0.3, size
        for _ in range(STEPS):
            moved, bound = self.stepped(normals, points, centre, size, trust)
            if bound <= size * (1.0 + accuracy) or trust < 0.01 * accuracy:
                if accuracy <= final:
                    break
                accuracy = max(1e-3 * accuracy, final)
                size, touch = self._size(centre, self.within(centre), accuracy)
                normals = np.concatenate([normals, self.slopes(centre, touch)])
                points, trust = np.concatenate([points, touch.points]), max(trust, accuracy)
                continue
            larger, there = self._size(moved, min(self.within(moved), 1.5 * bound), accuracy)
            gain = (larger - size) / (bound - size)
            normals = np.concatenate([normals, self.slopes(moved, there)])
            points = np.concatenate([points, there.points])
            if gain > 0.05:
                centre, size, touch = moved, larger, there
                trust = min(2.0 * trust, 1.0) if gain > 0.5 else trust
            else:
                trust *= 0.3
            # a piece that the shape as it is would cross is bent too much to count as flat
            room = (normals * (points - centre)).sum(axis=-1) / self.shape.support(normals)
            flat = room >= size * (1.0 - max(1e-2 * trust, accuracy))
            normals, points = normals[flat][-PIECES:], points[flat][-PIECES:]
        return centre, size, touch, max(bound, size)

    def _size(self, centre: Array, most: float, accuracy: float) -> tuple[float, Touch]:
        touch = self.touched(centre, most, accuracy)
        return (float(touch.size[0]) if len(touch.size) else most), touch
