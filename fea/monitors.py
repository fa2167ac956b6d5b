"""Monitors of a superelement: patches whose motions stand for its generalised coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg as sla
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.fea.tied_solid import TiedSolid
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]

#: Largest condition number of the exchange of coordinates.
CONDITION = 1e6

#: Relative error of a frequency that rounding by the exchange may cause.
ROUNDED = 1e-5

#: Candidates for monitors.
CANDIDATES = 400


def choose_monitors(
    solid: TiedSolid, shapes: Array, cells: NDArray[np.intp], k: int
) -> tuple[Array, Array]:
    """Places of the monitors (p, 3), and the exchange of coordinates (k + m, k + 6 p).

    Each monitor is one cell, its motion the least-squares rigid motion of the corners. They are
    chosen one by one for the volume that their rows add.

    Parameters
    ----------
    solid : TiedSolid
    shapes : (3 n, k + m)
        Displacements of the field nodes, no unit and m/rad.
    cells : (c, p)
        Nodes of its cells.
    k : int
        Interface freedoms, which stay.

    Raises
    ------
    NumericalError
        Shapes that cannot be told apart.
    """
    m = shapes.shape[1] - k
    if m == 0:
        return np.zeros((0, 3)), np.eye(k)
    step = max(1, len(cells) // CANDIDATES)
    chosen = cells[::step]
    points = solid.points[chosen]
    middle = points.mean(axis=1)
    arms = rigid_map(points - middle[:, None])[:, :, :3].reshape(len(chosen), -1, 6)
    reader = np.linalg.pinv(arms)
    dofs = (3 * chosen[:, :, None] + np.arange(3)).reshape(len(chosen), -1)
    rows = reader @ shapes[dofs]
    reach = np.linalg.norm(solid.points - solid.points.mean(axis=0), axis=1).max()
    # compared as displacements at the solid's size, and every shape by its own
    scaled = rows[:, :, k:] * np.array([1.0] * 3 + [reach] * 3)[:, None]
    scaled = scaled / np.maximum(np.abs(scaled).max(axis=(0, 1)), 1e-300)
    picked: list[int] = []
    outside = np.eye(m)
    for _ in range(m // 6):
        sizes = np.linalg.svd(scaled @ outside, compute_uv=False)
        volume = np.log(np.maximum(sizes[:, :6], 1e-300)).sum(axis=-1)
        volume[picked] = -np.inf
        picked.append(int(volume.argmax()))
        _, _, right = np.linalg.svd(scaled[picked].reshape(-1, m), full_matrices=False)
        outside = np.eye(m) - right.T @ right
    taken = rows[picked].reshape(m, -1)
    condition = float(np.linalg.cond(scaled[picked].reshape(m, m)))
    if not condition < CONDITION:
        raise NumericalError(
            f"superelement {solid.name}",
            f"the exchange of its coordinates has the condition number {condition:.2g}.",
            "Retain fewer modes, or refine the mesh.",
        )
    inverse = np.linalg.inv(taken[:, k:])
    exchange = np.block([[np.eye(k), np.zeros((k, m))], [-inverse @ taken[:, :k], inverse]])
    return middle[picked], exchange


def check_exchange(
    name: str, before: tuple[Array, Array], after: tuple[Array, Array], k: int
) -> None:
    """NumericalError where coordinates exchanged for monitors round frequencies by `ROUNDED`.

    The frequencies with all k interface freedoms held, and those with none held.

    Parameters
    ----------
    name : str
        Of the solid.
    before, after : two of (n, n)
        Stiffness and mass in either coordinates, N/m, kg and the like.
    k : int
    """
    if len(before[0]) == k:
        return
    floor = 0.0
    for free in (slice(k, None), slice(None)):
        exact, rounded = (_squares(m[0][free, free], m[1][free, free]) for m in (before, after))
        # rigid motions have no frequency: what rounds them counts beside the lowest held one
        floor = floor or float(exact[0])
        error = float((np.abs(rounded - exact) / np.maximum(np.abs(exact), floor)).max()) / 2.0
        if not error <= ROUNDED:
            raise NumericalError(
                f"superelement {name}",
                f"rounding by the exchange of its coordinates changes a frequency by {error:.2g} "
                "of it.",
                "Retain fewer modes, or refine the mesh.",
            )


def _squares(stiffness: Array, mass: Array) -> Array:
    """Eigenvalues, (rad/s)², of matrices with coordinates of any units."""
    size = 1.0 / np.sqrt(mass.diagonal())
    scale = np.outer(size, size)
    return np.asarray(sla.eigh(stiffness * scale, mass * scale, eigvals_only=True))
