"""The L-frame of the solid benchmarks: granite, linear hexahedra, one end held."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.fea.solid import Solid
from strutwork.fea.solid_matrices import solid_matrices
from strutwork.meshes.l_frame import l_frame
from strutwork.meshes.mesh import Mesh
from strutwork.msa import Material

#: Cells along an arm, through its thickness, and across.
SIZES = {"smallest": (12, 4, 4), "22k": (33, 11, 10), "92k": (54, 18, 17), "300k": (81, 27, 25)}

#: Edge of a cell, m.
CELL = 0.02

GRANITE = Material.isotropic(50e9, 0.25, 2900.0, name="granite")


def frame_mesh(size: str) -> tuple[Mesh, NDArray[np.intp]]:
    """The mesh and its nodes that are held."""
    length, thickness, width = SIZES[size]
    mesh = l_frame(
        (width * CELL, length * CELL, length * CELL),
        thickness * CELL,
        thickness * CELL,
        size=CELL * 1.001,
        region="granite",
    )
    return mesh, np.asarray(mesh.patch("plate top").nodes, dtype=np.intp)


def frame_pencil(size: str) -> tuple[sp.csc_array, sp.csc_array, NDArray[np.intp]]:
    """Stiffness and mass of the free dofs, and the rows of x of a patch at the other end."""
    mesh, held = frame_mesh(size)
    matrices = solid_matrices(Solid(mesh, {"granite": GRANITE}, order=1))
    nodes = np.setdiff1d(np.arange(len(mesh.points)), held)
    free = (3 * nodes[:, None] + np.arange(3)).ravel()
    mass: Any = matrices.mass_matrix
    end = np.asarray(mesh.patch("base front").nodes)
    patch = 3 * np.searchsorted(nodes, end[: len(end) // 4])
    return (
        sp.csc_array(matrices.stiffness[free][:, free]),
        sp.csc_array(mass[free][:, free]),
        np.asarray(patch, dtype=np.intp),
    )


def deck(mesh: Mesh, held: NDArray[np.intp]) -> str:
    """CalculiX's input for ten modes of the same mesh."""
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(mesh.points, 1)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=FRAME")
    cells = np.concatenate([np.asarray(b.nodes) for b in mesh.blocks]) + 1
    lines += [f"{i}, " + ", ".join(map(str, cell)) for i, cell in enumerate(cells, 1)]
    lines.append("*NSET, NSET=HELD")
    lines += [str(i + 1) for i in held]
    lines += [
        "*BOUNDARY",
        "HELD, 1, 3",
        "*MATERIAL, NAME=GRANITE",
        "*ELASTIC",
        "50e9, 0.25",
        "*DENSITY",
        "2900",
        "*SOLID SECTION, ELSET=FRAME, MATERIAL=GRANITE",
        "*STEP",
        "*FREQUENCY",
        "10",
        "*END STEP",
        "",
    ]
    return "\n".join(lines)
