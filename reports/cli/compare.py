"""`strutwork compare`: two machines, question by question."""

from __future__ import annotations

from pathlib import Path

from rich.text import Text

from strutwork.errors import ModelError
from strutwork.fea import Damping, LossFactor, ModalRatio
from strutwork.machines.load import load
from strutwork.names import visible
from strutwork.reports.cli.manner import MANNER
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import Where
from strutwork.reports.designs.comparison import compare_standing
from strutwork.reports.designs.quantities import QUESTIONS
from strutwork.reports.designs.result import DesignComparison, unanswered
from strutwork.reports.designs.row import Verdict
from strutwork.reports.grid_words import grid_of_words

#: Colours never say more than the words that they are of.
STYLES: dict[Verdict, str] = {
    "A better": "bold red",
    "B better": "bold green",
    "differs": "bold",
    "not compared": "dim",
}


def run(
    names: tuple[str, str],
    at: Where,
    around: list[str] | None,
    threshold: float,
    html: str | None,
    *,
    modal_ratio: float | None,
    loss_factor: float | None,
    json: bool,
) -> None:
    """Compare two machines and print their differences."""
    damping = _damping(modal_ratio, loss_factor)
    grid = grid_of_words(around, "--around") if around else None
    a, b = (load(name) for name in names)
    with shown() as started:
        found = compare_standing(
            (names[0], a),
            (names[1], b),
            at.task,
            at.joints,
            around=grid,
            threshold=threshold,
            damping=damping,
            progress=started,
        )
    page = None if html is None else found.report(Path(html))
    if json:
        print_json(found.to_dict() | {"report": None if page is None else str(page)})
        return
    _print(found)
    if page is not None:
        console().print(f"Report: {visible(str(page))}", markup=False, soft_wrap=True)


def _damping(modal_ratio: float | None, loss_factor: float | None) -> Damping | None:
    if modal_ratio is not None and loss_factor is not None:
        raise ModelError(
            "damping", "is given as a modal ratio and as a loss factor.", "Give one of them."
        )
    if modal_ratio is not None:
        return ModalRatio(modal_ratio)
    return None if loss_factor is None else LossFactor(loss_factor)


def _print(found: DesignComparison) -> None:
    out = console()
    for mark, design in (("A", found.a), ("B", found.b)):
        out.print(f"{mark}: {visible(design.name)}, {design.title}", soft_wrap=True)
    for question in QUESTIONS:
        rows = found.of(question.key)
        if not MANNER.whole:
            rows = tuple(
                row for row in rows if (row.a.known or row.b.known) and row.verdict != "equal"
            )
            if question.key == "counts" or not rows:
                continue
        places = MANNER.whole and any(v.at or v.why for row in rows for v in (row.a, row.b))
        heads = ["quantity", "unit", "A", "B", "B − A", "verdict"]
        heads += ["A: where, or why not", "B: where, or why not"] if places else []
        lines = [
            (
                row.quantity.name,
                row.shown_unit,
                row.a.shown(row.quantity.unit),
                row.b.shown(row.quantity.unit),
                row.shown_difference,
                Text(row.verdict, STYLES.get(row.verdict, "")),
                *((row.a.at or row.a.why, row.b.at or row.b.why) if places else ()),
            )
            for row in rows
        ]
        out.print(table(found.title_of(question), heads, lines, names=2))
        if any(row.quantity.better for row in rows):
            out.print(question.criterion, style="dim", soft_wrap=True)
    for line in unanswered(found):
        out.print(line, soft_wrap=True)
    for note in found.notes:
        out.print(note, soft_wrap=True)
    out.print(
        f"Marked from a difference of {found.threshold:g} % of A. {found.summary}.",
        style="bold",
        soft_wrap=True,
    )
    if not MANNER.whole:
        out.print("--verbose shows every row, also equal ones, with the pose or the part of each.")
