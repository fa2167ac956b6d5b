"""A machine that answers questions: what `strutwork.load` returns."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.arguments import explained
from strutwork.errors import ModelError
from strutwork.fea import FrequencyResponse, Modes, Port, frequency_response, modes
from strutwork.html import table
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_poses import at_pose
from strutwork.msa import tool_compliance
from strutwork.outward import OUTWARD, Outward
from strutwork.tool_stiffness import ToolStiffness
from strutwork.units import ANGLE, LENGTH, quantity
from strutwork.varying import VARYING, Varying

if TYPE_CHECKING:
    import plotly.graph_objects as go
    import xarray as xr

    from strutwork.reports.build import WrittenReport
    from strutwork.reports.designs.result import DesignComparison
    from strutwork.reports.model_check import ModelCheck
    from strutwork.reports.model_solution import ModelSolution
    from strutwork.reports.subject import Subject
    from strutwork.studies.answers import Answer
    from strutwork.studies.tolerance_result import ToleranceStudy

Array = NDArray[Any]

#: What completion shows first; the model's own fields are there as well.
QUESTIONS = (
    "assembly_forces",
    "at",
    "changed",
    "check",
    "compare",
    "frequency_response",
    *OUTWARD,
    "modes",
    "plot",
    "report",
    "solve",
    "stiffness",
    "survey",
    *VARYING,
)


@explained
@dataclass(frozen=True, repr=False)
class Machine(Model, Outward, Varying):
    """A model with its questions; the fields are those of `strutwork.machines.model.Model`.

    Attributes
    ----------
    source : str
        The name or file it was loaded from; empty once it was changed or moved.
    """

    source: str = field(default="", init=False)

    @classmethod
    def of(cls, model: Model, source: str = "") -> Self:
        """The same model, with its questions.

        Parameters
        ----------
        model : Model
            Its fields are taken over, not copied.
        source : str
            Name or file the model was loaded from; empty for none.
        """
        machine = cls(**{f.name: getattr(model, f.name) for f in fields(Model)})
        # frozen for all who come later; not copied by `dataclasses.replace`, as it should not be
        object.__setattr__(machine, "source", source)
        return machine

    def __dir__(self) -> list[str]:
        hidden = {n for n in super().__dir__() if n.startswith("_")}
        return sorted({*QUESTIONS, *hidden})

    def _repr_html_(self) -> str:
        linkage = self.structure.linkage
        driven = [f"{j.name}:{d}" for j in linkage.joints for d in j.driven]
        over = {} if self.workspace is None else self.workspace.axes
        rows = [
            ("bodies", len(linkage.bodies)),
            ("joints", len(self.joints)),
            ("nodes", len(self.nodes)),
            ("drives", ", ".join(driven) or "none"),
            ("tool", self.tool or "none"),
            ("flexible", f"{len(self.structure.beams)} beams, {len(self.solids)} solids"),
            ("workspace", ", ".join(f"{d}: {len(v)}" for d, v in over.items()) or "not stated"),
            ("load cases", ", ".join(c.name for c in self.cases) or "none"),
            ("tolerances", len(self.tolerances)),
        ]
        return table(self.title or "Machine", rows)

    @cached_property
    def _subject(self) -> Subject:
        from strutwork.reports.subject import Subject

        name = self.source or self.title or "machine"
        return Subject(self, name, name)

    def at(self, joints: Mapping[str, float | str] | None = None, **task: float | str) -> Self:
        """The same machine standing elsewhere.

        Parameters
        ----------
        joints : mapping of "JOINT:DIRECTION" to float or str, optional
            Joint coordinates, m and rad or with a unit.
        **task : float or str
            Of the tool: x, y, z in m, rx, ry, rz in rad, or with a unit as "20 mm".

        Raises
        ------
        ModelError, UnreachableError
            As `strutwork.machines.model_poses.at_pose`; an unknown direction, a wrong unit.
        """
        where = {d: _coordinate(d, v) for d, v in task.items()}
        turned = {}
        for name, value in (joints or {}).items():
            joint, _, direction = name.rpartition(":")
            turned[joint, direction] = _coordinate(direction, value)
        return type(self).of(at_pose(self, where, turned))

    def changed(self, numbers: Mapping[str, float | str]) -> Self:
        """The machine with other numbers.

        Parameters
        ----------
        numbers : mapping of path to float or str
            As `strutwork.studies.parametric.Parametric.model`, whose errors it raises: SI, or texts
            with units.
        """
        from strutwork.studies.parametric import Parametric

        return type(self).of(Parametric.of(self).model(numbers))

    def check(self) -> ModelCheck:
        """Freedoms, redundant constraints and mass.

        Raises
        ------
        StrutworkError
            As `strutwork.reports.model_check.check_model`.
        """
        return self._subject.check

    def compare(
        self,
        other: Machine | Path | str,
        pose: Mapping[str, float | str] | None = None,
        *,
        around: Mapping[str, ArrayLike] | None = None,
        **options: Any,
    ) -> DesignComparison:
        """Both machines, this one as A, question by question, with the differences marked.

        Parameters
        ----------
        other : Machine, or str or Path as of `strutwork.load`
        pose : mapping of direction to float or str, optional
            Where both stand, m and rad as for `at`; each at home else.
        around : mapping of direction to (n,), optional
            Poses relative to the home of each, m and rad; else those that both workspaces contain.
        **options
            Of `strutwork.reports.designs.comparison.compare_designs`: threshold, damping, progress.

        Raises
        ------
        ModelError, UnreachableError
            The same machine twice; a pose that one of them cannot take.
        """
        from strutwork.machines.load import load
        from strutwork.reports.designs.comparison import compare_standing

        second = other if isinstance(other, Machine) else Machine.of(load(other), str(other))
        a, b = ((m.source or m.title or "machine", m) for m in (self, second))
        task = {d: _coordinate(d, v) for d, v in (pose or {}).items()}
        grid = None if around is None else _grid(around)
        return compare_standing(a, b, task, {}, around=grid, **options)

    def solve(self) -> ModelSolution:
        """Displacements and forces under every load case.

        Raises
        ------
        StrutworkError
            As `strutwork.msa.solve`.
        """
        from strutwork.reports.model_solution import solve_model

        return solve_model(self)

    def stiffness(self) -> ToolStiffness:
        """Stiffness at the tool where the machine stands.

        Raises
        ------
        StrutworkError
            No tool, or a tool that moves freely.
        """
        self.require_tool()
        return ToolStiffness(np.asarray(tool_compliance(self.placed)))

    def modes(self, count: int = 10) -> Modes:
        """The lowest natural frequencies and shapes, under the preload where there is one.

        Parameters
        ----------
        count : int
            How many modes, rigid ones included.

        Raises
        ------
        StrutworkError
            As `strutwork.fea.modes`.
        """
        return modes(self.vibrating, count)

    def frequency_response(
        self, frequencies: ArrayLike, axes: Sequence[str] = ("x", "y", "z")
    ) -> FrequencyResponse:
        """Receptances at the tool, (f, outputs, inputs).

        Parameters
        ----------
        frequencies : (f,)
            Hz.
        axes : sequence of str
            Directions at the tool that are loaded and observed.

        Raises
        ------
        StrutworkError
            No tool, no damping; else as `strutwork.fea.frequency_response`.
        """
        from strutwork.studies.model_damping import model_damping

        damping = model_damping(self)
        if damping is None:
            raise ModelError(
                "damping", "is missing.", "Add [damping], or give the machine a damping."
            )
        ports = [Port(self.require_tool(), axis) for axis in axes]
        return frequency_response(self.vibrating, ports, ports, frequencies, damping)

    def assembly_forces(self) -> ToleranceStudy:
        """Forces that its tolerances lock in: worst case, distribution, causes.

        Raises
        ------
        StrutworkError
            As `strutwork.studies.tolerance_study.tolerance_study`.
        """
        from strutwork.studies.tolerance_study import tolerance_study

        return tolerance_study(self.placed, self.tolerances, self.force_limits, title=self.title)

    def survey(
        self, over: Mapping[str, ArrayLike] | None = None, *answers: Answer, **options: Any
    ) -> xr.Dataset:
        """Answers over poses of the tool.

        Parameters
        ----------
        over : mapping of direction to (n,), optional
            Values along each, m and rad; the machine's own workspace where it is left out.
        *answers : Answer
            `strutwork.studies.answers`; static stiffness where there is none.
        **options
            Of `strutwork.studies.survey.survey`: workers, progress, folder, executor.

        Returns
        -------
        xarray.Dataset
            With `dataset.strutwork.to_dataframe()`, `.split_units()` and `.plot()`, see
            `strutwork.surveyed.Surveyed`.

        Raises
        ------
        ModelError
            No workspace is known; else as `strutwork.studies.survey.survey`.
        """
        # gives the dataset its table, its units and its plot
        import strutwork.surveyed  # noqa: F401
        from strutwork.studies.answers import Stiffness
        from strutwork.studies.survey import survey

        grid = self._subject.grid if over is None else _grid(over)
        return survey(self, grid, answers or [Stiffness()], **options)

    def report(self, folder: Path | str | None = None) -> WrittenReport:
        """Write the report with all that applies to the machine.

        Parameters
        ----------
        folder : Path or str, optional
            Default `report-NAME` in the working directory.

        Raises
        ------
        StrutworkError
            As `strutwork.reports.build.write_report`.
        """
        from strutwork.reports.build import Composed, page_of, write_page, write_report
        from strutwork.reports.composed import report_of

        name = self.source or self.title or "machine"
        plain = re.sub(r"\W+", "-", Path(name).stem).strip("-").lower() or "machine"
        where = Path(f"report-{plain}" if folder is None else folder)
        if self.source:
            return write_report(self.source, where)
        chapters = report_of(self._subject)
        found = tuple(f for chapter in chapters for f in chapter.files)
        page = page_of(self._subject.title, "", chapters)
        return write_page(Composed(page, found, self._subject), where)

    def plot(self, *, case: str | None = None, mode: int | None = None) -> go.Figure:
        """A drawing to be turned by the pointer.

        Parameters
        ----------
        case : str, optional
            Deformed by this load case, exaggerated.
        mode : int, optional
            Swinging in this elastic mode, from 1.

        Returns
        -------
        plotly.graph_objects.Figure

        Raises
        ------
        ModelError
            Both a case and a mode, or one that does not exist.
        """
        from strutwork.reports.notebook import machine_figure

        return machine_figure(self, case, mode)


def _coordinate(direction: str, value: float | str) -> float:
    if not isinstance(value, str):
        return float(value)
    return quantity(value, ANGLE if direction.startswith("r") else LENGTH, direction)


def _grid(over: Mapping[str, ArrayLike]) -> TaskGrid:
    return TaskGrid({d: np.atleast_1d(np.asarray(v, dtype=float)) for d, v in over.items()})
