"""How far poses are from singular ones, by a stated length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.tool_drive_space import Freedoms, tool_drive_space

Array = NDArray[Any]


@dataclass(frozen=True)
class Distance:
    """Distance from singularities, by a stated length.

    Parameters
    ----------
    length : float
        L, m: how much translation counts as much as one radian, of the tool and of a drive that
        turns.
    parallel : (...)
        No unit. Least singular value of the inverse Jacobian: rates of the drives in that motion of
        the tool of size one, (v, L ω), which moves them least. 0 at type 2, of actuators.
    serial : (...)
        No unit. Least singular value of the Jacobian: motion of the tool, of those that rates of
        size one make, which is least. 0 at type 1, of the end-effector.
    passive : (...)
        No unit. Least singular value of the passive rows, each of size one on (v, L ω) of the
        bodies. 0 at a singularity of the configuration space.
    """

    length: float
    parallel: Array
    serial: Array
    passive: Array


def singularity_distance(
    linkage: Linkage,
    placement: Placement,
    length: float | None = None,
    known: Freedoms | None = None,
) -> Distance:
    """Distance of poses from singularities.

    Parameters
    ----------
    linkage : Linkage
    placement : Placement
        Poses that are reached.
    length : float, optional
        m; default the machine's `characteristic_length`.
    known : Freedoms, optional
        Ranks at poses that are not singular; needed where all of these poses may be singular.

    Raises
    ------
    ModelError
        As `tool_drive_space`.
    """
    space = tool_drive_space(linkage, placement, length, known)
    shape = placement.batch
    return Distance(
        space.length,
        space.parallel_distance().reshape(shape),
        space.serial_distance().reshape(shape),
        space.passive.reshape(shape),
    )
