"""Distances of moving meshes from one another and from capsules, by FCL.

FCL, the Flexible Collision Library (Pan, Chitta and Manocha 2012), is the extra `interference`:
its trees of boxes are built once per shape, and one call per pose asks two of them. Before that,
capsules about the shapes show which poses are near at all, all poses together.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.mesh_overlap import (
    crossing_depth,
    hull_depth,
    inside,
    share_space,
)
from strutwork.kinematics.mesh_shapes import MeshShape
from strutwork.kinematics.segments import segment_distances

Array = NDArray[Any]

#: Pairs of crossing triangles that are measured at a pose.
MOST_PAIRS = 500
#: A share of the thinner shape: meshes that cross less deep touch.
TOUCH = 1e-9


@dataclass(frozen=True)
class PlacedPart:
    """A capsule, or a mesh with the capsule about it, at a batch of poses.

    Parameters
    ----------
    ends : (p, 2, 3)
        Of the capsule's axis, m.
    radius : float
        Of the capsule, m.
    shape : MeshShape or None
    origin, rotation : (p, 3) and (p, 3, 3)
        Where the mesh's points are counted from, and its body's rotation.
    """

    ends: Array
    radius: float
    shape: MeshShape | None = None
    origin: Array | None = None
    rotation: Array | None = None

    def __getitem__(self, index: Any) -> PlacedPart:
        """Some of the poses."""
        return PlacedPart(
            self.ends[index],
            self.radius,
            self.shape,
            None if self.origin is None else self.origin[index],
            None if self.rotation is None else self.rotation[index],
        )


def require_fcl() -> Any:
    """The collision library.

    Raises
    ------
    ModelError
        It is not installed.
    """
    try:
        import fcl  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise ModelError(
            "interference",
            "of meshes needs python-fcl, which is not installed.",
            "Install the extra: pip install strutwork[interference].",
        ) from error
    return fcl


class MeshGaps:
    """Gaps between parts of which one at least is a mesh; keeps the trees of the meshes."""

    def __init__(self) -> None:
        self.fcl = require_fcl()
        self._trees: dict[int, tuple[MeshShape, Any]] = {}
        self._request = self.fcl.DistanceRequest(enable_nearest_points=False)
        self._contacts = self.fcl.CollisionRequest(num_max_contacts=MOST_PAIRS, enable_contact=True)

    def gaps(self, first: PlacedPart, second: PlacedPart, within: float) -> Array:
        """Gap of two parts at poses, m, negative where they overlap, (p,).

        Where it is not below `within`, a distance that it has at least.

        Parameters
        ----------
        first, second : PlacedPart
            At the same p poses; one of them at least is a mesh.
        within : float
            Gap from which on its exact value is not asked for, m.
        """
        found = segment_distances(first.ends, second.ends) - first.radius - second.radius
        near = np.flatnonzero(found < within)
        if len(near):
            one, other = (second, first) if first.shape is None else (first, second)
            found[near] = self._exact(one[near], other[near])
        return np.asarray(found)

    def _exact(self, first: PlacedPart, second: PlacedPart) -> Array:
        """The gaps themselves; the first part is a mesh."""
        shape, other = first.shape, second.shape
        assert shape is not None  # noqa: S101 - as asked for
        assert first.origin is not None  # noqa: S101
        assert first.rotation is not None  # noqa: S101
        back = np.swapaxes(first.rotation, -1, -2)
        if other is None:
            start = _turned(back, second.ends[:, 0] - first.origin)
            along = _turned(back, second.ends[:, 1] - second.ends[:, 0])
            turn, points, thickness = _towards(along), start, second.radius
            apart = self._segment_distances(shape, along, turn, start)
        else:
            assert second.origin is not None  # noqa: S101 - a mesh has both
            assert second.rotation is not None  # noqa: S101
            start = _turned(back, second.origin - first.origin)
            turn = back @ second.rotation
            points, thickness = start + turn @ other.corners[0, 0], 2.0 * other.half
            apart = self._distances(self._tree(shape), self._tree(other), turn, start)
        less = second.radius if other is None else 0.0
        found = apart - less
        meet = np.zeros(len(apart), dtype=bool)
        if other is not None:
            # faces in one plane are apart by their rounding
            meet = apart <= TOUCH * min(shape.half, other.half)
            for i in np.flatnonzero(meet):
                found[i] = -self._depth(shape, other, turn[i], start[i])
        free = np.flatnonzero(~meet & (apart > 0.0))
        held = free[inside(points[free], shape.corners)]
        found[held] = -apart[held] - thickness
        if other is not None:
            mine = _turned(np.swapaxes(turn, -1, -2), shape.corners[0, 0] - start)
            held = free[inside(mine[free], other.corners)]
            found[held] = -apart[held] - 2.0 * shape.half
        return np.asarray(found)

    def _segment_distances(
        self, shape: MeshShape, along: Array, turn: Array, start: Array
    ) -> Array:
        """Of the axes of a capsule, which is as long at every pose of a rigid body."""
        length = np.round(np.linalg.norm(along, axis=-1), 12)
        found = np.empty(len(length))
        for one in np.unique(length):
            some = length == one
            tree = self._segment(float(one))
            found[some] = self._distances(self._tree(shape), tree, turn[some], start[some])
        return found

    def _distances(self, tree: Any, other: Any, turn: Array, start: Array) -> Array:
        fcl, request = self.fcl, self._request
        fixed = fcl.CollisionObject(tree, fcl.Transform())
        moved = fcl.CollisionObject(other, fcl.Transform())
        found = np.empty(len(turn))
        for i, (rotation, place) in enumerate(zip(turn, start, strict=True)):
            moved.setTransform(fcl.Transform(rotation, place))
            found[i] = fcl.distance(fixed, moved, request, fcl.DistanceResult())
        return np.maximum(found, 0.0)

    def _depth(self, first: MeshShape, second: MeshShape, turn: Array, start: Array) -> float:
        """How deep two meshes overlap whose surfaces meet, m; zero where they only touch."""
        fcl, result = self.fcl, self.fcl.CollisionResult()
        moved = fcl.CollisionObject(self._tree(second), fcl.Transform(turn, start))
        fixed = fcl.CollisionObject(self._tree(first), fcl.Transform())
        fcl.collide(fixed, moved, self._contacts, result)
        pairs = np.array([(c.b1, c.b2) for c in result.contacts], dtype=int).reshape(-1, 2)
        other = second.corners @ turn.T + start
        depth = crossing_depth(first.corners[pairs[:, 0]], other[pairs[:, 1]])
        size = min(first.half, second.half)
        if depth <= TOUCH * size:
            overlap = share_space(first.corners, other, size)
            depth = hull_depth(first.corners, other) if overlap else 0.0
        return depth

    def _tree(self, shape: MeshShape) -> Any:
        if id(shape) not in self._trees:
            # the shape is kept with its tree: its id may not be another's
            self._trees[id(shape)] = shape, self._built(shape.local, shape.triangles)
        return self._trees[id(shape)][1]

    def _segment(self, length: float) -> Any:
        """A segment along z, as a triangle without width."""
        points = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, length]])
        return self._built(points, np.array([[0, 1, 1]]))

    def _built(self, points: Array, triangles: Array) -> Any:
        tree = self.fcl.BVHModel()
        tree.beginModel(len(points), len(triangles))
        tree.addSubModel(points, triangles.astype(np.int32))
        tree.endModel()
        return tree


def _turned(rotation: Array, vectors: Array) -> Array:
    return np.asarray((rotation @ vectors[..., None])[..., 0])


def _towards(along: Array) -> Array:
    """Rotations that turn z into directions, (p, 3, 3); none for a direction without length."""
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    z = np.where(length > 0.0, along / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 1.0])
    # across the axis that is farthest from it
    help_axis = np.eye(3)[np.abs(z).argmin(axis=-1)]
    x = np.cross(help_axis, z)
    x = x / np.linalg.norm(x, axis=-1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=-1)
