"""Small tables for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from strutwork.names import visible


def table(title: str, rows: Iterable[Sequence[object]], heads: Sequence[str] = ()) -> str:
    """A table in HTML; every text in it is shown, and none of it acts.

    Parameters
    ----------
    title : str
    rows : iterable of sequences
        The first cell of each is its name.
    heads : sequence of str
        Of the columns; without them the table has none.
    """

    def cell(tag: str, text: object) -> str:
        return f'<{tag} style="text-align:left">{escape(visible(str(text)))}</{tag}>'

    head = "".join(cell("th", h) for h in heads)
    body = "".join(
        "<tr>" + cell("th", first) + "".join(cell("td", c) for c in rest) + "</tr>"
        for first, *rest in rows
    )
    start = f"<thead><tr>{head}</tr></thead>" if head else ""
    return (
        f"<table><caption><strong>{escape(visible(title))}</strong></caption>"
        f"{start}<tbody>{body}</tbody></table>"
    )
