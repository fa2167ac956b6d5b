"""Machines of the catalogue whose tolerances are known, at the poses they are studied at."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import degrees
from types import MappingProxyType

import numpy as np

from strutwork.errors import ModelError
from strutwork.machines import CATALOGUE, MitSS1
from strutwork.machines.mit_ss1_tolerances import (
    bearing_limits,
    machine_bearings,
    mit_ss1_tolerances,
)
from strutwork.msa.structure import PlacedStructure
from strutwork.overconstraint import Limits, Quantity, Tolerance
from strutwork.studies.assembly_map import bearing_quantities, nominal_grid


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


def mit_ss1() -> TolerancedMachine:
    """The MIT-SS-1 over its nominal workspace: pins, rails, and the ratings of its bearings."""
    machine = MitSS1()
    x, tilt = (np.append(0.0, values) for values in nominal_grid())
    placement = machine.place(machine.poses(x, 0.0, tilt))
    kept = np.flatnonzero(placement.reachable)
    return TolerancedMachine(
        CATALOGUE["mit-ss1"].title,
        machine.structure.at(placement[kept]),
        tuple(
            "home" if i == 0 else f"x = {1e3 * x[i]:g} mm, b = {degrees(tilt[i]):g}°" for i in kept
        ),
        mit_ss1_tolerances(),
        bearing_limits(machine_bearings(machine)),
        bearing_quantities(machine),
        (
            "The stiffness of the bearings is calibrated, see `MitSS1`.",
            "The tolerances of housing and rails are our choice or read from the thesis's text.",
            "The static rating of the bearings is our assumption: the thesis prints none.",
        ),
    )


#: Machines with tolerances, by the catalogue's name.
TOLERANCED: Mapping[str, Callable[[], TolerancedMachine]] = MappingProxyType({"mit-ss1": mit_ss1})


def toleranced_machine(name: str) -> TolerancedMachine:
    """A machine of the catalogue with its tolerances.

    Raises
    ------
    ModelError
        A machine whose tolerances nobody has stated.
    """
    if name not in TOLERANCED:
        raise ModelError(
            f"tolerances of {name}",
            "are not known: its paper states none.",
            f"Machines with tolerances: {', '.join(TOLERANCED)}; or write a model file.",
        )
    return TOLERANCED[name]()
