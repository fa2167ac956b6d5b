"""A report as PDF: every chapter, every plot, numbered pages with the machine and the date."""

from __future__ import annotations

import re
import sys
import unicodedata
from html import unescape
from pathlib import Path

import pytest
from pypdf import PdfReader

from strutwork.errors import ModelError
from strutwork.reports.build import WrittenReport, write_report
from strutwork.reports.manifest import verify_report
from strutwork.reports.pdf import print_page, require_browser
from tests.reports.browser import Browser
from tests.reports.conftest import HOSTILE, text_of

#: Of an A4 page, points.
A4 = (595, 842)


def plain(text: str) -> str:
    """Letters and digits only: a PDF breaks lines, and joins words and letters, where it likes."""
    return "".join(c for c in unicodedata.normalize("NFKC", text) if c.isalnum())


def test_every_chapter_and_plot_is_printed(tolerance_report: WrittenReport, tmp_path: Path) -> None:
    page = tolerance_report.report
    found = PdfReader(print_page(page, tmp_path / "report.pdf"))
    html = text_of(page)
    titles = re.findall(r'<h2 id="[^"]+">(.*?)</h2>', html)
    tables = re.findall(r'<figure class="table">\s*<figcaption>([^<]+)', html)
    assert len(titles) > 5
    assert len(tables) > 5
    texts = [p.extract_text() for p in found.pages]
    everything = plain("".join(texts))
    assert [t for t in (*titles, *tables) if plain(unescape(t)) not in everything] == []
    # a plot that is not drawn would leave the pages short, one that is cut makes more
    assert len(titles) // 2 < len(found.pages) <= 20
    for number, (sheet, text) in enumerate(zip(found.pages, texts, strict=True), start=1):
        size = sheet.mediabox
        assert (round(size.width), round(size.height)) == A4
        assert f"Page{number}of{len(texts)}" in plain(text)
        assert plain(re.findall(r"Made by Strutwork \S+ on ([\d-]+)", html)[0]) in plain(text)
        assert number == 1 or "Tableontworails" in plain(text)
    assert {str(entry.title) for entry in found.outline if not isinstance(entry, list)}
    # links to files would name the folder of whoever printed it
    assert b"file://" not in (tmp_path / "report.pdf").read_bytes()


def test_the_pdf_is_part_of_the_report(tmp_path: Path) -> None:
    file = tmp_path / "arm & <co>.toml"
    file.write_text(HOSTILE, encoding="utf-8")
    written = write_report(str(file), tmp_path / "r", pdf=True)
    assert written.pdf is not None
    assert {written.pdf.name, "data.zip"} <= set(verify_report(tmp_path / "r").files)
    text = plain("".join(p.extract_text() for p in PdfReader(written.pdf).pages[1:]))
    # along the edge of each page, and no markup
    assert plain("Arm </script><script>document.title='taken'</script> & <b>co</b>") in text
    # without the option the older one would show another report: it goes
    write_report(str(file), tmp_path / "r")
    assert not written.pdf.exists()


def test_the_page_is_as_before_once_it_is_printed(
    browser: Browser, model_report: WrittenReport
) -> None:
    browser.open(model_report.report, 1400, unfolded=False)
    state = """[document.querySelectorAll("main details[open]").length,
        document.querySelectorAll("img.print").length,
        document.querySelectorAll(".links a[href]").length,
        document.querySelectorAll(".js-plotly-plot").length]"""
    browser.wait_for("document.documentElement.dataset.files === 'linked'")
    before = browser.evaluate(state)
    assert before[:2] == [0, 0]
    assert browser.evaluate("window.paper.prepare()") == []
    chapters, pictures, links, _ = browser.evaluate(state)
    assert chapters == browser.evaluate("document.querySelectorAll('main details').length")
    assert pictures == browser.evaluate("document.querySelectorAll('figure.plot').length")
    assert links == 0
    browser.evaluate("window.dispatchEvent(new Event('afterprint'))")
    assert browser.evaluate(state) == before
    assert browser.complaints == []


def test_without_a_browser_nothing_is_computed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BROWSER_PATH", str(tmp_path / "none"))
    with pytest.raises(ModelError, match=r"not a program") as caught:
        write_report("nor a model file", tmp_path / "r", pdf=True)
    assert "apt install chromium" in caught.value.remedy
    assert not (tmp_path / "r").exists()


def test_a_browser_that_is_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "browser"
    program.write_text("#!/bin/sh\nexit 3\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("BROWSER_PATH", str(program))
    page = tmp_path / "page.html"
    page.write_text("<p>nothing</p>", encoding="utf-8")
    with pytest.raises(ModelError, match="does not start") as caught:
        print_page(page, tmp_path / "page.pdf")
    assert "BROWSER_PATH" in caught.value.remedy
    assert not (tmp_path / "page.pdf").exists()


def test_without_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "choreographer", None)
    with pytest.raises(ModelError, match=r"not installed") as caught:
        require_browser()
    assert "strutwork[pdf]" in caught.value.remedy
