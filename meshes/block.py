"""Blocks of hexahedra: bricks, graded bricks, and sheared or tapered ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from strutwork.errors import ModelError
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.grading import lines
from strutwork.meshes.grids import grid
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.quality import check_quality


def block(
    size: Sequence[float],
    divisions: Sequence[int],
    grading: Sequence[float] = (1.0, 1.0, 1.0),
    *,
    both: bool = False,
    region: str = "solid",
    name: str = "block",
) -> Mesh:
    """A brick from the origin to `size`.

    Parameters
    ----------
    size : (3,)
        m.
    divisions : (3,) int
        Cells along each axis.
    grading : (3,)
        Ratio of the last cell to the first along each axis; more than 1 is finer at the origin.
    both : bool
        Grade both ends alike (`strutwork.meshes.grading.lines`).
    region, name : str
        Name of the region, and of the mesh.

    Returns
    -------
    Mesh
        Eight-node hexahedra; patches `-x`, `+x`, `-y`, `+y`, `-z`, `+z`.

    Raises
    ------
    ModelError
        A size, a division or a grading that is not positive.
    """
    axes = [
        lines(length, count, ratio, both=both)
        for length, count, ratio in zip(size, divisions, grading, strict=True)
    ]
    return grid(*axes, region=region, name=name)


def hexahedral_block(
    corners: ArrayLike,
    divisions: Sequence[int],
    grading: Sequence[float] = (1.0, 1.0, 1.0),
    *,
    region: str = "solid",
    name: str = "block",
) -> Mesh:
    """A block between eight corners: sheared, tapered or twisted.

    Parameters
    ----------
    corners : (8, 3)
        m, in the order of an eight-node hexahedron: four below counter-clockwise seen from
        above, then the four above them. The points inside are trilinear.
    divisions : (3,) int
        As for `block`.
    grading : (3,)
        Ratios, as for `block`.
    region, name : str
        As for `block`; the sides keep their names.

    Raises
    ------
    ModelError
        Corners that make an inverted block.
    """
    places = np.asarray(corners, dtype=float)
    if places.shape != (8, 3) or not np.isfinite(places).all():
        raise ModelError(
            f"mesh {name}", f"its corners have the shape {places.shape}.", "Give (8, 3) numbers."
        )
    unit = block((1.0, 1.0, 1.0), divisions, grading, region=region, name=name)
    mesh = replace(unit, points=CELL_TYPES["hexahedron"].shape(unit.points) @ places)
    check_quality(mesh)
    return mesh
