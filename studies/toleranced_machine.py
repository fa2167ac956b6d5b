"""Machines of the catalogue whose tolerances are known, at the poses they are studied at."""

from __future__ import annotations

from dataclasses import dataclass

from strutwork.errors import ModelError
from strutwork.machines.catalogue import CATALOGUE, get
from strutwork.machines.paper_reference import resolve
from strutwork.msa.structure import PlacedStructure
from strutwork.overconstraint import Limits, Quantity, Tolerance


@dataclass(frozen=True)
class TolerancedMachine:
    """A machine at a batch of poses, with its tolerances.

    Parameters
    ----------
    title : str
    placed : PlacedStructure
        Batch (p); reachable poses only, home first.
    poses : tuple of str
        A label for each.
    tolerances : tuple of Tolerance
    limits : mapping of (joint, kind) to float
        N and N·m.
    quantities : tuple of Quantity
        What is asked.
    notes : tuple of str
        What is assumed.
    """

    title: str
    placed: PlacedStructure
    poses: tuple[str, ...]
    tolerances: tuple[Tolerance, ...]
    limits: Limits
    quantities: tuple[Quantity, ...]
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        return (
            f"<TolerancedMachine {self.title!r}: {len(self.tolerances)} tolerances, "
            f"{len(self.poses)} poses>"
        )


def toleranced_machine(name: str) -> TolerancedMachine:
    """A machine of the catalogue with its tolerances.

    Parameters
    ----------
    name : str
        In the catalogue.

    Raises
    ------
    ModelError
        An unknown machine, or one whose tolerances nobody has stated.
    """
    entry = get(name)
    if not entry.tolerances:
        known = (e.name for e in CATALOGUE.values() if e.tolerances)
        raise ModelError(
            f"tolerances of {name}",
            "are not known: its paper states none.",
            f"Machines with tolerances: {', '.join(known)}; or write a model file.",
        )
    made: TolerancedMachine = resolve(entry.tolerances)()
    return made
