"""Reasons of statements as notes: what several reasons have in common is said once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from strutwork.papers.statements import Statement, printed

BETWEEN = "; "


class Notes:
    """Notes below tables, numbered in the order in which the statements need them.

    Parameters
    ----------
    said : sequence of Statement
    """

    def __init__(self, said: Sequence[Statement]) -> None:
        reasons = list(dict.fromkeys(s.reason for s in said if s.reason))
        often = Counter(part for reason in reasons for part in set(reason.split(BETWEEN)))
        self._parts = {reason: _parts(reason, often) for reason in reasons}
        self._numbers: dict[str, int] = {}

    def of(self, statement: Statement) -> tuple[int, ...]:
        """Numbers of a statement's notes."""
        parts = self._parts.get(statement.reason, ())
        return tuple(self._numbers.setdefault(p, len(self._numbers) + 1) for p in parts)

    @property
    def lines(self) -> tuple[str, ...]:
        """Every note that was needed, with its number."""
        return tuple(printed(f"({n}) {p[0].upper()}{p[1:]}.") for p, n in self._numbers.items())


def marks(numbers: Iterable[int]) -> str:
    """References to notes, or nothing.

    >>> marks([3, 14]), marks([])
    ('(3, 14)', '')
    """
    text = ", ".join(str(n) for n in numbers)
    return f"({text})" if text else ""


def _parts(reason: str, often: Counter[str]) -> tuple[str, ...]:
    """Clauses that other reasons have too, each by itself; the others stay together."""
    found: list[str] = []
    alone = False
    for part in reason.split(BETWEEN):
        if often[part] == 1 and alone:
            found[-1] += BETWEEN + part
        else:
            found.append(part)
        alone = often[part] == 1
    return tuple(found)
