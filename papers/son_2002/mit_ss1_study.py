"""What the report of the MIT-SS-1 needs to know."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees
from types import MappingProxyType

import xarray as xr

from strutwork.machines import MitSS1
from strutwork.overconstraint import Allocation, allocate
from strutwork.papers.published_rows import PublishedRow
from strutwork.papers.son_2002.assembly_map import (
    DesignForces,
    assembly_map,
    compare_designs,
)
from strutwork.papers.son_2002.assembly_scale import AssemblyScale, assembly_scale
from strutwork.papers.son_2002.assembly_table import (
    SETS,
    AssemblyCalibration,
    Set,
    calibrate_assembly,
    table_2_rows,
)
from strutwork.papers.son_2002.planar_kinematics import SINGULAR_X, planar_kinematics, singular_tilt
from strutwork.papers.son_2002.size import mit_ss1_scale
from strutwork.papers.son_2002.strut_assembly import CASES, StrutAssembly
from strutwork.papers.son_2002.tolerances import bearing_limits, table_2_joints, table_2_tolerances
from strutwork.papers.son_2002.whole_study import WholeStudy, study_whole
from strutwork.studies.progress import Teller, silent
from strutwork.studies.scale import ScaleStudy
from strutwork.studies.tolerance_result import ToleranceStudy
from strutwork.studies.tolerance_study import tolerance_study
from strutwork.studies.toleranced_machine import TolerancedMachine, toleranced_machine

NAME = "mit-ss1"

#: Objectives of the allocation, in words.
OBJECTIVES: Mapping[str, str] = MappingProxyType(
    {"uniform": "all by one factor", "cost": "cheapest, cost of each one over its size"}
)


@dataclass(frozen=True)
class MitSS1Study:
    """Everything that is computed for the report of the MIT-SS-1.

    Parameters
    ----------
    machine : MitSS1
    kinematics : Dataset
        Of `planar_kinematics`.
    singular : mapping of x to tilt
        m and rad.
    cases : mapping of numeral to ToleranceStudy
        Cases of Table 2, with limits of the bearings.
    table_2 : mapping of set to rows
    calibrations : tuple of AssemblyCalibration
        The fits made afresh: on Case I alone, and on all cases.
    scale : AssemblyScale
    designs : tuple of DesignForces
    toleranced : TolerancedMachine
    own : ToleranceStudy
        The machine with its own tolerances over its workspace.
    forces : Dataset
        Of `assembly_map`.
    allocations : mapping of objective to Allocation
        Of the machine's tolerances, at all poses.
    case_allocations : mapping of numeral to Allocation
        Of Table 2's, all by one factor.
    whole : WholeStudy
        The machine on its granite.
    moving_size, whole_size : ScaleStudy
        Stiffness and frequencies against size, rails held and on the granite.
    """

    machine: MitSS1
    kinematics: xr.Dataset
    singular: Mapping[float, float]
    cases: Mapping[str, ToleranceStudy]
    table_2: Mapping[Set, tuple[PublishedRow, ...]]
    calibrations: tuple[AssemblyCalibration, ...]
    scale: AssemblyScale
    designs: tuple[DesignForces, ...]
    toleranced: TolerancedMachine
    own: ToleranceStudy
    forces: xr.Dataset
    allocations: Mapping[str, Allocation]
    case_allocations: Mapping[str, Allocation]
    whole: WholeStudy
    moving_size: ScaleStudy
    whole_size: ScaleStudy

    def __repr__(self) -> str:
        return f"<MitSS1Study: {len(self.cases)} cases of Table 2, {self.own!r}>"


def study_mit_ss1(progress: Teller | None = None) -> MitSS1Study:
    """Compute everything that the report shows."""
    machine = MitSS1()
    tell: Teller = progress or (lambda _: silent)
    cases = {numeral: _case(numeral, tell) for numeral in CASES}
    whole = study_whole(progress)
    sizes = tell("stiffness and frequencies against size")
    moving_size = mit_ss1_scale()
    sizes(1, 2)
    whole_size = mit_ss1_scale(granite=True)
    sizes(2, 2)
    toleranced = toleranced_machine(NAME)
    own = tolerance_study(
        toleranced.placed,
        toleranced.tolerances,
        toleranced.limits,
        title=toleranced.title,
        poses=toleranced.poses,
        quantities=toleranced.quantities,
        progress=lambda part: tell(f"assembly forces of the machine, {part}"),
    )
    found = {x: singular_tilt(machine, x) for x in SINGULAR_X}
    return MitSS1Study(
        machine,
        planar_kinematics(machine),
        {x: b for x, b in found.items() if b is not None},
        cases,
        {which: table_2_rows(which) for which in SETS},
        (calibrate_assembly(("I",)), calibrate_assembly()),
        assembly_scale(),
        compare_designs(machine),
        toleranced,
        own,
        assembly_map(machine, progress=tell("assembly forces over the workspace")),
        {
            objective: allocate(own.responses, own.limits, objective=objective)
            for objective in OBJECTIVES
        },
        {
            numeral: allocate(s.responses, s.limits, objective="uniform")
            for numeral, s in cases.items()
        },
        whole,
        moving_size,
        whole_size,
    )


def _case(numeral: str, tell: Teller) -> ToleranceStudy:
    """A case of Table 2 with the limits of the machine's bearings."""
    assembly = StrutAssembly.case(numeral)
    return tolerance_study(
        assembly.structure.at(assembly.placement()),
        table_2_tolerances(),
        bearing_limits(table_2_joints()),
        title=f"Table 2, case {numeral}",
        progress=lambda part: tell(f"Table 2, case {numeral}, {part}"),
    )


def degrees_text(angle: float) -> str:
    """An angle in degrees with one decimal."""
    return f"{degrees(angle):.1f}°".replace("-", "\N{MINUS SIGN}")
