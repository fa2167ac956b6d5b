"""All five drives of the MIT-SS-1 from a point of the workpiece and the surface's normal."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import Poses, angle, drive_values, rotation_y
from strutwork.kinematics.drive_fields import FormulaField
from strutwork.machines import MitSS1, WorkTable

Array = NDArray[Any]

#: The drives in the order of the thesis: three blocks, the table's slide and its turn.
DRIVES = ("block 1", "block 2", "block 3", "slide", "turn")

#: Of the derivatives by complex steps: so small that its square is lost.
STEP = 1e-150


def tilts(normal: ArrayLike) -> tuple[Array, Array]:
    """Tilts a and b of the tool against the workpiece that lay it along a normal.

    The table, turned by −a, brings the normal into the struts' plane, the housing meets it there.

    Parameters
    ----------
    normal : (..., 3)
        Of any length, in the workpiece's axes; may carry a complex step.

    Returns
    -------
    a, b : (...)
        rad, b within ±90°.
    """
    n = np.asarray(normal)
    a = -angle(n[..., 1], n[..., 2])
    b = angle(n[..., 0], np.sqrt(n[..., 1] ** 2 + n[..., 2] ** 2))
    return a, b


def five_axes(
    work: ArrayLike,
    normal: ArrayLike,
    machine: MitSS1 | None = None,
    table: WorkTable | None = None,
) -> Array:
    """Inverse kinematics of the entire machine, Son 2002, eqs 43 to 47, batch first.

    Parameters
    ----------
    work : (..., 3)
        Point of the workpiece at the tool tip, m; broadcasts with the normal.
    normal : (..., 3)
        Direction of the tool from its tip upwards, in the workpiece's axes, of any length. Both
        may carry a complex step.
    machine, table : optional

    Returns
    -------
    drives : (..., 5)
        θ₁ to θ₄, m, and θ₅, rad, as `DRIVES`; not a number where a strut does not reach.
    """
    machine, table = machine or MitSS1(), table or WorkTable()
    work, normal = np.broadcast_arrays(work, normal)
    a, b = tilts(normal)
    placement = machine.place(Poses(table.tool_position(work, a), rotation_y(b)))
    good = placement.reachable[..., None]
    struts = np.where(good, drive_values(machine, placement), np.nan)
    carried = np.where(good, table.drive_values(work, a), np.nan)
    return np.concatenate([struts, carried], axis=-1)


def five_axes_field(
    surface: Callable[[Array], tuple[Array, Array]],
    machine: MitSS1 | None = None,
    table: WorkTable | None = None,
) -> FormulaField:
    """The drives over a surface with the tool along its normal, for `kinematics.reversals`.

    Parameters
    ----------
    surface : callable
        Points (m, 2) of the two parameters, complex, to points of the workpiece and normals,
        (m, 3) each, analytic in them.
    machine, table : optional

    Returns
    -------
    FormulaField
        Gradients by complex steps (Squire and Trapp 1998), to rounding.
    """

    def gradient(points: Array) -> Array:
        steps = [five_axes(*surface(points + 1j * STEP * way), machine, table) for way in np.eye(2)]
        # out of reach the real part alone is no number
        return np.stack([np.where(np.isnan(s.real), np.nan, s.imag / STEP) for s in steps], axis=-1)

    return FormulaField(DRIVES, gradient)
