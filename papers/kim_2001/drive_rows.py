"""The document's matrix G of the drives, and how far it is from losing rank.

Section III: G = (∂θ/∂u)ᵀ E (∂θ/∂u), where E picks the driven ones of all joints; so G = J⁻ᵀJ⁻¹ over
the rows of the drives, and loses rank at an actuator singularity. It adds squares of metres to
squares of radians: its condition number and its least singular value mean nothing before a length
is stated that counts as much as one radian.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import Poses, jacobians
from strutwork.machines.eclipse_prototype import Drives, EclipsePrototype

Array = NDArray[Any]

#: Tilts at which the margin is looked for, deg. At 90 a joint centre comes near the guide's axis.
TILTS = np.arange(0.5, 85.0, 0.5)
#: Spindle angles up to which it is, deg.
ROLLS = np.arange(-30.0, 31.0, 5.0)


def drive_gram(machine: EclipsePrototype, tilt: ArrayLike, roll: ArrayLike, length: float) -> Array:
    """G at tilts and spindle angles, (..., 6, 6), a pure number.

    Parameters
    ----------
    machine : EclipsePrototype
    tilt, roll : array_like
        β and γ, deg; broadcast together to (...).
    length : float
        What counts as much as one radian, of the tool and of a drive that turns, m.
    """
    tilt, roll = np.broadcast_arrays(np.radians(tilt), np.radians(roll))
    return gram_at(machine, machine.tilted(tilt, roll), length)


def gram_at(machine: EclipsePrototype, poses: Poses, length: float) -> Array:
    """G at poses, (..., 6, 6), as `drive_gram`."""
    found = jacobians(machine.linkage, machine.place(poses))
    rows = np.array(found.inverse)
    rows[..., 3:] /= length
    turning = np.array([direction.startswith("r") for _, direction in found.driven])
    rows[..., turning, :] *= length
    return np.asarray(np.swapaxes(rows, -1, -2) @ rows)


def least_singular_value(
    drives: Drives, rolls: ArrayLike, tilts: ArrayLike = TILTS, length: float | None = None
) -> tuple[float, float, float]:
    """Least singular value of the drives' rows over rolls × tilts, deg, and the tilt and roll.

    Parameters
    ----------
    length : float, optional
        m; default the platform's radius.
    """
    machine = EclipsePrototype(drives=drives)
    tilt, roll = (g.ravel() for g in np.meshgrid(tilts, rolls, indexing="ij"))
    gram = drive_gram(machine, tilt, roll, length or machine.platform_radius)
    least = np.sqrt(np.maximum(np.linalg.eigvalsh(gram)[..., 0], 0.0))
    at = int(np.argmin(least))
    return float(least[at]), float(tilt[at]), float(roll[at])


def condition(drives: Drives, tilts: ArrayLike, rolls: ArrayLike, length: float) -> Array:
    """Condition number of G, (tilts, rolls), as the document's Fig. 6."""
    machine = EclipsePrototype(drives=drives)
    values = np.linalg.eigvalsh(
        drive_gram(machine, np.asarray(tilts)[:, None], np.asarray(rolls), length)
    )
    # at a singular pose the least is zero but for its rounding, of either sign
    floor = np.finfo(float).eps * values[..., -1]
    return np.asarray(values[..., -1] / np.maximum(values[..., 0], floor))
