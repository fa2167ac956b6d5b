"""Whether misfits settle where the tool stands."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import MechanismError
from strutwork.kinematics import characteristic_lengths, mobility
from strutwork.msa.assembly import System
from strutwork.msa.constraints import free_unknowns, scales
from strutwork.msa.nodal_response import tool_displacement

Array = NDArray[Any]

#: A free motion moves the tool, or a misfit drives it, when its part exceeds this share.
MOVES = 1e-9


def check_tool_place(system: System, tool: Array) -> None:
    """Check that no misfit moves the tool along a motion that nothing resists.

    Free motions change no assembly force: a misfit meets what resists alone. Where one leaves the
    tool as it is, a strut that turns about itself between two balls, or no misfit moves the tool
    that way, a spindle that spins, the tool's place is settled as well. Else it depends on how far
    the free motion has gone, and no number for it would be true.

    Parameters
    ----------
    system : System
    tool : (p, 6, g)
        Displacement of the tool per unit misfit, m/m, rad/m, m/rad and rad/rad, with no part of a
        free motion in the unknowns.

    Raises
    ------
    MechanismError
        Names the joints and directions that move, and the pose.
    """
    linkage = system.placed.structure.linkage
    if linkage.tool is None or not tool.shape[-1]:
        return
    free = free_unknowns(system)
    if not free.shape[-1]:
        return
    moved = tool_displacement(system.placed, system.expand(free * scales(system)[..., None]))
    # rotations count by what they move at the machine's own length
    length = characteristic_lengths(system.placed.placement)[:, None, None]
    largest = np.zeros(system.poses)
    driven = np.zeros(system.poses)
    # along and about apart: a free turn shifts the tool too, and what a misfit does to the one
    # could be done by the other
    for part, size in ((slice(0, 3), 1.0), (slice(3, 6), length)):
        left, values, _ = np.linalg.svd(moved[:, part] * size, full_matrices=False)
        caused = tool[:, part] * size
        along = np.swapaxes(left * (values > MOVES)[:, None], -1, -2) @ caused
        driven = np.maximum(driven, np.abs(along).max(axis=(1, 2), initial=0.0))
        largest = np.maximum(largest, np.abs(caused).max(axis=(1, 2), initial=0.0))
    bad = driven > MOVES * np.maximum(largest, 1e-300)
    if not np.any(bad):
        return
    pose = int(np.flatnonzero(bad)[0])
    found = mobility(linkage, system.placed.placement[pose])
    names = dict.fromkeys(
        f"{joint} in {direction}" for motion in found.motions for joint, direction in motion.joints
    )
    where = f" at pose {pose}" if system.poses > 1 else ""
    motions = "; ".join(motion.description for motion in found.motions[:4])
    raise MechanismError(
        "joints " + ", ".join(names) if names else "structure",
        f'the misfits move the tool "{linkage.tool}" along a mechanism that nothing holds{where}: '
        f"{motions}. Its position is indeterminate.",
        "Lock, drive or spring one of these directions, or omit the tool: the forces do not "
        "depend on it.",
    )
