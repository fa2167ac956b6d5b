"""Kinematics of the MIT-SS-1 over its plane: drives, condition number, singular tilts."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from strutwork.errors import ModelError
from strutwork.kinematics import jacobians, velocity_ellipsoid
from strutwork.kinematics.mechanism import drive_values
from strutwork.machines import MitSS1
from strutwork.machines.mit_ss1 import NOMINAL_TILT, NOMINAL_X
from strutwork.machines.mit_ss1_parts import STRUTS, TOOL, strut

Array = NDArray[Any]

#: Columns of the inverse Jacobian that the plane has: x, z, turn about y.
PLANE = (0, 2, 4)

#: Positions along x at which the thesis's workspace is searched for singular tilts, m.
SINGULAR_X = (-0.06, -0.03, 0.0, 0.04)

#: Largest tilt of the search, rad.
STEEPEST = np.radians(80.0)


def planar_kinematics(
    machine: MitSS1 | None = None, x: ArrayLike | None = None, b: ArrayLike | None = None
) -> xr.Dataset:
    """Drive coordinates and ellipsoid of velocities over x and tilt, at height zero.

    The ellipsoid is that of the tool's velocity along x, y and z, tilts held:
    the three struts move x and z, the table's carriage y, one to one (Son 2002, section 6.4).

    Parameters
    ----------
    machine : MitSS1, optional
    x, b : (n,), (m,), optional
        m and rad; default the nominal workspace.

    Returns
    -------
    Dataset
        drive (x, b, block) in m; condition, smallest axis and volume of the ellipsoid for unit
        rates of the drives (x, b), as in Fig. 34; determinant (x, b) of the parallel matrix,
        m; not a number out of reach.
    """
    machine = machine or MitSS1()
    along = np.linspace(*NOMINAL_X, 21) if x is None else np.asarray(x, dtype=float)
    tilts = (
        np.linspace(-NOMINAL_TILT, NOMINAL_TILT, 25) if b is None else np.asarray(b, dtype=float)
    )
    grid = np.meshgrid(along, tilts, indexing="ij")
    placement = machine.place(machine.poses(grid[0], 0.0, grid[1]))
    good = placement.reachable
    if not np.any(good):
        raise ModelError(
            "planar kinematics", "no pose can be reached.", "Choose other x and tilts."
        )
    inverse = jacobians(machine.linkage, placement[good]).inverse
    matrix = np.zeros((len(inverse), 4, 3))
    matrix[:, :3, [0, 2]] = inverse[:, :, [0, 2]]
    matrix[:, 3, 1] = 1.0
    ellipsoid = velocity_ellipsoid(matrix)
    measures = {}
    for name in ("condition", "smallest", "volume"):
        values = np.full(grid[0].shape, np.nan)
        values[good] = getattr(ellipsoid, name)
        measures[name] = (("x", "b"), values, {"units": "1"})
    drives = np.where(good[..., None], drive_values(machine, placement), np.nan)
    return xr.Dataset(
        {
            "drive": (("x", "b", "block"), drives, {"units": "m"}),
            **measures,
            "determinant": (
                ("x", "b"),
                parallel_determinant(machine, grid[0], grid[1]),
                {"units": "m"},
            ),
        },
        coords={
            "x": ("x", along, {"units": "m"}),
            "b": ("b", tilts, {"units": "rad"}),
            "block": [1, 2, 3],
        },
    )


def strut_rows(machine: MitSS1, x: ArrayLike, b: ArrayLike) -> tuple[Array, Array]:
    """Rows a = (u_x, u_z, u_x q_z − u_z q_x) of the struts at height zero, and u itself.

    u is a strut's unit vector from the housing to the block, q its joint from the tool tip: a
    force f along the strut acts on the tool tip as f a, along x, z and about y.

    Parameters
    ----------
    machine : MitSS1
    x, b : (...)
        m and rad; broadcast.

    Returns
    -------
    rows : (..., 3, 3)
        A row a strut; the last column in m. Not a number out of reach.
    directions : (..., 3, 3)
        u in x, y, z.
    """
    x, b = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(b, dtype=float))
    placement = machine.place(machine.poses(x, 0.0, b))
    good = placement.reachable
    at = placement.positions[good]
    index = machine.linkage.node_index
    lower, upper = (
        at[..., [index[strut(i, end, "end")] for i in STRUTS], :] for end in ("housing", "block")
    )
    u = upper - lower
    u = u / np.linalg.norm(u, axis=-1, keepdims=True)
    q = lower - at[..., [index[TOOL]], :]
    a = np.stack([u[..., 0], u[..., 2], u[..., 0] * q[..., 2] - u[..., 2] * q[..., 0]], axis=-1)
    rows, directions = (np.full((*x.shape, 3, 3), np.nan) for _ in range(2))
    rows[good], directions[good] = a, u
    return rows, directions


def parallel_determinant(machine: MitSS1, x: ArrayLike, b: ArrayLike) -> Array:
    """Determinant of `strut_rows`, (...), m.

    It is zero where the three strut lines meet in a point or are parallel; not a number out of
    reach.
    """
    rows, _ = strut_rows(machine, x, b)
    good = np.isfinite(rows).all(axis=(-2, -1))
    found = np.full(good.shape, np.nan)
    found[good] = np.linalg.det(rows[good])
    return found


def singular_tilt(machine: MitSS1, x: float) -> float | None:
    """Tilt nearest to upright at which the three struts cannot hold the housing, rad.

    Parameters
    ----------
    machine : MitSS1
    x : float
        m.

    Returns
    -------
    float or None
        None where there is none within the search.
    """
    tilts = np.linspace(-STEEPEST, STEEPEST, 641)
    values = parallel_determinant(machine, x, tilts)
    found = [
        float(
            brentq(
                lambda b: float(parallel_determinant(machine, x, b)),
                tilts[i],
                tilts[i + 1],
                xtol=1e-14,
            )
        )
        for i in np.flatnonzero(values[:-1] * values[1:] < 0)
    ]
    return min(found, key=abs, default=None)
