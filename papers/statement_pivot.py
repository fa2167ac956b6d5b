"""Statements of one place that say the same of several things: which is a column, which a line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from strutwork.papers.statements import Statement
from strutwork.reports.long_tables import LONGEST

#: Most things side by side, each with its published and its computed value.
MOST_COLUMNS = 4

#: Fewest statements that are worth a table of their own, and the share of its cells they fill.
FEWEST, FILLED = 4, 0.75

#: Column and line of a statement; none where it has no such parts.
Place = tuple[str, str]
Cut = Callable[[str, str], Place | None]


@dataclass(frozen=True)
class Turned:
    """Statements in a table with a column for each thing.

    Parameters
    ----------
    places : tuple of (str, str)
        Column and line of each statement.
    said : tuple of Statement
    """

    places: tuple[Place, ...]
    said: tuple[Statement, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """The things compared."""
        return tuple(dict.fromkeys(column for column, _ in self.places))

    @property
    def lines(self) -> tuple[str, ...]:
        """What is said of each."""
        return tuple(dict.fromkeys(line for _, line in self.places))

    @property
    def filled(self) -> float:
        """Share of its cells that say something."""
        return len(self.said) / (len(self.columns) * len(self.lines))

    @property
    def worth(self) -> bool:
        """Whether it is easier to read than one row after another."""
        return (
            len(self.said) >= FEWEST
            and len(set(self.places)) == len(self.places)
            and 2 <= len(self.columns) <= MOST_COLUMNS
            and len(self.lines) <= LONGEST
            and self.filled >= FILLED
            # what has another unit is another quantity
            and len({(line, s.unit) for (_, line), s in zip(self.places, self.said, strict=True)})
            == len(self.lines)
        )


def turned(said: Sequence[Statement]) -> Turned | None:
    """The table that holds most of the statements of one place; None where there is none.

    Statements are read as "thing: quantity", where the thing may have several parts.

    Parameters
    ----------
    said : sequence of Statement

    Returns
    -------
    Turned or None
    """
    longest = max((len(s.what.partition(": ")[0].split()) for s in said), default=0)
    ways: list[Cut] = [_whole, _across]
    ways += [_cut(", ", k) for k in range(1, longest)] + [_cut(" ", k) for k in range(1, longest)]
    tables = [table for way in ways if (table := _table(said, way)) is not None and table.worth]
    # the first of equals: words are cut only where nothing better parts them
    return max(tables, key=lambda t: (len(t.said), t.filled, -len(t.lines)), default=None)


def _table(said: Sequence[Statement], way: Cut) -> Turned | None:
    found: list[tuple[Place, Statement]] = []
    for statement in said:
        thing, colon, quantity = statement.what.partition(": ")
        place = way(thing, quantity) if colon else None
        if place is not None:
            found.append((place, statement))
    # what is said of one thing alone is compared with nothing
    often = Counter(line for (_, line), _ in found)
    found = [(place, statement) for place, statement in found if often[place[1]] > 1]
    if not found:
        return None
    places, kept = zip(*found, strict=True)
    return Turned(places, kept)


def _whole(thing: str, quantity: str) -> Place | None:
    return thing, quantity


def _across(thing: str, quantity: str) -> Place | None:
    return quantity, thing


def _cut(between: str, parts: int) -> Cut:
    """The first parts of the thing are the column, the others begin the line."""

    def way(thing: str, quantity: str) -> Place | None:
        words = thing.split(between)
        if len(words) <= parts:
            return None
        rest = between.join(words[parts:])
        return between.join(words[:parts]).rstrip(","), f"{rest}: {quantity}"

    return way
