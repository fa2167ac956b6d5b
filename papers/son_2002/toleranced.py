"""The MIT-SS-1 with its tolerances."""

from __future__ import annotations

from math import degrees

import numpy as np

from strutwork.machines import CATALOGUE, MitSS1
from strutwork.papers.son_2002.assembly_map import bearing_quantities, nominal_grid
from strutwork.papers.son_2002.tolerances import (
    bearing_limits,
    machine_bearings,
    mit_ss1_tolerances,
)
from strutwork.studies.toleranced_machine import TolerancedMachine


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
            "The tolerances of housing and rails are assumed or taken from the thesis's text.",
            "The static rating of the bearings is an assumption: the thesis prints none.",
        ),
    )
