"""The built site: whole, and read without a network from a folder of files."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import typer
from typer.main import get_command

from strutwork.reports.cli.app import app
from tests.docs.building import ROOT
from tests.reports.browser import Browser

PAGES = (
    "index.html",
    "theory.html",
    "reference/commands.html",
    "reference/api/strutwork.html",
    "how-to/check.html",
    "validation.html",
)
#: Addresses that a page loads by itself, as against those that a reader may follow.
LOADED = re.compile(r"<(?:script|img|iframe|link)\b[^>]*?\b(?:src|href)=\"(?:https?:)?//[^\"]*\"")


@pytest.mark.parametrize("page", PAGES)
@pytest.mark.parametrize("width", [1400, 420])
def test_a_page_asks_for_nothing_outside_its_folder(
    page: str, width: int, site: Path, browser: Browser
) -> None:
    browser.visit((site / page).as_uri(), width)
    assert browser.requests, "the page itself is asked for"
    assert browser.network == []
    assert [url for url in browser.requests if not url.startswith((site.as_uri(), "data:"))] == []
    assert browser.complaints == []
    # no page is wider than its window
    assert browser.evaluate("document.documentElement.scrollWidth") <= width


def test_no_page_loads_anything_from_elsewhere(site: Path) -> None:
    pages = [*site.rglob("*.html")]
    assert len(pages) > 40
    loaded = {
        str(page.relative_to(site)): LOADED.findall(page.read_text(encoding="utf-8"))
        for page in pages
    }
    assert {page: found for page, found in loaded.items() if found} == {}
    styles = [p.read_text(encoding="utf-8") for p in site.rglob("*.css")]
    assert [s for s in styles if re.search(r"(url\(|@import)\s*['\"]?(https?:)?//", s)] == []


def test_search_finds_pages_from_a_folder_of_files(site: Path, browser: Browser) -> None:
    assert (site / "searchindex.js").stat().st_size > 10_000
    browser.visit((site / "search.html").as_uri() + "?q=stiffness", 1400)
    browser.wait_for("document.querySelectorAll('#search-results li a').length > 3", 30)
    found = browser.evaluate(
        "[...document.querySelectorAll('#search-results li a')].map(a => a.getAttribute('href'))"
    )
    assert any("stiffness" in link or "theory" in link for link in found), found
    assert browser.network == []
    assert browser.complaints == []


def test_formulas_are_mathml_of_some_size(site: Path, browser: Browser) -> None:
    text = (site / "theory.html").read_text(encoding="utf-8")
    assert "mathjax" not in text.lower()
    browser.visit((site / "theory.html").as_uri(), 1400)
    sizes = browser.evaluate(
        "[...document.querySelectorAll('math')].map(m => m.getBoundingClientRect().width)"
    )
    assert len(sizes) > 5
    assert min(sizes) > 3
    # nothing is left of the source of a formula
    assert browser.evaluate("document.querySelector('article').innerText.includes('$$')") is False


def test_every_public_name_has_an_entry(site: Path) -> None:
    pages = sorted((ROOT / "docs" / "reference" / "api").glob("*.rst"))
    assert len(pages) == 12
    for page in pages:
        package = re.search(r"package-reference:: (\S+)", page.read_text(encoding="utf-8"))
        assert package is not None
        module = __import__(package[1], fromlist=["__all__"])
        html = (site / "reference" / "api" / f"{page.stem}.html").read_text(encoding="utf-8")
        names = [name for name in module.__all__ if name != "__version__"]
        missing = [name for name in names if f'id="{package[1]}.{name}"' not in html]
        assert missing == []


def test_every_command_has_an_entry_with_all_its_options(site: Path) -> None:
    html = (site / "reference" / "commands.html").read_text(encoding="utf-8")
    group = get_command(app)
    commands = group.commands  # type: ignore[attr-defined]
    assert "check" in commands
    wanted = [
        f'id="cmdoption-strutwork-{name}-{option.lstrip("-")}"'
        for name, command in commands.items()
        for parameter in command.params
        for option in parameter.opts
        if option.startswith("--")
    ]
    assert [anchor for anchor in wanted if anchor not in html] == []
    assert isinstance(app, typer.Typer)


def test_every_command_has_a_page_with_a_task() -> None:
    folder = ROOT / "docs" / "how-to"
    names = set(get_command(app).commands)  # type: ignore[attr-defined]
    index = (folder / "index.md").read_text(encoding="utf-8")
    for name in names:
        text = (folder / f"{name}.md").read_text(encoding="utf-8")
        assert f"$ strutwork {name} " in text or f"$ strutwork {name}\n" in text
        assert f"]({name}.md)" in index
