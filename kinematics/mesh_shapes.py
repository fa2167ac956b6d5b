"""Shapes of bodies as closed triangle meshes, with capsules about them that are quick to ask."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]

#: Triangles of a shape at most: each may be looked at at every pose.
MOST_TRIANGLES = 200_000
#: Of which so many are tried for the least extent.
WIDTHS = 400


@dataclass(frozen=True, eq=False)
class MeshShape:
    """A closed surface that moves with one body of a linkage.

    Parameters
    ----------
    name : str
        Of the part, for messages.
    node : str
        A node of the body that does not slide along it, or any of the ground.
    place : (3,)
        Where that node stands when the body has not turned, m.
    points : (n, 3)
        m, in global axes at that moment.
    triangles : (t, 3) of int
        Counter-clockwise seen from outside; closed, of one body. `strutwork.meshes` reads and
        checks such surfaces.

    Raises
    ------
    ModelError
        No triangles, too many, or points that are not finite or do not exist.
    """

    name: str
    node: str
    place: Array
    points: Array
    triangles: NDArray[np.int64]

    def __post_init__(self) -> None:
        points = np.ascontiguousarray(self.points, dtype=float)
        place = np.asarray(self.place, dtype=float)
        triangles = np.ascontiguousarray(self.triangles, dtype=np.int64)
        object.__setattr__(self, "place", place)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "triangles", triangles)
        shaped = points.ndim == triangles.ndim == 2 and points.shape[1] == triangles.shape[1] == 3
        if not shaped or not len(triangles) or not np.isfinite([*points.ravel(), *place]).all():
            raise ModelError(
                self.name,
                "its shape has no triangles, or points that are not finite.",
                "Give points (n, 3) in m and triangles (t, 3).",
            )
        if triangles.min() < 0 or triangles.max() >= len(points):
            raise ModelError(
                self.name, "its shape names a point that does not exist.", "Export it again."
            )
        if len(triangles) > MOST_TRIANGLES:
            raise ModelError(
                self.name,
                f"its shape has {len(triangles)} triangles; {MOST_TRIANGLES} is the limit.",
                "Export it coarser: interference needs no fillets.",
            )

    def __repr__(self) -> str:
        return f"<MeshShape {self.name}: {len(self.triangles)} triangles, on {self.node}>"

    @cached_property
    def local(self) -> Array:
        """Points from the node, m, (n, 3)."""
        return np.asarray(self.points - self.place)

    @cached_property
    def corners(self) -> Array:
        """Corners of the triangles from the node, (t, 3, 3), m."""
        return np.asarray(self.local[self.triangles])

    @cached_property
    def _principal(self) -> Array:
        """Principal axes of the points as columns, the longest extent first, (3, 3)."""
        used = self.local[np.unique(self.triangles)]
        axes = np.linalg.eigh(np.cov(used.T) + 0.0)[1] if len(used) > 1 else np.eye(3)
        order = np.argsort(-np.ptp(used @ axes, axis=0), kind="stable")
        return np.asarray(axes[:, order])

    @cached_property
    def half(self) -> float:
        """Half of the least extent across a triangle, m: as the radius of a capsule."""
        corners = self.corners[:: -(-len(self.triangles) // WIDTHS)]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(normals, axis=-1, keepdims=True)
        normals = np.unique(np.round(normals / np.where(length > 0.0, length, 1.0), 12), axis=0)
        # a triangle without area has no normal, and no extent across it
        normals = normals[np.abs(normals).max(axis=-1) > 0.0]
        used = self.local[np.unique(self.triangles)]
        return float(0.5 * np.ptp(used @ np.vstack([normals, self._principal.T]).T, axis=0).min())

    @cached_property
    def around(self) -> tuple[Array, float]:
        """Ends from the node (2, 3) and radius of a capsule that holds the shape, lengthwise."""
        used = self.local[np.unique(self.triangles)] @ self._principal
        middle = 0.5 * (used.min(axis=0) + used.max(axis=0))
        aside = np.linalg.norm(used[:, 1:] - middle[1:], axis=1)
        radius = float(aside.max())
        # a point beside the axis needs an end no farther than the ball about it allows
        cap = np.sqrt(np.maximum(radius**2 - aside**2, 0.0))
        ends = np.array([np.min(used[:, 0] + cap), np.max(used[:, 0] - cap)])
        if ends[0] > ends[1]:
            ends[:] = middle[0]
            radius = float(np.linalg.norm(used - middle, axis=1).max())
        local = np.stack([[end, middle[1], middle[2]] for end in ends])
        return local @ self._principal.T, radius
