"""The motion of a machine of the catalogue or of a model file, and the ranges of its joints."""

from __future__ import annotations

from dataclasses import dataclass

from strutwork.kinematics.motion import Motion
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.load import load


@dataclass(frozen=True)
class Moving:
    """What moves, by its name.

    Parameters
    ----------
    title : str
    motion : Motion
    limits : tuple of Limit
        Of the joints, as they state them themselves.
    """

    title: str
    motion: Motion
    limits: tuple[Limit, ...]


def moving(name: str) -> Moving:
    """The motion of a machine, `NAME` or `NAME:VARIANT`, or of a model file, from its home.

    The home of a model file is the configuration that it describes.

    Raises
    ------
    ModelError
        An unknown machine, or a file that cannot be read or whose joints do not close.
    """
    found = load(name)
    linkage = found.structure.linkage
    # a range of a coordinate that only the machine's own formulas know is no motion's
    return Moving(found.title or name, found.motion, joint_limits(linkage))
