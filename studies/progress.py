"""Telling how far long work is: sparse lines on standard error.

A bar for terminals lives with the other faces in `reports`; this one serves log files, and
anything that calls a study without a face.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol, TextIO

from strutwork.names import visible

#: Work shorter than this is not worth a word, s.
PATIENCE = 2.0

#: Time between two lines, s.
INTERVAL = 15.0


class Progress(Protocol):
    """Called with how many units are done, and of how many."""

    def __call__(self, done: int, total: int, /) -> None:
        """Take note; called from one thread, `done` never falls."""


#: Given the name of a part of the work, returns what is told how far it is.
Teller = Callable[[str], Progress]


def silent(done: int, total: int, /) -> None:
    """Say nothing.

    Parameters
    ----------
    done, total : int
    """


def share(progress: Progress | None, number: int, count: int) -> Progress:
    """What one of several equally long parts is given to report to.

    Parameters
    ----------
    progress : callable or None
        That of all parts together; None for none.
    number : int
        Of the part, counted from zero.
    count : int
        Of all parts.
    """

    def tell(done: int, total: int, /) -> None:
        if progress is not None:
            progress(number * total + done, count * total)

    return tell


@dataclass
class Lines:
    """A line now and then, none at all for short work.

    Parameters
    ----------
    label : str
        What is being done.
    unit : str
        What is counted, in the plural.
    stream : text file
        Standard error by default.
    clock : callable
        Seconds.
    """

    label: str
    unit: str = "poses"
    stream: TextIO | None = None
    clock: Callable[[], float] = time.monotonic
    _begun: float | None = field(default=None, init=False, repr=False)
    _first: int = field(default=0, init=False, repr=False)
    _due: float = field(default=0.0, init=False, repr=False)
    _spoke: bool = field(default=False, init=False, repr=False)

    def __call__(self, done: int, total: int, /) -> None:
        """Write a line when one is due; the last one only when others came before."""
        now = self.clock()
        if self._begun is None:
            self._begun, self._first, self._due = now, done, now + PATIENCE
            return
        finished = done >= total
        if (finished and not self._spoke) or (not finished and now < self._due):
            return
        elapsed = now - self._begun
        text = f"{self.label}: {done} of {total} {self.unit}"
        if finished:
            text += f", done in {elapsed:.0f} s"
        elif done > self._first:
            rate = (done - self._first) / elapsed
            text += f", {rate:.3g} per s, about {(total - done) / rate:.0f} s left"
        stream = sys.stderr if self.stream is None else self.stream
        stream.write(visible(text) + "\n")
        stream.flush()
        self._spoke, self._due = not finished, now + INTERVAL
