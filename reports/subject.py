"""What a report is about: a machine, and its answers, each found when a chapter first asks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError, StrutworkError
from strutwork.fea.coupled import AnyDamping
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.inscribed_shape import box_of
from strutwork.kinematics.largest_shape import LargestShape, largest_shape
from strutwork.kinematics.singularity_curves import SingularPlane, singularities_in_plane
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.kinematics.task_surfaces import Plane
from strutwork.machines.model import Model
from strutwork.machines.singular_sections import PoseDistance, pose_distance, section_family
from strutwork.names import visible
from strutwork.reports.answers import Source, answer
from strutwork.reports.chapters.overconstraint_model import ModelTolerances, study_model_tolerances
from strutwork.reports.cut_study import CutStudy, study_cut
from strutwork.reports.found_changes import found_changes
from strutwork.reports.model_check import ModelCheck, check_model
from strutwork.reports.model_solution import ModelSolution, solve_model
from strutwork.reports.vibration_study import VibrationStudy, has_mass, study_model_vibration
from strutwork.studies.accuracy_answer import VolumetricAccuracy, drive_errors
from strutwork.studies.answers import Assembly, Stiffness, Vibration
from strutwork.studies.machine_modes import MachineModes, machine_modes
from strutwork.studies.model_damping import model_damping
from strutwork.studies.progress import Progress, silent
from strutwork.studies.reversal_study import ReversalStudy, reversal_study
from strutwork.studies.stability_answer import Stability
from strutwork.studies.standard_motion import StandardMotion, standard_motion
from strutwork.studies.survey import survey
from strutwork.studies.workspace import Workspace, workspace
from strutwork.studies.workspace_margin import MachineMargin, interference_of

Array = NDArray[Any]

Teller = Callable[[str], Progress]

#: Frequencies that the vibration over the workspace lists.
LISTED = 3

#: The workspace is looked for in so many times the ranges that are stated, with so many points
#: along each of one, two and three directions.
SPREAD = 2.0
SIZED = {1: 81, 2: 31, 3: 13}

#: Of the size of the largest box in the workspace, as a share of it.
BOX_ACCURACY = 1e-3

#: Poses along either direction of the plane in which singular poses are looked for.
SINGULAR_STEPS = 21

#: Points along either direction of the plane in which reversals are looked for.
REVERSAL_STEPS = 15


@dataclass(frozen=True)
class Subject:
    """A machine and its lazily found results.

    Parameters
    ----------
    model : Model
    name : str
        As the report was asked for.
    stem : str
        For a title, where the model has none.
    progress : callable, optional
        Given the name of a part of the work, returns what is told how far it is.
    source : Source, optional
        Where its answers come from; without one each is found where it is asked for.
    file : Path, optional
        The model file that it was read from.
    errors : Path, optional
        An errors file.
    """

    model: Model
    name: str
    stem: str
    progress: Teller | None = None
    source: Source | None = field(default=None, repr=False, compare=False)
    file: Path | None = None
    errors: Path | None = None

    def __repr__(self) -> str:
        return f"<Subject {self.name}: {self.model!r}>"

    @property
    def title(self) -> str:
        """Of the page."""
        return visible(self.model.title or self.stem, lines=True)

    @answer
    def check(self) -> ModelCheck:
        """Mobility, redundancy, mass."""
        return check_model(self.model)

    @answer
    def solution(self) -> ModelSolution | None:
        """Load cases and the tool at home; None where there is neither."""
        asked = self.model.cases or self.model.tool is not None
        return solve_model(self.model) if asked else None

    @answer
    def tolerances(self) -> ModelTolerances:
        """Assembly forces at home."""
        return study_model_tolerances(self.model)

    @property
    def vibrates(self) -> bool:
        """Whether it has mass and damping."""
        return self.model.damping is not None and has_mass(self.model)

    @answer
    def vibration(self) -> VibrationStudy:
        """Modes and responses at home."""
        return study_model_vibration(self.model, "vibration")

    @property
    def grid(self) -> TaskGrid:
        """Its workspace.

        Raises
        ------
        ModelError
            None is given.
        """
        if self.model.workspace is None:
            raise ModelError("workspace", "is not given.", "Add a table [workspace].")
        return self.model.workspace

    @cached_property
    def unmoved(self) -> str:
        """Why there is nothing over a workspace; empty where there is."""
        if self.model.tool is None:
            return "it has no tool: add [tool] with tcp"
        if self.model.workspace is None:
            return "the file names no poses to look at: add [workspace] with ranges of the tool"
        return self._reason(lambda: self.stiffness_survey)

    @answer
    def stiffness_survey(self) -> xr.Dataset:
        """Static stiffness over the workspace."""
        return survey(
            self.model,
            self.grid,
            [Stiffness()],
            progress=self._told("stiffness over the workspace"),
        )

    @answer
    def first_changes(self) -> tuple[xr.Dataset, ...]:
        """Gradients of the least stiffness along each axis, each at its pose; none without paths.

        A machine that was moved since it was read has none: its file describes it elsewhere.
        """
        named = str(self.file) if self.file is not None else self.name
        return found_changes(self.model, named, self.stiffness_survey)

    @property
    def damping(self) -> AnyDamping | None:
        """Its damping, dashpots of joints among it; None where none of the whole is given."""
        return None if self.model.damping is None else model_damping(self.model)

    @answer
    def vibration_survey(self) -> xr.Dataset:
        """Frequencies and least dynamic stiffness over the workspace, under its preload."""
        model, damping = self.model, self.damping
        if damping is None:
            raise ModelError("damping", "is missing.", "Add [damping].")
        preload = None if model.preload is None else model.case(model.preload)
        band = self.vibration.band
        answer = Vibration(model.require_tool(), damping, band, LISTED, preload)
        return survey(
            self.model, self.grid, [answer], progress=self._told("vibration over the workspace")
        )

    @property
    def cannot_cut(self) -> str:
        """What the stability of a cut lacks; empty where there is all."""
        process = self.model.process
        if process is None:
            return "no cut is given: add [process], or give --process"
        if self.model.tool is None:
            return "it has no tool: add [tool] with tcp"
        damped = self.damping is not None or process.modal_ratio is not None
        if not (damped and has_mass(self.model)):
            return "it needs mass and damping: add densities and [damping]"
        return ""

    @cached_property
    def unstable(self) -> str:
        """Why nothing is said of the stability of a cut; empty where something is."""
        return self.cannot_cut or self._reason(lambda: self.cut)

    @answer
    def cut(self) -> CutStudy:
        """Stability of its cut at home."""
        return study_cut(self.model)

    @answer
    def stability_survey(self) -> xr.Dataset:
        """Limiting depths over the workspace."""
        told = self._told("stability over the workspace")
        return survey(self.model, self.grid, [Stability.of(self.model)], progress=told)

    @answer
    def assembly_survey(self) -> xr.Dataset:
        """Worst case of assembly forces over the workspace."""
        return survey(
            self.model,
            self.grid,
            [Assembly.of(self.model)],
            progress=self._told("assembly forces over the workspace"),
        )

    @cached_property
    def accuracy_answer(self) -> VolumetricAccuracy:
        """What displaces its tool: tolerances, and half the resolution of its drives."""
        return VolumetricAccuracy(self.model.tolerances, drive_errors(self.model))

    @answer
    def accuracy_survey(self) -> xr.Dataset:
        """Displacement of the tool over the workspace."""
        return survey(
            self.model,
            self.grid,
            [self.accuracy_answer],
            progress=self._told("accuracy over the workspace"),
        )

    @cached_property
    def unsingular(self) -> str:
        """Why singularities are not looked for; empty where they are."""
        return self._reason(lambda: (self.singular_distance, self.singular_plane))

    @answer
    def singular_distance(self) -> PoseDistance:
        """Distance from singularities at home."""
        return pose_distance(self.model)

    @answer
    def singular_plane(self) -> SingularPlane | None:
        """Singular poses over two directions of the workspace; None without them.

        The first two, or the first and a later one where over them the distance does not change.
        """
        wide = tuple(self.wide_directions)
        if len(wide) < 2:
            return None
        first = self._singular_over(wide[:2])
        if len(wide) == 2 or first.changes:
            return first
        later = (self._singular_over((wide[0], name)) for name in wide[2:])
        return next((plane for plane in later if plane.changes), first)

    @property
    def wide_directions(self) -> dict[str, Array]:
        """Directions of its workspace with several points, each with its values."""
        axes = {} if self.model.workspace is None else self.model.workspace.axes
        return {d: v for d, v in axes.items() if len(v) > 1}

    def _singular_over(self, names: tuple[str, ...]) -> SingularPlane:
        family = section_family(self.model, names)
        home = self.model.motion.task_of(self.model.motion.home_pose)
        middle = [float(home[DIRECTIONS.index(d)]) for d in names]
        axes = [self.wide_directions[d] for d in names]
        first, second = (np.linspace(float(v[0]), float(v[-1]), SINGULAR_STEPS) for v in axes)
        return singularities_in_plane(
            family, (first, second), middle, self._told("singularities in a plane")
        )

    @cached_property
    def unbounded(self) -> str:
        """Why its workspace has no size; empty where it has one."""
        return self._reason(lambda: self.workspace)

    @answer
    def workspace(self) -> Workspace:
        """All poses that it reaches about those of its stated workspace, up to three directions.

        Where the model has shapes, its parts must not collide.

        Raises
        ------
        ModelError
            Too large a grid, or no direction to look along; shapes that collide at home, or
            that lack their library.
        """
        margin, axes = self._sized
        return workspace(margin, axes, progress=self._told("size of the workspace"))

    @cached_property
    def _sized(self) -> tuple[MachineMargin, dict[str, Array]]:
        """Margin and axes of `workspace`."""
        wide = [(d, v) for d, v in self.grid.axes.items() if len(v) > 1][:3]
        points = SIZED.get(len(wide), 2)
        axes = {}
        for direction, values in wide:
            middle, half = 0.5 * (values[0] + values[-1]), 0.5 * SPREAD * (values[-1] - values[0])
            axes[direction] = np.linspace(middle - half, middle + half, points)
        step = np.array([axis[1] - axis[0] for axis in axes.values()])
        safe = interference_of(self.model, None) if self.model.shapes else None
        margin = MachineMargin(self.model, tuple(axes), step, interference=safe)
        return margin, axes

    @answer
    def largest_box(self) -> LargestShape | None:
        """The largest box about home in the workspace, as long and wide as what is looked over.

        None where turns are among the directions, where poses are slow to place, or where home is
        outside.
        """
        margin, axes = self._sized
        if len(axes) < 2 or any(d.startswith("r") for d in axes):
            return None
        found = self.workspace
        if not (margin.quick and found.home_component):
            return None
        spans = np.array([np.ptp(axis) for axis in axes.values()])
        try:
            return largest_shape(
                found.grid, margin, box_of(spans.tolist()), centre=found.home, accuracy=BOX_ACCURACY
            )
        except (ModelError, NumericalError):
            # a home at the end of a range has no box about it
            return None

    @cached_property
    def unassembled(self) -> str:
        """Why nothing is said of assembly modes; empty where something is."""
        return self._reason(lambda: self.modes)

    @answer
    def modes(self) -> MachineModes:
        """Its assembly modes at home."""
        return machine_modes(self.model)

    @cached_property
    def undynamic(self) -> str:
        """Why nothing is said of its dynamics; empty where something is."""
        return self._reason(lambda: self.standard_motion)

    @answer
    def standard_motion(self) -> StandardMotion:
        """What its weight and a standard circle ask of its drives."""
        return standard_motion(self.model, self.grid, self._told("dynamics"))

    @cached_property
    def reversal_plane(self) -> dict[str, Array] | None:
        """The first two directions of its workspace with several points; None without them."""
        wide = list(self.wide_directions.items())[:2]
        if len(wide) < 2:
            return None
        return {d: np.linspace(float(v[0]), float(v[-1]), REVERSAL_STEPS) for d, v in wide}

    @cached_property
    def unreversed(self) -> str:
        """Why nothing is said of reversals; empty where something is."""
        return self._reason(lambda: self.reversals)

    @answer
    def reversals(self) -> ReversalStudy:
        """Where its drives turn back over that plane, fed along its first direction.

        Raises
        ------
        ModelError
            There is no plane.
        """
        plane = self.reversal_plane
        if plane is None:
            raise ModelError("workspace", "has no plane.", "Name two directions.")
        first, second = plane
        told = self._told("reversals")
        return reversal_study(
            self.model, Plane((first, second)), (plane[first], plane[second]), first, told
        )

    def _reason(self, ask: Callable[[], object]) -> str:
        """What keeps a question from an answer, in words; empty where nothing does."""
        try:
            ask()
        except StrutworkError as error:
            return visible(str(error).replace("\n", " ")).rstrip(".")
        return ""

    def _told(self, part: str) -> Progress:
        return silent if self.progress is None else self.progress(part)
