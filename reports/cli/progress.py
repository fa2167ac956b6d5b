"""Progress of long work on standard error: a bar in a terminal, lines now and then in a log."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bars

from strutwork.names import visible
from strutwork.reports.cli.output import progress_console
from strutwork.stages import stage
from strutwork.studies.progress import Lines, Progress


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


def _bars() -> Bars:
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    return Bars(*columns, console=progress_console(), transient=True)


def _started(bars: Bars, label: str) -> Progress:
    task = bars.add_task(visible(label), total=None)

    def tell(done: int, total: int, /) -> None:
        bars.update(task, completed=done, total=total)

    return tell
