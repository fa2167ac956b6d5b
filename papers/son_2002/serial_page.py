"""What the thesis adds to the report of the serial five-axis machines."""

from __future__ import annotations

from strutwork.machines import MovingBridge, get
from strutwork.papers.son_2002.chapters.serial import (
    assumptions_chapter,
    flat_chapter,
    heads_chapter,
)
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter, Points, Text
from strutwork.studies.description import parameters
from strutwork.studies.progress import Teller

OPEN = (
    (
        "From the thesis: the planar machine with all its dimensions (Appendix B), and that the "
        "bridge carries all three rails."
    ),
    (
        "Dimensions, mass and stiffness of the bridge, its drive and its guideway are not "
        "printed. They are rigid here, so statics and modes are those of the planar machine on "
        "fixed rails; a bridge would add its own compliance."
    ),
    (
        f"The bridge's mass of {MovingBridge.bridge_mass:g} kg is assumed; it affects only the "
        "force of the drive along y."
    ),
)


def serial_chapters(
    name: str, _progress: Teller | None = None
) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and the chapters that the thesis adds to the machine's report."""
    entry = get(name)
    chapters = [heads_chapter(), flat_chapter(), assumptions_chapter()]
    content = {"parameters": parameters(entry.factory())}
    chapters.append(closing_chapter(name, {"machine": name}, content, chapters))
    return entry.title, f"{entry.topology} · {entry.paper.citation}", tuple(chapters)


def bridge_chapters(
    name: str, _progress: Teller | None = None
) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and the chapters that the thesis adds to the moving bridge's report."""
    entry = get(name)
    chapters = [bridge_chapter(), flat_chapter()]
    content = {"parameters": parameters(entry.factory())}
    chapters.append(closing_chapter(name, {"machine": name}, content, chapters))
    return entry.title, f"{entry.topology} · {entry.paper.citation}", tuple(chapters)


def bridge_chapter() -> Chapter:
    """What chapter 10 says, and what it leaves open."""
    return Chapter(
        "bridge",
        "What does the text support?",
        (
            Text(
                "In chapter 10 the planar machine of the MIT-SS-1 hangs from a moving bridge "
                "over a fixed workpiece: four axes, x, z and b of the planar machine and y of "
                "the bridge, along a guideway of almost unlimited length."
            ),
            Points(OPEN),
        ),
    )
