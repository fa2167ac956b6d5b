"""Reading a design file: a machine, parameters, objectives, constraints."""

from __future__ import annotations

from pathlib import Path

from strutwork.machines.beside_model import tables_beside_model
from strutwork.studies.design import Design
from strutwork.studies.design_schema import CostTable, DesignTable
from strutwork.studies.design_terms import Constraint, Cost, CostOf, Objective, Search
from strutwork.studies.question import Asked
from strutwork.studies.study_file import machine_beside, parameter_of, poses_of

#: Where the file is described.
PAGE = "docs/how-to/design.md"


def read_design(path: str | Path) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : str or Path
        TOML; its tables are those of docs/how-to/design.md. The model file that it names lies
        beside it or below it, or has a full path.

    Raises
    ------
    ModelError, UnitError
        The file or the model cannot be read, a key is unknown or wrong, or as `Design`.
    """
    place = Path(path)
    tables = tables_beside_model(place, "design", DesignTable, PAGE)
    machine = machine_beside(place, tables.machine)
    search, vibration = tables.search, tables.vibration
    return Design(
        machine,
        tuple(parameter_of(i, table) for i, table in enumerate(tables.parameters)),
        tuple(Objective.of(t.quantity, t.goal) for t in tables.objectives),
        tuple(Constraint.of(t.quantity, t.at_least, t.at_most) for t in tables.constraints),
        Search(search.population, search.generations, search.seed),
        poses_of(tables.workspace, machine),
        _cost(tables.cost),
        Asked("vibration", vibration.band, vibration.count),
    )


def _cost(table: CostTable) -> Cost:
    parts = tuple(CostOf(t.name, float(t.amount), t.per) for t in table.parameters)
    return Cost(float(table.fixed), float(table.per_kg), parts, table.currency)
