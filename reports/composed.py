"""The report of any machine: the chapters that apply, in a reader's order."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from strutwork.errors import StrutworkError
from strutwork.machines.process_file import is_known
from strutwork.names import visible
from strutwork.reports.chapters import (
    accuracy,
    assembly_modes,
    dynamics,
    ellipsoids,
    inputs,
    motion,
    reversals,
    servo,
    singularities,
    stability,
    workspace_assembly,
    workspace_size,
    workspace_stiffness,
    workspace_vibration,
)
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.chapters.cover import answers_by_chapter, cover_blocks
from strutwork.reports.chapters.model import check_chapter, structure_chapter, summary_chapter
from strutwork.reports.chapters.model_loads import forces_chapter, loads_chapter
from strutwork.reports.chapters.model_tool import tool_chapter
from strutwork.reports.chapters.overconstraint_model import tolerance_chapter
from strutwork.reports.chapters.part_budget import budget_chapter
from strutwork.reports.chapters.vibration import vibration_chapter
from strutwork.reports.content import Answers, Block, Chapter, Links, Points, Text
from strutwork.reports.data_files import DataFile
from strutwork.reports.subject import Subject

#: Cover of a machine that a document describes.
COVER = "cover"
COVER_TEXT = (
    "These answers are for the machine at home, and each links to the chapter that says more. "
    "Further down, published values are shown beside the computed ones. Where the document "
    "leaves a dimension open, it is calibrated or assumed and these answers depend on it; the "
    "assumptions name each."
)

NO_TOOL = "it has no tool: add [tool] with tcp"


@dataclass(frozen=True)
class Offered:
    """A chapter, and when it applies.

    Parameters
    ----------
    key, title : str
    missing : callable
        Why a subject has no such chapter; empty where it has.
    write : callable
    """

    key: str
    title: str
    missing: Callable[[Subject], str]
    write: Callable[[Subject], Chapter]


def _always(_: Subject) -> str:
    return ""


def _needs_cases(subject: Subject) -> str:
    return "" if subject.model.cases else "there is no load case: add [[loads]] or gravity"


def _needs_tool(subject: Subject) -> str:
    return "" if subject.model.tool is not None else NO_TOOL


def _needs_stiffness(subject: Subject) -> str:
    if subject.model.tool is None:
        return NO_TOOL
    solution = subject.solution
    moves = solution is None or solution.compliance is None
    return "the tool moves freely" if moves else ""


def _needs_tolerances(subject: Subject) -> str:
    return "" if subject.model.tolerances else "no tolerances are given: add [[tolerances]]"


def _needs_vibration(subject: Subject) -> str:
    return (
        "" if subject.vibrates else "vibration needs mass and damping: add densities and [damping]"
    )


def _solved(write: Callable[[Any], Chapter]) -> Callable[[Subject], Chapter]:
    return lambda subject: write(subject.solution)


def _module(chapter: Any) -> Offered:
    return Offered(chapter.KEY, chapter.TITLE, chapter.missing, chapter.write)


#: What a report can say, in a reader's order; the cover stands before.
CHAPTERS: tuple[Offered, ...] = (
    Offered("structure", "What is it made of?", _always, lambda s: structure_chapter(s.model)),
    Offered(
        "check",
        "Can it move, and is any direction constrained twice?",
        _always,
        lambda s: check_chapter(s.check),
    ),
    _module(motion),
    _module(workspace_size),
    _module(singularities),
    _module(assembly_modes),
    _module(reversals),
    Offered("tool", "How stiff is it at home?", _needs_tool, _solved(tool_chapter)),
    _module(ellipsoids),
    Offered("budget", "What deforms most?", _needs_stiffness, lambda s: budget_chapter(s.model)),
    _module(workspace_stiffness),
    Offered("loads", "How does it bend under its loads?", _needs_cases, _solved(loads_chapter)),
    Offered("forces", "What do its joints and beams carry?", _needs_cases, _solved(forces_chapter)),
    Offered(
        "vibration",
        "How does it vibrate at home?",
        _needs_vibration,
        lambda s: vibration_chapter(s.vibration),
    ),
    _module(workspace_vibration),
    _module(servo),
    _module(stability),
    Offered(
        "tolerances",
        "Which forces do manufacturing errors lock in?",
        _needs_tolerances,
        lambda s: tolerance_chapter(s.model, s.tolerances),
    ),
    _module(workspace_assembly),
    _module(accuracy),
    _module(dynamics),
    _module(inputs),
)


def chapters_of(
    subject: Subject, offered: Sequence[Offered] = CHAPTERS
) -> tuple[tuple[Chapter, ...], tuple[tuple[str, str], ...]]:
    """Chapters that apply, and for the others title and reason.

    Raises
    ------
    StrutworkError
        The structure moves freely under its loads, or another answer cannot be found; names the
        chapter.
    """
    written: list[Chapter] = []
    left: list[tuple[str, str]] = []
    for one in offered:
        try:
            reason = one.missing(subject)
            if reason:
                left.append((one.title, reason))
            else:
                written.append(replace(one.write(subject), key=one.key, title=one.title))
        except StrutworkError as error:
            part = f'chapter "{one.title}"' + (f", {error.part}" if error.part else "")
            raise type(error)(part, error.problem, error.remedy) from error
    return tuple(written), tuple(left)


def chapters_beside(own: tuple[Chapter, ...], subject: Subject) -> tuple[Chapter, ...]:
    """Chapters that every machine has, put into a report that a document's machine has of its own.

    The cover answers first, then come those of the document, and before its closing chapter all
    others that it has not of its own: by their keys and the names of their files.

    Raises
    ------
    StrutworkError
        As `report_of`.
    """
    keys = {chapter.key for chapter in own}
    files = {file.name for chapter in own for file in chapter.files}
    offered = [one for one in CHAPTERS if one.key not in keys]
    written, _ = chapters_of(subject, offered)
    kept = [c for c in written if not files & {file.name for file in c.files}]
    known = keys | {chapter.key for chapter in kept}
    blocks, beside = cover_blocks(subject, [said for chapter in own for said in chapter.cover])
    answers = Chapter(COVER, "What it does", (*_known(blocks, known), Text(COVER_TEXT)), beside)
    *before, closing = own
    more = [*beside, *(file for chapter in kept for file in chapter.files)]
    return (answers, *_answered((*before, *kept), blocks), _with_files(closing, more))


def _known(blocks: Sequence[Block], keys: set[str]) -> tuple[Block, ...]:
    """Sentences that lead only to chapters that are there."""
    return tuple(
        Answers(tuple(replace(i, link=i.link if i.link in keys else "") for i in block.items))
        if isinstance(block, Answers)
        else block
        for block in blocks
    )


def _answered(chapters: Sequence[Chapter], cover: tuple[Block, ...]) -> tuple[Chapter, ...]:
    """Each chapter with what the cover says of it."""
    said = answers_by_chapter(cover)
    return tuple(replace(c, answer=c.answer or said.get(c.key, "")) for c in chapters)


def _with_files(closing: Chapter, files: Sequence[DataFile]) -> Chapter:
    """The closing chapter with some files more in its list."""
    more = tuple((file.name, file.what) for file in files)
    blocks = tuple(
        Links((*block.items, *more)) if isinstance(block, Links) else block
        for block in closing.blocks
    )
    return replace(closing, blocks=blocks)


def report_of(subject: Subject) -> tuple[Chapter, ...]:
    """Chapters of a machine's report.

    Raises
    ------
    StrutworkError
        The model is wrong, or moves freely under its loads.
    """
    written, left = chapters_of(subject)
    first = cover(subject)
    known = {chapter.key for chapter in written}
    first = replace(first, blocks=_known(first.blocks, known))
    if first.files:
        # how many nodes and freedoms it has stands in the back
        plain = summary_chapter(subject.model, subject.check, subject.solution)
        written = tuple(
            replace(c, blocks=(*plain.blocks[:1], *c.blocks)) if c.key == "check" else c
            for c in written
        )
    chapters = (first, *_answered(written, first.blocks))
    if left:
        lines = tuple(f"{title} {reason[0].upper()}{reason[1:]}." for title, reason in left)
        absent = Chapter(
            "absent",
            "What is missing here",
            (Text("These questions have no answer:"), Points(lines)),
        )
        chapters = (*chapters, absent)
    shown = visible(subject.name)
    settings = {"model": shown}
    if subject.solution is not None:
        settings["solver"] = subject.solution.statics.method
    command = None
    if subject.errors is not None and not is_known(subject.errors):
        beside = visible(subject.errors.name)
        settings["errors"] = beside
        again = (shlex.quote(shown), shlex.quote(beside))
        command = "strutwork report {} --errors {}".format(*again)
    closing = closing_chapter(shown, settings, _content(subject), chapters, command)
    return (*chapters, closing)


def cover(subject: Subject) -> Chapter:
    """What the machine does, in sentences, and its picture; where there is none, what it is."""
    plain = summary_chapter(subject.model, subject.check, subject.solution)
    blocks, files = cover_blocks(subject)
    return replace(plain, blocks=blocks if files else (*blocks, *plain.blocks), files=files)


def _content(subject: Subject) -> dict[str, Any]:
    """The tables' numbers, SI."""
    content: dict[str, Any] = {"title": subject.model.title}
    if subject.model.tolerances:
        content["tolerances"] = subject.tolerances.to_dict()
    if subject.vibrates:
        content["vibration"] = subject.vibration.to_dict()
    return content
