"""What to say of a structure that cannot be solved."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import MechanismError, NumericalError, StrutworkError
from strutwork.kinematics import mobility
from strutwork.msa.assembly import System, system_of
from strutwork.msa.constraints import free_unknowns, scales
from strutwork.msa.unjoined import in_words, unjoined_nodes

Array = NDArray[Any]

#: A load excites a free motion when its work exceeds this share of its size.
WORK_TOLERANCE = 1e-9

#: Poses whose free motions are found at once.
PIECE = 128


def check_held(system: System, free: Array, load: Array) -> None:
    """Check that no load does work in a motion that nothing resists.

    Parameters
    ----------
    system : System
    free : (p, n, k)
        From `free_unknowns`, no unit.
    load : (p, n, m)
        On the unknowns, N and N·m.

    Raises
    ------
    MechanismError
        Names the joints and directions that move, and the pose.
    """
    if free.shape[-1] == 0:
        return
    scaled = load * scales(system)[..., None]
    work = np.abs(np.swapaxes(free, -1, -2) @ scaled)
    size = np.linalg.norm(scaled, axis=1)[:, None, :]
    excited = work > WORK_TOLERANCE * np.maximum(size, 1e-300)
    if np.any(excited):
        raise mechanism_error(system, int(np.argwhere(excited.any(axis=(1, 2)))[0][0]))


def mechanisms_under(
    system: System, load_of: Callable[[System], Array]
) -> tuple[NDArray[np.bool_], StrutworkError]:
    """Poses at which a load does work in a motion that nothing resists, found by rank.

    Parameters
    ----------
    system : System
    load_of : callable
        Loads (p, n, m), N and N·m, on the unknowns of a system that is given to it.

    Returns
    -------
    moves : (p,)
    error : MechanismError
        That of the first of them.
    """
    moves = np.zeros(system.poses, dtype=bool)
    for start in range(0, system.poses, PIECE):
        part = system_of(system.placed[start : start + PIECE])
        scale = scales(part)[..., None]
        load = load_of(part) * scale
        work = np.abs(np.swapaxes(free_unknowns(part), -1, -2) @ load)
        size = np.linalg.norm(load, axis=1)[:, None, :]
        moves[start : start + PIECE] = (work > WORK_TOLERANCE * np.maximum(size, 1e-300)).any(
            axis=(1, 2)
        )
    first = int(moves.argmax()) if moves.size else 0
    return moves, mechanism_error(system, first)


def mechanism_error(system: System, pose: int) -> StrutworkError:
    """The error for a structure that moves freely under its load at one pose.

    Parameters
    ----------
    system : System
    pose : int
        Its place in the batch.
    """
    placed = system.placed
    linkage = placed.structure.linkage
    found = mobility(linkage, placed.placement[pose])
    where = f" at pose {pose}" if system.poses > 1 else ""
    if not found.motions:
        return NumericalError(
            "structure",
            f"is too close to a mechanism to be solved{where}.",
            "Look for stiffnesses that differ by more than ten orders of magnitude, or for a "
            "pose next to a singular one.",
        )
    names = dict.fromkeys(
        f"{joint} in {direction}" for motion in found.motions for joint, direction in motion.joints
    )
    part = "joints " + ", ".join(names) if names else "structure"
    motions = "; ".join(motion.description for motion in found.motions[:4])
    loose = unjoined_nodes(placed[pose])
    cause = f" Probably {in_words(placed, loose[0])}." if loose else ""
    return MechanismError(
        part,
        f"the structure is a mechanism under its load{where}: {motions}.{cause}",
        "Lock, drive or spring one of these directions, or add a support.",
    )


def check_residual(residual: Array, size: Array, what: str, limit: float = 1e-8) -> None:
    """Withhold a solution whose residual is not small beside `size`.

    Parameters
    ----------
    residual : (...)
        Largest residual, N.
    size : (...)
        What it is small beside, N.
    what : str
        The part that the error names.
    limit : float
        Largest share of `size`, no unit.

    Raises
    ------
    NumericalError
        States the residual, its limit and the pose.
    """
    share = residual / np.maximum(size, 1e-300)
    bad = ~(share <= limit)
    if np.any(bad):
        pose = int(np.argwhere(bad)[0][0])
        raise NumericalError(
            what,
            f"the residual is {share.ravel()[pose]:.2g} of the load at pose {pose}, above "
            f"{limit:g}: the solution is withheld.",
            "The structure is nearly a mechanism there, or its stiffnesses differ too much.",
        )
