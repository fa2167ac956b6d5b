"""Straight two-node beams in space, Timoshenko or Euler-Bernoulli."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section

Array = NDArray[Any]


@dataclass(frozen=True)
class Beam:
    """A uniform straight beam between two nodes.

    Local x runs from the first end to the second; local z lies in the plane of x and
    `orientation`, on its side; y = z × x.

    Parameters
    ----------
    name : str
    nodes : (str, str)
    material : Material
    section : Section
    orientation : (3,) or str or None
        A vector in global axes, no unit, or the name of a joint whose z axis is taken at every
        pose. None: global z, or global y for a beam along z.
    shear : bool
        Timoshenko (True) or Euler-Bernoulli (False).
    elements : int
        Number of equal elements the beam is divided into.
    offsets : ((3,), (3,))
        From each node to the beam's end, global axes, m: a rigid arm.
    mass : "consistent" or "lumped"
        Consistent with rotary inertia, or half the mass at either end and none to turn.

    Raises
    ------
    ModelError
        No element, or the same node twice.
    """

    name: str
    nodes: tuple[str, str]
    material: Material
    section: Section
    orientation: tuple[float, float, float] | str | None = None
    shear: bool = True
    elements: int = 1
    offsets: tuple[tuple[float, float, float], tuple[float, float, float]] = (
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0),
    )
    mass: Literal["consistent", "lumped"] = "consistent"

    def __post_init__(self) -> None:
        if self.elements < 1:
            raise ModelError(
                f"beam {self.name}", f"has {self.elements} elements.", "Give at least one."
            )
        if self.nodes[0] == self.nodes[1]:
            raise ModelError(
                f"beam {self.name}",
                f'runs from node "{self.nodes[0]}" to itself.',
                "Give it two different nodes.",
            )

    @property
    def properties(self) -> tuple[float, float, float, float, float, float]:
        """EA, GJ, EIy, EIz (N, N·m²) and the shear flexibilities 12 EI/(G A_s), m².

        The last two are Φ L² of bending in the x-z and the x-y plane; zero without shear.
        """
        e, g = self.material.youngs_modulus, self.material.shear_modulus
        s = self.section
        areas = s.shear_area(self.material.poissons_ratio) if self.shear else None
        phi_y = 12.0 * e * s.second_moment_y / (g * areas[1]) if areas else 0.0
        phi_z = 12.0 * e * s.second_moment_z / (g * areas[0]) if areas else 0.0
        return (
            e * s.area,
            g * s.torsion_constant,
            e * s.second_moment_y,
            e * s.second_moment_z,
            phi_y,
            phi_z,
        )


def beam_axes(
    start: Array, end: Array, orientation: Array, names: Sequence[str]
) -> tuple[Array, Array]:
    """Length and local axes of beams.

    Parameters
    ----------
    start, end : (..., b, 3)
        Ends of the beams, m.
    orientation : (..., b, 3)
        A vector in each local x-z plane, no unit; NaN for the default.
    names : sequence of b str
        Named in an error.

    Returns
    -------
    length : (..., b)
    axes : (..., b, 3, 3)
        Local x, y, z as rows: `axes @ v` is v in local axes.

    Raises
    ------
    ModelError
        A beam of zero length, or an orientation along its beam.
    """
    span = end - start
    length = np.linalg.norm(span, axis=-1)
    size = np.abs(start).max(initial=0.0) + np.abs(end).max(initial=0.0)
    short = length <= 1e-12 * max(size, 1e-9)
    if np.any(short):
        raise ModelError(
            f"beam {_first(names, short)}",
            "has zero length.",
            "Move one of its nodes, or replace the beam by a joint.",
        )
    x = span / length[..., None]
    up = np.where(np.isnan(orientation), default_up(x), orientation)
    z = up - (up * x).sum(-1, keepdims=True) * x
    height = np.linalg.norm(z, axis=-1, keepdims=True)
    flat = height <= 1e-9 * np.linalg.norm(up, axis=-1, keepdims=True)
    if np.any(flat):
        raise ModelError(
            f"beam {_first(names, flat[..., 0])}",
            "its orientation has zero length or lies along the beam.",
            "Give a vector that points sideways: it fixes the local x-z plane.",
        )
    z = z / height
    return length, np.stack([x, np.cross(z, x), z], axis=-2)


def default_up(x: Array) -> Array:
    """Vectors in the local x-z plane of beams that name none, (..., 3): z, or y of one along z.

    Parameters
    ----------
    x : (..., 3)
        Unit vectors along the beams, no unit.
    """
    along_z = np.hypot(x[..., :1], x[..., 1:2]) < 1e-6
    return np.where(along_z, np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]))


def _first(names: Sequence[str], bad: NDArray[np.bool_]) -> str:
    return names[int(np.argwhere(bad)[0][-1])]


def local_stiffness(length: Array, properties: Sequence[Any] | Array) -> Array:
    """Stiffness in local axes (Przemieniecki 1968, eq. 5.116).

    Parameters
    ----------
    length : (...)
        m.
    properties : sequence of six numbers or (...) arrays
        As `Beam.properties`: N, N·m² and m².

    Returns
    -------
    stiffness : (..., 12, 12)
        Ends in order, x y z rx ry rz each.
    """
    ea, gj, eiy, eiz, shear_y, shear_z = properties
    # extended precision in, extended precision out
    length = np.asarray(length, dtype=np.result_type(length, float))
    k = np.zeros((*length.shape, 12, 12), dtype=length.dtype)
    for i, value in ((0, ea / length), (3, gj / length)):
        k[..., i, i] = k[..., i + 6, i + 6] = value
        k[..., i, i + 6] = k[..., i + 6, i] = -value
    # bending in x-y uses v and rz, in x-z uses w and ry with the opposite sign of rotation
    for v, r, ei, shear, sign in ((1, 5, eiz, shear_z, 1.0), (2, 4, eiy, shear_y, -1.0)):
        phi = shear / length**2
        factor = ei / (length**3 * (1.0 + phi))
        side, turn = 12.0 * factor, sign * 6.0 * length * factor
        near = (4.0 + phi) * length**2 * factor
        far = (2.0 - phi) * length**2 * factor
        for a, b, value in (
            (v, v, side),
            (v + 6, v + 6, side),
            (v, v + 6, -side),
            (v, r, turn),
            (v, r + 6, turn),
            (v + 6, r, -turn),
            (v + 6, r + 6, -turn),
            (r, r, near),
            (r + 6, r + 6, near),
            (r, r + 6, far),
        ):
            k[..., a, b] = k[..., b, a] = value
    return k


def fixed_end_loads(
    length: Array, properties: Sequence[Any] | Array, first: Array, second: Array
) -> Array:
    """Nodal loads consistent with a line load that varies linearly along the beam.

    Integrals of the load with the beam's exact static shape functions, which contain the
    shear flexibility Φ (Reddy 1997), so that nodal displacements are exact.

    Parameters
    ----------
    length : (...)
        m.
    properties : sequence of six numbers or (...) arrays
        As `Beam.properties`: N, N·m² and m².
    first, second : (..., 3)
        Load per length at the two ends in local axes, N/m.

    Returns
    -------
    loads : (..., 12)
        Equivalent nodal forces in local axes, N and N·m.
    """
    length = np.asarray(length, dtype=float)
    batch = np.broadcast_shapes(length.shape, first.shape[:-1])
    loads = np.zeros((*batch, 12))
    change = second - first
    loads[..., 0] = length * (first[..., 0] / 2.0 + change[..., 0] / 6.0)
    loads[..., 6] = length * (first[..., 0] / 2.0 + change[..., 0] / 3.0)
    for v, r, shear, sign in ((1, 5, properties[5], 1.0), (2, 4, properties[4], -1.0)):
        phi = shear / length**2
        q, dq = first[..., v], change[..., v] / (1.0 + phi)
        loads[..., v] = length * (q / 2.0 + dq * (3.0 / 20.0 + phi / 6.0))
        loads[..., v + 6] = length * (q / 2.0 + dq * (7.0 / 20.0 + phi / 3.0))
        loads[..., r] = sign * length**2 * (q / 12.0 + dq * (1.0 / 30.0 + phi / 24.0))
        loads[..., r + 6] = -sign * length**2 * (q / 12.0 + dq * (1.0 / 20.0 + phi / 24.0))
    return loads


def to_global(axes: Array, matrix: Array) -> Array:
    """Turn a matrix of beam ends from local to global axes, (..., 12, 12).

    Parameters
    ----------
    axes : (..., 3, 3)
        Local x, y, z as rows, no unit.
    matrix : (..., 12, 12)
        Stiffness or mass: N/m, N, N·m/rad, or kg, kg·m, kg·m².
    """
    batch = np.broadcast_shapes(axes.shape[:-2], matrix.shape[:-2])
    blocks = matrix.reshape(*matrix.shape[:-2], 4, 3, 4, 3)
    turned = np.einsum("...ki,...akbl,...lj->...aibj", axes, blocks, axes, optimize=True)
    return np.asarray(turned).reshape(*batch, 12, 12)
