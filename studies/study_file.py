"""Reading a study file: a machine, what is varied, what is asked."""

from __future__ import annotations

from pathlib import Path

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.beside_model import tables_beside_model
from strutwork.machines.model_motion_schema import WorkspaceTable
from strutwork.machines.model_motion_tables import grid_of_table
from strutwork.machines.naming import is_machine
from strutwork.studies.parameter import Parameter
from strutwork.studies.parametric import Parametric
from strutwork.studies.question import Asked, Question, asked
from strutwork.studies.sample import Sample
from strutwork.studies.study import Study
from strutwork.studies.study_schema import ParameterTable, SampleTable, StudyTable

#: Where the file is described.
PAGE = "docs/how-to/study.md"


def read_study(path: str | Path) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : str or Path
        TOML; its tables are those of docs/how-to/study.md. The model file that it names lies
        beside it or below it, or has a full path.

    Raises
    ------
    ModelError, UnitError
        The file or the model cannot be read, a key is unknown or wrong, or as `Study`.
    """
    place = Path(path)
    tables = tables_beside_model(place, "study", StudyTable, PAGE)
    machine = machine_beside(place, tables.machine)
    grid = poses_of(tables.workspace, machine)
    default = ("home",) if grid is None else ("worst", "mean", "home")
    return Study(
        machine,
        tuple(parameter_of(i, table) for i, table in enumerate(tables.parameters)),
        _sample(tables.sample),
        tuple(_question(tables, name) for name in tables.answers),
        grid,
        tables.reductions or default,
    )


def machine_beside(place: Path, name: str) -> Parametric:
    """The machine that a file names: one of the catalogue, or a model file beside it.

    Parameters
    ----------
    place : Path
        Of the file.
    name : str

    Raises
    ------
    ModelError
        As `Parametric.of`.
    """
    if name.endswith(".toml") or not is_machine(name):
        name = str(place.parent / name)
    return Parametric.of(name)


def parameter_of(number: int, table: ParameterTable) -> Parameter:
    """A parameter from its table.

    Parameters
    ----------
    number : int
        In the file, counted from zero.
    table : ParameterTable

    Raises
    ------
    ModelError
        Both values and a range, or neither.
    """
    scattered = table.distribution is not None
    if not scattered and bool(table.values) == (table.range is not None):
        what = "both values and range" if table.values else "neither values nor range"
        raise ModelError(
            f"parameters[{number}]",
            f"has {what}.",
            'Give values = [...], or range = ["LOW", "HIGH"].',
        )
    low, high = table.range or (None, None)
    return Parameter(
        table.path,
        table.values,
        low,
        high,
        table.points,
        table.relative,
        table.log,
        table.name or "",
        table.distribution or "",
        table.mean,
        table.scatter,
        table.independent,
    )


def _sample(table: SampleTable) -> Sample:
    return Sample(table.kind or "", table.count, table.seed, table.second_order)


def _question(tables: StudyTable, name: str) -> Question:
    question = asked(name)
    if name != "vibration":
        return question
    return Asked(name, tables.vibration.band, tables.vibration.count)


def poses_of(table: WorkspaceTable | None, machine: Parametric) -> TaskGrid | None:
    """Poses: the file's, else the machine's own; an empty table is home alone.

    Parameters
    ----------
    table : WorkspaceTable or None
    machine : Parametric
    """
    if table is None:
        return machine.origin.model.workspace
    if not any(getattr(table, d) is not None for d in DIRECTIONS):
        return None
    return grid_of_table(table)
