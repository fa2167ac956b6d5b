"""One door to every machine: a name of the catalogue or the path of a model file."""

from __future__ import annotations

import os
from pathlib import Path

from strutwork.errors import ModelError
from strutwork.machines.catalogue import CATALOGUE, Machine
from strutwork.machines.model import Model
from strutwork.machines.model_file import read_model
from strutwork.machines.variants import is_machine, named_machine


def load(name: str | Path) -> Model:
    """A machine by its name or from its file.

    Parameters
    ----------
    name : str or Path
        `NAME` or `NAME:VARIANT` of the catalogue, or the path of a model file.

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
    if is_machine(text):
        found = named_machine(text)
        return machine_model(found.machine, found.title)
    path = Path(text)
    if path.suffix != ".toml" and path.name == text and not os.path.lexists(path):
        raise ModelError(
            text,
            "is no machine of the catalogue and no model file.",
            "Machines: " + ", ".join(CATALOGUE) + "; a model file ends in .toml.",
        )
    return read_model(text)


def machine_model(machine: Machine, title: str) -> Model:
    """A machine that is written in Python, at home; its own formulas place it.

    Parameters
    ----------
    machine : Machine
    title : str
    """
    home = machine.home()
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
        rotation=home.rotation,
        closed_form=machine.place,
    )
