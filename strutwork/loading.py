"""The front door: a machine by its name or from its file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from strutwork.arguments import checked

if TYPE_CHECKING:
    from strutwork.front import Machine


@checked
def load(name: str | Path) -> Machine:
    """Load a machine by its name or from its file.

    Parameters
    ----------
    name : str or Path
        `NAME` or `NAME:VARIANT` of `strutwork machines`, or the path of a model file or of a
        robot file (URDF, SDF or MJCF).

    Returns
    -------
    strutwork.front.Machine
        At home: for a file, the configuration that it describes.

    Raises
    ------
    ModelError
        No such machine, variant or file, or a wrong model.
    """
    # the rooms are entered only when somebody does: importing strutwork stays quick
    from strutwork.front import Machine
    from strutwork.machines.load import load as loaded

    return Machine.of(loaded(name), str(name))
