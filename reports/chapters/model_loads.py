"""Load cases of a model file: deformed shapes, displacements, reactions, joint forces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import floor, isnan, log10
from typing import Any

import numpy as np

from strutwork.reports.content import Block, Chapter, Column, Figure, Note, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, json_file
from strutwork.reports.figures.model import deformed_shape, deformed_view, model_size
from strutwork.reports.model_solution import ModelSolution
from strutwork.reports.numbers import significant, times
from strutwork.reports.solution_tables import FORCE_TABLES, beam_ends, shown_energy, shown_tables

#: Rows of a table a reader is shown; the file has all.
SHOWN = 40

#: Share of the structure's size that the largest displacement is drawn with.
DRAWN = 0.08

_MOVED = (*((f"u{a}", "µm") for a in "xyz"), *((f"r{a}", "mrad") for a in "xyz"))
_IN_SHOWN_UNITS = np.array([1e6] * 3 + [1e3] * 3)
_FORCE = (*((f"F{a}", "N") for a in "xyz"), *((f"M{a}", "N·m") for a in "xyz"))


def loads_chapter(solution: ModelSolution) -> Chapter:
    """Every load case with its deformed shape and its numbers."""
    answers = solution.to_dict()
    blocks: list[Block] = []
    shapes: list[list[Any]] = []
    for number, name in enumerate(solution.statics.cases):
        figure = _deformed(solution, number, shapes)
        energy = significant(shown_energy(solution, number), 4)
        blocks.append(Text(f"Case “{name}”: strain energy {energy} J."))
        if figure is not None:
            blocks.append(figure)
        tables = shown_tables(solution, number)
        moved = {n: _IN_SHOWN_UNITS * six for n, six in tables["displacements"].items()}
        blocks += _six(f"Displacements, case “{name}”", "node", _MOVED, moved)
        title, what, key = FORCE_TABLES[0]
        blocks += _six(f"{title}, case “{name}”", what, _FORCE, tables[key])
    files = [
        json_file(
            "solution.json", "displacements, reactions and forces of every case, SI", answers
        ),
        csv_file(
            "deformed-shapes.csv",
            "the drawn shapes: true position and displacement, m; lines are parted by empty rows",
            ("case", "x_m", "y_m", "z_m", "displacement_m", "drawn_factor"),
            shapes,
        ),
    ]
    return Chapter("loads", "Load cases", tuple(blocks), tuple(files))


def forces_chapter(solution: ModelSolution) -> Chapter:
    """Forces in joints, springs and beams for every load case."""
    answers = solution.to_dict()
    blocks: list[Block] = []
    rows: list[list[Any]] = []
    for number, (name, case) in enumerate(answers["cases"].items()):
        shown = shown_tables(solution, number)
        exact = case | {"beam_forces": beam_ends(case["beam_forces"])}
        for title, what, key in FORCE_TABLES[1:]:
            blocks += _six(f"{title}, case “{name}”", what, _FORCE, shown[key], "forces.csv")
            rows += [[name, what, part, *force] for part, force in exact[key].items()]
    columns = ("case", "kind", "part", *(f"{f}_{u}".replace("·", "") for f, u in _FORCE))
    file: DataFile = csv_file("forces.csv", "forces in joints, springs and beams", columns, rows)
    return Chapter("forces", "Forces in joints and beams", tuple(blocks), (file,))


def _six(
    title: str,
    what: str,
    columns: Sequence[tuple[str, str]],
    values: Mapping[str, Any],
    data: str = "solution.json",
) -> list[Block]:
    if not values:
        return []
    rows = [
        [part, *("not determined" if isnan(v) else significant(float(v), 4) for v in six)]
        for part, six in list(values.items())[:SHOWN]
    ]
    heads = (Column(what, "", False), *(Column(title, unit) for title, unit in columns))
    blocks: list[Block] = [Table(title, heads, rows, data)]
    if len(values) > SHOWN:
        blocks.append(Text(f"The first {SHOWN} of {len(values)} are shown; {data} has all."))
    return blocks


def _deformed(solution: ModelSolution, number: int, rows: list[list[Any]]) -> Figure | Note | None:
    model, statics = solution.model, solution.statics
    case = model.cases[number]
    largest, factor = exaggeration(solution, number)
    if not factor:
        return Note(f"Nothing moves in case “{case.name}”.")
    shape, moved = deformed_shape(model, statics, number, factor)
    if not len(shape):
        return None
    still, _ = deformed_shape(model, statics, number, 0.0)
    rows += [
        [case.name, *(float(v) for v in point), float(m), factor]
        for point, m in zip(still, moved, strict=True)
    ]
    forces = ", red the forces" if any(any(w[:3]) for _, w in case.wrenches) else ""
    edges = ", of solids along their edges" if model.solids else ""
    return Figure(
        f"deformed-{number + 1}",
        f"Case “{case.name}”: displacements drawn {times(factor)} times as large as they are. The "
        f"largest of a node is {significant(1e6 * largest, 4)} µm. Colour gives the true "
        f"displacement, between nodes as the beams' ends bend them{edges}; grey is the structure "
        f"at rest{forces}.",
        deformed_view(model, shape, moved, case, "displacement (µm)"),
        f"Three-dimensional drawing of the deformed structure in case {case.name}.",
        "deformed-shapes.csv",
        height=520,
    )


def exaggeration(solution: ModelSolution, number: int) -> tuple[float, float]:
    """The largest displacement of a node in a case, m, and how many times as large to draw it.

    0 times where nothing moves.
    """
    moves = solution.statics.displacements[:, :3, number]
    largest = float(np.linalg.norm(moves, axis=-1).max(initial=0.0))
    size = model_size(solution.model)
    return largest, round_factor(DRAWN * size / largest) if largest >= 1e-15 * size else 0.0


def round_factor(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above `value`.

    >>> round_factor(730.0), round_factor(0.31)
    (500.0, 0.2)
    """
    power = 10.0 ** floor(log10(value))
    step = next(s for s in (5.0, 2.0, 1.0) if s * power <= value * (1 + 1e-12))
    return float(f"{step * power:.6g}")
