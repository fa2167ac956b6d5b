"""`strutwork solve`: displacements, forces and the stiffness at the tool of a machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isnan

import numpy as np
from numpy.typing import NDArray
from rich.console import Console

from strutwork.machines.model import Model
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free
from strutwork.reports.cli.flexures import print_flexure_uses, print_flexures
from strutwork.reports.cli.manner import MANNER
from strutwork.reports.cli.output import console, print_json, print_table, show, table
from strutwork.reports.flexure_use import flexure_uses
from strutwork.reports.model_solution import ModelSolution, solve_model
from strutwork.reports.solution_tables import FORCE_TABLES, shown_energy, shown_tables

_AXES = ("x", "y", "z")
_MOVED = [*(f"{a}, mm" for a in _AXES), *(f"r{a}, mrad" for a in _AXES)]

#: Rows of a table in the short answer: of a longer one those with the largest values.
SHORT = 10

_FORCE = [*(f"F{a}, N" for a in _AXES), *(f"M{a}, N·m" for a in _AXES)]


def run(model: Model, json: bool) -> None:
    """Solve a machine's load cases and print the answers."""
    found = solve_model(model)
    if json:
        print_json(found.to_dict())
    else:
        _print(found)


def _print(found: ModelSolution) -> None:
    out, answers = console(), found.to_dict()
    out.print(found.model.title or "Model", markup=False, style="bold")
    for number, name in enumerate(answers["cases"]):
        energy = shown_energy(found, number)
        out.print(f'\nCase "{name}", strain energy {energy:.4g} J', markup=False)
        tables = shown_tables(found, number)
        moved = {n: 1e3 * six for n, six in tables["displacements"].items()}
        _six(out, "Displacements", "node", _MOVED, moved, kept=found.model.tool)
        for title, what, key in FORCE_TABLES:
            _six(out, title, what, _FORCE, tables[key])
        print_flexure_uses(out, flexure_uses(found.model, found.statics, number))
        if found.equilibria:
            from strutwork.reports.cli.bearings import print_states

            print_states(out, found, number)
    print_flexures(out, found.model.flexures)
    if found.compliance is not None:
        _print_tool(out, found, found.compliance)


def _six(
    out: Console,
    title: str,
    what: str,
    columns: Sequence[str],
    values: Mapping[str, NDArray[np.float64]],
    kept: str | None = None,
) -> None:
    if not values:
        return
    names = list(values) if MANNER.whole else _largest(values, kept)
    rows = [
        (name, *("not determined" if isnan(v) else v for v in values[name].tolist()))
        for name in names
    ]
    print_table(out, title, [what, *columns], rows)
    if len(names) < len(values):
        more = len(values) - len(names)
        out.print(f"Only the largest are shown; --verbose lists {more} more.", markup=False)


def _largest(values: Mapping[str, NDArray[np.float64]], kept: str | None) -> list[str]:
    """The rows with the largest values, forces and moments each beside the largest of all."""
    if len(values) <= SHORT:
        return list(values)
    six = np.abs(np.nan_to_num(np.array(list(values.values()))).reshape(-1, 2, 3)).max(axis=-1)
    share = (six / np.where(six.max(axis=0) > 0, six.max(axis=0), 1.0)).max(axis=-1)
    share += np.array([name == kept for name in values])
    chosen = set(np.argsort(-share, kind="stable")[:SHORT].tolist())
    return [name for i, name in enumerate(values) if i in chosen]


def _print_tool(out: Console, found: ModelSolution, compliance: NDArray[np.float64]) -> None:
    free, blocked = axis_stiffness_free(compliance), axis_stiffness_blocked(compliance)
    rows: list[tuple[object, ...]] = []
    for i, axis in enumerate((*_AXES, *(f"r{a}" for a in _AXES))):
        scale, unit = (1e-6, "N/µm") if i < 3 else (1e-3, "kN·m/rad")
        rows.append((axis, unit, *(float(v[i]) * scale for v in (free, blocked))))
    title = f"Stiffness at the tool {found.model.tool}{found.model.relative}"
    if found.equilibria:
        title += ", at preload"
    out.print(table(title, ["axis", "unit", "others free", "others blocked"], rows, names=2))
    if not np.isfinite(free[:3]).any():
        return
    softest, stiffest = int(np.argmin(free[:3])), int(np.argmax(free[:3]))
    low, high = (f"{show(1e-6 * float(free[i]))} N/µm in {_AXES[i]}" for i in (softest, stiffest))
    out.print(
        f"With the other axes free to follow, the stiffness at {found.model.tool}"
        f"{found.model.relative} is least with {low} and largest with {high}.",
        soft_wrap=True,
    )
