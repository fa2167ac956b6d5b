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
    """Called with the number of units done and their total."""

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


#: Said where the rest takes longer than what was done let expect.
LONGER = "longer than estimated"


@dataclass
class Remaining:
    """When work will end, by the rate at which it came as far as it is.

    Between two units it counts down: a unit that takes long does not let the estimate grow, and
    nothing is promised once the estimate has passed.
    """

    end: float | None = field(default=None, init=False)
    #: Units per second so far.
    rate: float = field(default=0.0, init=False)
    _begun: float | None = field(default=None, init=False, repr=False)
    _first: int = field(default=0, init=False, repr=False)
    _done: int = field(default=0, init=False, repr=False)

    def __call__(self, now: float, done: int, total: int) -> float | None:
        """Time left, s; zero where the estimate has passed, None where nothing is known yet.

        Parameters
        ----------
        now : float
            s, of a clock that never goes back.
        done, total : int
        """
        if self._begun is None:
            self._begun, self._first, self._done = now, done, done
        elif done > self._done:
            each = (now - self._begun) / (done - self._first)
            self._done, self.end = done, now + each * (total - done)
            self.rate = 1.0 / max(each, 1e-9)
        return None if self.end is None else max(0.0, self.end - now)


@dataclass
class Lines:
    """Occasional lines of progress, none for short work.

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
    _left: Remaining = field(default_factory=Remaining, init=False, repr=False)
    _due: float = field(default=0.0, init=False, repr=False)
    _spoke: bool = field(default=False, init=False, repr=False)

    def __call__(self, done: int, total: int, /) -> None:
        """Write a line when one is due; the last one only when others came before."""
        now = self.clock()
        left = self._left(now, done, total)
        if self._begun is None:
            self._begun, self._due = now, now + PATIENCE
            return
        finished = done >= total
        if (finished and not self._spoke) or (not finished and now < self._due):
            return
        elapsed = now - self._begun
        text = f"{self.label}: {done} of {total} {self.unit}"
        if finished:
            text += f", done in {elapsed:.0f} s"
        elif left is not None:
            text += f", {self._left.rate:.3g} per s"
            text += f", about {left:.0f} s left" if left >= 0.5 else f", {LONGER}"
        stream = sys.stderr if self.stream is None else self.stream
        stream.write(visible(text) + "\n")
        stream.flush()
        self._spoke, self._due = not finished, now + INTERVAL
