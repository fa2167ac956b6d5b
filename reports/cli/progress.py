"""Progress of long work on standard error: a bar in a terminal, lines now and then in a log."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bars

from reports.cli.output import progress_console
from strutwork.names import visible
from studies.progress import Lines, Progress


@contextmanager
def shown(unit: str = "poses") -> Iterator[Callable[[str], Progress]]:
    """Give a function that makes the progress of a piece of work from its label.

    `unit` is what is counted, in the plural.
    """
    if not sys.stderr.isatty():
        yield partial(Lines, unit=unit)
        return
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Bars(*columns, console=progress_console(), transient=True) as bars:

        def started(label: str) -> Progress:
            task = bars.add_task(visible(label), total=None)

            def tell(done: int, total: int, /) -> None:
                bars.update(task, completed=done, total=total)

            return tell

        yield started
