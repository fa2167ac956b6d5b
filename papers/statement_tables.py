"""The chapter of a document's statements: tables turned, notes below, tests behind a line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

from strutwork.papers.statement_notes import Notes, marks
from strutwork.papers.statement_pivot import Turned, turned
from strutwork.papers.statements import NONE, Statement, difference_cell, printed, shown
from strutwork.papers.tables import texts
from strutwork.reports.content import Block, Cell, Chapter, Column, Details, Points, Table, Text
from strutwork.reports.long_tables import LONGEST, together
from strutwork.reports.numbers import count
from strutwork.reports.pivot import Entry, pivoted

HARD_SPACE = "\N{NO-BREAK SPACE}"

Letters = Callable[[Sequence[Statement]], str]


def statements_chapter(key: str, title: str, said: Sequence[Statement], data: str = "") -> Chapter:
    """A chapter with every statement, and below the tables notes and tests, each once.

    What a place says of several things stands in columns side by side; inputs that were taken
    as printed are a sentence; the others are rows, in several tables where they are many.

    Parameters
    ----------
    key, title : str
        Of the chapter.
    said : sequence of Statement
    data : str
        File beside the report that holds them, one a row.
    """
    notes = Notes(said)
    tests = list(dict.fromkeys(s.test for s in said))

    def letters(some: Sequence[Statement]) -> str:
        return ", ".join(dict.fromkeys(_letter(tests.index(s.test)) for s in some))

    held = letters if len(tests) > 1 else None
    side_by_side = [
        (place, table)
        for place, some in _by_place(said).items()
        if (table := turned(some)) is not None
    ]
    # the same statement may be made twice
    taken = {id(s) for _, table in side_by_side for s in table.said}
    left = [s for s in said if id(s) not in taken]
    inputs = [some for some in _alike(left, _input) if len(some) > 1]
    taken |= {id(s) for some in inputs for s in some}
    rows = _alike([s for s in left if id(s) not in taken], _words)
    blocks: list[Block] = [*_plain(rows, notes, held, len(said), data)]
    blocks += [_side_by_side(place, table, notes, held, data) for place, table in side_by_side]
    if inputs:
        blocks.append(Points(tuple(_sentence(some, notes) for some in inputs)))
    if notes.lines:
        blocks.append(Points(notes.lines))
    if held is None:
        blocks.append(Text(f"Held by {tests[0]}."))
    else:
        lines = (Text(f"{_letter(n)}:{HARD_SPACE}{test}") for n, test in enumerate(tests))
        blocks.append(Details(f"{count(len(tests), 'test')} that hold these results", tuple(lines)))
    return Chapter(key, title, tuple(blocks))


def _by_place(said: Sequence[Statement]) -> dict[str, list[Statement]]:
    found: dict[str, list[Statement]] = {}
    for statement in said:
        found.setdefault(statement.place, []).append(statement)
    return found


def _alike(
    said: Sequence[Statement], kind: Callable[[Statement], object]
) -> list[tuple[Statement, ...]]:
    """Neighbours of one kind together; those without a kind by themselves."""
    found: list[tuple[Statement, ...]] = []
    for what, group in groupby(said, key=kind):
        some = tuple(group)
        found += [some] if what is not None else [(s,) for s in some]
    return found


def _input(said: Statement) -> object:
    """Numbers that were taken as printed and chosen so: neighbours of a place and a reason."""
    same = not isinstance(said.published, str) and said.published == said.computed
    return (said.place, said.reason) if same and said.status == "calibrated" else None


def _words(said: Statement) -> object:
    """What is no number and the same in all but its name."""
    if not isinstance(said.published, str):
        return None
    return (said.published, str(said.computed), said.status, said.reason)


def _sentence(some: Sequence[Statement], notes: Notes) -> str:
    first = some[0]
    thing, colon, _ = first.what.partition(": ")
    common = colon and all(s.what.startswith(f"{thing}: ") for s in some)
    values = ", ".join(
        f"{printed(s.what.removeprefix(f'{thing}: ') if common else s.what)} "
        f"{shown(s.published, s.unit)}"
        for s in some
    )
    of = f" of {thing}" if common else ""
    return f"{first.place}{of}, taken as printed {marks(notes.of(first))}: {values}."


def _plain(
    rows: Sequence[tuple[Statement, ...]],
    notes: Notes,
    held: Letters | None,
    number: int,
    data: str,
) -> list[Table]:
    """One statement a row, or neighbours that differ by their name alone."""
    said = [s for some in rows for s in some]
    # among words a unit stands with its number, which leaves the words more room
    words = any(isinstance(v, str) for s in said for v in (s.published, s.computed))
    columns = (
        Column("place", "", False, width="narrow"),
        Column("what", "", False, width="wide"),
        # words wrap, numbers stand to the right
        Column("published", "", not any(isinstance(s.published, str) for s in said)),
        Column("computed", "", not any(isinstance(s.computed, str) for s in said)),
        *(() if words else texts("unit")),
        Column("difference"),
        Column("status", "", False, width="narrow"),
        *(texts("test") if held else ()),
    )
    runs = [
        [_row(some, notes, held, words) for some in run]
        for _, run in groupby(rows, key=lambda r: r[0].place)
    ]
    parts = together(runs, LONGEST)
    tables = []
    for part in parts:
        places = [str(row[0]) for row in part]
        of = f"{places[0]} to {places[-1]}" if places[0] != places[-1] else places[0]
        caption = f"{of}: published and computed"
        if len(parts) == 1:
            caption = f"Published and computed: {len(said)}"
            caption += f" of {number}, the others below" if number > len(said) else ""
        tables.append(Table(caption, columns, part, data))
    return tables


def _row(
    some: tuple[Statement, ...], notes: Notes, held: Letters | None, words: bool
) -> list[str | Cell]:
    first = some[0]
    return [
        "; ".join(dict.fromkeys(s.place for s in some)),
        "; ".join(printed(s.what) for s in some),
        *(shown(v, first.unit if words else "") for v in (first.published, first.computed)),
        *(() if words else (printed(first.unit),)),
        difference_cell(first),
        f"{first.status} {marks(notes.of(first))}".strip(),
        *([held(some)] if held else []),
    ]


def _side_by_side(
    place: str, table: Turned, notes: Notes, held: Letters | None, data: str
) -> Table:
    """Published and computed of each thing in columns; what is the same in all is said above."""
    said = table.said
    words = any(isinstance(v, str) for s in said for v in (s.published, s.computed))
    by_line: dict[str, list[Statement]] = {line: [] for line in table.lines}
    for (_, line), statement in zip(table.places, said, strict=True):
        by_line[line].append(statement)
    heads: dict[str, list[str]] = {
        "unit": [] if words else [printed(some[0].unit) for some in by_line.values()],
        "status": [_status(some, notes) for some in by_line.values()],
        "test": [held(some) for some in by_line.values()] if held else [],
    }
    # of inputs that were taken as printed one number says both
    single = all(_input(s) is not None for s in said)
    once = not single and all(len({str(s.published) for s in o}) == 1 for o in by_line.values())
    parts = [count(len(said), "result"), *(["taken as printed"] if single else [])]
    for head, texts_below in heads.items():
        if len(set(texts_below)) == 1:
            parts.append(f"test {texts_below[0]}" if head == "test" else texts_below[0])
    kept = {head: column for head, column in heads.items() if len(set(column)) > 1}
    if once:
        kept["published"] = [
            shown(some[0].published, some[0].unit if words else "") for some in by_line.values()
        ]
    first = {line: [column[n] for column in kept.values()] for n, line in enumerate(by_line)}
    # beside other columns there is no room for two of each of many things
    below = not single and not once and len(table.columns) > 2 and bool(kept)
    apart = not single and not once and not below
    columns = [Column("computed" if apart else "", "", not words)]
    if apart:
        columns.insert(0, Column("published", "", not words))
    entries = []
    for (column, line), s in zip(table.places, said, strict=True):
        some = by_line[line]
        published = shown(s.published, s.unit if words else "")
        cells: list[str | Cell] = [
            _computed(s, some, notes, words, f"published {published}" if below else "")
        ]
        if apart:
            cells.insert(0, published)
        entries.append(Entry([printed(line), *first[line]], printed(column), cells))
    if below:
        parts.append("computed above published")
    return pivoted(
        f"{place}: {', '.join(part for part in parts if part)}",
        [
            Column("", "", False, width="wide"),
            *(
                Column(
                    "published, and computed:" if head == "published" else head,
                    "",
                    head == "published" and not words,
                    width="narrow" if head == "status" else "",
                )
                for head in kept
            ),
        ],
        columns,
        entries,
        data,
    )


def _common(some: Sequence[Statement], notes: Notes) -> list[int]:
    """Notes that all of them have."""
    return sorted(set.intersection(*(set(notes.of(s)) for s in some)))


def _status(some: Sequence[Statement], notes: Notes) -> str:
    states = dict.fromkeys(s.status for s in some)
    text = next(iter(states)) if len(states) == 1 else "in the columns"
    return f"{text} {marks(_common(some, notes))}".strip()


def _computed(
    said: Statement, some: Sequence[Statement], notes: Notes, words: bool, published: str
) -> Cell:
    """The computed value; below it the difference and what its neighbours do not have."""
    found = difference_cell(said)
    same = not isinstance(said.published, str) and said.published == said.computed
    parts = (
        said.status if len({s.status for s in some}) > 1 else "",
        "" if found.text == NONE or same else found.text,
        marks(n for n in notes.of(said) if n not in _common(some, notes)),
    )
    value = shown(said.computed, said.unit if words else "")
    own = " ".join(part for part in parts if part)
    return Cell(value, found.tone, ", ".join(part for part in (published, own) if part))


def _letter(number: int) -> str:
    """A to z, then aa and so on."""
    text = ""
    number += 1
    while number:
        number, digit = divmod(number - 1, 26)
        text = chr(ord("a") + digit) + text
    return text
