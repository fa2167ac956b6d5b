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
from scipy.ndimage import minimum_filter

from strutwork.kinematics.drive_fields import DriveField
from strutwork.kinematics.zero_lines import zero_lines

Array = NDArray[Any]

#: Step of second derivatives, as a share of the patch: its sixth power is below rounding.
STEP = 1e-2

#: Second derivatives whose smaller singular value is below this share of the larger: a line.
FLAT = 1e-6

#: Gradient at which a point counts as singular, as a share of the largest on the patch.
ZERO = 1e-9

#: The same along a whole line of them, between whose points the line is not corrected.
LINE = 1e-6

#: Places nearer than this share of the patch are one.
SAME = 1e-6

#: Steps of Newton's method, and the last, as a share of the patch.
STEPS = 40
SETTLED = 1e-12

#: The direction of the gradient turns by less than this between two points of a border, rad.
TURN = 0.5


@dataclass(frozen=True)
class Patch:
    """The rectangle of the parameters, and a grid over it.

    Parameters
    ----------
    u, v : (k,), (l,)
        Ascending, m or rad.
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
        """Points on the patch, its border included to rounding, (m,).

        Parameters
        ----------
        points : (m, 2)
            Values of the parameters, in the units of u and v.
        """
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
        Parameters, m or rad.
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
        Whole lines of such points, in parameters, m or rad.
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
        """Whether strong less weak points are the winding; None where that is unknown."""
        if self.winding is None or self.lines:
            return None
        return self.strong - self.weak == self.winding


def singularities(
    field: DriveField,
    patch: Patch,
    gradient: Array,
    moving: NDArray[np.intp],
    finer: int = 2,
) -> tuple[DriveSingularities, ...]:
    """Singular points and lines of drives.

    Started in every cell in which both derivatives change their signs, and where the gradient
    is least among its neighbours; where the index then misses some, on grids twice as fine.

    Parameters
    ----------
    field : DriveField
    patch : Patch
    gradient : (k, l, n, 2)
        On the patch's grid.
    moving : (a,) of int
        Drives that are looked at.
    finer : int
        Times that the grid is halved.
    """
    turns = windings(field, patch, moving)
    found: dict[int, DriveSingularities] = {}
    left = moving
    for step in range(finer + 1):
        found |= _found(field, patch, gradient, left, turns)
        left = np.array([k for k in left if found[int(k)].complete is False], dtype=np.intp)
        if not left.size or step == finer:
            break
        patch = patch.finer()
        shape = (len(patch.u), len(patch.v), *gradient.shape[2:])
        gradient = field.gradient(patch.points).reshape(shape)
    return tuple(found[int(k)] for k in moving)


def hessians(field: DriveField, patch: Patch, points: Array, drives: NDArray[np.intp]) -> Array:
    """Second derivatives of a drive's coordinate at each point, (m, 2, 2).

    Differences of exact gradients, of the sixth order; not a number where the machine cannot
    take the points beside.

    Parameters
    ----------
    field : DriveField
    patch : Patch
    points : (m, 2)
        Values of the parameters, in the units of u and v.
    drives : (m,) of int
    """
    count = len(points)
    steps = STEP * np.diag(patch.span)
    counts = (-3, -2, -1, 1, 2, 3)
    beside = np.concatenate([points + n * step for step in steps for n in counts])
    g = _of(field, beside, np.tile(drives, 12)).reshape(2, 6, count, 2)
    weights = np.array([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0]) / 60.0
    found = np.einsum("n,knmi->mik", weights, g) / np.diag(steps)
    return np.asarray((found + np.swapaxes(found, -1, -2)) / 2)


def windings(field: DriveField, patch: Patch, moving: NDArray[np.intp]) -> dict[int, int | None]:
    """Turns of drives' gradients along the border of the patch, counter-clockwise.

    None where the border leaves the reach or the gradient vanishes on it.

    Parameters
    ----------
    field : DriveField
        Of n drives.
    patch : Patch
        Whose border is gone round.
    moving : (a,) of int
        Drives that are looked at.
    """
    way = patch.border()
    g = field.gradient(way)[:, moving] * patch.span
    found: dict[int, int | None] = dict.fromkeys(moving.tolist())
    for _ in range(24):
        size = np.linalg.norm(g, axis=-1)
        # a drive whose gradient vanishes on the border has no index there
        sound = ~np.isnan(size).any(axis=0) & (size.min(axis=0) > ZERO * size.max(axis=0))
        angle = np.arctan2(g[..., 1], g[..., 0])
        step = (np.diff(angle, axis=0) + np.pi) % (2 * np.pi) - np.pi
        wide = (np.abs(step) > TURN) & sound
        for n, k in enumerate(moving.tolist()):
            if sound[n] and not wide[:, n].any():
                found[k] = round(float(step[:, n].sum()) / (2 * np.pi))
        more = np.flatnonzero(wide.any(axis=1))
        if not more.size:
            break
        between = (way[more] + way[more + 1]) / 2
        way = np.insert(way, more + 1, between, axis=0)
        g = np.insert(g, more + 1, field.gradient(between)[:, moving] * patch.span, axis=0)
    return found


def _of(field: DriveField, points: Array, drives: NDArray[np.intp]) -> Array:
    """Gradient of one drive at each point, (m, 2)."""
    return np.asarray(field.gradient(points)[np.arange(len(points)), drives])


def _found(
    field: DriveField,
    patch: Patch,
    gradient: Array,
    moving: NDArray[np.intp],
    turns: dict[int, int | None],
) -> dict[int, DriveSingularities]:
    if not moving.size:
        return {}
    # derivatives and places count by the patch's own size
    scaled = gradient * patch.span
    sizes = np.nanmax(np.linalg.norm(scaled, axis=-1), axis=(0, 1))
    starts = [_starts(patch, scaled[:, :, k]) for k in moving]
    owner = np.repeat(moving, [len(s) for s in starts])
    places, bends, owner = _newton(field, patch, np.concatenate(starts), owner, sizes)
    own = bends * patch.span[:, None] * patch.span
    values = np.linalg.svd(own, compute_uv=False)
    flat = values[:, 1] <= FLAT * values[:, 0]
    found = {}
    for k in moving.tolist():
        name, mine = field.drives[k], owner == k
        points = tuple(
            SingularPoint(name, place, "strong" if np.linalg.det(bend) > 0 else "weak", bend)
            for place, bend in zip(places[mine & ~flat], bends[mine & ~flat], strict=True)
        )
        lines = _lines(field, patch, gradient[:, :, k], k, own[mine & flat])
        found[k] = DriveSingularities(name, points, lines, turns[k])
    return found


def _starts(patch: Patch, scaled: Array) -> Array:
    """Middles of the cells near which a zero may be, (s, 2)."""
    corners = np.stack([scaled[:-1, :-1], scaled[1:, :-1], scaled[:-1, 1:], scaled[1:, 1:]])
    low, high = corners.min(axis=0), corners.max(axis=0)
    changes = np.all((low <= 0.0) & (high >= 0.0), axis=-1)
    u, v = ((a[1:] + a[:-1]) / 2 for a in (patch.u, patch.v))
    middles = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1)
    size = np.where(np.isnan(scaled[..., 0]), np.inf, np.linalg.norm(scaled, axis=-1))
    least = (size <= minimum_filter(size, 3, mode="nearest")) & np.isfinite(size)
    return np.concatenate([middles[changes], patch.points.reshape(*size.shape, 2)[least]])


def _newton(
    field: DriveField,
    patch: Patch,
    starts: Array,
    owner: NDArray[np.intp],
    sizes: Array,
) -> tuple[Array, Array, NDArray[np.intp]]:
    """Zeros reached from some places, each once, the second derivatives there, whose they are."""
    cell = np.array([np.diff(patch.u).max(), np.diff(patch.v).max()])
    places = starts.copy()
    bends = np.full((len(places), 2, 2), np.nan)
    alive = np.ones(len(places), dtype=bool)
    settled = np.zeros(len(places), dtype=bool)
    for _ in range(STEPS):
        i = np.flatnonzero(alive & ~settled)
        if not i.size:
            break
        g = _of(field, places[i], owner[i]) * patch.span
        bends[i] = hessians(field, patch, places[i], owner[i])
        own = bends[i] * patch.span[:, None] * patch.span
        bad = np.isnan(own).any(axis=(1, 2)) | np.isnan(g).any(axis=1)
        own[bad], g[bad] = np.eye(2), 0.0
        # what is nearly flat is a line: go straight to it
        step = -(np.linalg.pinv(own, rcond=FLAT) @ g[..., None])[..., 0] * patch.span
        step /= np.maximum(np.abs(step / cell).max(axis=-1), 1.0)[:, None]
        places[i] += step
        # a zero farther than a few cells has starts of its own
        gone = np.any(np.abs(places[i] - starts[i]) > 6 * cell, axis=-1)
        alive[i[bad | gone]] = False
        settled[i] = np.all(np.abs(step) <= SETTLED * patch.span, axis=-1)
    good = np.flatnonzero(alive & patch.inside(places))
    rest = np.linalg.norm(_of(field, places[good], owner[good]) * patch.span, axis=-1)
    good = good[rest <= ZERO * sizes[owner[good]]]
    kept: list[int] = []
    for n in good:
        apart = (places[n] - places[kept]) / patch.span
        if not np.any((np.abs(apart).max(axis=-1) <= SAME) & (owner[kept] == owner[n])):
            kept.append(int(n))
    return places[kept], bends[kept], owner[kept]


def _lines(
    field: DriveField, patch: Patch, gradient: Array, drive: int, bends: Array
) -> tuple[Array, ...]:
    """Lines along which the whole gradient is zero."""
    lines: list[Array] = []
    size = float(np.nanmax(np.linalg.norm(gradient * patch.span, axis=-1)))
    for bend in bends:
        # points of a line that is known already
        _, _, right = np.linalg.svd(bend)
        across = right[0] * patch.span

        def along(points: Array, _: NDArray[np.intp], across: Array = across) -> Array:
            return np.asarray(field.gradient(points)[:, drive] @ across)

        (found,) = zero_lines(along, (gradient @ across)[..., None], patch.u, patch.v)
        for line in found:
            rest = np.linalg.norm(field.gradient(line)[:, drive] * patch.span, axis=-1)
            new = all(_apart(line, other, patch.span) > SAME for other in lines)
            if rest.max() <= LINE * size and new:
                lines.append(line)
    return tuple(lines)


def _apart(one: Array, other: Array, span: Array) -> float:
    """Largest distance of a line's points from another's nearest, as a share of the patch."""
    gaps = np.abs((one[:, None] - other[None]) / span).max(axis=-1)
    return float(gaps.min(axis=1).max())
