"""The page: content in, one self-contained HTML text out."""

from __future__ import annotations

import json
import re
import textwrap
from dataclasses import replace
from functools import cache
from html import escape
from importlib.resources import files
from itertools import chain
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from strutwork.reports.archive import Carried
from strutwork.reports.content import Chapter, Page, Table
from strutwork.reports.formulas import typeset
from strutwork.reports.long_tables import shortened
from strutwork.reports.row_legend import one_legend

HARD_SPACE = "\N{NO-BREAK SPACE}"

#: Between a number and its unit, and between a direction and its coordinate.
_UNIT = re.compile(
    r"(?<=\d) (?=(?:%|°|[mµn]?m[²³]?\b|[µm]?rad\b|deg\b|k?N²?\b|Hz\b"
    r"|kg\b|[GM]Pa\b|[sJW]\b|times\b))"
    r"|(?<=\b[xyz]) (?=[−\d])|(?<=\br[xyz]) (?=[−\d])"
)

#: A unit that is a quotient, with the number before it, in escaped text.
_PART = r"(?:[kµmnGM]?(?:N|m|rad|g|s|Pa|J)|min|deg|Hz)[²³]?"
_PRODUCT = rf"{_PART}(?:·{_PART})?"
_QUOTIENT = re.compile(
    rf"(?:(?<![\w.])[−±+]?\d[\d.,]*(?:e[−-]?\d+)?{HARD_SPACE})?"
    rf"(?<![\w/]){_PRODUCT}/(?:{_PRODUCT}|\({_PART}[· ]{_PART}\))(?![\w/])"
)
WORD_JOINER = "\N{WORD JOINER}"

#: Longest line of a name in a plot, characters.
LINE = 40

#: Longest title along the edge of a page on paper, characters.
TITLE = 90


def render(page: Page, carried: Carried | None = None) -> str:
    """A page as one HTML text that needs no other file and no network.

    Text is escaped by the template; scripts, style and plot data are written into the page.

    Parameters
    ----------
    page : Page
    carried : Carried, optional
        Data that its links lead to where the page stands alone.

    Returns
    -------
    str
    """
    return (
        _environment()
        .get_template("report.html")
        .render(
            page=replace(page, chapters=tuple(_short(chapter) for chapter in page.chapters)),
            carried=carried or Carried(),
            style=_asset("style.css"),
            paper=_asset("print.css") + Markup(_edges(page)),  # noqa: S704 - escaped
            scripts=[_asset(f"{name}.js") for name in ("keys", "picks", "print", "files")],
            script=_asset("report.js"),
            plotly=Markup(_closed(get_plotlyjs())),  # noqa: S704 - the library's own text
        )
    )


def _short(chapter: Chapter) -> Chapter:
    """A chapter whose long tables show their first rows."""
    blocks = (shortened(b) if isinstance(b, Table) else (b,) for b in chapter.blocks)
    return replace(chapter, blocks=tuple(chain.from_iterable(blocks)))


def embedded(value: Any) -> Markup:
    """JSON that may stand inside a script element whatever strings it holds.

    Raises
    ------
    ValueError
        A number that is not finite: JSON has none.
    """
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return Markup(text)  # noqa: S704 - no character of markup is left in it


def unbroken(text: str) -> str:
    """Text whose lines end neither between a number and its unit nor within a coordinate.

    >>> unbroken("at x 0 mm, rz 5°: 3.2 N/µm in 12 poses").replace(chr(0xA0), "_")
    'at x_0_mm, rz_5°: 3.2_N/µm in 12 poses'
    """
    return _UNIT.sub(HARD_SPACE, text)


def joined(text: str) -> str:
    """Text whose lines do not end after the slash of a unit, for what holds no markup.

    >>> joined("mean (N/µm)").replace(chr(0x2060), "_")
    'mean (N/_µm)'
    """
    return _QUOTIENT.sub(lambda found: found.group().replace("/", f"/{WORD_JOINER}"), text)


def held_together(safe: str) -> str:
    """Escaped text in which a quotient of units stays on one line, with its number.

    A browser ends lines after a slash; an element, unlike a sign that joins, is not copied.

    >>> held_together(unbroken("at least 3.2 N/µm")).replace(chr(0xA0), " ")
    'at least <span class="held">3.2 N/µm</span>'
    """
    return _QUOTIENT.sub(lambda found: f'<span class="held">{found.group()}</span>', safe)


def plain(text: str) -> str:
    """A name as plotly shows it literally, long ones on several lines.

    Plotly reads a subset of HTML in its texts, and fields as in `%{x}` in its templates.
    """
    lines = textwrap.wrap(text, LINE, drop_whitespace=False) if len(text) > LINE else [text]
    return "<br>".join(escape(line, quote=False).replace("%{", "%&#123;") for line in lines)


def css_string(text: str) -> str:
    r"""A string of CSS that may stand inside a style element whatever it holds.

    >>> css_string('a</style>')
    '"a\\3c \\2f style\\3e "'
    """
    shown = (c if c.isalnum() or c in " .,:-" else f"\\{ord(c):x} " for c in text)
    return f'"{"".join(shown)}"'


def _edges(page: Page) -> str:
    """What stands along the edges of each page on paper: machine, date, number."""
    look = "font: 8pt system-ui, sans-serif; color: #55606e"
    title = page.title if len(page.title) <= TITLE else page.title[: TITLE - 1] + "…"
    # the cover has its own title
    return (
        f"@page {{ @top-left {{ content: {css_string(title)}; {look}; width: 75%; }} "
        f"@top-right {{ content: {css_string(page.made)}; {look}; }} "
        f'@bottom-right {{ content: "Page " counter(page) " of " counter(pages); {look}; }} '
        f"@bottom-left {{ content: {css_string('Strutwork report')}; {look}; }} }} "
        '@page :first { @top-left { content: ""; } }'
    )


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("strutwork.reports", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["embedded"] = embedded
    environment.filters["one_legend"] = one_legend
    environment.filters["unbroken"] = typeset(unbroken, held_together)
    environment.filters["joined"] = joined
    return environment


def _asset(name: str) -> Markup:
    text = files("strutwork.reports").joinpath("templates", name).read_text(encoding="utf-8")
    return Markup(_closed(text))  # noqa: S704 - our own file


def _closed(script: str) -> str:
    """A script's text that cannot end its element early."""
    return script.replace("</script", "<\\/script")
