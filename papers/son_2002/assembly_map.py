"""Worst-case assembly forces of the MIT-SS-1 over its workspace, and of the designs of Fig. 39."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.machines import MitSS1
from strutwork.machines.mit_ss1 import NOMINAL_TILT, NOMINAL_X
from strutwork.overconstraint import (
    Quantity,
    Tolerance,
    WorstCase,
    joint_quantities,
    tolerance_responses,
    tool_quantities,
    worst_case,
)
from strutwork.papers.son_2002.designs import DESIGNS, Design, design_tolerances, placed_design
from strutwork.papers.son_2002.tolerances import (
    machine_bearings,
    mit_ss1_tolerances,
    pin_tolerances,
)
from strutwork.studies.progress import Progress, silent

Array = NDArray[Any]

#: Kinds of force that a bearing of the machine carries.
FORCES = ("radial force", "axial force")

#: Poses solved in one stack.
CHUNK = 64

#: Positions along x and tilts that stand for the nominal workspace, m and rad.
ALONG = np.round(np.linspace(*NOMINAL_X, 11), 12)
TILTS = np.linspace(-NOMINAL_TILT, NOMINAL_TILT, 13)


def nominal_grid() -> tuple[Array, Array]:
    """Every pair of them: x in m and b in rad, (143,) each."""
    x, b = np.meshgrid(ALONG, TILTS, indexing="ij")
    return x.ravel(), b.ravel()


def bearing_quantities(machine: MitSS1) -> tuple[Quantity, ...]:
    """Radial and axial force of every bearing, then the tool's displacements and rotations."""
    bearings = set(machine_bearings(machine))
    forces = (q for q in joint_quantities(machine.linkage) if q.joint in bearings)
    return (*forces, *tool_quantities())


def machine_worst_case(
    machine: MitSS1 | None = None, tolerances: Sequence[Tolerance] | None = None
) -> WorstCase:
    """Worst case of the machine at home.

    Parameters
    ----------
    machine : MitSS1, optional
    tolerances : sequence of Tolerance, optional
        Default: `strutwork.papers.son_2002.tolerances`.
    """
    machine = machine or MitSS1()
    placed = machine.structure.at(machine.place(machine.home()))
    chosen = mit_ss1_tolerances() if tolerances is None else tolerances
    return worst_case(tolerance_responses(placed, chosen, bearing_quantities(machine)))


def assembly_map(
    machine: MitSS1 | None = None,
    tolerances: Sequence[Tolerance] | None = None,
    *,
    x: ArrayLike | None = None,
    b: ArrayLike | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Worst-case forces of the bearings and places of the tool over x and tilt.

    Height moves the whole plane along its guides and changes nothing.

    Parameters
    ----------
    machine : MitSS1, optional
    tolerances : sequence of Tolerance, optional
        Default: `strutwork.papers.son_2002.tolerances`.
    x, b : (n,), (m,), optional
        m and rad; default the nominal workspace.
    progress : callable

    Returns
    -------
    Dataset
        force (x, b, force, bearing) in N and tool (x, b, direction) in m and rad; not a number
        at poses out of reach.

    Raises
    ------
    ModelError
        No pose can be taken.
    """
    machine = machine or MitSS1()
    chosen = mit_ss1_tolerances() if tolerances is None else tolerances
    along = ALONG if x is None else np.asarray(x, dtype=float)
    tilts = TILTS if b is None else np.asarray(b, dtype=float)
    grid = np.meshgrid(along, tilts, indexing="ij")
    placement = machine.place(machine.poses(grid[0].ravel(), 0.0, grid[1].ravel()))
    good = np.flatnonzero(placement.reachable)
    if not good.size:
        raise ModelError("assembly map", "no pose can be reached.", "Choose other x and tilts.")
    quantities = bearing_quantities(machine)
    found = np.full((grid[0].size, len(quantities)), np.nan)
    for start in range(0, good.size, CHUNK):
        some = good[start : start + CHUNK]
        placed = machine.structure.at(placement[some])
        found[some] = worst_case(tolerance_responses(placed, chosen, quantities)).value
        progress(min(start + CHUNK, good.size), int(good.size))
    bearings = machine_bearings(machine)
    number = len(bearings) * len(FORCES)
    shape = (*grid[0].shape, len(bearings), len(FORCES))
    forces = np.swapaxes(found[:, :number].reshape(shape), -1, -2)
    return xr.Dataset(
        {
            "force": (("x", "b", "force_kind", "bearing"), forces, {"units": "N"}),
            "tool": (
                ("x", "b", "direction"),
                found[:, number:].reshape(*grid[0].shape, -1),
                {"component_units": "m; rad"},
            ),
        },
        coords={
            "x": ("x", along, {"units": "m"}),
            "b": ("b", tilts, {"units": "rad"}),
            "force_kind": list(FORCES),
            "bearing": list(bearings),
            "direction": [q.directions[0] for q in quantities[number:]],
        },
        attrs={"tolerances": [t.name for t in chosen]},
    )


@dataclass(frozen=True)
class DesignForces:
    """Worst-case forces of one design of Fig. 39, the largest over the bearings.

    Parameters
    ----------
    design : Design
    rails : mapping of kind to float
        From the places of the rails and their datum surfaces alone, N.
    everything : mapping of kind to float
        With the pins' parallelism, N.
    tool : (6,)
        Worst displacement and rotation of the tool from the rails alone, m and rad.
    """

    design: Design
    rails: Mapping[str, float]
    everything: Mapping[str, float]
    tool: Array

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, SI."""
        return {
            "design": self.design.letter,
            "title": self.design.title,
            "datums": [list(rails) for rails in self.design.datums],
            "rails": dict(self.rails),
            "rails_and_pins": dict(self.everything),
            "tool": self.tool.tolist(),
        }


def compare_designs(machine: MitSS1 | None = None) -> tuple[DesignForces, ...]:
    """The three designs with the same structure at home.

    Parameters
    ----------
    machine : MitSS1, optional

    Returns
    -------
    tuple of DesignForces
    """
    machine = machine or MitSS1()
    quantities = bearing_quantities(machine)
    result = []
    for design in DESIGNS.values():
        placed = placed_design(design, machine)
        rails = design_tolerances(design, machine)
        each = [
            worst_case(tolerance_responses(placed, some, quantities)).value
            for some in (rails, (*rails, *pin_tolerances()))
        ]
        largest = [
            MappingProxyType(
                {
                    kind: max(
                        float(v) for q, v in zip(quantities, value, strict=True) if q.kind == kind
                    )
                    for kind in FORCES
                }
            )
            for value in each
        ]
        result.append(DesignForces(design, largest[0], largest[1], each[0][-6:]))
    return tuple(result)
