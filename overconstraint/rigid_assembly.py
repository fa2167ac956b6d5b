"""The virtual-work solver of Son 2002, section 6.6: a rigid body on elastic joints with misfits.

The body's joints are drawn to places that do not fit it; the springs share what is left.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import MechanismError, ModelError, NumericalError
from strutwork.kinematics import cross_matrix

Array = NDArray[Any]

#: Largest sum of forces or moments left, as a share of the largest joint force.
RESIDUAL = 1e-9


@dataclass(frozen=True)
class RigidAssembly:
    """A rigid body on n joints of given stiffness (Son 2002, figures 40 and 41).

    Parameters
    ----------
    points : (..., n, 3)
        Joints on the body, m.
    stiffness : (..., n, 3, 3)
        Of each joint in global axes, N/m (the thesis has it diagonal).
    """

    points: Array
    stiffness: Array

    def __post_init__(self) -> None:
        n = self.points.shape[-2]
        if self.points.shape[-1] != 3 or self.stiffness.shape[-3:] != (n, 3, 3):
            raise ModelError(
                "rigid assembly",
                f"has points {self.points.shape} and stiffness {self.stiffness.shape}.",
                "Give points (..., n, 3) and stiffness (..., n, 3, 3).",
            )
        if not (np.all(np.isfinite(self.points)) and np.all(np.isfinite(self.stiffness))):
            raise ModelError(
                "rigid assembly", "holds a value that is not finite.", "Give finite numbers."
            )

    def __repr__(self) -> str:
        return f"<RigidAssembly: {self.points.shape[-2]} joints, batch {self.points.shape[:-2]}>"


@dataclass(frozen=True)
class RigidEquilibrium:
    """Equilibrium of the rigid body.

    Parameters
    ----------
    translation : (..., 3)
        Of the point that was the reference, m.
    rotation : (..., 3)
        Small rotation vector, rad.
    deformation : (..., n, 3)
        q of every joint's spring, m (eq. 57).
    forces : (..., n, 3)
        On the springs, global axes, N (eq. 63); the body feels the opposite.
    energy : (...)
        J.
    """

    translation: Array
    rotation: Array
    deformation: Array
    forces: Array
    energy: Array

    def __repr__(self) -> str:
        return f"<RigidEquilibrium: {self.forces.shape[-2]} joints, forces in N>"


def rigid_equilibrium(
    assembly: RigidAssembly, misfits: Array, reference: Array | None = None
) -> RigidEquilibrium:
    """Equilibrium of a rigid body whose joints are displaced by manufacturing errors.

    With u_i = T + Θ × p_i (eq. 56) and q_i = u_i − d_i (eq. 57), virtual work makes the sums of
    K_i q_i and of p_i × K_i q_i vanish (eqs 58 to 62).

    Parameters
    ----------
    assembly : RigidAssembly
    misfits : (..., n, 3)
        d, the displacement of each joint's other side, global axes, m.
    reference : (..., 3), optional
        Point whose translation is reported, m; default the first joint, as in the thesis. Forces do
        not depend on it.

    Returns
    -------
    RigidEquilibrium

    Raises
    ------
    MechanismError
        The joints leave the body a motion.
    NumericalError
        Forces or moments are not in balance.
    """
    points, stiffness = assembly.points, assembly.stiffness
    origin = points[..., 0, :] if reference is None else np.asarray(reference, dtype=float)
    arms = points - origin[..., None, :]
    length = np.linalg.norm(arms - arms.mean(axis=-2, keepdims=True), axis=-1).max(axis=-1)
    length = np.where(length > 0, length, 1.0)[..., None, None, None]
    # u = B x with x = (T, length Θ), so that all unknowns are metres
    carry = np.concatenate(
        [np.broadcast_to(np.eye(3), (*arms.shape, 3)), -cross_matrix(arms) / length], axis=-1
    )
    turned = np.swapaxes(carry, -1, -2)
    matrix = (turned @ stiffness @ carry).sum(axis=-3)
    if np.any(np.linalg.cond(matrix) > 1e12):
        raise MechanismError(
            "rigid assembly",
            "its joints leave the body free to move.",
            "Give enough joints a stiffness: at least six independent directions.",
        )
    load = (turned @ (stiffness @ misfits[..., None])).sum(axis=-3)
    solution = np.linalg.solve(matrix, load)
    moved = (carry @ solution[..., None, :, :])[..., 0]
    deformation = moved - misfits
    forces = (stiffness @ deformation[..., None])[..., 0]
    left = (turned @ forces[..., None]).sum(axis=-3)
    size = np.abs(stiffness @ misfits[..., None]).max(axis=(-1, -2, -3), initial=0.0)
    if np.any(np.abs(left).max(axis=(-1, -2)) > RESIDUAL * size):
        raise NumericalError(
            "rigid assembly",
            "its forces are not in balance: the solution is withheld.",
            "The joints nearly leave the body free, or their stiffnesses differ too much.",
        )
    return RigidEquilibrium(
        solution[..., :3, 0],
        solution[..., 3:, 0] / length[..., 0, 0],
        deformation,
        forces,
        0.5 * (deformation * forces).sum(axis=(-1, -2)),
    )
