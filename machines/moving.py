"""The motion of a machine of the catalogue or of a model file, and the ranges of its joints."""

from __future__ import annotations

from dataclasses import dataclass

from strutwork.kinematics.motion import Motion
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.model_file import read_model
from strutwork.machines.variants import is_machine, named_machine


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
    if is_machine(name):
        found = named_machine(name)
        machine, home = found.machine, found.machine.home()
        linkage = machine.linkage
        motion = Motion(linkage, machine.place(home), home.rotation)
        title = found.title
    else:
        model = read_model(name)
        linkage = model.structure.linkage
        motion, title = Motion(linkage, model.placement), model.title or name
    return Moving(title, motion, joint_limits(linkage))
