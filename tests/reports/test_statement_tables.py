"""Tables of a document's statements: units, reasons, and room for all columns."""

from __future__ import annotations

from pathlib import Path

import pytest

from strutwork.papers.statement_tables import statements_chapter
from strutwork.papers.statements import Statement
from strutwork.reports.build import write_report
from strutwork.reports.content import Cell, Points, Table
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


def several(things: tuple[str, ...], lines: tuple[str, ...]) -> list[Statement]:
    return [
        Statement(
            "Table 4",
            f"{thing}: {line}",
            "mm",
            float(len(thing)),
            float(n),
            "predicted",
            f"of every machine; of {thing}",
            "a test",
        )
        for thing in things
        for n, line in enumerate(lines)
    ]


def test_the_same_of_several_things_stands_side_by_side() -> None:
    some = several(("ab, first", "abcd, first", "ab, second", "abcd, second"), ("width", "height"))
    chapter = statements_chapter("key", "title", [*some, said("large", "small")], "all.csv")
    plain, table = (b for b in chapter.blocks if isinstance(b, Table))
    assert len(plain.rows) == 1
    # each of the four things has both
    assert table.caption == "Table 4: 8 results, mm, predicted (1)"
    assert [name for name, _ in table.groups if name] == [
        "ab, first",
        "abcd, first",
        "ab, second",
        "abcd, second",
    ]
    assert [row[0].text for row in table.cells] == ["width", "height"]
    assert table.cells[1][1:3] == [Cell("9"), Cell("1", "poor", "−88.9 % (2)")]
    assert plain.data == table.data == "all.csv"


def test_what_reasons_have_in_common_is_one_note() -> None:
    some = several(("A", "B", "C"), ("width", "height"))
    chapter = statements_chapter("key", "title", some)
    notes = next(b for b in chapter.blocks if isinstance(b, Points))
    assert notes.items == ("(1) Of every machine.", "(2) Of A.", "(3) Of B.", "(4) Of C.")
    (table,) = (b for b in chapter.blocks if isinstance(b, Table))
    # all of them print one number, which stands once
    assert [c.title for c in table.columns] == ["", "published, and computed:", "A", "B", "C"]
    assert table.caption == "Table 4: 6 results, mm, predicted (1)"


def test_inputs_as_printed_are_a_sentence() -> None:
    some = [
        Statement("Table 1", f"arm: {what}", "mm", 5.0, 5.0, "calibrated", "an input", "a test")
        for what in ("width", "height")
    ]
    chapter = statements_chapter("key", "title", some)
    sentence = next(b for b in chapter.blocks if isinstance(b, Points))
    assert sentence.items == (
        "Table 1 of arm, taken as printed (1): width 5\u00a0mm, height 5\u00a0mm.",
    )
    assert not [b for b in chapter.blocks if isinstance(b, Table)]


def test_many_rows_are_several_tables() -> None:
    some = [
        Statement(f"section {n // 4}", f"what {n}", "", float(n), 0.0, "predicted", "", "a test")
        for n in range(20)
    ]
    tables = [b for b in statements_chapter("k", "t", some).blocks if isinstance(b, Table)]
    assert [len(t.rows) for t in tables] == [12, 8]
    assert tables[0].caption == "section 0 to section 2: published and computed"


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
