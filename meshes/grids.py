"""Structured hexahedra over mesh lines, all cells or some, with the sides as patches."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.meshes.boundary import boundary
from strutwork.meshes.mesh import CellBlock, Faces, Mesh, Patch

Array = NDArray[Any]

#: Names of the six sides, with their axis and whether they are at the high end of it.
SIDES = {
    "-x": (0, False), "+x": (0, True),
    "-y": (1, False), "+y": (1, True),
    "-z": (2, False), "+z": (2, True),
}  # fmt: skip


def grid(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    keep: NDArray[np.bool_] | None = None,
    *,
    region: str = "solid",
    name: str = "grid",
) -> Mesh:
    """Eight-node hexahedra between mesh lines.

    Parameters
    ----------
    x, y, z : (nx + 1,), (ny + 1,), (nz + 1,)
        Coordinates of the lines, rising, m.
    keep : (nx, ny, nz) bool or None
        The cells to keep; all by default.
    region, name : str
        Name of the only region, and of the mesh.

    Returns
    -------
    Mesh
        With the outermost sides as patches `-x`, `+x`, `-y`, `+y`, `-z`, `+z`.

    Raises
    ------
    ModelError
        Lines that do not rise, nothing to keep.
    """
    axes = [np.asarray(a, dtype=float) for a in (x, y, z)]
    for axis, values in zip("xyz", axes, strict=True):
        if values.ndim != 1 or len(values) < 2 or not (np.diff(values) > 0).all():
            raise ModelError(
                f"mesh {name}", f"its lines along {axis} do not ascend.", "Sort them; at least two."
            )
    counts = tuple(len(a) - 1 for a in axes)
    kept = np.ones(counts, dtype=bool) if keep is None else np.asarray(keep, dtype=bool)
    if kept.shape != counts or not kept.any():
        raise ModelError(
            f"mesh {name}", f"keeps no cell, or not of {counts} cells.", "Check `keep`."
        )
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape([len(a) for a in axes])
    low, high = slice(None, -1), slice(1, None)
    square = ((low, low), (high, low), (high, high), (low, high))
    cells = np.stack(
        [number[i, j, k][kept] for k in (low, high) for i, j in square], axis=-1
    ).reshape(-1, 8)
    used, nodes = np.unique(cells, return_inverse=True)
    mesh = Mesh(
        points[used],
        (CellBlock("hexahedron", nodes.reshape(cells.shape), np.zeros(len(cells), np.int64)),),
        (region,),
        name=name,
    )
    outer = boundary(mesh).faces[0].nodes
    patches = {side: _side(mesh, outer, *where) for side, where in SIDES.items()}
    return Mesh(mesh.points, mesh.blocks, mesh.regions, {}, patches, name)


def _side(mesh: Mesh, outer: NDArray[np.int64], axis: int, high: bool) -> Patch:
    limit = mesh.bounds[int(high), axis]
    # the lines are copied, not computed: equality is exact
    return Patch((Faces("quad", outer[(mesh.points[outer, axis] == limit).all(axis=1)]),))
