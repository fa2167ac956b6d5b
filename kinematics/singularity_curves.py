"""Curves of singular poses in a plane section, and the border of reach there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.grid_lines import (
    grid_edges,
    grid_places,
    one_sense,
    runs,
    sign_lines,
)
from strutwork.kinematics.lost_motion import Kind, kinds
from strutwork.kinematics.pose_family import PoseFamily, Progress
from strutwork.kinematics.reach_end import ReachEnds, reach_ends
from strutwork.kinematics.singular_poses import (
    PARTS,
    Singularity,
    before_the_end,
    end_kinds,
    local_minima,
    ordered_ends,
    singular_pose,
    singular_poses,
)
from strutwork.kinematics.singularity_search import (
    Part,
    edge_senses,
    has_minor,
    minor,
    refine_least,
    refine_zeros,
)

Array = NDArray[Any]
Indices = NDArray[np.intp]

#: Poses of a grid, and what one takes, s and bytes.
LARGEST = 1_000_000
SECONDS, BYTES = 5e-3, 5e3

#: Distances that differ by this share of the largest are the same.
SAME = 1e-6

#: A curve goes on to a pose at most this many cells from its end.
CELL = 1.5


@dataclass(frozen=True)
class SingularCurve:
    """A curve of singular poses, or a section of the limit of reach.

    Parameters
    ----------
    points : (v, 2)
        In the order of the curve, each on an edge of the grid and refined there, m and rad.
    kind : Kind
    border : bool
        Whether poses on its other side are out of reach.
    closed : bool
    at : Singularity
        The vertex nearest to home, with what is lost there.
    """

    points: Array
    kind: Kind
    border: bool
    closed: bool
    at: Singularity

    def __repr__(self) -> str:
        what = "border of reach" if self.border else "curve"
        return f"<SingularCurve: {what}, {self.kind.value}, {len(self.points)} points>"


@dataclass(frozen=True)
class SingularPlane:
    """Singular poses of a plane section.

    Parameters
    ----------
    names : (str, str)
        Of the two coordinates.
    axes : ((n,), (m,))
        The grid, m and rad.
    reach : (n, m) of bool
    parallel, serial : (n, m)
        Distances of the poses of the grid as in `Distance`, no unit; NaN out of reach.
    curves : tuple of SingularCurve
        Nearest to home first.
    points : tuple of Singularity
        Singular poses that lie alone.
    missed : int
        Edges of the grid whose ends are too different for a sign to be followed: a finer grid
        sees more.
    """

    names: tuple[str, str]
    axes: tuple[Array, Array]
    reach: NDArray[np.bool_]
    parallel: Array
    serial: Array
    curves: tuple[SingularCurve, ...]
    points: tuple[Singularity, ...]
    missed: int

    @property
    def changes(self) -> bool:
        """Whether the distance is not the same wherever the machine reaches."""
        nearest = np.fmin(self.parallel, self.serial)[self.reach]
        return bool(len(nearest)) and float(np.ptp(nearest)) > SAME * float(nearest.max())

    def __repr__(self) -> str:
        return (
            f"<SingularPlane: {' over '.join(self.names)}, {self.reach.size} poses, "
            f"{len(self.curves)} curves, {len(self.points)} single poses>"
        )


def singularities_in_plane(
    family: PoseFamily,
    axes: tuple[ArrayLike, ArrayLike],
    home: ArrayLike = (0.0, 0.0),
    progress: Progress | None = None,
) -> SingularPlane:
    """Curves of singular poses in a plane of two parameters.

    A minor of the motions' tool or drive part is followed over a grid; between the grid's poses
    its lines of zero are found by their signs (contourpy), and every vertex is refined along its
    edge to rounding. Least singular values that touch zero alone are found as `points`.

    Parameters
    ----------
    family : PoseFamily
        Of two parameters.
    axes : ((n,), (m,))
        Values of both parameters, m and rad, increasing.
    home : (2,)
        What is nearest to it comes first, m and rad.
    progress : callable, optional

    Raises
    ------
    ModelError
        Not two parameters, axes that do not increase, a grid of more than `LARGEST` poses (with
        its time and memory), no pose that is reached, or as `tool_drive_space`.
    """
    x, y = _checked(family, axes)
    shape = (len(x), len(y))
    parameters = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    looked = family.look(parameters, progress)
    family = replace(family, known=looked.space.known)
    edges = grid_edges(shape)
    inner = edges[looked.reach[edges].all(axis=1)]
    centre = np.asarray(home, dtype=float)
    spacing = np.array([np.ptp(x) / (len(x) - 1), np.ptp(y) / (len(y) - 1)])
    curves: list[SingularCurve] = []
    points: list[Singularity] = []
    senses = edge_senses(looked, inner)
    sense, missed = one_sense(len(parameters), inner, senses)
    for part in PARTS:
        changed = inner[:0]
        if has_minor(looked.space, part):
            signed = sense * looked.spread(minor(looked.space, part))
            curves += _zero_lines(family, signed.reshape(shape), (x, y), part, centre)
            values = signed[inner]
            changed = inner[values[:, 0] * values[:, 1] < 0.0]
        low = local_minima(looked, edges, changed, part)
        if low.size:
            refined = refine_least(family, parameters[low], spacing, part)
            points += _apart(singular_poses(family, refined), curves, points, (x, y))
    rim = edges[looked.reach[edges].sum(axis=1) == 1]
    if len(rim):
        inside, outside, reasons = ordered_ends(looked, rim)
        ends = reach_ends(family, inside, outside, reasons)
        late = before_the_end(family, inside, ends.parameters)
        curves, alone = _reaching(curves, late, spacing)
        points += _apart(alone, curves, points, (x, y))
        curves += _border(family, looked.reach.reshape(shape), ends, rim, (x, y), centre)
    curves.sort(key=lambda c: _far(c.at, centre, spacing))
    points.sort(key=lambda p: _far(p, centre, spacing))

    def grid(values: Array) -> Array:
        return looked.spread(values).reshape(shape)

    return SingularPlane(
        (family.names[0], family.names[1]),
        (x, y),
        looked.reach.reshape(shape),
        grid(looked.space.parallel_distance()),
        grid(looked.space.serial_distance()),
        tuple(curves),
        tuple(points),
        missed,
    )


def _checked(family: PoseFamily, axes: tuple[ArrayLike, ArrayLike]) -> tuple[Array, Array]:
    if len(family.names) != 2 or len(axes) != 2:
        raise ModelError("plane", f"has {len(family.names)} coordinates.", "Give two.")
    x, y = (np.asarray(a, dtype=float) for a in axes)
    for name, values in zip(family.names, (x, y), strict=True):
        if values.ndim != 1 or len(values) < 2 or not np.all(np.diff(values) > 0.0):
            raise ModelError(
                "plane", f"{name} does not increase.", "Give two or more increasing values."
            )
    count = len(x) * len(y)
    if count > LARGEST:
        raise ModelError(
            "plane",
            f"has {count:,} poses, more than the {LARGEST:,} that are allowed: about "
            f"{SECONDS * count / 60:.0f} minutes and {BYTES * count / 1e9:.1f} GB.",
            "Use fewer steps: curves are refined whatever the grid.",
        )
    return x, y


def _zero_lines(
    family: PoseFamily, signed: Array, axes: tuple[Array, Array], part: Part, home: Array
) -> list[SingularCurve]:
    """Lines on which a minor, (n, m) with NaN out of reach, is zero."""
    result = []
    for start, end in sign_lines(signed):
        a, b = grid_places(axes, start), grid_places(axes, end)
        refined = refine_zeros(family, a, b, part)
        found = kinds(refined.space)
        # a curve may meet another kind at a point and change its own there
        for run in runs([None if k is None else k.value for k in found]):
            closed = len(run) == len(start) and np.array_equal(start[0], start[-1])
            at = _nearest(refined.parameters[run], axes, home)
            one = singular_poses(family, refined[run[at : at + 1]])[0]
            result.append(SingularCurve(refined.parameters[run], one.kind, False, closed, one))
    return result


def _reaching(
    curves: list[SingularCurve], late: list[Singularity], spacing: Array
) -> tuple[list[SingularCurve], list[Singularity]]:
    """Curves led on to poses between the grid and the border, and those that no curve leads to."""
    curves = list(curves)
    alone = []
    for one in late:
        here = np.array(list(one.parameters.values()))
        gaps = [
            (float(np.abs((c.points[end] - here) / spacing).max()), k, end)
            for k, c in enumerate(curves)
            if c.kind is one.kind and not c.closed and len(c.points)
            for end in (0, -1)
        ]
        gap, k, end = min(gaps, default=(np.inf, 0, 0))
        if gap > CELL:
            alone.append(one)
            continue
        parts = [curves[k].points, here[None]]
        points = np.concatenate(parts if end else parts[::-1])
        curves[k] = replace(curves[k], points=points)
    return curves, alone


def _border(
    family: PoseFamily,
    mask: NDArray[np.bool_],
    ends: ReachEnds,
    rim: Indices,
    axes: tuple[Array, Array],
    home: Array,
) -> list[SingularCurve]:
    """The border of reach within the plane, from its ends on the edges `rim`, (e, 2)."""
    result = []
    found = end_kinds(family, ends)
    number = {(int(a), int(b)): i for i, (a, b) in enumerate(np.sort(rim, axis=1))}
    for start, end in sign_lines(np.where(mask, 1.0, -1.0)):
        flat = np.stack([k[:, 0] * mask.shape[1] + k[:, 1] for k in (start, end)], axis=1)
        which = np.array([number[int(a), int(b)] for a, b in np.sort(flat, axis=1)])
        for run in runs([found[i].value for i in which]):
            own = which[run]
            points = ends.parameters[own]
            closed = len(run) == len(start) and np.array_equal(start[0], start[-1])
            at = own[_nearest(points, axes, home)]
            one = singular_pose(
                family,
                ends.parameters[at],
                found[at],
                ends.placement[at : at + 1],
                ends.reasons[at],
            )
            result.append(SingularCurve(points, found[at], True, closed, one))
    return result


def _nearest(points: Array, axes: tuple[Array, Array], home: Array) -> int:
    span = np.array([np.ptp(axes[0]), np.ptp(axes[1])])
    return int(np.linalg.norm((points - home) / span, axis=1).argmin())


def _far(one: Singularity, home: Array, spacing: Array) -> float:
    return float(np.linalg.norm((np.array(list(one.parameters.values())) - home) / spacing))


def _apart(
    found: list[Singularity],
    curves: list[SingularCurve],
    points: list[Singularity],
    axes: tuple[Array, Array],
) -> list[Singularity]:
    """Single poses within the plane that lie on no curve and were not found before."""
    low, high = (np.array([f(a) for a in axes]) for f in (np.min, np.max))
    spacing = (high - low) / [len(a) - 1 for a in axes]
    known = [c.points for c in curves] + [np.array([list(p.parameters.values())]) for p in points]
    result: list[Singularity] = []
    for one in found:
        here = np.array(list(one.parameters.values()))
        inside = np.all((here >= low) & (here <= high))
        if inside and all(
            np.abs((k - here) / spacing).max(axis=1).min() > 1.0 for k in known if len(k)
        ):
            result.append(one)
            known.append(here[None])
    return result
