"""Progress of long work on standard error: a bar in a terminal, lines now and then in a log."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    ProgressColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
)
from rich.progress import Progress as Bars
from rich.text import Text

from strutwork.names import visible
from strutwork.reports.cli.output import progress_console
from strutwork.stages import stage
from strutwork.studies.progress import INTERVAL, LONGER, Lines, Progress, Remaining


@contextmanager
def shown(unit: str = "poses") -> Iterator[Callable[[str], Progress]]:
    """Give a function that makes the progress of a piece of work from its label.

    `unit` is what is counted, in the plural.
    """
    with stage("", silent=True):
        if sys.stderr.isatty():
            with _bars() as bars:
                yield partial(_started, bars)
        else:
            yield partial(Lines, unit=unit)


@contextmanager
def counted(label: str, unit: str = "poses") -> Iterator[Callable[[int], None]]:
    """Give a function that shows how far a search is whose end nobody knows.

    `unit` is what is counted, in the plural.
    """
    with stage("", silent=True):
        if not sys.stderr.isatty():
            yield _Counting(f"{visible(label)}: ", unit)
            return
        columns = (TextColumn("{task.description}", markup=False), TimeElapsedColumn())
        with Bars(*columns, console=progress_console(), transient=True) as bars:
            task = bars.add_task(visible(label), total=None)
            yield lambda done: bars.update(task, description=f"{visible(label)}: {done} {unit}")


class _Counting:
    """A line now and then of what was done so far."""

    def __init__(self, label: str, unit: str) -> None:
        self.label, self.unit = label, unit
        self.begun = time.monotonic()
        self.due = self.begun + INTERVAL

    def __call__(self, done: int) -> None:
        now = time.monotonic()
        if now >= self.due:
            self.due = now + INTERVAL
            sys.stderr.write(f"{self.label}{done} {self.unit}, {now - self.begun:.0f} s so far\n")
            sys.stderr.flush()


class LeftColumn(ProgressColumn):
    """Time left by the task's field `end`, or that it takes longer than was estimated."""

    def render(self, task: Task) -> Text:
        """The cell of a task."""
        end: float | None = task.fields.get("end")
        if task.finished or end is None:
            return Text("")
        left = end - time.monotonic()
        return Text(f"{left:.0f} s left" if left >= 0.5 else LONGER)


class _Rate(ProgressColumn):
    """How many are done per second."""

    def render(self, task: Task) -> Text:
        """Empty until something is done."""
        return Text(f"{task.speed:.3g} per s" if task.speed else "")


def _bars() -> Bars:
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        _Rate(),
        LeftColumn(),
    )
    return Bars(*columns, console=progress_console(), transient=True)


def _started(bars: Bars, label: str) -> Progress:
    task = bars.add_task(visible(label), total=None)
    remaining = Remaining()

    def tell(done: int, total: int, /) -> None:
        remaining(time.monotonic(), done, total)
        bars.update(task, completed=done, total=total, end=remaining.end)

    return tell
