"""Curves of singular poses in a plane section, and the border of reach there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import contourpy
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import (
    breadth_first_order,
    connected_components,
    minimum_spanning_tree,
)

from strutwork.errors import ModelError
from strutwork.kinematics.lost_motion import Kind, kinds
from strutwork.kinematics.pose_family import Looked, PoseFamily, Progress
from strutwork.kinematics.reach_end import reach_ends
from strutwork.kinematics.singularities import (
    PARTS,
    Singularity,
    end_kinds,
    local_minima,
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

#: Poses of a grid: each takes about a millisecond and, with its rows, 100 kB.
LARGEST = 1_000_000
SECONDS, BYTES = 2e-3, 4e3


@dataclass(frozen=True)
class SingularCurve:
    """A curve of singular poses, or a piece of the border of reach.

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
        Distances of the poses of the grid as in `Distance`; NaN out of reach.
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
        Increasing.
    home : (2,)
        Nearest to what is told first.
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
    number = np.arange(len(parameters)).reshape(shape)
    edges = np.concatenate(
        [
            np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1),
            np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1),
        ]
    )
    inner = edges[looked.reach[edges].all(axis=1)]
    centre = np.asarray(home, dtype=float)
    spacing = np.array([np.ptp(x) / (len(x) - 1), np.ptp(y) / (len(y) - 1)])
    curves: list[SingularCurve] = []
    points: list[Singularity] = []
    senses = edge_senses(looked, inner)
    sense, missed = _one_sense(len(parameters), inner, senses)
    for part in PARTS:
        changed = inner[:0]
        if has_minor(looked.space, part):
            signed = sense * looked.spread(minor(looked.space, part))
            curves += _zero_lines(family, signed.reshape(shape), (x, y), part, centre)
            values = signed[inner]
            changed = inner[values[:, 0] * values[:, 1] < 0.0]
        low = local_minima(looked, inner, changed, part)
        if low.size:
            refined = refine_least(family, parameters[low], spacing, part)
            points += _apart(singular_poses(family, refined), curves, points, (x, y))
    curves += _border(family, looked, (x, y), centre)
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
            f"has {count:,} poses, more than the {LARGEST:,} that are taken: about "
            f"{SECONDS * count / 60:.0f} minutes and {BYTES * count / 1e9:.1f} GB.",
            "Take fewer steps: curves are refined whatever the grid.",
        )
    return x, y


def _zero_lines(
    family: PoseFamily, signed: Array, axes: tuple[Array, Array], part: Part, home: Array
) -> list[SingularCurve]:
    """Lines on which a minor, (n, m) with NaN out of reach, is zero."""
    result = []
    for start, end in _outlines(signed):
        a, b = _at(axes, start), _at(axes, end)
        refined = refine_zeros(family, a, b, part)
        found = kinds(refined.space)
        # a curve may meet another kind at a point and change its own there
        for run in _runs([None if k is None else k.value for k in found]):
            closed = len(run) == len(start) and np.array_equal(start[0], start[-1])
            at = _nearest(refined.parameters[run], axes, home)
            one = singular_poses(family, refined[run[at : at + 1]])[0]
            result.append(
                SingularCurve(refined.parameters[run], one.kind, False, closed, one)
            )
    return result


def _border(
    family: PoseFamily, looked: Looked, axes: tuple[Array, Array], home: Array
) -> list[SingularCurve]:
    """The border of reach within the plane."""
    mask = looked.reach.reshape(len(axes[0]), len(axes[1]))
    result = []
    for start, end in _outlines(np.where(mask, 1.0, -1.0)):
        inside = mask[start[:, 0], start[:, 1], None]
        a, b = np.where(inside, start, end), np.where(inside, end, start)
        ends = reach_ends(family, _at(axes, a), _at(axes, b))
        found = end_kinds(family, ends)
        for run in _runs([k.value for k in found]):
            points = ends.parameters[run]
            closed = len(run) == len(start) and np.array_equal(start[0], start[-1])
            at = run[_nearest(points, axes, home)]
            one = singular_pose(
                family,
                ends.parameters[at],
                found[at],
                ends.placement[at : at + 1],
                ends.reasons[at],
            )
            result.append(SingularCurve(points, found[at], True, closed, one))
    return result


def _outlines(field: Array) -> list[tuple[Indices, Indices]]:
    """Edges of a grid that the lines between signs cross, in their order, (v, 2) each."""
    known = np.isfinite(field)
    # by its signs alone, so that every vertex is the middle of its edge and tells which it is
    signs = np.where(np.where(known, field, 1.0) >= 0.0, 1.0, -1.0)
    lines = contourpy.contour_generator(z=np.ma.array(signs.T, mask=~known.T)).lines(0.0)
    result = []
    for line in lines:
        middle = np.asarray(line)
        low = np.floor(middle + 0.25).astype(np.intp)
        result.append((low, low + (middle - low > 0.25)))
    return result


def _at(axes: tuple[Array, Array], index: Indices) -> Array:
    return np.stack([axes[0][index[:, 0]], axes[1][index[:, 1]]], axis=1)


def _runs(names: list[str | None]) -> list[Indices]:
    """Neighbours of one name, those without left out."""
    cuts = [0, *(k for k in range(1, len(names)) if names[k] != names[k - 1]), len(names)]
    return [np.arange(a, b) for a, b in pairwise(cuts) if b > a and names[a] is not None]


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
    known = [c.points for c in curves] + [
        np.array([list(p.parameters.values())]) for p in points
    ]
    result: list[Singularity] = []
    for one in found:
        here = np.array(list(one.parameters.values()))
        inside = np.all((here >= low) & (here <= high))
        if inside and all(np.abs((k - here) / spacing).max(axis=1).min() > 1.0 for k in known if len(k)):
            result.append(one)
            known.append(here[None])
    return result


def _one_sense(count: int, edges: Indices, senses: Array) -> tuple[Array, int]:
    """Sense of every pose's basis against the first of its region, ±1, and edges that disagree.

    It is handed on between poses whose spaces are nearest to each other.
    """
    sense = np.ones(count)
    if not len(edges):
        return sense, 0
    apart = 2.0 - np.abs(senses)
    graph = coo_array((apart, edges.T), shape=(count, count)).tocsr()
    tree = minimum_spanning_tree(graph)
    regions, label = connected_components(tree, directed=False)
    first = np.unique(label, return_index=True)[1]
    before = np.arange(count)
    for start in first[np.bincount(label, minlength=regions) > 1]:
        order, found = breadth_first_order(tree, start, directed=False)
        before[order[1:]] = found[order[1:]]
    both = np.concatenate([edges, edges[:, ::-1]])
    key = both[:, 0] * count + both[:, 1]
    order = np.argsort(key)
    at = np.flatnonzero(before != np.arange(count))
    place = order[np.searchsorted(key[order], before[at] * count + at)]
    sign = np.where(senses < 0.0, -1.0, 1.0)
    sense[at] = np.tile(sign, 2)[place]
    sense = _gathered(sense, before)
    agree = sense[edges[:, 0]] * sense[edges[:, 1]] * sign
    return sense, int(np.count_nonzero(agree < 0.0))


def _gathered(sense: Array, before: Indices) -> Array:
    """Product of signs from each pose back to its region's first, which has 1."""
    while True:
        further = before[before]
        if np.array_equal(further, before):
            return sense
        sense, before = sense * sense[before], further
