"""How far long work is: a bar on a terminal, sparse lines elsewhere, on standard error."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from studies.progress import PATIENCE, Lines, Progress

if TYPE_CHECKING:
    from rich.progress import Progress as RichProgress


@contextmanager
def shown_progress(label: str) -> Iterator[Progress]:
    """What a study is given as `progress` while it runs.

    Parameters
    ----------
    label : str
        What is being done.

    Yields
    ------
    Progress
        Silent for work shorter than `studies.progress.PATIENCE`.
    """
    if not sys.stderr.isatty():
        yield Lines(label)
        return
    # rich is slow to import and needed on terminals only
    from rich.console import Console
    from rich.progress import Progress as RichProgress

    bar = RichProgress(console=Console(stderr=True), transient=True)
    try:
        yield _Bar(label, bar)
    finally:
        bar.stop()


class _Bar:
    """A rich bar that appears once the work has lasted a while."""

    def __init__(self, label: str, bar: RichProgress) -> None:
        self.bar = bar
        self.task = bar.add_task(label, total=None)
        self.begun = time.monotonic()

    def __call__(self, done: int, total: int, /) -> None:
        self.bar.update(self.task, completed=done, total=total)
        if not self.bar.live.is_started and time.monotonic() - self.begun > PATIENCE:
            self.bar.start()
