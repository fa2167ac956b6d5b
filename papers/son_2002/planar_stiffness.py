"""Planar stiffness of the MIT-SS-1: the thesis's formula (eqs 51 to 53) and the corrected one."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.machines import MitSS1
from strutwork.machines.mit_ss1 import NOMINAL_TILT
from strutwork.papers.son_2002.planar_kinematics import strut_rows
from strutwork.papers.son_2002.published import FIGURE_29_TICK
from strutwork.studies.description import attributes
from strutwork.studies.variables import named

Array = NDArray[Any]

Formula = Literal["corrected", "thesis"]

#: The two formulas in words.
FORMULAS: Mapping[Formula, str] = MappingProxyType(
    {
        "corrected": "corrected: struts stretch along their lines",
        "thesis": "as printed: J⁻ᵀ K J⁻¹ of the struts",
    }
)

#: k_i of a strut with its bearings (eq. 51), N/m. Calibrated: 1/Cxx of the corrected formula is
#: then between 140 and 150 N/µm where Fig. 29-(a) is flat; 150 N/µm is its highest tick.
STRUT_STIFFNESS = 255e6

#: Half the range of x in Fig. 29-(a), m.
REACH = 0.06

#: Half of the range to either side: what "the middle of the workspace" is taken to mean; m, rad.
MIDDLE = (REACH / 2.0, NOMINAL_TILT / 2.0)

#: Corners at which the struts come near an actuator singularity: x in m, b in rad.
CORNERS = ((-REACH, -NOMINAL_TILT), (REACH, NOMINAL_TILT))


def planar_compliance(
    machine: MitSS1,
    x: ArrayLike,
    b: ArrayLike,
    strut_stiffness: ArrayLike = STRUT_STIFFNESS,
    guide_stiffness: float | None = None,
    screw_stiffness: float | None = None,
    formula: Formula = "corrected",
) -> Array:
    """Compliance of the tool tip in the plane, in the order x, z, turn about y.

    With a strut's row a_i (`planar_kinematics.strut_rows`) and the displacement c_i along its line
    for a unit force in it, C = Σ of A⁻¹ diag(c) A⁻ᵀ. The corrected formula has c = 1/k + u_x²/k_tr
    + u_z²/k_screw: K = Σ a aᵀ/c. The thesis adds the displacements of J⁻ᵀ K J⁻¹
    and J_tr⁻ᵀ K_tr J_tr⁻¹ (eqs 52 and 53), whose rows are a/u_z and a/u_x: that is c = u_z²/k +
    u_x²/k_tr, as if the struts' stiffness stood at the drives along z. Its second part is right.

    Parameters
    ----------
    machine : MitSS1
        Its dimensions; its own stiffnesses do not count.
    x, b : (...)
        m and rad; broadcast.
    strut_stiffness : float or (3,)
        k of each strut with its bearings (eq. 51), N/m.
    guide_stiffness, screw_stiffness : float or None
        k_tr of a guide along x and stiffness of a drive along z, N/m; None: rigid. The thesis
        has no drive stiffness, so its formula takes none.
    formula : "corrected" or "thesis"

    Returns
    -------
    (..., 3, 3)
        m/N, 1/N and rad/(N m). Infinite at an actuator singularity, not a number out of reach.

    Raises
    ------
    ModelError
        A stiffness that is not positive, an unknown formula, or a drive stiffness with the
        thesis's.
    """
    k = np.broadcast_to(np.asarray(strut_stiffness, dtype=float), (3,))
    others = [v for v in (guide_stiffness, screw_stiffness) if v is not None]
    if not all(np.isfinite(v) and v > 0 for v in (*k, *others)):
        raise ModelError(
            "planar stiffness", "has a stiffness that is not positive.", "Give N/m, or None."
        )
    if formula not in FORMULAS or (formula == "thesis" and screw_stiffness is not None):
        raise ModelError(
            "planar stiffness",
            f'cannot use the formula "{formula}" here.',
            'Choose "corrected", or "thesis" without a drive stiffness.',
        )
    rows, u = strut_rows(machine, x, b)
    along, across = u[..., 2] ** 2, u[..., 0] ** 2
    c = (along if formula == "thesis" else 1.0) / k
    if guide_stiffness is not None:
        c = c + across / guide_stiffness
    if screw_stiffness is not None:
        c = c + along / screw_stiffness
    # a strut's elongation per unit of tool motion is its row: the inverse maps back
    regular = np.asarray(np.isfinite(rows).all(axis=(-1, -2)))
    safe = np.where(regular[..., None, None], rows, np.eye(3))
    singular = np.asarray(np.linalg.det(safe) == 0.0)
    back = np.linalg.inv(np.where(singular[..., None, None], np.eye(3), safe))
    found = (back * c[..., None, :]) @ np.swapaxes(back, -1, -2)
    found = np.where(singular[..., None, None], np.inf, found)
    return np.where(regular[..., None, None], found, np.nan)


def planar_stiffness_map(
    machine: MitSS1 | None = None,
    x: ArrayLike | None = None,
    b: ArrayLike | None = None,
    strut_stiffness: float = STRUT_STIFFNESS,
    guide_stiffness: float | None = None,
) -> xr.Dataset:
    """Stiffness of the tool tip over x and tilt by both formulas (Fig. 29-(a)).

    Parameters
    ----------
    machine : MitSS1, optional
    x, b : (n,), (m,), optional
        m and rad; default ±60 mm and ±30° as in Fig. 29-(a).
    strut_stiffness, guide_stiffness
        As in `planar_compliance`.

    Returns
    -------
    xarray.Dataset
        stiffness (formula, x, b, direction), N/m, 1/C_ii with the other directions free to
        follow, and blocked (same), (C⁻¹)_ii; directions x and z. Not a number out of reach.
    """
    machine = machine or MitSS1()
    along = np.linspace(-REACH, REACH, 49) if x is None else np.asarray(x, dtype=float)
    tilts = (
        np.linspace(-NOMINAL_TILT, NOMINAL_TILT, 49) if b is None else np.asarray(b, dtype=float)
    )
    grid = np.meshgrid(along, tilts, indexing="ij")
    compliance = np.stack(
        [
            planar_compliance(
                machine, grid[0], grid[1], strut_stiffness, guide_stiffness, formula=f
            )
            for f in FORMULAS
        ]
    )
    good = np.isfinite(compliance).all(axis=(-1, -2))
    free, blocked = np.full((2, *compliance.shape[:-1]), np.nan)
    free[good] = 1.0 / np.diagonal(compliance[good], axis1=-2, axis2=-1)
    blocked[good] = np.diagonal(np.linalg.inv(compliance[good]), axis1=-2, axis2=-1)
    dims = ("formula", "x", "b", "direction")
    return xr.Dataset(
        {
            "stiffness": named(
                dims, free[..., :2], "N/m", "stiffness, other directions free, 1/C_ii"
            ),
            "blocked": named(
                dims, blocked[..., :2], "N/m", "stiffness, other directions blocked, (C^-1)_ii"
            ),
        },
        coords={
            "formula": list(FORMULAS),
            "x": ("x", along, {"units": "m", "long_name": "tool tip along x"}),
            "b": ("b", tilts, {"units": "rad", "long_name": "tilt about y"}),
            "direction": ["x", "z"],
        },
        attrs=attributes("planar stiffness", machine)
        | {
            "strut_stiffness": strut_stiffness,
            "guide_stiffness": "rigid" if guide_stiffness is None else guide_stiffness,
        },
    )


def map_figures(found: xr.Dataset) -> dict[str, float]:
    """What can be said of Fig. 29-(a) in numbers.

    Parameters
    ----------
    found : xarray.Dataset
        Of `planar_stiffness_map` over the default places, or others that hold home, the
        corners and the middle.

    Returns
    -------
    dict
        Stiffness along x at home, N/m, and that read from the figure; largest over smallest in
        the middle; home over either corner; the thesis's formula over the corrected one at
        home and at the lower left corner.
    """
    corrected, thesis = (
        found["stiffness"].sel(formula=f, direction="x") for f in ("corrected", "thesis")
    )

    def at(array: xr.DataArray, x: float, b: float) -> float:
        return float(array.sel(x=x, b=b, method="nearest", tolerance=1e-9))

    middle = corrected.where(
        (np.abs(corrected["x"]) <= MIDDLE[0] + 1e-12)
        & (np.abs(corrected["b"]) <= MIDDLE[1] + 1e-12)
    )
    home = at(corrected, 0.0, 0.0)
    left, right = (at(corrected, *corner) for corner in CORNERS)
    return {
        "home": home,
        "figure 29": FIGURE_29_TICK,
        "largest over smallest in the middle": float(middle.max() / middle.min()),
        "home over lower left": home / left,
        "home over upper right": home / right,
        "thesis over corrected at home": at(thesis, 0.0, 0.0) / home,
        "thesis over corrected at lower left": at(thesis, *CORNERS[0]) / left,
    }
