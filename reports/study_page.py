"""The report of a study: which machine is best in what, and which parameter decides."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from strutwork.errors import ModelError
from strutwork.reports.build import Composed, WrittenReport, page_of, write_page
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Answer, Answers, Chapter, Column, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, netcdf_file
from strutwork.reports.figures.study import parallel, rank_bars, scatter
from strutwork.reports.numbers import count, significant
from strutwork.reports.study_analysis_page import analysis_chapters
from strutwork.reports.study_words import gap_words, machine_words, read_value, reading, title_of
from strutwork.studies.study import Study
from strutwork.studies.study_table import (
    NumberColumn,
    answer_columns,
    leading,
    parameter_columns,
    rank_correlation,
    study_columns,
)
from strutwork.studies.travel_answer import TRAVELLED

#: Machines in each table, answers and parameters that are drawn.
ROWS, DRAWN = 8, 4

MACHINES, RANKS, DATA = "machines.csv", "rank-correlations.csv", "study.nc"


def write_study_report(study: Study, found: xr.Dataset, folder: Path) -> WrittenReport:
    """Write the report of a study.

    Parameters
    ----------
    study : Study
    found : xarray.Dataset
        Its result.
    folder : Path

    Raises
    ------
    OutputError
        The folder cannot be written, or holds a report on something else.
    ModelError
        No answer is finite.
    """
    parameters = parameter_columns(found)
    answers = main_answers(study, found)
    if not answers:
        raise ModelError("study", "has no finite answer to show.", "Ask for something else.")
    chapters: tuple[Chapter, ...] = (
        _cover(study, found, parameters, answers),
        *analysis_chapters(found, answers, MACHINES),
        _effects(study, parameters, answers, answer_columns(found)),
        _machines(study, found, parameters, answers),
    )
    title = f"Study of {study.machine.title}"
    closing = closing_chapter(title, study.settings, {}, chapters)
    poses = 0 if study.workspace is None else len(study.workspace)
    where = f"at {count(poses, 'pose')} and at home" if poses else "at home"
    subtitle = f"{count(len(study), 'machine')}, each asked {where}"
    every = (*chapters, closing)
    page = page_of(title, subtitle, every)
    files = tuple(f for chapter in every for f in chapter.files)
    return write_page(Composed(page, files), folder, title)


def main_answers(study: Study, found: xr.Dataset) -> tuple[NumberColumn, ...]:
    """One reduction of each answer along x, y, z or of the first mode: what is shown first.

    Parameters
    ----------
    study : Study
    found : xarray.Dataset
        Its result.
    """
    worst = study.workspace is not None and "worst" in study.reductions
    end = "_worst" if worst else "_home"
    some = [
        c
        for c in answer_columns(found)
        if (c.variable == "mass" or c.variable.endswith(end))
        and "blocked" not in c.variable
        and c.label in ("x", "y", "z", "1", "")
        and np.isfinite(c.values).any()
    ]
    some += [c for c in answer_columns(found) if c.variable == TRAVELLED][:DRAWN]
    return (
        tuple(some)
        or tuple(c for c in answer_columns(found) if np.isfinite(c.values).any())[:DRAWN]
    )


def worst_is(study: Study, column: NumberColumn) -> str:
    """Whether the least or the largest value of an answer is the worst.

    Parameters
    ----------
    study : Study
    column : NumberColumn
    """
    kept = {k.name: k.column.worst for k in study.machines.kept} | {TRAVELLED: "largest"}
    return kept.get(column.variable, "least") or "least"


def _best(study: Study, column: NumberColumn) -> int:
    least = worst_is(study, column) == "largest"
    return int((np.nanargmin if least else np.nanargmax)(column.values))


def _cover(
    study: Study,
    found: xr.Dataset,
    parameters: Sequence[NumberColumn],
    answers: Sequence[NumberColumn],
) -> Chapter:
    said = []
    for column in answers:
        row = _best(study, column)
        low, high = float(np.nanmin(column.values)), float(np.nanmax(column.values))
        name, rank = leading(list(parameters), column.values)
        way = f"; it follows {name} most (rank correlation {rank:.2f})" if name else ""
        # of many parameters the values fill a paragraph
        many = len(parameters) > DRAWN
        which = f"machine {row}" if many else machine_words(parameters, row, 3)
        said.append(
            Answer(
                f"{title_of(column).capitalize()} goes from {read_value(column, low, 3)} to "
                f"{read_value(column, high, 3)}: the best is ",
                read_value(column, float(column.values[row]), 3),
                f" with {which}{way}.",
                "what-decides",
            )
        )
    solved = int(np.count_nonzero(found["status"].to_numpy() == 0))
    lost = len(study) - solved
    text = f"All {len(study)} machines can be built."
    if lost:
        text = f"{solved} of {len(study)} machines can be built; {MACHINES} says why others cannot."
    poses = 0 if study.workspace is None else len(study.workspace)
    text = " ".join([text, *gap_words(found, poses, answers)])
    blocks: list[Answers | Text | Figure] = [Answers(tuple(said)), Text(text)]
    drawn = [*parameters[:DRAWN], *answers[:DRAWN]]
    titles, values = zip(*(_read(c) for c in drawn), strict=True)
    blocks.append(
        Figure(
            "all-machines",
            "Each line is a machine: its parameters on the left, its answers on the right. Drag "
            "along an axis to keep the lines through a part of it, drag a title to move its axis.",
            parallel(titles, values, min(len(parameters), DRAWN)),
            "Lines across parallel axes of parameters and answers, one for each machine.",
            MACHINES,
        )
    )
    files = (
        _machine_file(found),
        netcdf_file(DATA, "everything of the study, with units and provenance", found),
    )
    return Chapter("what-comes-of-it", "What comes of it?", tuple(blocks), files)


def _read(column: NumberColumn) -> tuple[str, np.ndarray]:
    """Title with the unit, and values in it."""
    unit, factor = reading(column)
    title = title_of(column)
    return f"{title} ({unit})" if unit else title, column.values * factor


def _machine_file(found: xr.Dataset) -> DataFile:
    columns = study_columns(found)
    rows = list(zip(*(c.cells for c in columns), strict=True))
    return csv_file(MACHINES, "one row for each machine", [c.head for c in columns], rows)


def _effects(
    study: Study,
    parameters: Sequence[NumberColumn],
    answers: Sequence[NumberColumn],
    every: Sequence[NumberColumn],
) -> Chapter:
    def ranks(columns: Sequence[NumberColumn]) -> np.ndarray:
        return np.array(
            [[rank_correlation(p.values, a.values) for p in parameters] for a in columns]
        )

    names = [p.name for p in parameters]
    shown = ranks(answers)
    blocks: list[Text | Figure | Row] = [
        Text(
            "The rank correlation (Spearman) is 1 where an answer always rises with a parameter, "
            "−1 where it always falls, and near 0 where others decide or it rises and falls."
        ),
        Figure(
            "rank-correlations",
            "How the answers follow each parameter.",
            rank_bars([title_of(a) for a in answers], names, shown),
            "Bars from −1 to 1 for each answer and parameter.",
            RANKS,
            160 + (26 + 14 * len(names)) * len(answers),
        ),
    ]
    for a, column in enumerate(answers[:DRAWN]):
        order = np.argsort(-np.abs(np.nan_to_num(shown[a])))[:3]
        labels = [machine_words(parameters, i, 3) for i in range(len(column.values))]
        y_title, y = _read(column)
        blocks.append(
            Row(
                tuple(
                    Figure(
                        f"effect-{a}-{k}",
                        f"{title_of(column)} over {parameters[k].name}; the best is ringed.",
                        scatter(
                            _read(parameters[k])[1],
                            y,
                            _read(parameters[k])[0],
                            y_title,
                            labels,
                            _best(study, column),
                        ),
                        f"A point for each machine: {y_title} over {_read(parameters[k])[0]}.",
                        MACHINES,
                        340,
                    )
                    for k in order
                )
            )
        )
    rows = [[c.name, *row] for c, row in zip(every, ranks(every).tolist(), strict=True)]
    files = (csv_file(RANKS, "rank correlations of all answers", ["answer", *names], rows),)
    return Chapter("what-decides", "What decides?", tuple(blocks), files)


def _machines(
    study: Study,
    found: xr.Dataset,
    parameters: Sequence[NumberColumn],
    answers: Sequence[NumberColumn],
) -> Chapter:
    first = answers[0]
    order = np.argsort(first.values)
    order = order[np.isfinite(first.values[order])]
    if worst_is(study, first) == "least":
        order = order[::-1]
    shown = [*parameters, *answers]
    columns = [Column("machine")] + [Column(title_of(c), reading(c)[0]) for c in shown]

    def table(caption: str, rows: np.ndarray) -> Table:
        cells = [
            [str(i), *(significant(float(c.values[i]) * reading(c)[1], 4) for c in shown)]
            for i in rows.tolist()
        ]
        return Table(caption, columns, cells, MACHINES)

    best = table(f"The best by {title_of(first)}", order[:ROWS])
    worst = table(f"The worst by {title_of(first)}", order[::-1][:ROWS])
    blocks: list[Table | Text] = [best, worst]
    texts = [str(t) for t in found["reason_text"].to_numpy()]
    numbers = np.bincount(found["reason"].to_numpy().ravel(), minlength=len(texts))
    lost = [[t, str(int(n))] for t, n in zip(texts, numbers, strict=True) if t and n]
    if lost:
        heads = [Column("reason", numeric=False), Column("machines")]
        blocks.append(Table("Machines that cannot be", heads, lost, MACHINES))
    return Chapter("machines", "Which machines?", tuple(blocks))
