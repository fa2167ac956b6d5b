"""A design of a machine in Python: the tables of a design file as arguments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from strutwork.errors import ModelError
from strutwork.studies.design import Design
from strutwork.studies.design_store import run_design
from strutwork.studies.design_terms import Constraint, Objective
from strutwork.studies.finished_parts import require_file
from strutwork.studies.parameter import Parameter, Value
from strutwork.studies.progress import Progress


def design_machine(  # noqa: PLR0913 - the tables of a file
    machine: object,
    parameters: Mapping[str, object] | Sequence[Parameter],
    *objectives: str | Objective,
    at_least: Mapping[str, Value] | None = None,
    at_most: Mapping[str, Value] | None = None,
    constraints: Sequence[Constraint] = (),
    out: str | Path | None = None,
    resume: bool = False,
    workers: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> xr.Dataset:
    """Search the numbers of a machine that are best in several objectives.

    Parameters
    ----------
    machine : object
        As `Parametric.of`.
    parameters : mapping of path to values, or sequence of Parameter
        Beside a path a list of values, or a pair (low, high) for a range; SI, or texts with units.
    *objectives : str or Objective
        Names of `strutwork.studies.design_quantities.QUANTITIES`.
    at_least, at_most : mapping of quantity to float or str, optional
        Limits: SI, texts with units, or "stated" for what the machine as described has.
    constraints : sequence of Constraint
        Further limits.
    out : str or Path, optional
        File of the result, ending in .nc.
    resume, workers, progress
        As `strutwork.studies.design_store.run_design`.
    **options
        Of `Design.of`: workspace, cost, band, and of the search method, population, generations,
        starts and seed.

    Returns
    -------
    xarray.Dataset
        As `strutwork.studies.design_store.run_design`.

    Raises
    ------
    ModelError, UnitError, OutputError
        As `Design.of`, `Constraint.of` and `strutwork.studies.design_store.run_design`.
    """
    low, high = _limits("at_least", at_least), _limits("at_most", at_most)
    limits = [Constraint.of(n, low.get(n), high.get(n)) for n in dict.fromkeys([*low, *high])]
    design = Design.of(
        machine, parameters, *objectives, constraints=[*limits, *constraints], **options
    )
    require_file(out, resume=resume)
    return run_design(design, out, resume=resume, workers=workers, progress=progress)


def _limits(name: str, given: Mapping[str, Value] | None) -> Mapping[str, Value]:
    if given is not None and not isinstance(given, Mapping):
        raise ModelError(
            name, f"is a {type(given).__name__}.", 'Give limits by quantity: {"mass": "80 kg"}.'
        )
    return given or {}
