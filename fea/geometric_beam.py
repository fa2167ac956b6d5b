"""Geometric stiffness of a beam element under all six section forces.

The second-order part of the strains of a beam whose sections turn as rigid ones by a rotation
vector θ (Reissner 1973; Simo 1985): with the strain measures Γ = Rᵀ r' − e₁ and K = Rᵀ R',

    Γ⁽²⁾ = −θ × u' + ½ θ × (θ × e₁),    K⁽²⁾ = −½ θ × θ',

the section force n and moment m do the work ∫ n·Γ⁽²⁾ + m·K⁽²⁾ dx. The normal force acts on the
slope of the axis, N (v'² + w'²)/2, as is usual for solid beams (Przemieniecki 1968, section
15.2), and on the fibres that torsion inclines, N (Iy + Iz)/A θx'²/2. Under a rigid turn the sum is
the work of forces that keep their direction, exactly; moments turn half with the body (Argyris
1978).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Gauss points: forces are cubic at most, and so is the rest of the integrand.
POINTS = 4


def beam_geometric_stiffness(length: Array, properties: Array, forces: Array) -> Array:
    """Geometric stiffness of beam elements in local axes.

    Parameters
    ----------
    length : (...)
        m.
    properties : (6, ...)
        As `Beam.properties`: N, N·m² and m².
    forces : (..., POINTS, 6)
        Section forces N Vy Vz and moments Mx My Mz on the far face of a cut at the Gauss points,
        N and N·m; tension is positive.

    Returns
    -------
    stiffness : (..., 12, 12)
        Symmetric.
    """
    batch = np.broadcast_shapes(length.shape, forces.shape[:-2])
    result = np.zeros((*batch, 12, 12))
    points, weights = gauss_points()
    ea, eiy, eiz = properties[0], properties[2], properties[3]
    radius = (eiy + eiz) / ea
    for i, (x, weight) in enumerate(zip(points, weights, strict=True)):
        f = _fields(x, length, properties)
        n, vy, vz, mx, my, mz = (
            (weight * length * forces[..., i, d])[..., None, None] for d in range(6)
        )

        def square(first: str, second: str, f: dict[str, Array] = f) -> Array:
            return f[first][..., :, None] * f[second][..., None, :]

        work = (
            n / 2.0 * (square("dv", "dv") + square("dw", "dw"))
            + n / 2.0 * radius[..., None, None] * square("dtx", "dtx")
            + vy * (square("tx", "dw") + 0.5 * square("tx", "ty"))
            + vz * (0.5 * square("tx", "tz") - square("tx", "dv"))
            - 0.5 * mx * (square("ty", "dtz") - square("tz", "dty"))
            - 0.5 * my * (square("tz", "dtx") - square("tx", "dtz"))
            - 0.5 * mz * (square("tx", "dty") - square("ty", "dtx"))
        )
        result += work + np.swapaxes(work, -1, -2)
    return result


def gauss_points() -> tuple[Array, Array]:
    """Places along an element, 0 to 1, and their weights, (POINTS,) each."""
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    return (points + 1) / 2, weights / 2


def _fields(x: float, length: Array, properties: Array) -> dict[str, Array]:
    """Slopes of the axis, turns of the section and their rates, of the displacements, (..., 12)."""
    shape = (*length.shape, 12)
    f = {name: np.zeros(shape) for name in ("dv", "dw", "tx", "ty", "tz", "dtx", "dty", "dtz")}
    f["tx"][..., 3], f["tx"][..., 9] = 1 - x, x
    f["dtx"][..., 3], f["dtx"][..., 9] = -1 / length, 1 / length
    for slope, turn, v, r, shear, sign in (
        ("dv", "tz", 1, 5, properties[5], 1.0),
        ("dw", "ty", 2, 4, properties[4], -1.0),
    ):
        phi = shear / length**2
        share = 1 / (1 + phi)
        near = (6 * x**2 - 6 * x) / length
        rate = (12 * x - 6) / length**2
        # the displacement of each end, then its turn; in x-z a turn lowers
        f[slope][..., v] = share * (near - phi / length)
        f[slope][..., v + 6] = -f[slope][..., v]
        f[slope][..., r] = sign * share * (1 - 4 * x + 3 * x**2 + phi / 2 * (1 - 2 * x))
        f[slope][..., r + 6] = sign * share * (3 * x**2 - 2 * x - phi / 2 * (1 - 2 * x))
        f[turn][..., v], f[turn][..., v + 6] = sign * share * near, -sign * share * near
        f[turn][..., r] = share * (1 - 4 * x + 3 * x**2 + phi * (1 - x))
        f[turn][..., r + 6] = share * (3 * x**2 - 2 * x + phi * x)
        f["d" + turn][..., v], f["d" + turn][..., v + 6] = sign * share * rate, -sign * share * rate
        f["d" + turn][..., r] = share * (6 * x - 4 - phi) / length
        f["d" + turn][..., r + 6] = share * (6 * x - 2 + phi) / length
    return f
