"""Load cases of a model file: deformed shapes, displacements, reactions, joint forces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import floor, isnan, log10
from typing import Any

import numpy as np

from strutwork.machines.extent import model_size
from strutwork.reports.alike import label, pattern
from strutwork.reports.chapters.model_flexures import flexure_tables
from strutwork.reports.content import Block, Chapter, Column, Details, Figure, Note, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, json_file
from strutwork.reports.figures.model import deformed_shape, deformed_view
from strutwork.reports.model_solution import ModelSolution
from strutwork.reports.numbers import count, significant, times
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
        energy = significant(shown_energy(solution, number))
        tables = shown_tables(solution, number)
        moved = {n: _IN_SHOWN_UNITS * six for n, six in tables["displacements"].items()}
        said = _tool(solution, moved)
        blocks.append(Text(f"Case “{name}”: {said}the strain energy is {energy} J."))
        if figure is not None:
            blocks.append(figure)
        title, what, key = FORCE_TABLES[0]
        folded = [
            *_six(f"Displacements, case “{name}”", "node", _MOVED, moved),
            *_six(f"{title}, case “{name}”", what, _FORCE, tables[key]),
        ]
        blocks.append(
            Details(
                f"Displacements of {count(len(moved), 'node')} and reactions, case “{name}”",
                tuple(folded),
            )
        )
    files = [
        json_file(
            "solution.json", "displacements, reactions and forces of every case, SI", answers
        ),
        csv_file(
            "deformed-shapes.csv",
            "the drawn shapes: true position and displacement, m; empty rows separate the lines",
            ("case", "x_m", "y_m", "z_m", "displacement_m", "drawn_factor"),
            shapes,
        ),
    ]
    return Chapter("loads", "Load cases", tuple(blocks), tuple(files))


def _tool(solution: ModelSolution, moved: Mapping[str, Any]) -> str:
    """How far the tool moves in a case, in words."""
    tool = solution.model.tool
    if tool is None or tool not in moved:
        return ""
    x, y, z = (significant(float(v)) for v in moved[tool][:3])
    return f"the tool moves by {x}, {y} and {z} µm along x, y and z; "


def forces_chapter(solution: ModelSolution) -> Chapter:
    """Forces in joints, springs and beams: the largest of every case, and folded all."""
    answers = solution.to_dict()
    blocks: list[Block] = [
        Text(
            "The largest force and moment on each kind of part, over all load cases; parts whose "
            "names differ only in their numbers are one kind. The components of every force are "
            "listed below by load case."
        )
    ]
    rows: list[list[Any]] = []
    largest: dict[tuple[str, str], list[tuple[float, float, str, str]]] = {}
    folded: list[Block] = []
    for number, (name, case) in enumerate(answers["cases"].items()):
        shown = shown_tables(solution, number)
        exact = case | {"beam_forces": beam_ends(case["beam_forces"])}
        tables: list[Table | Text] = []
        for title, what, key in FORCE_TABLES[1:]:
            tables += _six(f"{title}, case “{name}”", what, _FORCE, shown[key], "forces.csv")
            rows += [[name, what, part, *force] for part, force in exact[key].items()]
            for part, six in shown[key].items():
                force, moment = float(np.linalg.norm(six[:3])), float(np.linalg.norm(six[3:]))
                stem = part.rsplit(", at its ", 1)[0]
                largest.setdefault((what, pattern(stem)), []).append((force, moment, part, name))
        if tables:
            folded.append(Details(f"Forces on every part, case “{name}”", tuple(tables)))
    blocks += [*_largest(largest), *flexure_tables(solution), *folded]
    columns = ("case", "kind", "part", *(f"{f}_{u}".replace("·", "") for f, u in _FORCE))
    file: DataFile = csv_file("forces.csv", "forces in joints, springs and beams", columns, rows)
    return Chapter("forces", "Forces in joints and beams", tuple(blocks), (file,))


def _largest(
    found: Mapping[tuple[str, str], Sequence[tuple[float, float, str, str]]],
) -> list[Block]:
    """The largest force and moment of parts alike."""
    lines = []
    for (what, _), some in found.items():
        names = list(dict.fromkeys(part.rsplit(", at its ", 1)[0] for *_, part, _ in some))
        known = [s for s in some if not (isnan(s[0]) or isnan(s[1]))]
        if not known:
            lines.append([label(names), what, "not determined", "", "not determined", ""])
            continue
        force = max(known, key=lambda s: s[0])
        moment = max(known, key=lambda s: s[1])
        lines.append(
            [
                label(names),
                what,
                significant(force[0]),
                f"{force[2]}, {force[3]}" if force[0] else "",
                significant(moment[1]),
                f"{moment[2]}, {moment[3]}" if moment[1] else "",
            ]
        )
    heads = (
        Column("parts", "", False),
        Column("kind", "", False),
        Column("largest force", "N"),
        Column("where, load case", "", False),
        Column("largest moment", "N·m"),
        Column("where, load case", "", False),
    )
    return [Table("Largest forces and moments", heads, lines, "forces.csv")] if lines else []


def _six(
    title: str,
    what: str,
    columns: Sequence[tuple[str, str]],
    values: Mapping[str, Any],
    data: str = "solution.json",
) -> list[Table | Text]:
    if not values:
        return []
    rows = [
        [part, *("not determined" if isnan(v) else significant(float(v), 4) for v in six)]
        for part, six in list(values.items())[:SHOWN]
    ]
    heads = (Column(what, "", False), *(Column(title, unit) for title, unit in columns))
    blocks: list[Table | Text] = [Table(title, heads, rows, data)]
    if len(values) > SHOWN:
        blocks.append(Text(f"The first {SHOWN} of {len(values)} are shown; {data} contains all."))
    return blocks


def _deformed(solution: ModelSolution, number: int, rows: list[list[Any]]) -> Figure | Note | None:
    model, statics = solution.model, solution.statics
    case = model.cases[number]
    largest, factor = exaggeration(solution, number)
    if not factor:
        return Note(f"No node moves in case “{case.name}”.")
    shape, moved = deformed_shape(model, statics, number, factor)
    if not len(shape):
        return None
    still, _ = deformed_shape(model, statics, number, 0.0)
    rows += [
        [case.name, *(float(v) for v in point), float(m), factor]
        for point, m in zip(still, moved, strict=True)
    ]
    forces = ", forces are red" if any(any(w[:3]) for _, w in case.wrenches) else ""
    edges = " and those of solids along their edges" if model.solids else ""
    return Figure(
        f"deformed-{number + 1}",
        f"Case “{case.name}”: displacements are drawn {times(factor)} times their true size. The "
        f"largest of a node is {significant(1e6 * largest, 4)} µm. Colour shows the true "
        f"displacements, between nodes as the beams' ends bend them{edges}; the structure at rest "
        f"is grey{forces}.",
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
