"""What a chapter says: typed blocks that the page's template turns into HTML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, ClassVar, Literal

from strutwork.reports.data_files import DataFile

Spec = Mapping[str, Any]
Tone = Literal["plain", "good", "fair", "poor", "quiet"]


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    text: str
    kind: ClassVar[str] = "text"


@dataclass(frozen=True)
class Note:
    """A paragraph set apart: what a reader must know to read the numbers beside it."""

    text: str
    kind: ClassVar[str] = "note"


@dataclass(frozen=True)
class Fact:
    """A headline number.

    Parameters
    ----------
    label : str
    value : str
        Already rounded.
    unit : str
    detail : str
        Second line, smaller.
    link : str
        Key of the chapter that says more; empty for none.
    """

    label: str
    value: str
    unit: str = ""
    detail: str = ""
    link: str = ""


@dataclass(frozen=True)
class Facts:
    """Headline numbers side by side."""

    items: tuple[Fact, ...]
    kind: ClassVar[str] = "facts"


@dataclass(frozen=True)
class Column:
    """Heading of a table's column; numbers stand to the right.

    Parameters
    ----------
    title : str
    unit : str
    numeric : bool
    group : str
        Heading over neighbouring columns of the same group.
    width : "", "wide" or "narrow"
        Of a column of words: more room than its neighbours, or lines broken early.
    """

    title: str
    unit: str = ""
    numeric: bool = True
    group: str = ""
    width: Literal["", "wide", "narrow"] = ""

    @property
    def label(self) -> str:
        """All of its heading in one line, for a cell that stands by itself."""
        words = ", ".join(part for part in (self.group, self.title) if part)
        return f"{words} ({self.unit})" if self.unit and words else words or self.unit


@dataclass(frozen=True)
class Cell:
    """A cell with a tone: its colour never says more than its words.

    Parameters
    ----------
    text : str
    tone : "plain", "good", "fair", "poor" or "quiet"
    detail : str
        Second line, smaller.
    """

    text: str
    tone: Tone = "plain"
    detail: str = ""


@dataclass(frozen=True)
class Answer:
    """One sentence of the cover with its number.

    Parameters
    ----------
    before, number, after : str
        The sentence; the number, with its unit, stands out.
    link : str
        Key of the chapter that says more; empty where there is none.
    alarm : bool
        Whether a limit is exceeded.
    """

    before: str
    number: str
    after: str
    link: str = ""
    alarm: bool = False

    @property
    def sentence(self) -> str:
        """All of it."""
        return f"{self.before}{self.number}{self.after}"


@dataclass(frozen=True)
class Answers:
    """Sentences that answer first; one that alarms before the others."""

    items: Sequence[Answer]
    kind: ClassVar[str] = "answers"


@dataclass(frozen=True)
class Table:
    """A table.

    Parameters
    ----------
    caption : str
    columns : sequence of Column
    rows : sequence of sequences of str or Cell
        The first cell of a row is its heading.
    data : str
        Data file beside the report that holds the numbers unrounded; empty: none.
    """

    caption: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[str | Cell]]
    data: str = ""
    kind: ClassVar[str] = "table"

    @property
    def groups(self) -> list[tuple[str, int]]:
        """Headings over the columns and how many each spans; none where no column has one."""
        found = [(name, len(list(some))) for name, some in groupby(c.group for c in self.columns)]
        return found if any(name for name, _ in found) else []

    @property
    def cells(self) -> list[list[Cell]]:
        """The rows with every cell as a `Cell`."""
        return [[c if isinstance(c, Cell) else Cell(c) for c in row] for row in self.rows]


@dataclass(frozen=True)
class Figure:
    """A plot one can hover and zoom.

    Parameters
    ----------
    key : str
        Unique on the page; letters, digits and hyphens.
    caption : str
    spec : mapping
        A plotly figure as plain data: `data` and `layout`.
    alt : str
        What the plot shows, in words, for readers who do not see it.
    data : str
        Data file beside the report that holds the plotted numbers.
    height : int
        px; 0 for a square.
    """

    key: str
    caption: str
    spec: Spec
    alt: str
    data: str = ""
    height: int = 420
    kind: ClassVar[str] = "figure"


@dataclass(frozen=True)
class Row:
    """Figures side by side where the window is wide enough.

    Parameters
    ----------
    figures : tuple of Figure
    width : int
        Narrowest width of a figure before it moves to the next line, px.
    """

    figures: tuple[Figure, ...]
    width: int = 300
    kind: ClassVar[str] = "row"


@dataclass(frozen=True)
class Details:
    """Tables and text that open within a chapter: what few readers want, folded.

    Parameters
    ----------
    summary : str
        What is inside, in a few words.
    items : tuple of Table or Text
    """

    summary: str
    items: tuple[Table | Text, ...]
    kind: ClassVar[str] = "details"


@dataclass(frozen=True)
class Links:
    """Files beside the report, each with what it holds."""

    items: tuple[tuple[str, str], ...]
    kind: ClassVar[str] = "links"


@dataclass(frozen=True)
class Points:
    """A list of short statements.

    Parameters
    ----------
    items : tuple of str
    title : str
        Stands above them.
    """

    items: tuple[str, ...]
    title: str = ""
    kind: ClassVar[str] = "points"


@dataclass(frozen=True)
class Pick:
    """One of several things that a reader chooses from.

    Parameters
    ----------
    title : str
    facts : tuple of (str, str)
        Names with values.
    commands : tuple of str
        To be copied.
    """

    title: str
    facts: tuple[tuple[str, str], ...]
    commands: tuple[str, ...] = ()


@dataclass(frozen=True)
class Picks:
    """What is chosen from a list, or by a click on a point of a figure above.

    Parameters
    ----------
    label : str
        What is chosen.
    figure : str
        Key of the figure; the `customdata` of its points count the items from zero.
    items : tuple of Pick
    note : str
        Before the commands.
    """

    label: str
    figure: str
    items: tuple[Pick, ...]
    note: str = ""
    kind: ClassVar[str] = "picks"


Block = Points | Text | Note | Answers | Facts | Table | Figure | Row | Details | Links | Picks


@dataclass(frozen=True)
class Chapter:
    """A chapter of the report.

    Parameters
    ----------
    key : str
        Unique on the page, the target of links.
    title : str
    blocks : tuple of Block
    files : tuple of DataFile
        What stands beside the report because of this chapter.
    answer : str
        What stands beside the title while the chapter is folded.
    cover : tuple of Answer
        Sentences for the first screen of a page whose chapters are a document's.
    """

    key: str
    title: str
    blocks: tuple[Block, ...]
    files: tuple[DataFile, ...] = ()
    answer: str = ""
    cover: tuple[Answer, ...] = ()


@dataclass(frozen=True)
class Page:
    """A whole report.

    Parameters
    ----------
    title : str
    subtitle : str
    chapters : tuple of Chapter
    footer : str
    made : str
        Date of the report.
    """

    title: str
    subtitle: str
    chapters: tuple[Chapter, ...]
    footer: str
    made: str = ""
