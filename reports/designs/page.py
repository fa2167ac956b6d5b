"""The page that shows how two machines differ: one file, with its data in it."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from strutwork.files import write_whole
from strutwork.names import visible
from strutwork.reports.archive import ARCHIVE, carried, write_archive
from strutwork.reports.build import page_of, with_archive
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import (
    Answer,
    Answers,
    Cell,
    Chapter,
    Column,
    Note,
    Page,
    Points,
    Table,
    Text,
    Tone,
)
from strutwork.reports.content import Row as Beside
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.designs.pictures import difference_bars, drawings
from strutwork.reports.designs.quantities import QUESTIONS, Question
from strutwork.reports.designs.result import DesignComparison, flat, tally, unanswered
from strutwork.reports.designs.row import Row, Value, Verdict
from strutwork.reports.page import render

#: Of the table of every number.
CSV = "comparison.csv"

#: Sentences on the cover.
MOST = 8

#: Title of a machine that stands at the head of the page, characters; else its name does.
LONGEST = 60

_TONES: dict[Verdict, Tone] = {
    "A better": "poor",
    "B better": "good",
    "differs": "fair",
    "not compared": "quiet",
    "equal": "quiet",
}

#: What the cover speaks of first, where it is marked.
HEADLINES = (
    "worst_stiffness_free_x",
    "worst_stiffness_free_y",
    "worst_stiffness_free_z",
    "frequency_1",
    "least_dynamic_stiffness_x",
    "least_dynamic_stiffness_y",
    "least_dynamic_stiffness_z",
    "mass",
    "locked_force",
    "limit_used",
    "tool_deviation",
    "poses_taken",
    "redundant_constraints",
)

#: The same in words of a sentence.
_SAID = {
    "worst_stiffness_free_x": "stiffness along x at the worst pose",
    "worst_stiffness_free_y": "stiffness along y at the worst pose",
    "worst_stiffness_free_z": "stiffness along z at the worst pose",
    "frequency_1": "first natural frequency",
    "locked_force": "largest assembly force",
    "limit_used": "largest share of a limit that assembly forces use",
    "tool_deviation": "largest deviation of the tool by tolerances",
    "poses_taken": "share of the poses that are reached",
    "redundant_constraints": "number of redundant constraints",
}


def write_comparison(found: DesignComparison, file: Path) -> Path:
    """Write the page, all of it or nothing.

    Parameters
    ----------
    found : DesignComparison
    file : Path
        Its data are in it: it may be passed on alone.

    Raises
    ------
    OutputError
        It cannot be written.
    """
    page = comparison_page(found)
    files = [one for chapter in page.chapters for one in chapter.files]

    def write(path: Path) -> None:
        # beside the page: what the disk says is said of the page
        with TemporaryDirectory(dir=path.parent) as folder:
            for one in files:
                one.write(Path(folder) / one.name)
            paths = [Path(folder) / one.name for one in files]
            data = carried(write_archive(Path(folder) / ARCHIVE, paths))
            path.write_text(render(with_archive(page), data), encoding="utf-8")

    return write_whole(file, write)


def comparison_page(found: DesignComparison) -> Page:
    """What the page says.

    Parameters
    ----------
    found : DesignComparison
    """
    chapters = [_cover(found), *(_chapter(found, q) for q in QUESTIONS)]
    names = [visible(design.name) for design in (found.a, found.b)]
    again = f"strutwork compare {shlex.join(names)} --html FILE" if found.named else ""
    settings = {"marked from": f"{found.threshold:g} %", "machines stand": found.where}
    closing = closing_chapter(" beside ".join(names), settings, found.to_dict(), chapters, again)
    titles = [
        design.title if len(design.title) <= LONGEST else name
        for design, name in zip((found.a, found.b), names, strict=True)
    ]
    title = " beside ".join(titles)
    subtitle = f"A is {names[0]}, B is {names[1]}; {found.where}"
    return page_of(title, subtitle, (*chapters, closing))


def _cover(found: DesignComparison) -> Chapter:
    bars, bars_file = difference_bars(found)
    pictures, pictures_file = drawings(found)
    notes = (*found.notes, *unanswered(found))
    blocks = (
        Text(_sentence(found.summary)),
        Answers(_sentences(found)),
        Beside(pictures, 340),
        *((bars,) if bars is not None else ()),
        Note(
            f"Differences are (B − A) / A; above {found.threshold:g} % they are marked, "
            "in green where B is better and in red where A is. Better "
            "means by the criterion that each chapter states, and only by that: machines of "
            "different sizes and tasks differ for good reasons."
        ),
        Points(notes),
    )
    files = (_csv(found), pictures_file, *((bars_file,) if bars_file is not None else ()))
    return Chapter("cover", "Which of the two is better in what?", blocks, files)


def _sentences(found: DesignComparison) -> tuple[Answer, ...]:
    said: list[Answer] = []
    for key in HEADLINES:
        row = found[key]
        if not row.marked or len(said) == MOST:
            continue
        name = _SAID.get(key, row.quantity.name)
        unit = f" {row.shown_unit}".rstrip()
        a, b = (v.shown(row.quantity.unit, 3) for v in (row.a, row.b))
        said.append(
            Answer(
                f"{row.verdict[0]} is better in the {name}: ",
                row.shown_difference,
                f" from A to B, {a}{unit} and {b}{unit}.",
                row.quantity.question,
                row.verdict == "A better",
            )
        )
    if not said:
        return (
            Answer(
                "In none of the headline quantities they differ by more than ",
                f"{found.threshold:g} %",
                ".",
            ),
        )
    return tuple(said)


def _chapter(found: DesignComparison, question: Question) -> Chapter:
    rows = found.of(question.key)
    placed = _placed(rows)
    lines = [_line(row, placed) for row in rows]
    table = Table(found.title_of(question), _columns(placed), lines, CSV)
    return Chapter(
        question.key,
        found.asks(question),
        (Text(question.criterion), table),
        answer=_sentence(tally(rows)),
    )


def _columns(placed: Sequence[str]) -> list[Column]:
    return [
        Column("quantity", "", False),
        Column("unit", "", False),
        Column("A"),
        Column("B"),
        Column("B − A"),
        Column("verdict", "", False),
        *(Column(f"{mark}: where, or why not", "", False, width="wide") for mark in placed),
    ]


def _placed(rows: Sequence[Row]) -> list[str]:
    """Machines of which the rows say more than a number."""
    found = {"A": [row.a for row in rows], "B": [row.b for row in rows]}
    return [mark for mark, values in found.items() if any(v.at or v.why for v in values)]


def _line(row: Row, placed: Sequence[str]) -> list[str | Cell]:
    tone = _TONES.get(row.verdict, "plain")
    numbers: list[str | Cell] = [
        Cell(v.shown(row.quantity.unit), "plain" if v.known else "quiet") for v in (row.a, row.b)
    ]
    more = {"A": row.a, "B": row.b}
    return [
        row.quantity.name,
        row.shown_unit,
        *numbers,
        row.shown_difference,
        Cell(row.verdict, tone),
        *(_place(more[mark]) for mark in placed),
    ]


def _place(value: Value) -> Cell:
    # the cover has the remedy as well
    return Cell(value.why.partition(". ")[0], "quiet") if value.why else Cell(value.at)


def _csv(found: DesignComparison) -> DataFile:
    lines = [flat(row) for row in found.rows]
    rows = [[_cell(v) for v in line.values()] for line in lines]
    return csv_file(CSV, "every quantity of both machines, SI", list(lines[0]), rows)


def _sentence(words: str) -> str:
    return f"{words[:1].upper()}{words[1:]}."


def _cell(value: object) -> object:
    return "infinite" if value == float("inf") else value
