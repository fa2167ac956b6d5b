"""Points of a surface about which a drive turns back whichever way the tool goes.

There the gradient of the drive's coordinate is zero. A strong point is an extremum, round which
no path comes without a reversal; a weak one is a saddle (Son 2002, chapter 4). The index of the
gradient along a border counts the strong less the weak ones inside (Milnor 1965, section 6).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.drive_fields import DriveField
from strutwork.kinematics.zero_lines import zero_lines

Array = NDArray[Any]

#: Step of second derivatives, as a share of the patch: its sixth power is below rounding.
STEP = 1e-2

#: Second derivatives whose smaller singular value is below this share of the larger: a line.
FLAT = 1e-6

#: Gradient at which a point counts as singular, as a share of the largest on the patch.
ZERO = 1e-9

#: Steps of Newton's method.
STEPS = 60

#: The direction of the gradient turns by less than this between two points of a border, rad.
TURN = 0.5


@dataclass(frozen=True)
class Patch:
    """The rectangle of the parameters, and a grid over it.

    Parameters
    ----------
    u, v : (k,), (l,)
        Ascending.
    """

    u: Array
    v: Array

    @property
    def span(self) -> Array:
        """Size along u and v, (2,)."""
        return np.array([self.u[-1] - self.u[0], self.v[-1] - self.v[0]])

    @property
    def points(self) -> Array:
        """All points, (k l, 2); v changes fastest."""
        return np.stack(np.meshgrid(self.u, self.v, indexing="ij"), axis=-1).reshape(-1, 2)

    def inside(self, points: Array) -> NDArray[np.bool_]:
        """Points on the patch, its border included to rounding, (m,)."""
        slack = 1e-9 * self.span
        low = np.array([self.u[0], self.v[0]]) - slack
        high = np.array([self.u[-1], self.v[-1]]) + slack
        return np.asarray(np.all((points >= low) & (points <= high), axis=-1))

    def finer(self) -> Patch:
        """With a point between every two."""
        return Patch(*(np.sort(np.append(a, (a[1:] + a[:-1]) / 2)) for a in (self.u, self.v)))

    def border(self) -> Array:
        """Once round counter-clockwise, its first point again at the end, (m, 2)."""
        u, v = self.u, self.v
        sides = (
            np.stack([u, np.full(len(u), v[0])], axis=-1)[:-1],
            np.stack([np.full(len(v), u[-1]), v], axis=-1)[:-1],
            np.stack([u[::-1], np.full(len(u), v[-1])], axis=-1)[:-1],
            np.stack([np.full(len(v), u[0]), v[::-1]], axis=-1),
        )
        return np.concatenate(sides)


@dataclass(frozen=True)
class SingularPoint:
    """Where the gradient of one drive is zero.

    Parameters
    ----------
    drive : str
    place : (2,)
        Parameters.
    kind : "strong" or "weak"
        An extremum or a saddle.
    hessian : (2, 2)
        Second derivatives of the drive's coordinate over the parameters.
    """

    drive: str
    place: Array
    kind: Literal["strong", "weak"]
    hessian: Array


@dataclass(frozen=True)
class DriveSingularities:
    """Where one drive turns back whichever way the tool goes.

    Parameters
    ----------
    drive : str
    points : tuple of SingularPoint
    lines : tuple of (c, 2)
        Whole lines of such points.
    winding : int or None
        Turns of the gradient along the border; None where the border leaves the reach, or a
        singular place lies on it.
    """

    drive: str
    points: tuple[SingularPoint, ...]
    lines: tuple[Array, ...]
    winding: int | None

    @property
    def strong(self) -> int:
        """Number of strong points."""
        return sum(p.kind == "strong" for p in self.points)

    @property
    def weak(self) -> int:
        """Number of weak points."""
        return sum(p.kind == "weak" for p in self.points)

    @property
    def complete(self) -> bool | None:
        """Whether strong less weak points are the winding; None where it cannot be told."""
        if self.winding is None or self.lines:
            return None
        return self.strong - self.weak == self.winding


def singularities(
    field: DriveField, patch: Patch, gradient: Array, drive: int, finer: int = 2
) -> DriveSingularities:
    """Singular points and lines of a drive.

    Started in every cell in which both derivatives change their signs, and where the gradient
    is least among its neighbours; where the index then misses some, on grids twice as fine.

    Parameters
    ----------
    field : DriveField
    patch : Patch
    gradient : (k, l, 2)
        Of the drive on the patch's grid.
    drive : int
        Its index in the field.
    finer : int
        Times that the grid is halved.
    """
    turns = winding(field, patch, drive)
    for _ in range(finer + 1):
        found = _found(field, patch, gradient, drive, turns)
        if found.complete is not False:
            break
        patch = patch.finer()
        shape = (len(patch.u), len(patch.v), 2)
        gradient = field.gradient(patch.points)[:, drive].reshape(shape)
    return found


def hessians(field: DriveField, patch: Patch, points: Array, drive: int) -> Array:
    """Second derivatives of a drive's coordinate, (m, 2, 2): differences of exact gradients.

    Of the sixth order; not a number where the machine cannot take the points beside.
    """
    found = np.empty((len(points), 2, 2))
    for k in (0, 1):
        step = np.zeros(2)
        step[k] = STEP * patch.span[k]
        beside = np.concatenate([points + n * step for n in (-3, -2, -1, 1, 2, 3)])
        g = field.gradient(beside)[:, drive].reshape(6, len(points), 2)
        weights = np.array([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0]) / (60.0 * step[k])
        found[:, :, k] = np.einsum("n,nmi->mi", weights, g)
    return np.asarray((found + np.swapaxes(found, -1, -2)) / 2)


def winding(field: DriveField, patch: Patch, drive: int) -> int | None:
    """Turns of a drive's gradient along the border of the patch, counter-clockwise.

    None where the border leaves the reach or the gradient vanishes on it.
    """
    span = patch.span
    way = patch.border()
    g = field.gradient(way)[:, drive] * span
    for _ in range(24):
        size = np.linalg.norm(g, axis=-1)
        if np.isnan(g).any() or size.min() <= ZERO * size.max():
            return None
        angle = np.arctan2(g[:, 1], g[:, 0])
        step = (np.diff(angle) + np.pi) % (2 * np.pi) - np.pi
        wide = np.flatnonzero(np.abs(step) > TURN)
        if not wide.size:
            return round(float(step.sum()) / (2 * np.pi))
        between = (way[wide] + way[wide + 1]) / 2
        way = np.insert(way, wide + 1, between, axis=0)
        g = np.insert(g, wide + 1, field.gradient(between)[:, drive] * span, axis=0)
    return None


def _found(
    field: DriveField, patch: Patch, gradient: Array, drive: int, turns: int | None
) -> DriveSingularities:
    name = field.drives[drive]
    scaled = gradient * patch.span
    # mixed derivatives and places count by the patch's own size
    size = float(np.nanmax(np.linalg.norm(scaled, axis=-1)))
    places, bends = _newton(field, patch, _starts(patch, scaled), drive, size)
    own = bends * patch.span[:, None] * patch.span
    values = np.linalg.svd(own, compute_uv=False)
    flat = values[:, 1] <= FLAT * values[:, 0] if len(values) else np.zeros(0, dtype=bool)
    points = tuple(
        SingularPoint(name, place, "strong" if np.linalg.det(bend) > 0 else "weak", bend)
        for place, bend, single in zip(places, own, ~flat, strict=True)
        if single
    )
    points = tuple(
        SingularPoint(p.drive, p.place, p.kind, p.hessian / patch.span[:, None] / patch.span)
        for p in points
    )
    lines: tuple[Array, ...] = ()
    if flat.any():
        lines = _lines(field, patch, gradient, drive, own[flat], size)
    return DriveSingularities(name, points, lines, turns)


def _starts(patch: Patch, scaled: Array) -> Array:
    """Middles of the cells near which a zero may be, (s, 2)."""
    corners = np.stack([scaled[:-1, :-1], scaled[1:, :-1], scaled[:-1, 1:], scaled[1:, 1:]])
    low, high = corners.min(axis=0), corners.max(axis=0)
    changes = np.all((low <= 0.0) & (high >= 0.0), axis=-1)
    middles = np.stack(
        np.meshgrid((patch.u[1:] + patch.u[:-1]) / 2, (patch.v[1:] + patch.v[:-1]) / 2, indexing="ij"),
        axis=-1,
    )
    size = np.where(np.isnan(scaled[..., 0]), np.inf, np.linalg.norm(scaled, axis=-1))
    ringed = np.pad(size, 1, constant_values=np.inf)
    beside = np.stack(
        [
            ringed[1 + i : ringed.shape[0] - 1 + i, 1 + j : ringed.shape[1] - 1 + j]
            for i in (-1, 0, 1)
            for j in (-1, 0, 1)
            if (i, j) != (0, 0)
        ]
    )
    least = (size <= beside.min(axis=0)) & np.isfinite(size)
    return np.concatenate(
        [middles[changes], patch.points.reshape(*size.shape, 2)[least]]
    )


def _newton(
    field: DriveField, patch: Patch, starts: Array, drive: int, size: float
) -> tuple[Array, Array]:
    """Zeros reached from some places, each once, and the second derivatives there."""
    cell = np.array([np.diff(patch.u).max(), np.diff(patch.v).max()])
    places = starts.copy()
    bends = np.full((len(places), 2, 2), np.nan)
    alive = np.ones(len(places), dtype=bool)
    settled = np.zeros(len(places), dtype=bool)
    for _ in range(STEPS):
        i = np.flatnonzero(alive & ~settled)
        if not i.size:
            break
        g = field.gradient(places[i])[:, drive] * patch.span
        bend = hessians(field, patch, places[i], drive)
        bends[i] = bend
        own = bend * patch.span[:, None] * patch.span
        bad = np.isnan(own).any(axis=(1, 2)) | np.isnan(g).any(axis=1)
        own[bad] = np.eye(2)
        # what is nearly flat is a line: go straight to it
        step = -(np.linalg.pinv(own, rcond=FLAT) @ g[..., None])[..., 0] * patch.span
        far = np.abs(step / cell).max(axis=-1)
        step /= np.maximum(far, 1.0)[:, None]
        places[i] += np.where(bad[:, None], 0.0, step)
        away = np.abs(places[i] - starts[i]).max(axis=-1) > 0
        # a zero farther than a few cells has starts of its own
        gone = np.any(np.abs(places[i] - starts[i]) > 6 * cell, axis=-1) & away
        alive[i[bad | gone]] = False
        settled[i] = np.all(np.abs(step) <= 1e-13 * patch.span, axis=-1) | (
            np.linalg.norm(g, axis=-1) <= 1e-14 * size
        )
    good = np.flatnonzero(alive & patch.inside(places))
    rest = np.linalg.norm(field.gradient(places[good])[:, drive] * patch.span, axis=-1)
    good = good[rest <= ZERO * size]
    kept: list[int] = []
    for n in good:
        if all(np.abs((places[n] - places[k]) / patch.span).max() > 1e-6 for k in kept):
            kept.append(int(n))
    return places[kept], bends[kept]


def _lines(
    field: DriveField, patch: Patch, gradient: Array, drive: int, bends: Array, size: float
) -> tuple[Array, ...]:
    """Lines along which the whole gradient is zero."""
    lines: list[Array] = []
    for bend in bends:
        _, _, right = np.linalg.svd(bend)
        across = right[0] * patch.span

        def along(points: Array, across: Array = across) -> Array:
            return np.asarray(field.gradient(points)[:, drive] @ across)

        for line in zero_lines(along, gradient @ across, patch.u, patch.v):
            rest = np.linalg.norm(field.gradient(line)[:, drive] * patch.span, axis=-1)
            new = all(_apart(line, other, patch.span) > 1e-6 for other in lines)
            if rest.max() <= ZERO * size * 1e3 and new:
                lines.append(line)
    return tuple(lines)


def _apart(one: Array, other: Array, span: Array) -> float:
    """Largest distance of a line's points from another's nearest, as a share of the patch."""
    gaps = np.abs((one[:, None] - other[None]) / span).max(axis=-1)
    return float(gaps.min(axis=1).max())
