"""How far the locked-in misfits may carry the tool, in any direction of space.

The set of the tool's displacements is convex; f(e) = e·mean + Σ h(Gᵀe) is its support function
and the largest displacement its maximum over the sphere. Within a spherical triangle the
displacement lies below the planes of the three corners' supports, which bounds it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.overconstraint.sources import MisfitSources
from strutwork.overconstraint.worst_case import WorstCase

Array = NDArray[Any]

#: Divisions of all triangles at the start, each into four.
STARTS = 2

#: Divisions of those that are left, at most.
STEPS = 24

#: Triangles at a time, of all poses together.
MOST = 1_000_000

#: Numbers of a part of them: memory stays small.
PART = 2**21


@dataclass(frozen=True)
class ToolDeviation:
    """Worst displacement of the tool.

    Parameters
    ----------
    along : (..., 3)
        Largest along x, y and z, to either side, m.
    largest : (...)
        Largest length, reached by `parameters`, m.
    bound : (...)
        No combination exceeds it, m.
    displacement : (..., 3)
        The displacement of that length, m.
    parameters : (..., k)
        The z that causes it, no unit.
    misfits : (..., g)
        The misfits that cause it, in the order of the sources' columns, m and rad.
    """

    along: Array
    largest: Array
    bound: Array
    displacement: Array
    parameters: Array
    misfits: Array

    def __repr__(self) -> str:
        return f"<ToolDeviation: batch {self.largest.shape}, m>"

    def to_dict(self) -> dict[str, Any]:
        """Lists, SI."""
        return {
            "along": self.along.tolist(),
            "largest": self.largest.tolist(),
            "bound": self.bound.tolist(),
            "displacement": self.displacement.tolist(),
            "misfits": self.misfits.tolist(),
        }


def tool_deviation(worst: WorstCase, tolerance: float = 1e-4) -> ToolDeviation:
    """Worst displacement of the tool along the axes and in any direction.

    Parameters
    ----------
    worst : WorstCase
        Whose tolerances and influence count.
    tolerance : float
        Largest gap between bound and value, as a share of the value.

    Returns
    -------
    ToolDeviation

    Raises
    ------
    ModelError
        A linkage without a tool.
    NumericalError
        The bound did not come down to the value.
    """
    sources, found = worst.responses.sources, worst.responses.influence
    if found.linkage.tool is None:
        raise ModelError("tool", "the linkage has none.", "Name a node as the tool.")
    pick = [found.columns.index(c) for c in sources.columns]
    rows = found.tool[..., :3, pick]
    batch = rows.shape[:-2]
    count = int(np.prod(batch, dtype=int))
    gain = (rows @ sources.map).reshape(count, 3, sources.parameters)
    mean = (rows @ sources.mean[..., None]).reshape(count, 3)
    ends = np.broadcast_to(np.concatenate([np.eye(3), -np.eye(3)]), (count, 6, 3))
    along = _reach(sources, gain, mean, ends).reshape(count, 2, 3).max(axis=1)
    z, place, bound = farthest(sources, gain, mean, tolerance)
    largest = np.linalg.norm(place, axis=-1)
    z = z.reshape(*batch, sources.parameters)
    return ToolDeviation(
        along.reshape(*batch, 3),
        largest.reshape(batch),
        bound.reshape(batch),
        place.reshape(*batch, 3),
        z,
        sources.mean + (sources.map @ z[..., None])[..., 0],
    )


def farthest(
    sources: MisfitSources, gain: Array, mean: Array, tolerance: float = 1e-4
) -> tuple[Array, Array, Array]:
    """The farthest that a vector mean + gain z gets from zero.

    Parameters
    ----------
    sources : MisfitSources
        Whose zones z ranges over.
    gain : (p, 3, k)
        m, or any unit.
    mean : (p, 3)
        In the same unit.
    tolerance : float
        Largest gap between bound and value, as a share of the value.

    Returns
    -------
    z : (p, k)
    place : (p, 3)
        The vector there.
    bound : (p,)
        Of its length: no z exceeds it.

    Raises
    ------
    NumericalError
        The bound did not come down to the value.
    """
    direction, bound = _largest(sources, gain, mean, tolerance)
    z, place = _point(sources, gain, mean, direction)
    largest = np.linalg.norm(place, axis=-1)
    bound = np.maximum(bound, largest)
    if np.any(bound > largest * (1 + tolerance) * (1 + 1e-9)):
        raise NumericalError(
            "tool deviation",
            "its bound exceeds its value by more than the tolerance.",
            "Request a larger tolerance.",
        )
    return z, place, bound


def _reach(sources: MisfitSources, gain: Array, mean: Array, directions: Array) -> Array:
    """Values of f at directions (p, a, 3), (p, a)."""
    supports = sources.supports(directions @ gain).sum(axis=-1)
    return np.asarray((directions @ mean[..., None])[..., 0] + supports)


def _point(
    sources: MisfitSources, gain: Array, mean: Array, direction: Array
) -> tuple[Array, Array]:
    """The z that is farthest along directions (p, 3), and where it brings the tool."""
    z = sources.extreme((direction[:, None] @ gain)[:, 0])
    return z, mean + (gain @ z[..., None])[..., 0]


def _largest(
    sources: MisfitSources, gain: Array, mean: Array, tolerance: float
) -> tuple[Array, Array]:
    """Branch and bound over triangles of the sphere: direction (p, 3) and bound (p,)."""
    count = len(gain)
    shape = _sphere()
    owner = np.repeat(np.arange(count), len(shape))
    triangles = np.tile(shape, (count, 1, 1))
    best, direction = np.zeros(count), np.tile([1.0, 0.0, 0.0], (count, 1))
    closed = np.zeros(count)
    for _ in range(STEPS):
        part = max(1, PART // (3 * max(gain.shape[-1], 1)))
        f = np.concatenate(
            [
                _reach(sources, gain[which], mean[which], triangles[start : start + part])
                for start in range(0, len(owner), part)
                for which in [owner[start : start + part]]
            ]
        )
        best, direction = _improve((sources, gain, mean), (owner, f, triangles), best, direction)
        upper = _corner(f, triangles)
        done = upper <= best[owner] * (1 + tolerance)
        np.maximum.at(closed, owner[done], upper[done])
        if np.all(done):
            return direction, closed
        owner, triangles = np.tile(owner[~done], 4), _divided(triangles[~done])
        if len(owner) > MOST:
            break
    raise NumericalError(
        "tool deviation",
        f"its bound did not come within {tolerance:g} of the value.",
        "Request a larger tolerance, or use fewer poses at a time.",
    )


def _improve(
    model: tuple[MisfitSources, Array, Array],
    seen: tuple[NDArray[np.intp], Array, Array],
    best: Array,
    direction: Array,
) -> tuple[Array, Array]:
    """Best direction so far of every pose, climbed from: each step turns to the point reached."""
    sources, gain, mean = model
    owner, f, triangles = seen
    value = f.max(axis=1)
    order = np.argsort(value)
    first = np.full(len(best), -1)
    # ascending, so that the largest of a pose is written last
    first[owner[order]] = order
    has = np.flatnonzero(first >= 0)
    chosen = first[has]
    better = has[value[chosen] > best[has]]
    start = first[better]
    direction = direction.copy()
    direction[better] = triangles[start, f[start].argmax(axis=1)]
    for _ in range(20):
        _, place = _point(sources, gain, mean, direction)
        size = np.linalg.norm(place, axis=-1)
        direction = np.where(
            (size > 0)[:, None], place / np.where(size > 0, size, 1.0)[:, None], direction
        )
    reached = np.linalg.norm(_point(sources, gain, mean, direction)[1], axis=-1)
    return np.maximum(best, reached), direction


def _corner(f: Array, triangles: Array) -> Array:
    """Bound of a displacement whose direction lies in a triangle, (m,).

    The point p where the three planes meet bounds it by p·e. That is largest along p, if p is
    in the triangle, else on an edge, where the meeting line of two planes bounds it.
    """
    normals = np.stack(
        [np.cross(triangles[:, i - 2], triangles[:, i - 1]) for i in range(3)], axis=1
    )
    volume = np.einsum("mi,mi->m", triangles[:, 0], normals[:, 0])
    point = np.einsum("mi,mij->mj", f, normals) / volume[:, None]
    # p in the cone of the corners: in front of all three sides
    weights = np.einsum("mij,mj->mi", normals, point) / volume[:, None]
    inside = np.all(weights >= 0, axis=1)
    edges = np.zeros(len(f))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        half = np.linalg.norm(triangles[:, i] - triangles[:, j], axis=-1) / 2
        cosine = 1 - 2 * half**2
        sine = 2 * half * np.sqrt(1 - half**2)
        a, b = f[:, i], f[:, j]
        met = np.hypot(a - b, 2 * np.sqrt(np.abs(a * b)) * half) / sine
        larger = np.maximum(a, b)
        met = np.where(np.minimum(a, b) < larger * cosine, larger, np.maximum(met, larger))
        edges = np.maximum(edges, met)
    return np.where(inside, np.maximum(np.linalg.norm(point, axis=-1), edges), edges)


def _sphere() -> Array:
    """Triangles of a divided icosahedron, corners on the unit sphere, (m, 3, 3)."""
    golden = (1 + np.sqrt(5)) / 2
    corners = np.array(
        [p for a in (-1, 1) for b in (-golden, golden) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    )
    corners /= np.linalg.norm(corners[0])
    near = corners @ corners.T > 0.4
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(i)
        for k in range(j)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    triangles: Array = corners[np.array(faces)]
    for _ in range(STARTS):
        triangles = _divided(triangles)
    return triangles


def _divided(triangles: Array) -> Array:
    """Every triangle in four, by the middles of its edges."""
    a, b, c = (triangles[:, i] for i in range(3))
    ab, bc, ca = (_unit(a + b), _unit(b + c), _unit(c + a))
    parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector, axis=-1, keepdims=True))
