"""How accurate it is, at home and over the workspace."""

from __future__ import annotations

import numpy as np

from strutwork.kinematics import DIRECTIONS
from strutwork.reports.alike import grouped, word
from strutwork.reports.chapters.error_sheet import error_blocks
from strutwork.reports.content import Block, Chapter, Column, Note, Row, Table, Text
from strutwork.reports.data_files import DataFile, netcdf_file
from strutwork.reports.figures.slices import slice_figure
from strutwork.reports.numbers import count, share, significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text, largest
from strutwork.studies.accuracy_answer import top_sources
from strutwork.studies.survey_files import write_survey

KEY = "accuracy"
TITLE = "How accurate is it?"
STEM = "accuracy-survey"


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    if subject.model.tool is None:
        return "it has no tool: add [tool] with tcp"
    answer = subject.accuracy_answer
    if subject.errors is None and not answer.tolerances and not answer.errors:
        return "no errors are given: add [[tolerances]], or a resolution to [[drives]]"
    return ""


def write(subject: Subject) -> Chapter:
    """Displacement of the tool by all errors, its causes, and its map."""
    answer = subject.accuracy_answer
    more, beside = error_blocks(subject)
    if not answer.tolerances and not answer.errors:
        return Chapter(KEY, TITLE, tuple(more), beside)
    found = answer.at(subject.model.placed)
    place, parts = found.largest()
    most = float(np.linalg.norm(place))
    rows = []
    for i, direction in enumerate(DIRECTIONS):
        unit = "µrad" if direction.startswith("r") else "µm"
        values = (found.worst, found.root_sum_square, found.deviation)
        rows.append([direction, unit, *(significant(1e6 * float(v[i])) for v in values)])
    how = "through elastic deformation" if bool(found.elastic) else "without force"
    blocks: list[Block] = [
        Text(
            f"{count(len(answer.tolerances), 'tolerance')} and "
            f"{count(len(answer.errors), 'drive error')} of half a resolution to either side; the "
            f"tool follows them {how}. At home it is displaced"
            f"{subject.model.relative} by {significant(1e6 * most)} µm in the worst case, in any "
            "direction."
        ),
        Table(
            "Displacement of the tool at home, to either side",
            (
                Column("tool", "", False),
                Column("unit", "", False),
                Column("at worst"),
                Column("root of squares"),
                Column("standard deviation"),
            ),
            rows,
        ),
        _causes(list(found.names), parts, "home"),
    ]
    files: tuple[DataFile, ...] = ()
    if not subject.unmoved:
        some, files = _map(subject)
        blocks += some
    return Chapter(KEY, TITLE, (*more, *blocks), (*beside, *files))


def _causes(
    names: list[str], parts: np.ndarray[tuple[int], np.dtype[np.float64]], at: str
) -> Table:
    total = float(np.sum(parts)) or 1.0
    by_name = dict(zip(names, np.asarray(parts, dtype=float).tolist(), strict=True))
    groups = grouped(dict.fromkeys(names, ()))
    alike = [word(group.names) or group.label for group in groups]
    sums = np.array([sum(by_name[name] for name in group.names) for group in groups])
    rows = [
        [name, significant(1e6 * value), share(value / total)]
        for name, value in top_sources(alike, sums)
    ]
    columns = (Column("sources of error", "", False), Column("adds", "µm"), Column("share"))
    return Table(f"Largest contributors to the largest displacement, {at}", columns, rows)


def _map(subject: Subject) -> tuple[list[Block], tuple[DataFile, ...]]:
    found = subject.accuracy_survey
    values = 1e6 * found["largest_displacement"].to_numpy()
    worst = largest(found, values)
    parts = found["contribution"].to_numpy()[worst.index]
    names = [str(s) for s in found["source"].to_numpy()]
    figures = [
        slice_figure(
            found,
            values,
            ("largest displacement", "µm"),
            f"{STEM}-largest",
            f"{STEM}.csv",
            worst_is_least=False,
        )
    ]
    for axis in "xyz":
        along = 1e6 * found["worst_case"].sel(direction=axis).to_numpy()
        figures.append(
            slice_figure(
                found,
                along,
                (f"displacement along {axis} at worst", "µm"),
                f"{STEM}-{axis}",
                f"{STEM}.csv",
                worst_is_least=False,
            )
        )
    blocks: list[Block] = [
        Note(
            f"Over {grid_text(subject.grid)} the tool is displaced{subject.model.relative} by "
            f"{significant(worst.value)} µm at most, at {worst.where}: "
            "the volumetric accuracy of the machine as far as "
            "these errors determine it."
        ),
        _causes(names, parts, f"at {worst.where}"),
        Row(tuple(figures), 330),
    ]
    files = (
        netcdf_file(f"{STEM}.nc", "accuracy over the workspace, NetCDF", found),
        DataFile(
            f"{STEM}.csv",
            "accuracy over the workspace: one line per pose",
            lambda path: write_survey(path, found),
        ),
    )
    return blocks, files
