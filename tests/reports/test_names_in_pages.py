"""Hard names in a page, read as a browser reads it: text everywhere, elements nowhere."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest

from strutwork.reports.build import WrittenReport, write_report
from strutwork.reports.page import LINE, plain
from tests.hard_names import BEAM, CASE, JOINT, LONG, NODES, hard_model
from tests.reports.browser import Browser
from tests.reports.conftest import text_of

#: Elements that only a name could have brought.
FOREIGN = {"img", "b", "i", "iframe", "object", "form", "br", "svg"}

TITLE = "=title <i> & \"q\" 'a'"


class Page(HTMLParser):
    """Elements, attributes, texts and scripts of a page."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.tags: set[str] = set()
        self.attributes: set[str] = set()
        self.links: list[str] = []
        self.texts: list[str] = []
        self.json: list[Any] = []
        self.scripts = 0
        self._in_json = False
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.attributes |= {name for name, _ in attrs}
        self.links += [value or "" for name, value in attrs if name == "href"]
        self.scripts += tag == "script"
        self._in_json = tag == "script" and ("type", "application/json") in attrs

    def handle_data(self, data: str) -> None:
        if self._in_json:
            self.json.append(json.loads(data))
        else:
            self.texts.append(data)

    def handle_endtag(self, _tag: str) -> None:
        self._in_json = False


@pytest.fixture(scope="module")
def hard_report(tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    folder = tmp_path_factory.mktemp("hard")
    path = folder / "'\"><img src=x> #?%20.toml"
    path.write_text(hard_model(TITLE), encoding="utf-8")
    return write_report(str(path), folder / "report")


@pytest.fixture(scope="module")
def page(hard_report: WrittenReport) -> Page:
    return Page(text_of(hard_report.report))


def strings(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for key, part in value.items():
            yield key
            # of a mode: text of an option, which the template escapes and plotly never sees
            if key != "label":
                yield from strings(part)
    elif isinstance(value, list):
        for part in value:
            yield from strings(part)


def test_no_element_or_attribute_comes_from_a_name(page: Page, tmp_path: Path) -> None:
    tame = hard_model("plain")
    for i, name in enumerate((*NODES, BEAM[:98], JOINT, CASE)):
        tame = tame.replace(json.dumps(name)[1:-1], f"name{i}-")
    path = tmp_path / "tame.toml"
    path.write_text(tame, encoding="utf-8")
    other = Page(text_of(write_report(str(path), tmp_path / "report").report))

    assert page.tags == other.tags
    assert page.attributes == other.attributes
    assert page.scripts == other.scripts
    assert not page.tags & FOREIGN
    assert not any(name.startswith("on") for name in page.attributes)


def test_names_are_whole_in_the_text(page: Page) -> None:
    text = "\n".join(page.texts)
    for name in (*NODES, BEAM[:98] + "00", JOINT, CASE, TITLE):
        assert name in text, name


def test_plots_hold_names_as_text(page: Page) -> None:
    found = [text for spec in page.json for text in strings(spec)]
    assert any(plain(f"{LONG}1") in text for text in found)
    assert any(plain(f"{LONG}2") in text for text in found)
    for text in found:
        # what plotly takes for markup is our own
        assert not any(f"<{tag}" in text for tag in ("img", "script", "i>"))
        assert "<b><b>" not in text
    templates = [t for t in found if "<extra>" in t]
    assert templates
    assert not any("東京 %{x}" in t for t in templates)


def test_links_lead_to_the_files_beside_the_page(page: Page, hard_report: WrittenReport) -> None:
    folder = hard_report.report.parent
    files = [unquote(link) for link in page.links if not link.startswith(("#", "data:"))]
    assert files
    assert all((folder / name).is_file() for name in files)


def test_long_names_in_plots_break_into_lines_and_stay_apart() -> None:
    first, second = plain(f"{LONG}1"), plain(f"{LONG}2")
    assert first != second
    assert max(map(len, first.split("<br>"))) <= LINE
    assert first.replace("<br>", "") == f"{LONG}1"
    assert plain("a %{x} <b>") == "a %&#123;x} &lt;b&gt;"
    # spaces where a line ends are kept
    words = "word " * 20
    assert plain(words).replace("<br>", "") == words


def test_a_file_whose_name_is_no_utf8_has_a_page(tmp_path: Path) -> None:
    path = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff.toml"))
    path.write_text(hard_model(""), encoding="utf-8")
    written = write_report(str(path), tmp_path / "report")
    assert "\\xff.toml" in text_of(written.report)


@pytest.mark.slow
def test_a_page_of_hard_names_is_drawn_and_as_wide_as_its_window(
    browser: Browser, hard_report: WrittenReport
) -> None:
    for width in (1400, 420):
        browser.open(hard_report.report, width)
        assert browser.evaluate("document.documentElement.dataset.plots") == "drawn"
        assert browser.evaluate("document.title") == TITLE
        assert browser.evaluate("document.documentElement.scrollWidth") == width
        assert (
            browser.evaluate("document.querySelectorAll('main img[onerror], main b').length") == 0
        )
        assert browser.complaints == []
        assert browser.network == []
