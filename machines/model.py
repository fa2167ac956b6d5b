"""A machine as data: its structure in one configuration, how it moves, what acts on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, ModelWarning
from strutwork.kinematics.motion import Motion

if TYPE_CHECKING:
    # a file without solids, shapes or tolerances does not wait for what computes with them
    from strutwork.flexures import Flexure
    from strutwork.kinematics import Placement, Poses
    from strutwork.kinematics.mesh_shapes import MeshShape
    from strutwork.kinematics.task_grid import TaskGrid
    from strutwork.machines.bearing_entry import BearingEntry
    from strutwork.machines.described_process import DescribedProcess
    from strutwork.machines.drives import Drive
    from strutwork.machines.limits import Limit
    from strutwork.machines.model_solid_element import SolidElement
    from strutwork.machines.servos import Servo
    from strutwork.msa import LoadCase, PlacedStructure, Structure
    from strutwork.overconstraint.tolerance import Tolerance

__all__ = ["Damping", "Model", "ModelWarning"]

Array = NDArray[Any]


@dataclass(frozen=True)
class Damping:
    """Damping of a whole structure; one of the three is not None.

    Parameters
    ----------
    modal_ratio : float or None
        Viscous ratio ζ of every mode, no unit.
    loss_factor : float or None
        Structural loss factor η, no unit; at resonance η = 2 ζ.
    rayleigh : (float, float) or None
        α in 1/s and β in s of C = α M + β K.
    """

    modal_ratio: float | None = None
    loss_factor: float | None = None
    rayleigh: tuple[float, float] | None = None


@dataclass(frozen=True)
class Model:
    """A structure in one configuration, with its load cases.

    Parameters
    ----------
    title : str
    structure : Structure
        Its linkage has, beside the nodes and joints of the file, one ground node and one joint
        for every supported node.
    placement : Placement
        One pose, no batch axes.
    cases : tuple of LoadCase
        In the order in which the file names them; gravity first.
    nodes : tuple of str
        The nodes of the file.
    joints : tuple of str
        The joints of the file.
    supports : mapping of node to joint name
        The joint that holds each supported node to the ground.
    damping : Damping or None
    tolerances : tuple of Tolerance
    tolerance_costs : mapping of tolerance name to float
        Weights of an allocation, any unit.
    force_limits : mapping of (joint name, kind of quantity) to float
        Greatest forces and moments that joints may bear, N and N·m.
    preload : str or None
        The load case under which the structure vibrates.
    limits : tuple of Limit
        Ranges of joint coordinates.
    task : tuple of str
        Directions in which the tool is to move; empty where nobody says.
    workspace : TaskGrid or None
        Poses that maps and reports look at.
    drives : tuple of Drive
        What the drives can do.
    servos : tuple of Servo
        The drives' controllers.
    rotation : (3, 3)
        Rotation matrix of the tool in this placement.
    closed_form : callable or None
        Placement at poses of the tool, where the machine has formulas for it.
    solids : tuple of SolidElement
        Its elements that are solids. Their monitors, nodes inside a solid, are nodes of the
        linkage and none of the file.
    shapes : tuple of MeshShape
        Of bodies, for interference.
    process : DescribedProcess or None
        The cut whose stability is reported.
    flexures : mapping of joint name to Flexure
        Of joints that are flexures; their stiffness is in the structure.
    bearings : mapping of joint to BearingEntry
        Of the joints whose stiffness a catalogue states; the structure has that of their preload.
    """

    title: str
    structure: Structure
    placement: Placement
    cases: tuple[LoadCase, ...]
    nodes: tuple[str, ...]
    joints: tuple[str, ...]
    supports: Mapping[str, str]
    damping: Damping | None = None
    tolerances: tuple[Tolerance, ...] = ()
    tolerance_costs: Mapping[str, float] = field(default_factory=dict)
    force_limits: Mapping[tuple[str, str], float] = field(default_factory=dict)
    solids: tuple[SolidElement, ...] = ()
    preload: str | None = None
    limits: tuple[Limit, ...] = ()
    task: tuple[str, ...] = ()
    workspace: TaskGrid | None = None
    drives: tuple[Drive, ...] = ()
    rotation: Array = field(default_factory=lambda: np.eye(3))
    closed_form: Callable[[Poses], Placement] | None = None
    shapes: tuple[MeshShape, ...] = ()
    process: DescribedProcess | None = None
    servos: tuple[Servo, ...] = ()
    flexures: Mapping[str, Flexure] = field(default_factory=dict)
    bearings: Mapping[str, BearingEntry] = field(default_factory=dict)

    def __repr__(self) -> str:
        kind = type(self).__name__
        return f"<{kind} {self.title!r}: {self.structure!r}, {len(self.cases)} load cases>"

    @property
    def tool(self) -> str | None:
        """Node of the tool centre point."""
        return self.structure.linkage.tool

    @property
    def relative(self) -> str:
        """Words behind the tool: " relative to NODE" where the file names a workpiece."""
        return self.structure.linkage.relative_to

    def require_tool(self) -> str:
        """Node of the tool centre point.

        Raises
        ------
        ModelError
            The file has no [tool].
        """
        if self.tool is None:
            raise ModelError("tool", "is missing.", 'Add a table [tool] with tcp = "NODE".')
        return self.tool

    @cached_property
    def motion(self) -> Motion:
        """How it moves, from this placement.

        Raises
        ------
        ModelError
            Its joints do not close, or one slides along a solid.
        """
        motion = Motion(self.structure.linkage, self.placement, self.rotation)
        tied = {node: solid.name for solid in self.solids for node in solid.nodes}
        for joint, slides in zip(self.structure.linkage.joints, motion.joints.sliding, strict=True):
            if slides and joint.between[0] in tied:
                raise ModelError(
                    f"joint {joint.name}",
                    f'slides on node "{joint.between[0]}", which is tied to the solid '
                    f"{tied[joint.between[0]]}: its patch cannot follow.",
                    "Put a rigid body between: one node tied to the solid, another that slides.",
                )
        return motion

    @cached_property
    def placed(self) -> PlacedStructure:
        """The structure at its placement."""
        return self.structure.at(self.placement)

    def case(self, name: str) -> LoadCase:
        """A load case by its name.

        Parameters
        ----------
        name : str

        Raises
        ------
        ModelError
            There is none.
        """
        for case in self.cases:
            if case.name == name:
                return case
        raise ModelError(
            "preload",
            f'names the unknown load case "{name}".',
            "Cases: " + ", ".join(case.name for case in self.cases) + "."
            if self.cases
            else "The model has no load case: add [[loads]] or gravity.",
        )

    @cached_property
    def vibrating(self) -> PlacedStructure:
        """The structure as it vibrates: under its preload, where it names one.

        Bearings with contacts then have the tangent at their load of this case.

        Raises
        ------
        StrutworkError
            The preload cannot be solved.
        """
        if self.preload is None:
            return self.placed
        # vibration has its libraries: a check of mobility needs none of them
        from strutwork.fea.preload import preloaded

        case = self.case(self.preload)
        if not self.bearings:
            return preloaded(self.placed, case)
        from strutwork.machines.bearing_equilibrium import equilibrium

        found = equilibrium(self, case)
        return replace(found.tangent, stiffening=preloaded(found.secant, case).stiffening)
