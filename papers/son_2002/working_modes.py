"""The eight working modes of the MIT-SS-1, and where the drives hold the housing in each."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.machines import MitSS1
from strutwork.machines.mit_ss1 import NOMINAL_TILT, NOMINAL_X

Array = NDArray[Any]

#: Signs of the struts' roots in eqs 43 to 45, the machine's own mode first: +1 is a block above
#: its joint on the housing, −1 one below.
SIGNS = np.array(list(product((1.0, -1.0), repeat=3)))


def working_modes(
    machine: MitSS1 | None = None, x: ArrayLike | None = None, b: ArrayLike | None = None
) -> xr.Dataset:
    """Drives and determinant of the struts' rows in every mode, over x and tilt, at height zero.

    A strut reaches in both of its ways or in none: all modes have the same workspace. They meet
    only where a strut lies flat.

    Parameters
    ----------
    machine : MitSS1, optional
    x, b : (n,), (m,), optional
        m and rad; default the nominal workspace.

    Returns
    -------
    Dataset
        drive (mode, x, b, block), m; determinant (mode, x, b), m, zero where the drives do not
        hold the housing; sign (mode, block). Not a number out of reach.
    """
    machine = machine or MitSS1()
    along = np.linspace(*NOMINAL_X, 101) if x is None else np.asarray(x, dtype=float)
    tilts = (
        np.linspace(-NOMINAL_TILT, NOMINAL_TILT, 61) if b is None else np.asarray(b, dtype=float)
    )
    at, tilt = (a[..., None] for a in np.meshgrid(along, tilts, indexing="ij"))
    seat_x, seat_z = machine.seats[:, 0], machine.seats[:, 2]
    # joints on the housing from the tool tip, turned by b about y
    q_x = seat_x * np.cos(tilt) + seat_z * np.sin(tilt)
    q_z = -seat_x * np.sin(tilt) + seat_z * np.cos(tilt)
    lengths = np.asarray(machine.strut_lengths)
    u_x = (machine.rails - at - q_x) / lengths
    # a strut that lies flat still reaches; beyond that no root is real
    u_z = SIGNS[:, None, None] * np.sqrt(np.where(np.abs(u_x) <= 1.0, 1.0 - u_x * u_x, np.nan))
    # the housing stands only where all three struts reach
    u_z = np.where(np.isnan(u_z).any(axis=-1, keepdims=True), np.nan, u_z)
    rows = np.stack([np.broadcast_to(u_x, u_z.shape), u_z, u_x * q_z - u_z * q_x], axis=-1)
    determinant = np.full(rows.shape[:-2], np.nan)
    good = np.isfinite(rows).all(axis=(-2, -1))
    determinant[good] = np.linalg.det(rows[good])
    return xr.Dataset(
        {
            "drive": (("mode", "x", "b", "block"), q_z + lengths * u_z, {"units": "m"}),
            "determinant": (("mode", "x", "b"), determinant, {"units": "m"}),
            "sign": (("mode", "block"), SIGNS, {"units": "1"}),
        },
        coords={
            "mode": [mode_name(signs) for signs in SIGNS],
            "x": ("x", along, {"units": "m"}),
            "b": ("b", tilts, {"units": "rad"}),
            "block": [1, 2, 3],
        },
    )


def mode_name(signs: ArrayLike) -> str:
    """Signs of a mode as "++−"."""
    return "".join("+" if s > 0 else "−" for s in np.ravel(signs))


def free_modes(found: xr.Dataset) -> NDArray[np.bool_]:
    """Which modes of `working_modes` keep one sign of the determinant where they reach, (8,)."""
    values = found["determinant"].to_numpy().reshape(len(found["mode"]), -1)
    low, high = np.nanmin(values, axis=-1), np.nanmax(values, axis=-1)
    return np.asarray(low * high > 0.0)
