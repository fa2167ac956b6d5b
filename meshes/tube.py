"""Tubes of hexahedra, with straight or curved edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isfinite, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.grading import lines
from strutwork.meshes.grids import grid
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.order import quadratic
from strutwork.meshes.transform import mapped, merged

Array = NDArray[Any]


def tube(
    inner: float,
    outer: float,
    length: float,
    divisions: Sequence[int],
    *,
    order: int = 1,
    region: str = "tube",
    name: str = "tube",
) -> Mesh:
    """A tube about the z axis, from z = 0 to `length`.

    Parameters
    ----------
    inner, outer : float
        Radii, m.
    length : float
        m.
    divisions : (3,) int
        Cells through the wall, around (at least 3) and along.
    order : int
        1 for eight-node hexahedra, whose section is a polygon of sin(2π/n)/(2π/n) of the
        area of the ring; 2 for hexahedra of 27 nodes on the circles.
    region, name : str
        Name of the region, and of the mesh.

    Returns
    -------
    Mesh
        Patches `inner`, `outer`, `-z`, `+z`.

    Raises
    ------
    ModelError
        Radii that are not 0 < inner < outer, too few cells around, an unknown order.
    """
    if not (isfinite(outer) and 0 < inner < outer):
        raise ModelError(
            f"mesh {name}",
            f"its radii are {inner!r} and {outer!r} m.",
            "Give 0 < inner < outer.",
        )
    radial, around, along = divisions
    if around < 3 or order not in {1, 2}:
        raise ModelError(
            f"mesh {name}",
            f"has {around} cells around, of order {order}.",
            "Give at least 3 cells around, and order 1 or 2.",
        )
    unrolled = grid(
        inner + lines(outer - inner, radial),
        lines(2.0 * pi, around),
        lines(length, along),
        region=region,
        name=name,
    )
    sides = {"inner": "-x", "outer": "+x", "-z": "-z", "+z": "+z"}
    patches = {label: unrolled.patch(side) for label, side in sides.items()}
    unrolled = replace(unrolled, patches=patches)
    return merged(mapped(quadratic(unrolled) if order == 2 else unrolled, _rolled))


def _rolled(points: Array) -> Array:
    r, angle, z = points.T
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)
