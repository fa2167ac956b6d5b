"""The serial axes of the MIT-SS-1: a work table that slides along y and turns about x."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]


@dataclass(frozen=True, kw_only=True)
class WorkTable:
    """Closed-form kinematics of the two serial axes (Son 2002, eqs 38, 39, 46, 47).

    The carriage slides along y by θ₄; on it the table turns about an axis along x, at the height
    h₁, by θ₅ = −a. Workpiece coordinates (x_w, y_w, z_w) have their origin on the table, h₂ above
    the axis.

    Parameters
    ----------
    axis_height : float
        h₁, m (Appendix B).
    table_height : float
        h₂, m (Appendix B).
    """

    axis_height: float = 0.1
    table_height: float = 0.1

    def tool_position(self, work: ArrayLike, a: ArrayLike) -> Array:
        """Where the tool tip must stand in the machine's plane, eq. 39.

        Parameters
        ----------
        work : (..., 3)
            Point of the workpiece at the tool tip, m; may carry a complex step.
        a : (...)
            Tilt of the table, rad.

        Returns
        -------
        position : (..., 3)
            (x, 0, z), m, in the axes of `strutwork.machines.MitSS1`.
        """
        w, a = np.asarray(work), np.asarray(a)
        rise = w[..., 2] + self.table_height
        z = -w[..., 1] * np.sin(a) + rise * np.cos(a) + self.axis_height
        x, z = np.broadcast_arrays(w[..., 0], z)
        return np.stack([x, np.zeros_like(x), z], axis=-1)

    def drive_values(self, work: ArrayLike, a: ArrayLike) -> Array:
        """θ₄, m, and θ₅, rad, (..., 2): eqs 46 and 47.

        Parameters
        ----------
        work : (..., 3)
            Point of the workpiece at the tool tip, m; may carry a complex step.
        a : (...)
            Tilt of the table, rad.
        """
        w, a = np.asarray(work), np.asarray(a)
        slide = -w[..., 1] * np.cos(a) - (w[..., 2] + self.table_height) * np.sin(a)
        slide, turn = np.broadcast_arrays(slide, -a)
        return np.stack([slide, turn], axis=-1)

    def work_position(self, tool: ArrayLike, drives: ArrayLike) -> Array:
        """Point of the workpiece at the tool tip, (..., 3), m: the inverse of the other two.

        Parameters
        ----------
        tool : (..., 3)
            Tool tip in the machine's axes, m.
        drives : (..., 2)
            θ₄, m, and θ₅, rad.
        """
        p, d = np.asarray(tool), np.asarray(drives)
        a = -d[..., 1]
        back, rise = p[..., 1] - d[..., 0], p[..., 2] - self.axis_height
        y = back * np.cos(a) - rise * np.sin(a)
        z = back * np.sin(a) + rise * np.cos(a) - self.table_height
        x, y, z = np.broadcast_arrays(p[..., 0], y, z)
        return np.stack([x, y, z], axis=-1)
