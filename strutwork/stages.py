"""What long work is at, for whoever watches it: the command line says it on standard error."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field


@dataclass(frozen=True, eq=False)
class Stage:
    """A piece of work under way.

    Parameters
    ----------
    what : str
        As in "reduces solid column, 305 000 degrees of freedom".
    estimate : float or None
        How long it takes, s, where that is foreseen.
    begun : float
        `time.monotonic()` at its start, s.
    silent : bool
        Whether the work itself reports how far it is.
    """

    what: str
    estimate: float | None = None
    begun: float = field(default_factory=time.monotonic)
    silent: bool = False

    def line(self, now: float) -> str:
        """What to say at the time `now` of `time.monotonic()`.

        Parameters
        ----------
        now : float
            s, of the same clock as `begun`.
        """
        text = f"{self.what or 'works'}, {now - self.begun:.0f} s so far"
        if self.estimate is not None:
            text += f" of about {self.estimate:.0f} s"
        return text


_open: list[Stage] = []


@contextmanager
def stage(what: str, estimate: float | None = None, *, silent: bool = False) -> Iterator[None]:
    """Do a piece of work in the sight of whoever watches.

    Parameters
    ----------
    what : str
    estimate : float or None
        s.
    silent : bool
        Whether it reports itself how far it is.
    """
    mine = Stage(what, estimate, silent=silent)
    _open.append(mine)
    try:
        yield
    finally:
        _open.remove(mine)


def current() -> Stage | None:
    """The innermost piece of work under way; None where there is none."""
    return _open[-1] if _open else None
