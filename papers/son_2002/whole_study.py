"""What the report of the MIT-SS-1 needs to know about the entire machine on its granite."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees
from types import MappingProxyType
from typing import Any, get_args

import numpy as np
import xarray as xr

from strutwork.machines.mit_ss1 import NOMINAL_TILT
from strutwork.machines.mit_ss1_whole import MitSS1Whole
from strutwork.msa import tool_compliance
from strutwork.msa.mass import mass_properties
from strutwork.papers.published_rows import PublishedRow
from strutwork.papers.son_2002.calibrated import Which, calibrated_machine
from strutwork.papers.son_2002.calibration import Part, stored_calibration
from strutwork.papers.son_2002.modes import SCREW, NamedModes, mode_rows, named_modes
from strutwork.papers.son_2002.planar_stiffness import REACH, planar_stiffness_map
from strutwork.papers.son_2002.tilt import posture_frequencies
from strutwork.reports.vibration_study import VibrationStudy, study_machine_vibration
from strutwork.studies.calibrate import Calibration
from strutwork.studies.progress import Teller, silent
from strutwork.studies.variables import AXES, named

#: Hz; the reduced granite holds to 400 Hz.
BAND = (5.0, 400.0)

#: Hz; without the rigid-body modes on the mounts.
ELASTIC = (100.0, 400.0)

#: Where the postures are taken, m; at the far corners the tilt parts into several modes.
POSTURES = (-0.03, 0.0, 0.03)

#: The sets of calibrated constants, in the words of the page.
SETS: Mapping[Which, str] = MappingProxyType(
    {
        "numerical": "as the thesis's finite element model",
        "measured": "as measured: softer bearings on the preloading side",
        "ball screw": "as measured, drives elastic",
    }
)


@dataclass(frozen=True)
class WholeStudy:
    """The machine on its granite: modes, responses, stiffness, calibration.

    Parameters
    ----------
    named : mapping of set to NamedModes
        At home.
    rows : tuple of PublishedRow
        Published frequencies beside the computed values.
    postures : Dataset
        Of `posture_frequencies`.
    stiffness : Dataset
        Of `calibrated_stiffness`, and the thesis's planar map.
    planar : Dataset
        Of `planar_stiffness_map`.
    vibration, beyond_mounts : VibrationStudy
        At home, damping assumed; in `BAND` and in `ELASTIC`.
    calibrations : mapping of part to Calibration
        The stored constants and what the targets determine of them.
    masses : mapping of str to float
        kg.
    """

    named: Mapping[Which, NamedModes]
    rows: tuple[PublishedRow, ...]
    postures: xr.Dataset
    stiffness: xr.Dataset
    planar: xr.Dataset
    vibration: VibrationStudy
    beyond_mounts: VibrationStudy
    calibrations: Mapping[Part, Calibration]
    masses: Mapping[str, float]

    def __repr__(self) -> str:
        return f"<WholeStudy: {self.named['numerical']!r}>"

    @property
    def whole(self) -> MitSS1Whole:
        """The machine of the thesis's finite element model."""
        return self.named["numerical"].whole

    @property
    def shown(self) -> dict[str, tuple[Which, str]]:
        """Set and name of every mode that the page draws, by its label, lowest first."""
        found: dict[str, tuple[Which, str]] = {
            f"{name.capitalize()}, {frequency:.1f} Hz": ("numerical", name)
            for name, frequency in self.named["numerical"].frequencies.items()
        }
        screw = self.named["ball screw"].frequencies[SCREW]
        found[f"Ball screw, {screw:.1f} Hz, drives elastic"] = ("ball screw", SCREW)
        return found

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI."""
        return {
            "masses": dict(self.masses),
            "modes": {which: found.to_dict() for which, found in self.named.items()},
            "vibration": self.vibration.to_dict(),
            "minima_beyond_mounts": self.beyond_mounts.to_dict()["minima"],
        }


def study_whole(progress: Teller | None = None) -> WholeStudy:
    """Compute everything that the report shows of the entire machine."""
    tell: Teller = progress or (lambda _: silent)
    done, steps = tell("the entire machine: granite, modes, responses"), 6
    done(0, steps)
    named_ = {which: named_modes(calibrated_machine(which)) for which in get_args(Which)}
    whole = named_["numerical"].whole
    done(1, steps)
    rows = mode_rows()
    done(2, steps)
    postures = posture_frequencies(whole, POSTURES, np.linspace(-NOMINAL_TILT, NOMINAL_TILT, 13))
    done(3, steps)
    vibration, beyond = (
        study_machine_vibration(key, "MIT-SS-1 on its granite", whole, band=band)
        for key, band in (("whole-machine", BAND), ("whole-machine-beyond-mounts", ELASTIC))
    )
    done(4, steps)
    stiffness = calibrated_stiffness(whole)
    planar = planar_stiffness_map()
    done(5, steps)
    placed = named_["numerical"].modes.placed
    machine = whole.machine
    masses = {
        "whole": float(mass_properties(placed).total),
        "moving": float(mass_properties(machine.structure.at(machine.place(machine.home()))).total),
    }
    done(6, steps)
    parts, calibrations = get_args(Part), {}
    told = tell("calibration: what the data determine")
    for i, part in enumerate(parts):
        told(i, len(parts))
        calibrations[part] = stored_calibration(part)
    told(len(parts), len(parts))
    return WholeStudy(
        MappingProxyType(named_),
        rows,
        postures,
        stiffness,
        planar,
        vibration,
        beyond,
        MappingProxyType(calibrations),
        MappingProxyType(masses),
    )


def calibrated_stiffness(whole: MitSS1Whole, count: int = 13) -> xr.Dataset:
    """Stiffness 1/C_ii at the tool over x and tilt, the rails held and on the granite.

    Parameters
    ----------
    whole : MitSS1Whole
    count : int
        Places along x, and tilts.

    Returns
    -------
    Dataset
        stiffness (base, x, b, direction), N/m; the base is "rails held" or "on the granite",
        to the floor.
    """
    x, b = np.linspace(-REACH, REACH, count), np.linspace(-NOMINAL_TILT, NOMINAL_TILT, count)
    grid = np.meshgrid(x, b, indexing="ij")
    values = []
    for machine in (whole.machine, whole):
        placement = machine.place(machine.poses(grid[0], 0.0, grid[1]))
        found = np.full((*grid[0].shape, 3), np.nan)
        kept = placement.reachable
        compliance = tool_compliance(machine.structure.at(placement[kept]))
        found[kept] = 1.0 / np.einsum("...ii->...i", compliance)[..., :3]
        values.append(found)
    return xr.Dataset(
        {
            "stiffness": named(
                ("base", "x", "b", "direction"),
                np.array(values),
                "N/m",
                "stiffness at the tool tip, other directions free",
            )
        },
        coords={
            "base": ["rails held", "on the granite"],
            "x": named("x", x, "m", "place of the tool tip along x"),
            "b": named("b", b, "rad", "tilt of the tool about y"),
            "direction": list(AXES),
        },
        attrs={"title": f"MIT-SS-1, calibrated bearings, tilts to {degrees(NOMINAL_TILT):g} deg"},
    )
