"""No table of a page is long: what is more than a look takes in lies behind a line that opens."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path

from strutwork.reports.build import WrittenReport
from strutwork.reports.long_tables import LONGEST
from strutwork.reports.page import held_together, joined, unbroken


class Rows(HTMLParser):
    """Rows of every table of a page that lies open, by its caption."""

    def __init__(self) -> None:
        super().__init__()
        self.found: dict[str, int] = {}
        self._caption, self._body = "", False
        self._folded: list[bool] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = dict(attrs)
        if tag == "details":
            self._folded.append("more" in (values.get("class") or ""))
        elif tag == "table" and not any(self._folded):
            self._caption = f"{len(self.found)}: {values.get('aria-label')}"
            self.found[self._caption] = 0
        elif tag in ("thead", "tbody"):
            self._body = tag == "tbody"
        elif tag == "tr" and self._body and self._caption:
            self.found[self._caption] += 1

    def handle_endtag(self, tag: str) -> None:
        if tag == "details":
            self._folded.pop()
        elif tag == "table":
            self._caption = ""


def open_rows(page: Path) -> dict[str, int]:
    rows = Rows()
    rows.feed(page.read_text(encoding="utf-8"))
    return rows.found


def test_no_open_table_is_long(any_report: WrittenReport) -> None:
    found = open_rows(any_report.report)
    assert found
    assert {name: rows for name, rows in found.items() if rows > LONGEST} == {}


def test_what_is_compared_is_turned_not_cut(comparison_report: WrittenReport) -> None:
    """Machines stand side by side; a cut table would hide rows that only turning shows."""
    html = comparison_report.report.read_text(encoding="utf-8")
    assert "further row" not in html
    found = open_rows(comparison_report.report)
    assert max(found.values()) <= LONGEST
    for words in ("Table 4 of the paper", "Table 4: 48 results", "Blocked stiffness by region"):
        assert any(words in name for name in found), words


def test_units_do_not_break_after_their_slash() -> None:
    whole = held_together(unbroken("3.2 N/µm and 1.1 kN·m/rad, and/or 2 mm"))
    assert whole.count('<span class="held">') == 2
    assert '<span class="held">3.2\u00a0N/µm</span>' in whole
    assert "and/or" in whole
    assert joined("mean (N²/µm²), and/or") == "mean (N²/\u2060µm²), and/or"
