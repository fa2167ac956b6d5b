"""A plate whose mesh lines fall on the edges of rectangles: rails, mounts, pads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from strutwork.errors import ModelError
from strutwork.meshes.grading import lines, lines_through
from strutwork.meshes.grids import grid
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.selection import Box, patches

#: Low x, high x, low y, high y, m.
Rectangle = tuple[float, float, float, float]


def plate_with_patches(
    size: Sequence[float],
    rectangles: Mapping[str, Rectangle],
    *,
    cell: float,
    layers: int = 2,
    region: str = "plate",
    name: str = "plate",
) -> Mesh:
    """A plate from the origin to `size` with rectangles of its top as patches.

    Parameters
    ----------
    size : (length, width, thickness)
        Along x, y and z, m.
    rectangles : mapping of str to (low x, high x, low y, high y)
        m; they may overlap.
    cell : float
        Largest edge of a cell along x and y, m.
    layers : int
        Cells through the thickness.
    region, name : str
        Name of the region, and of the mesh.

    Returns
    -------
    Mesh
        Eight-node hexahedra; patches `-x`, `+x`, `-y`, `+y`, `-z`, `+z` and the rectangles.

    Raises
    ------
    ModelError
        A rectangle without area, outside the plate, or named as a side.
    """
    length, width, thickness = size
    for label, (x0, x1, y0, y1) in rectangles.items():
        if not (0 <= x0 < x1 <= length and 0 <= y0 < y1 <= width):
            raise ModelError(
                f"mesh {name}, patch {label!r}",
                f"its rectangle x {x0:g} to {x1:g}, y {y0:g} to {y1:g} m is empty or leaves "
                f"the plate of {length:g} × {width:g} m.",
                "Give low x < high x and low y < high y within the plate.",
            )
        if label in {"-x", "+x", "-y", "+y", "-z", "+z"}:
            raise ModelError(
                f"mesh {name}, patch {label!r}", "has the name of a side.", "Choose another name."
            )
    x = lines_through((0.0, length, *(v for r in rectangles.values() for v in r[:2])), cell)
    y = lines_through((0.0, width, *(v for r in rectangles.values() for v in r[2:])), cell)
    mesh = grid(x, y, lines(thickness, layers), region=region, name=name)
    boxes: dict[str, Box] = {
        label: ((x0, y0, thickness), (x1, y1, thickness), (0, 0, 1))
        for label, (x0, x1, y0, y1) in rectangles.items()
    }
    return patches(mesh, boxes) if boxes else mesh
