"""Reports of all machines, and a page that sets them side by side by the same questions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import StrutworkError
from strutwork.machines.catalogue import CATALOGUE
from strutwork.machines.load import load
from strutwork.machines.naming import heavy_variants, named_machine
from strutwork.reports.build import (
    Composed,
    WrittenReport,
    compose,
    page_of,
    paper_pages,
    write_page,
)
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.chapters.workspace_size import shown_unit
from strutwork.reports.content import Chapter, Column, Links, Note, Points, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.long_tables import LONGEST
from strutwork.reports.numbers import micro, significant
from strutwork.reports.report_folder import PAGE, require_ours
from strutwork.reports.subject import Subject, Teller
from strutwork.reports.survey_words import pose_text
from strutwork.studies.comparison import AXES, TASK, MachineAnswers, machine_answers

TITLE = "All machines side by side"
#: What the page that compares them is on.
ALL = "all machines"
NONE = "–"
CSV = "comparison.csv"

#: Its own data a page carries, the reports of others it does not.
BESIDE = (
    "Each report lies in the folder of its name, beside this page. Passed on alone, this page "
    "keeps its own data, and its links to the reports lead nowhere: pass on the entire folder."
)


@dataclass(frozen=True)
class Compared:
    """One machine of the comparison.

    Parameters
    ----------
    name, title : str
    answers : MachineAnswers
    vibrating : str
        The model that its frequency is of, where that is another.
    workspace : str
        Size of its whole workspace, with its unit; empty where none was found.
    """

    name: str
    title: str
    answers: MachineAnswers
    vibrating: str = ""
    workspace: str = ""


def write_every_report(
    folder: Path, progress: Teller | None = None, *, fresh: bool = False
) -> Iterator[WrittenReport]:
    """Write the report of every machine and document, then the page that compares the machines.

    Each report is on disk when it is yielded; a machine whose report cannot be made is named on
    the page with the reason, and the others go on.

    Parameters
    ----------
    folder : Path
        Each report goes into a folder of its name in it.
    progress : callable, optional
    fresh : bool
        Whether everything is computed anew, as of `strutwork.reports.build.write_report`.

    Yields
    ------
    WrittenReport
        The page that compares comes last.

    Raises
    ------
    OutputError
        A folder that cannot be written, or that holds files that are not ours.
    """
    names = [*CATALOGUE, *paper_pages()]
    require_ours(folder, (PAGE,), ALL)
    for name in names:
        require_ours(folder / name, (PAGE,), name)
    compared: list[Compared] = []
    failed: dict[str, str] = {}
    links: list[tuple[str, str]] = []
    for name in names:
        try:
            composed = compose(name, progress, fresh=fresh)
            if name in CATALOGUE:
                compared.append(_compared(name, composed.subject, progress))
        except StrutworkError as error:
            failed[name] = str(error)
            continue
        yield write_page(composed, folder / name, name)
        links.append((f"{name}/{PAGE}", composed.page.title))
    yield write_page(comparison_page(compared, links, failed), folder, ALL)


def comparison_page(
    compared: Sequence[Compared],
    links: Sequence[tuple[str, str]],
    failed: Mapping[str, str],
) -> Composed:
    """The page that sets machines side by side.

    Parameters
    ----------
    compared : sequence of Compared
    links : sequence of (str, str)
        Reports beside the page: path and title.
    failed : mapping of str to str
        Why the others have none.
    """
    chapters = [_comparison(compared), _reports(links, failed)]
    content = {"machines": {c.name: c.answers.to_dict() for c in compared}}
    closing = closing_chapter("all machines", {"task": TASK}, content, chapters)
    all_ = (*chapters, closing)
    subtitle = f"{len(compared)} machines, compared at the same task"
    files = tuple(f for chapter in all_ for f in chapter.files)
    return Composed(page_of(TITLE, subtitle, all_), files)


def _compared(name: str, subject: Subject | None, progress: Teller | None) -> Compared:
    found = named_machine(name)
    heavy = next(iter(heavy_variants(found)), "")
    told = None if progress is None else progress("the same questions")
    answers = machine_answers(
        load(name) if subject is None else subject.model, load(heavy) if heavy else None, told
    )
    return Compared(name, found.entry.title, answers, heavy, _size(subject))


def _size(subject: Subject | None) -> str:
    if subject is None or subject.unmoved or subject.unbounded:
        return ""
    factor, unit = shown_unit(subject.workspace.unit)
    return f"{significant(factor * subject.workspace.measure)} {unit}"


def _comparison(compared: Sequence[Compared]) -> Chapter:
    home = [Column(axis, "N/µm", group="stiffness at home") for axis in AXES]
    worst = [Column(axis, "N/µm", group="least stiffness in the task") for axis in AXES]
    stiff = (
        Column("machine", "", False),
        *home,
        *worst,
        Column("softest", "", False),
        Column("first frequency", "Hz"),
    )
    moves = (
        Column("machine", "", False),
        Column("freedoms"),
        Column("drives"),
        Column("redundant constraints"),
        Column("condition, least to largest"),
        Column("task reached"),
        Column("entire workspace"),
    )
    parts = _parts(compared)
    blocks = (
        Text(
            "Every machine is at home with its drives held, and the same is computed for each. "
            f"The task is {TASK}."
        ),
        *(
            Table(
                "Stiffness at the tool centre point, with the other directions free to follow"
                + words,
                stiff,
                [
                    [
                        c.name,
                        *(_stiffness(v) for v in (*c.answers.home, *c.answers.worst)),
                        _softest(c.answers),
                        _known(c.answers.frequency),
                    ]
                    for c in some
                ],
                CSV,
            )
            for words, some in parts
        ),
        *(
            Table(
                "Mobility; redundant constraints are those with the drives held" + words,
                moves,
                [
                    [
                        c.name,
                        f"{c.answers.mobility}",
                        f"{c.answers.drives}",
                        f"{c.answers.redundant}",
                        _range(c.answers.condition),
                        f"{c.answers.reached} of {c.answers.poses}",
                        c.workspace or NONE,
                    ]
                    for c in some
                ],
                CSV,
            )
            for words, some in parts
        ),
        Note(
            "Machines differ in size, and the documents leave dimensions open: a row shows what "
            "its model does, not which machine is better. The condition number takes the machine's "
            "characteristic length as one radian; the entire workspace is that of its report."
        ),
        *((Points(remarks),) if (remarks := tuple(_remarks(compared))) else ()),
    )
    return Chapter("comparison", "How do the machines compare?", blocks, (_csv(compared),))


def _parts(compared: Sequence[Compared]) -> list[tuple[str, Sequence[Compared]]]:
    """Many machines in two tables by their freedoms, with what the captions say of them."""
    if len(compared) <= LONGEST:
        return [("", compared)]
    six = [c for c in compared if c.answers.mobility >= 6]
    fewer = [c for c in compared if c.answers.mobility < 6]
    named = ((": six freedoms or more", six), (": fewer than six freedoms", fewer))
    return [(words, some) for words, some in named if some]


def _softest(answers: MachineAnswers) -> str:
    known = [(v, k) for k, v in enumerate(answers.worst) if np.isfinite(v)]
    if not known:
        return NONE
    _, k = min(known)
    return f"along {AXES[k]}, at {pose_text(answers.worst_at[k])}"


def _remarks(compared: Sequence[Compared]) -> Iterator[str]:
    for c in compared:
        if c.vibrating:
            yield f"{c.name}: the frequency is that of its model {c.vibrating}, which has a mass."
        for what, why in c.answers.missing.items():
            yield f"{c.name}, {what}: {' '.join(why.split())}"


def _reports(links: Sequence[tuple[str, str]], failed: Mapping[str, str]) -> Chapter:
    lines = tuple(f"{name}: {' '.join(why.split())}" for name, why in failed.items())
    without = (Text("Without a report:"), Points(lines)) if lines else ()
    blocks = (Text(BESIDE), Links(tuple(links))) if links else ()
    return Chapter("reports", "Where are their reports?", (*blocks, *without))


def _csv(compared: Sequence[Compared]) -> DataFile:
    columns = [
        "machine",
        "mobility",
        "drives",
        "redundant_constraints",
        *(f"stiffness_at_home_{a}_N_per_m" for a in AXES),
        *(f"least_stiffness_{a}_N_per_m" for a in AXES),
        "first_frequency_Hz",
        "least_condition",
        "largest_condition",
        "characteristic_length_m",
        "poses_reached",
        "poses",
    ]
    rows = [
        [
            c.name,
            c.answers.mobility,
            c.answers.drives,
            c.answers.redundant,
            *c.answers.home.tolist(),
            *c.answers.worst.tolist(),
            c.answers.frequency,
            *c.answers.condition.tolist(),
            c.answers.length,
            c.answers.reached,
            c.answers.poses,
        ]
        for c in compared
    ]
    return csv_file(CSV, "the same quantities of all machines, SI", columns, rows)


def _stiffness(value: float) -> str:
    return NONE if np.isnan(value) else micro(float(value))


def _known(value: float) -> str:
    return NONE if np.isnan(value) else significant(value)


def _range(values: NDArray[np.float64]) -> str:
    if np.isnan(values).any():
        return NONE
    return f"{significant(float(values[0]))} to {significant(float(values[1]))}"
