"""Points seen from the axis of a circular guide."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import angle
from strutwork.kinematics.frames import frame, vector

Array = NDArray[Any]


@dataclass(frozen=True)
class Radial:
    """Joint centres on the platform in the cylindrical coordinates of the guide.

    Parameters
    ----------
    points : (..., 3, 3)
        One for each leg, m.
    radius, angle, height : (..., 3)
        m, rad, m.
    outward, tangent : (..., 3, 3)
        Unit vectors; the third axis is the global z.
    on_axis : (..., 3) of bool
        Where the point lies on the guide's axis and its angle means nothing.
    """

    points: Array
    radius: Array
    angle: Array
    height: Array
    outward: Array
    tangent: Array
    on_axis: NDArray[np.bool_]

    @classmethod
    def of(cls, points: Array) -> Radial:
        """Cylindrical coordinates of points.

        Parameters
        ----------
        points : (..., 3, 3)
            One for each leg, m.
        """
        x, y, z = points[..., 0], points[..., 1], points[..., 2]
        square = x * x + y * y
        on_axis = np.asarray(square.real < 1e-18)
        radius = np.sqrt(np.where(on_axis, 1.0, square))
        cosine = np.where(on_axis, 1.0, x) / radius
        sine = np.where(on_axis, 0.0, y) / radius
        outward = vector(cosine, sine, 0.0)
        tangent = vector(-sine, cosine, 0.0)
        turn = angle(np.where(on_axis, 0.0, y), np.where(on_axis, 1.0, x))
        return cls(points, np.where(on_axis, 0.0, radius), turn, z, outward, tangent, on_axis)

    @property
    def up(self) -> Array:
        """The global z axis, (..., 3, 3)."""
        return np.broadcast_to(np.array([0.0, 0.0, 1.0]), self.outward.shape)

    @property
    def guide_frame(self) -> Array:
        """Axes outward, tangent, up as columns, (..., 3, 3, 3)."""
        return frame(self.outward, self.tangent, self.up)

    @property
    def hinge_frame(self) -> Array:
        """Axes outward, down, tangent as columns, (..., 3, 3, 3).

        A positive turn about z lifts a link that points inward.
        """
        return frame(self.outward, -self.up, self.tangent)

    def at(self, radius: Array | float, height: Array | float) -> Array:
        """Points in the legs' planes, (..., 3, 3), m.

        Parameters
        ----------
        radius, height : (..., 3) or float
            m.
        """
        r, h = np.broadcast_arrays(radius, height)
        # the third coordinate of outward is zero, that of up one
        return vector(r * self.outward[..., 0], r * self.outward[..., 1], h)
