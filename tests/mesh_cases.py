"""Meshes that several tests look at."""

from __future__ import annotations

import numpy as np

from strutwork.meshes import (
    CellBlock,
    Mesh,
    block,
    joined,
    mapped,
    moved,
    node_set,
    patches,
    quadratic,
)

#: A cube cut into five tetrahedra, in VTK's order.
FIVE = [[0, 1, 3, 4], [1, 2, 3, 6], [1, 6, 3, 4], [3, 6, 7, 4], [1, 5, 6, 4]]


def five_tetrahedra(size: tuple[float, float, float] = (1.0, 2.0, 3.0)) -> Mesh:
    """A brick of five tetrahedra with its bottom as a patch."""
    brick = block(size, (1, 1, 1))
    cells = brick.blocks[0].nodes[:, FIVE].reshape(-1, 4)
    mesh = Mesh(brick.points, (CellBlock("tetra", cells, np.zeros(5, int)),), name="five")
    return patches(mesh, {"bottom": ((None, None, 0.0), (None, None, 0.0), (0, 0, -1))})


def two_regions() -> Mesh:
    """Two cubes side by side with a patch on both, one on one alone and two node sets."""
    left = block((1.0, 1.0, 1.0), (2, 2, 2), region="left half")
    right = moved(block((1.0, 1.0, 1.0), (2, 2, 2), region="right"), translation=(1.0, 0.0, 0.0))
    mesh = joined(left, right)
    mesh = patches(
        Mesh(mesh.points, mesh.blocks, mesh.regions, name="two"),
        {
            "top": ((None, None, 1.0), (None, None, 1.0), (0, 0, 1)),
            "top left": ((None, None, 1.0), (1.0, None, 1.0), None),
            "end": ((2.0, None, None), (2.0, None, None), (1, 0, 0)),
        },
    )
    mesh = node_set(mesh, "everything")
    return node_set(mesh, "corner", high=(0.1, 0.1, 0.1))


def every_kind() -> dict[str, Mesh]:
    """A mesh of each kind of cell, none of them with right angles."""

    def skew(points: np.ndarray) -> np.ndarray:
        return points @ np.array([[1.0, 0.1, 0.0], [0.2, 1.0, 0.1], [0.0, 0.3, 1.2]])

    hexahedra, tetrahedra = mapped(two_regions(), skew), mapped(five_tetrahedra(), skew)
    return {
        "hexahedron": hexahedra,
        "hexahedron20": quadratic(hexahedra, serendipity=True),
        "hexahedron27": quadratic(hexahedra),
        "tetra": tetrahedra,
        "tetra10": quadratic(tetrahedra),
    }
