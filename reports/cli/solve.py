"""`strutwork solve`: displacements, forces and the stiffness at the tool of a model file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite, isnan

import numpy as np
from numpy.typing import NDArray
from rich.console import Console

from machines.model_file import read_model
from msa import axis_stiffness_free
from reports.cli.output import console, print_json, table
from reports.model_solution import ModelSolution, solve_model

_AXES = ("x", "y", "z")
_MOVED = [*(f"{a}, mm" for a in _AXES), *(f"r{a}, mrad" for a in _AXES)]
_FORCE = [*(f"F{a}, N" for a in _AXES), *(f"M{a}, N·m" for a in _AXES)]


def run(file: str, json: bool) -> None:
    """Solve a model file and print the answers."""
    found = solve_model(read_model(file))
    if json:
        print_json(found.to_dict())
    else:
        _print(found)


def _print(found: ModelSolution) -> None:
    out, answers = console(), found.to_dict()
    out.print(found.model.title or "Model", markup=False, style="bold")
    for name, case in answers["cases"].items():
        out.print(f'\nCase "{name}", strain energy {case["strain_energy"]:.4g} J', markup=False)
        moved = {n: [1e3 * v for v in u] for n, u in case["displacements"].items()}
        _six(out, "Displacements", "node", _MOVED, moved)
        _six(out, "Reactions on the structure", "node", _FORCE, case["reactions"])
        on_second = "Joint forces on the second node, joint axes"
        _six(out, on_second, "joint", _FORCE, case["joint_forces"])
        _six(out, "Spring forces", "spring", _FORCE, case["spring_forces"])
        ends = {
            f"{beam} {end}": force
            for beam, both in case["beam_forces"].items()
            for end, force in both.items()
        }
        _six(out, "Forces on the beam ends, beam axes", "beam", _FORCE, ends)
    if found.compliance is not None:
        _print_tool(out, found, found.compliance)


def _six(
    out: Console,
    title: str,
    what: str,
    columns: Sequence[str],
    values: Mapping[str, Sequence[float | None]],
) -> None:
    if not values:
        return
    # round-off beside the largest force or moment is shown as zero
    numbers = np.array(list(values.values()), dtype=float)
    sizes = np.nan_to_num(np.abs(numbers)).reshape(-1, 2, 3)
    numbers[np.abs(numbers) < 1e-10 * sizes.max(axis=(0, 2)).repeat(3)] = 0.0
    rows = [
        (name, *("not determined" if isnan(v) else v for v in row))
        for name, row in zip(values, numbers.tolist(), strict=True)
    ]
    out.print(table(title, [what, *columns], rows))


def _print_tool(out: Console, found: ModelSolution, compliance: NDArray[np.float64]) -> None:
    free = axis_stiffness_free(compliance)
    blocked = None if found.stiffness is None else found.stiffness.diagonal()
    rows: list[tuple[object, ...]] = []
    for i, axis in enumerate((*_AXES, *(f"r{a}" for a in _AXES))):
        scale, unit = (1e-6, "N/µm") if i < 3 else (1e-3, "kN·m/rad")
        held = "infinite" if blocked is None else float(blocked[i]) * scale
        follows = float(free[i]) * scale if isfinite(free[i]) else "infinite"
        rows.append((axis, unit, follows, held))
    title = f"Stiffness at the tool {found.model.tool}"
    out.print(table(title, ["axis", "unit", "others free", "others blocked"], rows, names=2))
