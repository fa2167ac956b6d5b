"""One door to every machine: a name of the catalogue or the path of a model file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_file import read_model
from strutwork.names import meant

if TYPE_CHECKING:
    from strutwork.machines.catalogue import Machine
    from strutwork.machines.naming import NamedMachine


#: Endings of robot files: URDF, SDFormat and MJCF.
ROBOT_FILES = (".urdf", ".sdf", ".xml", ".mjcf")


def load(name: str | Path) -> Model:
    """Load a machine by its name or from its file.

    Parameters
    ----------
    name : str or Path
        `NAME` or `NAME:VARIANT` of the catalogue, or the path of a model file or of a robot file
        (URDF, SDF or MJCF).

    Returns
    -------
    Model
        At home: for a file, the configuration that it describes.

    Raises
    ------
    ModelError
        No such machine, variant or file, or a wrong model.
    """
    text = str(name)
    path = Path(text)
    if path.suffix == ".toml":
        # no machine's name ends so: those of the literature are not read for a file
        return read_model(text)
    if path.suffix.lower() in ROBOT_FILES:
        from strutwork.machines.robots.models import robot_model

        return robot_model(text)
    from strutwork.machines.catalogue import CATALOGUE
    from strutwork.machines.naming import is_machine, named_machine

    if is_machine(text):
        found = named_machine(text)
        return named_model(found)
    if path.name == text and not os.path.lexists(path):
        raise ModelError(
            text,
            "is neither a machine of the catalogue nor a model file.",
            meant(text, CATALOGUE)
            + f"Machines: {', '.join(CATALOGUE)}; a model file ends in .toml.",
        )
    return read_model(text)


def load_heavy(name: str | Path) -> Model:
    """As `load`, a machine that can vibrate.

    Parameters
    ----------
    name : str or Path
        As `load`.

    Raises
    ------
    ModelError
        As `load`, and a variant that is for statics alone; names those that are not.
    """
    text = str(name)
    from strutwork.machines.naming import is_machine, named_machine, require_mass

    if not is_machine(text):
        return load(text)
    found = require_mass(named_machine(text))
    return named_model(found)


def named_model(found: NamedMachine) -> Model:
    """A machine of the catalogue at home, with the process that its report takes.

    Parameters
    ----------
    found : NamedMachine
    """
    from strutwork.machines.process_file import known_process

    model = machine_model(found.machine, found.title, found.around_home)
    process = found.entry.process
    return replace(model, process=known_process(process)) if process else model


def machine_model(
    machine: Machine, title: str, around_home: Mapping[str, tuple[float, int]] | None = None
) -> Model:
    """A machine that is written in Python, at home; its own formulas place it.

    Parameters
    ----------
    machine : Machine
    title : str
    around_home : mapping of direction to (float, int), optional
        Its workspace: so far to either side of home, m or rad, in so many points.
    """
    home = machine.home()
    middle = dict(zip(DIRECTIONS, [*home.position, 0.0, 0.0, 0.0], strict=True))
    axes = {
        d: middle[d] + np.linspace(-half, half, points)
        for d, (half, points) in (around_home or {}).items()
    }
    linkage = machine.linkage
    return Model(
        title=title,
        structure=machine.structure,
        placement=machine.place(home),
        cases=(),
        nodes=linkage.nodes,
        joints=tuple(joint.name for joint in linkage.joints),
        supports={},
        limits=machine.limits,
        workspace=TaskGrid(axes) if axes else None,
        rotation=home.rotation,
        closed_form=machine.place,
    )
