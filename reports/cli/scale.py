"""`strutwork scale`: how forces, stiffness and frequencies change with the size of a machine."""

from __future__ import annotations

from collections.abc import Callable

from strutwork.errors import ModelError
from strutwork.machines.catalogue import CATALOGUE
from strutwork.machines.paper_reference import resolve


def is_studied(machine: str) -> bool:
    """Whether a paper has a study of this machine's size."""
    return machine in CATALOGUE and bool(CATALOGUE[machine].scale)


def study_of(machine: str) -> Callable[..., None]:
    """What computes and prints the study of a machine's size, given the command's words.

    Raises
    ------
    ModelError
        Nobody has studied it.
    """
    studied = {name: entry.scale for name, entry in CATALOGUE.items() if entry.scale}
    if machine not in studied:
        raise ModelError(
            f"scale of {machine}",
            "is unknown: no study of its size exists.",
            "Machines: " + ", ".join(studied) + ".",
        )
    made: Callable[..., None] = resolve(studied[machine])
    return made
