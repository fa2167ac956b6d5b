"""Tables of a document's statements: units, reasons, and room for all columns."""

from __future__ import annotations

from pathlib import Path

import pytest

from strutwork.papers.statement_tables import statements_chapter
from strutwork.papers.statements import Statement
from strutwork.reports.build import write_report
from strutwork.reports.content import Table
from tests.reports.browser import Browser


def said(published: float | str, computed: float | str, reason: str = "") -> Statement:
    return Statement("Table 1", "area", "m^2", published, computed, "predicted", reason, "a test")


def table_of(*statements: Statement) -> tuple[list[str], list[list[str]]]:
    (table,) = (
        b for b in statements_chapter("key", "title", statements).blocks if isinstance(b, Table)
    )
    return [c.title for c in table.columns], [[c.text for c in row] for row in table.cells]


def test_units_stand_with_numbers_among_words() -> None:
    heads, rows = table_of(said(0.5, 0.25, "because"), said("large", float("nan")))
    assert heads == ["place", "what", "published", "computed", "difference", "status"]
    assert rows[0][2:4] == ["0.500\u00a0m²", "0.250\u00a0m²"]
    assert rows[0][-1] == "predicted (1)"
    # words have their units in them, and what is not known has none
    assert rows[1][2:4] == ["large", "–"]
    assert rows[1][-1] == "predicted"


def test_numbers_alone_have_a_column_of_units() -> None:
    heads, rows = table_of(said(0.5, 0.25))
    assert heads[4] == "unit"
    assert rows[0][2:5] == ["0.500", "0.250", "m²"]


@pytest.mark.slow
def test_all_columns_stand_on_the_page(browser: Browser, tmp_path: Path) -> None:
    page = write_report("chablat-2003", tmp_path).report
    for width in (1100, 1400):
        browser.open(page, width)
        over = "[...document.querySelectorAll('.scroller')].map(e => e.scrollWidth - e.clientWidth)"
        assert max(browser.evaluate(over)) <= 0
    # the four squares, each with its white edge
    drawn = "document.querySelectorAll('#amplification .scatterlayer .trace').length"
    assert browser.evaluate(drawn) == 8
    assert "15,1.13" in (tmp_path / "largest-squares.csv").read_text().replace(".0,", ",")
