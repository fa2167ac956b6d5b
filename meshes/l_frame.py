"""The L-shaped frame of a machine: a base and a vertical plate at its back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from math import isfinite

import numpy as np

from strutwork.errors import ModelError
from strutwork.meshes.grading import lines_through
from strutwork.meshes.grids import grid
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.selection import Box, in_box, patches


def l_frame(
    envelope: Sequence[float],
    plate: float,
    base: float,
    *,
    size: float,
    corner_ratio: float = 1.0,
    stops: Mapping[str, Iterable[float]] | None = None,
    region: str = "frame",
    name: str = "l-frame",
) -> Mesh:
    """An L-frame of a vertical plate and a base, as one body.

    x runs along the width, y to the front, z up; the origin is the lower left corner at the
    back. The base fills y = 0 to `depth` below z = `base`, the plate y = 0 to `plate` up to
    z = `height`.

    Parameters
    ----------
    envelope : (width, depth, height)
        m.
    plate, base : float
        Thickness of the plate along y and of the base along z, m.
    size : float
        Largest edge of a cell, m. Cells are uniform between two stops.
    corner_ratio : float
        Ratio of the largest to the smallest cell on the way to the inner corner of the L; 1 is
        uniform.
    stops : mapping of "x", "y", "z" to coordinates, or None
        Where mesh lines must fall besides, m: the edges of mounts and rails.
    region, name : str
        Name of the region, and of the mesh.

    Returns
    -------
    Mesh
        Patches `bottom`, `base top`, `plate front`, `plate back`, `plate top`, `left`,
        `right`, `base front`; node sets `bottom left back`, `bottom right back`,
        `bottom left front`, `bottom right front`, one corner each.

    Raises
    ------
    ModelError
        A dimension that is not positive, a plate or base that fills the envelope.
    """
    width, depth, height = envelope
    dimensions = {
        "width": width, "depth": depth, "height": height, "plate": plate, "base": base
    }  # fmt: skip
    for what, value in dimensions.items():
        if not (isfinite(value) and value > 0):
            raise ModelError(f"mesh {name}", f"{what} is {value!r} m.", "Give a positive number.")
    if plate >= depth or base >= height:
        raise ModelError(
            f"mesh {name}",
            f"plate {plate:g} m in depth {depth:g} m and base {base:g} m in height {height:g} m "
            "leave no L.",
            "Make the plate thinner than the depth and the base lower than the height.",
        )
    own = {"x": (0.0, width), "y": (0.0, plate, depth), "z": (0.0, base, height)}
    further = _checked_stops(stops or {}, own, name)
    corner = {"x": (), "y": (plate,), "z": (base,)}
    x, y, z = (
        lines_through((*own[axis], *further[axis]), size, corner[axis], corner_ratio)
        for axis in "xyz"
    )
    keep = np.zeros((len(x) - 1, len(y) - 1, len(z) - 1), dtype=bool)
    keep[:, y[:-1] < plate * (1 - 1e-9), :] = True
    keep[:, :, z[:-1] < base * (1 - 1e-9)] = True
    mesh = replace(grid(x, y, z, keep, region=region, name=name), patches={})
    sides: dict[str, Box] = {
        "bottom": ((None, None, 0.0), (None, None, 0.0), (0, 0, -1)),
        "base top": ((None, None, base), (None, None, base), (0, 0, 1)),
        "plate front": ((None, plate, None), (None, plate, None), (0, 1, 0)),
        "plate back": ((None, 0.0, None), (None, 0.0, None), (0, -1, 0)),
        "plate top": ((None, None, height), (None, None, height), (0, 0, 1)),
        "left": ((0.0, None, None), (0.0, None, None), (-1, 0, 0)),
        "right": ((width, None, None), (width, None, None), (1, 0, 0)),
        "base front": ((None, depth, None), (None, depth, None), (0, 1, 0)),
    }
    mesh = patches(mesh, sides)
    corners = {
        f"bottom {side} {end}": in_box(mesh, (a, b, 0.0), (a, b, 0.0))
        for side, a in (("left", 0.0), ("right", width))
        for end, b in (("back", 0.0), ("front", depth))
    }
    return replace(mesh, node_sets=corners)


def _checked_stops(
    stops: Mapping[str, Iterable[float]], own: Mapping[str, Sequence[float]], name: str
) -> dict[str, list[float]]:
    """The further stops of each axis; ModelError for another axis or one outside the frame."""
    further: dict[str, list[float]] = {axis: list(stops.get(axis, ())) for axis in own}
    if unknown := set(stops) - set(own):
        raise ModelError(f"mesh {name}", f"has stops along {sorted(unknown)}.", "Use x, y and z.")
    for axis, values in further.items():
        outside = [v for v in values if not 0.0 <= v <= own[axis][-1]]
        if outside:
            raise ModelError(
                f"mesh {name}",
                f"the stops {outside} along {axis} lie outside 0 to {own[axis][-1]:g} m.",
                "Give coordinates within the envelope, in m.",
            )
    return further
