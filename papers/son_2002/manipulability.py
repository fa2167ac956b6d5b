"""Velocity ellipsoids of the Hexel hexapod over x and tilt, beside section 2.2 of Son 2002."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import jacobians, velocity_ellipsoid
from strutwork.machines import HexelHexapod
from strutwork.machines.hexel_hexapod import LEVEL, REACH, TILT
from strutwork.papers.published_rows import PublishedRow
from strutwork.papers.son_2002.published import MANIPULABILITY
from strutwork.studies.description import attributes
from strutwork.studies.variables import named

Array = NDArray[Any]

#: Row of the hexapod in the published table.
ROW = "hexapod"

#: The two ellipsoids, with their columns of the inverse Jacobian and the unit of a semi-axis.
PARTS = {"position": (slice(0, 3), "1"), "rotation": (slice(3, 6), "rad/m")}

#: What is read of an ellipsoid, by the thesis's words.
MEASURES = {"condition number": "condition", "smallest axis": "smallest", "volume": "volume"}

IDENTITY = "six legs of unit direction: the inverse squares of the semi-axes add to six"
READ = (
    "from the dimensions of Appendix A, whose drawing is missing: of many ways to read how the "
    "joints stand and how far the table reaches, that was chosen which meets the condition numbers "
    "of section 2.2; the other numbers hang on the same choice"
)


def hexapod_manipulability(
    machine: HexelHexapod | None = None,
    x: ArrayLike | None = None,
    a: ArrayLike | None = None,
    z: float = LEVEL,
) -> xr.Dataset:
    """Semi-axes of the velocity ellipsoids of position and of rotation, the other held.

    Parameters
    ----------
    machine : HexelHexapod, optional
    x, a : (n,), (m,), optional
        m and rad; default ±0.1 m and ±35°.
    z : float
        Height of the tool tip, m.

    Returns
    -------
    xarray.Dataset
        For each of "position" and "rotation": semi_axes (x, a, semi_axis), largest first, tool
        velocity per unit rate of the legs; condition, smallest, volume (x, a). Not a number
        out of reach.
    """
    machine = machine or HexelHexapod()
    along = np.linspace(-REACH, REACH, 21) if x is None else np.asarray(x, dtype=float)
    tilts = np.linspace(-TILT, TILT, 29) if a is None else np.asarray(a, dtype=float)
    grid = np.meshgrid(along, tilts, indexing="ij")
    placement = machine.place(machine.poses(grid[0], grid[1], z))
    good = placement.reachable
    inverse = jacobians(machine.linkage, placement[good]).inverse
    variables = {}
    for part, (columns, unit) in PARTS.items():
        ellipsoid = velocity_ellipsoid(inverse[..., columns])
        axes = np.full((*grid[0].shape, 3), np.nan)
        axes[good] = ellipsoid.semi_axes
        variables[f"{part}_semi_axes"] = named(
            ("x", "a", "semi_axis"), axes, unit, f"semi-axes of the {part} ellipsoid"
        )
        for words, name in MEASURES.items():
            values = np.full(grid[0].shape, np.nan)
            values[good] = getattr(ellipsoid, name)
            power = {"condition": "1", "smallest": unit, "volume": _cubed(unit)}[name]
            variables[f"{part}_{name}"] = named(("x", "a"), values, power, f"{part} {words}")
    return xr.Dataset(
        variables,
        coords={
            "x": ("x", along, {"units": "m", "long_name": "tool tip along x"}),
            "a": ("a", tilts, {"units": "rad", "long_name": "tilt about x"}),
            "semi_axis": ["largest", "middle", "smallest"],
        },
        attrs=attributes("manipulability", machine) | {"z": z},
    )


def manipulability_rows(found: xr.Dataset) -> tuple[PublishedRow, ...]:
    """The hexapod's rows of the published table beside the computed values.

    Parameters
    ----------
    found : xarray.Dataset
        Of `hexapod_manipulability` over the default places.
    """
    rows = []
    for v in MANIPULABILITY:
        if v.row != ROW:
            continue
        quantity, end = v.quantity.rsplit(", ", 1)
        part, words = quantity.split(" ", 1)
        values = found[f"{part}_{MEASURES[words]}"]
        ours = float(values.min() if end == "least" else values.max())
        note = f"{READ}; {IDENTITY}" if part == "position" else READ
        rows.append(
            PublishedRow(
                f"{v.row}",
                v.quantity,
                v.unit,
                v.value,
                ours,
                "calibrated",
                note,
            )
        )
    return tuple(rows)


def _cubed(unit: str) -> str:
    return unit if unit == "1" else "rad^3/m^3"
