"""Variables that the datasets of studies share, with their units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free, stiffness_ellipsoid
from strutwork.studies.dataset_units import LabelledUnits, unit_attributes
from strutwork.studies.filters import PoseStatus

Array = NDArray[Any]

AXES = ("x", "y", "z")
WRENCHES = ("fx", "fy", "fz", "mx", "my", "mz")

_STIFFNESS = "N/m for x y z; N m/rad for rx ry rz"


def named(
    dims: str | Sequence[str], values: Array, unit: str | LabelledUnits, name: str, **more: Any
) -> xr.Variable:
    """A variable that says what it is and in which unit.

    Parameters
    ----------
    dims : str or sequence of str
        Names of the dimensions.
    values : (...)
        Along these, in `unit`, which may be any unit.
    unit : str or LabelledUnits
        One unit, or several as in `unit_attributes`.
    name : str
        What it is, for the attribute `long_name`.
    **more : attributes
    """
    return xr.Variable(dims, values, unit_attributes(str(unit)) | {"long_name": name, **more})


def flags(dim: str, status: NDArray[np.int8]) -> xr.Variable:
    """Status codes with their meanings, as the CF conventions write flags.

    Parameters
    ----------
    dim : str
        Dimension of the poses.
    status : (p,)
        Codes of `PoseStatus`.
    """
    return xr.Variable(
        dim,
        status,
        {
            "long_name": "status of the pose",
            "flag_values": np.array([int(s) for s in PoseStatus], dtype=np.int8),
            "flag_meanings": " ".join(s.word for s in PoseStatus),
        },
    )


def stiffness_variables(
    dim: str, compliance: Array, status: NDArray[np.int8]
) -> dict[str, xr.Variable]:
    """Compliance and what follows from it, along a dimension of poses.

    Parameters
    ----------
    dim : str
    compliance : (p, 6, 6)
        m/N, 1/N, rad/(N·m); poses whose status is not good do not matter and come out as NaN.
    status : (p,)

    Returns
    -------
    dict
        status, compliance, stiffness_blocked, stiffness_free, principal_stiffness,
        principal_direction.
    """
    good = np.flatnonzero(status == PoseStatus.GOOD)
    count = len(status)
    blocked, free = np.full((2, count, 6), np.nan)
    values, vectors = np.full((count, 3), np.nan), np.full((count, 3, 3), np.nan)
    # in pieces: a million poses at once would hold several copies of their compliance
    for piece in np.array_split(good, max(1, len(good) // 65536)):
        blocked[piece] = axis_stiffness_blocked(compliance[piece])
        free[piece] = axis_stiffness_free(compliance[piece])
        ellipsoid = stiffness_ellipsoid(compliance[piece], "blocked")
        values[piece], vectors[piece] = ellipsoid.values, ellipsoid.directions
    six = xr.Variable("direction", list(DIRECTIONS))
    return {
        "status": flags(dim, status),
        "compliance": named(
            (dim, "direction", "wrench"),
            compliance,
            "m/N and rad/(N m) on the diagonal blocks; 1/N off them",
            "tool compliance: twist per unit wrench",
        ),
        "stiffness_blocked": named(
            (dim, "direction"),
            blocked,
            _STIFFNESS,
            "stiffness with the other directions blocked, (C^-1)_ii",
        ),
        "stiffness_free": named(
            (dim, "direction"),
            free,
            _STIFFNESS,
            "stiffness with the other directions free to follow, 1/C_ii",
        ),
        "principal_stiffness": named(
            (dim, "principal"),
            values,
            "N/m",
            "principal translational stiffness, rotations blocked, ascending",
        ),
        "principal_direction": named(
            (dim, "axis", "principal"),
            vectors,
            "1",
            "unit vectors of the principal stiffnesses",
        ),
        "direction": six,
        "wrench": xr.Variable("wrench", list(WRENCHES)),
    }
