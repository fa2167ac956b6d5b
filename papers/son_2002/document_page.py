"""The page of Son 2002: every result that the thesis prints, beside the computed values."""

from __future__ import annotations

from itertools import groupby

from strutwork.machines.literature import SON_2002
from strutwork.papers.son_2002.statements import statements
from strutwork.papers.statement_tables import statements_chapter
from strutwork.papers.statements import count_text, statements_file
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter, Text
from strutwork.studies.progress import Teller

#: Chapters of the page: key, title, and the places of the thesis that begin it.
_PARTS = (
    ("serial", "Where is a serial machine singular?", ("section 2.1.1", "eq. 9", "eq. 10")),
    ("manipulability", "How well do drives move a hexapod?", ("section 2.2",)),
    (
        "scale",
        "What is the effect of size?",
        ("eqs 14, 15", "eq. 24", "Fig. 8", "Fig. 9", "eq. 22", "eq. 23"),
    ),
    (
        "reversals",
        "Where do drives reverse?",
        ("eq. 34", "section 4", "section 4.4.4", "section 4.4.5"),
    ),
    (
        "planar",
        "How does the planar machine move, and how stiff is it?",
        (
            *("section 6.4", "Fig. 34 (b), (c)", "section 6.1"),
            *("eqs 43 to 45", "section 6.3", "section 6.2", "Fig. 32", "Fig. 51"),
        ),
    ),
    ("table-2", "Which forces lock in?", ("Table 2",)),
    ("targets", "Does it meet its targets?", ("chapter 7",)),
    (
        "measured",
        "What was measured on it?",
        ("section 9.1.1", "Table 5", "section 9.1.3", "Table 6", "eq. 65", "section 9.2.1"),
    ),
    ("modes", "How does it vibrate?", ("eq. 66", "sections 6.2, 9.2.2", "Fig. 61")),
    ("bridge", "What about the moving bridge?", ("chapter 10",)),
)


def document_chapters(progress: Teller | None = None) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and chapters of the thesis's page."""
    told = None if progress is None else progress("results of the thesis")
    said = statements()
    if told is not None:
        told(len(said), len(said))
    file = statements_file(SON_2002.key, said)
    summary = Chapter(
        "summary",
        "Summary",
        (
            count_text(said),
            Text(
                "The machines' own reports, “strutwork report mit-ss1” and likewise "
                "hexel-hexapod, serial-five-axis and moving-bridge, explain how each number is "
                "computed; this page lists every result of the thesis in its order, with the "
                "test that checks it."
            ),
        ),
        (file,),
    )
    part_of = {place: key for key, _, places in _PARTS for place in places}
    by_part = {
        key: tuple(some)
        for key, some in groupby(
            sorted(said, key=lambda s: [p[0] for p in _PARTS].index(part_of[s.place])),
            key=lambda s: part_of[s.place],
        )
    }
    chapters = [
        summary,
        *(statements_chapter(key, title, by_part[key], file.name) for key, title, _ in _PARTS),
    ]
    chapters.append(closing_chapter(SON_2002.key, {}, {}, chapters))
    return (
        "A hybrid five-axis machine: results of its thesis beside the computed values",
        SON_2002.citation,
        tuple(chapters),
    )
