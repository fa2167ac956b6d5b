"""The report of a design: the front, each machine of it, and what was given up."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.reports.build import Composed, WrittenReport, page_of, write_page
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import (
    Answer,
    Answers,
    Block,
    Chapter,
    Column,
    Figure,
    Pick,
    Picks,
    Table,
    Text,
)
from strutwork.reports.data_files import csv_file, netcdf_file
from strutwork.reports.design_words import (
    comparison,
    extremes,
    limits_words,
    machine_code,
    on_front,
    parameter_words,
    rounds_words,
    starts_words,
    unit_of,
    value_words,
)
from strutwork.reports.figures.front import front_scatter
from strutwork.reports.figures.study import parallel, scatter
from strutwork.reports.numbers import count, significant
from strutwork.reports.study_words import machine_words, title_of
from strutwork.studies.design_pick import changes_of
from strutwork.studies.design_table import (
    design_objectives,
    design_parameters,
    design_quantities,
    design_rows,
    reasons_of,
)
from strutwork.studies.study_table import NumberColumn

FRONT, DATA = "machines.csv", "design.nc"

#: Figure in which machines are chosen, machines that can be chosen, axes side by side.
KEY, CHOICES, AXES = "front", 200, 8


def write_design_report(found: xr.Dataset, folder: Path) -> WrittenReport:
    """Write the report of a design.

    Parameters
    ----------
    found : xarray.Dataset
        Its result.
    folder : Path

    Raises
    ------
    OutputError
        The folder cannot be written, or holds a report on something else.
    """
    chapters = [_cover(found), _front(found)]
    if reasons_of(found):
        chapters.append(_lost(found))
    settings = json.loads(found.attrs["settings"])
    title = str(found.attrs["title"])
    title = title[0].upper() + title[1:]
    keys = ("machine", "method", "population", "starts", "seed")
    short = {k: settings[k] for k in keys if k in settings}
    closing = closing_chapter(title, short, {"design": settings}, chapters, "")
    subtitle = rounds_words(found)
    every = (*chapters, closing)
    files = tuple(f for chapter in every for f in chapter.files)
    return write_page(Composed(page_of(title, subtitle, every), files), folder, title)


def _cover(found: xr.Dataset) -> Chapter:
    said = [
        Answer(f"{title}: ", value, f" with {which}.", "the-front")
        for title, value, which in extremes(found)
    ]
    said.append(Answer(*comparison(found), "the-front"))
    front = on_front(design_objectives(found)[0][0], found).values
    feasible = int(np.count_nonzero(found["status"].to_numpy() == 0))
    limits = limits_words(found)
    kept = f" Limits: {'; '.join(limits)}." if limits else ""
    number = count(len(front), "machine")
    text = (
        f"{feasible} of {found.sizes['machine']} machines are feasible; no "
        f"other one is better in every objective than the {number} of the front.{kept} "
        f"Parameters: {parameter_words(found)}. {starts_words(found)}".rstrip()
    )
    blocks: list[Block] = [Answers(tuple(said)), _picture(found), Text(text), _picks(found)]
    heads, rows = design_rows(found)
    files = (
        csv_file(FRONT, "one row for each machine, those of the front first", heads, rows),
        netcdf_file(DATA, "everything of the design, with units and provenance", found),
    )
    return Chapter("which-machine", "Which machine?", tuple(blocks), files)


def _titled(column: NumberColumn, found: xr.Dataset) -> str:
    unit, _ = unit_of(column, found)
    return f"{title_of(column)} ({unit})" if unit else title_of(column)


def _read(column: NumberColumn, found: xr.Dataset) -> Any:
    return column.values * unit_of(column, found)[1]


def _picture(found: xr.Dataset) -> Figure:
    columns = [c for c, _ in design_objectives(found)]
    parameters = [on_front(p, found) for p in design_parameters(found)]
    front = [_read(on_front(c, found), found) for c in columns]
    labels = [f"machine {i + 1}: {machine_words(parameters, i, 3)}" for i in range(len(front[0]))]
    if len(columns) == 1:
        # one objective: over the parameter that varies most along it
        good = found["status"].to_numpy() == 0
        first = design_parameters(found)[0]
        words = [""] * int(good.sum())
        best = int(np.flatnonzero(np.flatnonzero(good) == found["front"].to_numpy()[0])[0])
        x, y = _read(first, found)[good], _read(columns[0], found)[good]
        spec = scatter(x, y, _titled(first, found), _titled(columns[0], found), words, best)
        caption = f"Feasible machines over {first.name}; the best is ringed."
        return Figure(KEY, caption, spec, "A point for each feasible machine.", FRONT)
    beside = found["status"].to_numpy() == 0
    beside[found["front"].to_numpy()] = False
    spec = front_scatter(
        [_titled(c, found) for c in columns],
        front,
        [_read(c, found)[beside] for c in columns],
        [float(found[c.name].attrs["stated"]) * unit_of(c, found)[1] for c in columns],
        labels,
    )
    goals = " and ".join(f"{goal.removesuffix('e')}ed {title_of(c)}" for c, goal in _two(found))
    return Figure(
        KEY,
        f"The front: {goals}. Click a point, or choose a machine below, to see what it is.",
        spec,
        "Machines as points over two objectives, those of the front joined and numbered below.",
        FRONT,
        460,
    )


def _two(found: xr.Dataset) -> Sequence[tuple[NumberColumn, str]]:
    return design_objectives(found)[:2]


def _picks(found: xr.Dataset) -> Picks:
    total = found.sizes["front"]
    columns = [*design_quantities(found), *design_parameters(found)]
    fronts = [on_front(c, found) for c in columns]
    objectives = [on_front(c, found) for c, _ in design_objectives(found)]
    from_file = bool(found.attrs.get("model_file"))
    machine = str(json.loads(found.attrs["settings"])["machine"])
    items = []
    for i in range(min(total, CHOICES)):
        words = ", ".join(value_words(c, float(c.values[i]), found, 3) for c in objectives)
        facts = tuple((title_of(c), value_words(c, float(c.values[i]), found)) for c in fronts)
        if from_file:
            name = f"machine-{i + 1}.toml"
            commands: tuple[str, ...] = (
                f"strutwork design {DATA} --pick {i + 1} -o {name}",
                f"strutwork report {name} -o machine-{i + 1}",
            )
        else:
            commands = (machine_code(changes_of(found, i + 1), machine),)
        items.append(Pick(f"{i + 1}: {words}", facts, commands))
    note = (
        "In the folder of this page these commands write the model file of the machine and its "
        "report:"
        if from_file
        else "In Python:"
    )
    return Picks("Machine", KEY, tuple(items), note)


def _front(found: xr.Dataset) -> Chapter:
    columns = [*design_quantities(found), *design_parameters(found)]
    fronts = [on_front(c, found) for c in columns]
    heads = [Column("machine")] + [Column(title_of(c), unit_of(c, found)[0]) for c in columns]
    rows = [
        [
            str(i + 1),
            *(significant(float(c.values[i]) * unit_of(c, found)[1], 4) for c in fronts),
        ]
        for i in range(found.sizes["front"])
    ]
    caption = "Machines that no other one beats in every objective"
    blocks: list[Block] = [Table(caption, heads, rows, FRONT)]
    if found.sizes["front"] > 1:
        objectives = [on_front(c, found) for c, _ in design_objectives(found)]
        parameters = [on_front(p, found) for p in design_parameters(found)]
        drawn = [*parameters[: AXES - len(objectives)], *objectives]
        spec = parallel(
            [_titled(c, found) for c in drawn],
            [_read(c, found) for c in drawn],
            len(drawn) - len(objectives),
        )
        blocks.append(
            Figure(
                "front-lines",
                "Each line is a machine of the front: parameters on the left, objectives on the "
                "right. Drag along an axis to keep the lines through a part of it.",
                spec,
                "Lines across parallel axes of parameters and objectives, one for each machine.",
                FRONT,
            )
        )
    title = f"{count(found.sizes['front'], 'machine')} on the front"
    return Chapter("the-front", "Which machines are on the front?", tuple(blocks), (), title)


def _lost(found: xr.Dataset) -> Chapter:
    rows = [[reason, str(number)] for reason, number in reasons_of(found).items()]
    heads = [Column("reason", numeric=False), Column("machines")]
    lost = int(np.count_nonzero(found["status"].to_numpy() != 0))
    return Chapter(
        "not-feasible",
        "Which machines are not feasible?",
        (Table("Machines that are not feasible, by reason", heads, rows, FRONT),),
        (),
        f"{lost} of {found.sizes['machine']}",
    )
