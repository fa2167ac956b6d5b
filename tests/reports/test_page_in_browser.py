"""The pages in a real browser: drawn, quiet, offline, and as wide as the window."""

from __future__ import annotations

from typing import Any

import pytest

from strutwork.reports.build import WrittenReport
from tests.reports.browser import Browser

#: A desktop window and a telephone, px.
WIDTHS = (1400, 420)

PLOTS = """
[...document.querySelectorAll("figure.plot")].map((figure) => {
  const plot = figure.querySelector(".js-plotly-plot");
  const drawn = plot ? plot.querySelector(".main-svg") : null;
  const box = drawn ? drawn.getBoundingClientRect() : { width: 0, height: 0 };
  const marks = plot ? plot.querySelectorAll(
    ".points path, .point, .heatmaplayer image, .boxes path, .lines path, canvas").length : 0;
  return { key: figure.id, width: box.width, height: box.height, marks };
})
"""

OVERFLOW = """
[...document.querySelectorAll("main *, header *, nav *, footer *")].filter((element) => {
  if (element.closest(".scroller") || element.closest(".drawing")) return false;
  return element.getBoundingClientRect().right > window.innerWidth + 1;
}).map((element) => element.tagName + "." + element.className)
"""


#: Pages that have every kind of figure; the others take long to draw in software.
PAGES = ("machine", "model", "document")
OTHER_PAGES = ("comparison", "prototype", "planar", "hexapod", "tolerance")


@pytest.mark.parametrize(
    ("kind", "width"),
    [
        *((kind, WIDTHS[0]) for kind in PAGES),
        *(pytest.param(kind, WIDTHS[0], marks=pytest.mark.slow) for kind in OTHER_PAGES),
        *(pytest.param(kind, WIDTHS[1], marks=pytest.mark.slow) for kind in (*PAGES, *OTHER_PAGES)),
    ],
)
def test_page_is_drawn_quiet_and_offline(
    browser: Browser, kind: str, width: int, request: pytest.FixtureRequest
) -> None:
    any_report: WrittenReport = request.getfixturevalue(f"{kind}_report")
    browser.open(any_report.report, width)

    assert browser.evaluate("document.documentElement.dataset.plots") == "drawn"
    plots: list[dict[str, Any]] = browser.evaluate(PLOTS)
    assert plots, "the page has no plots"
    for plot in plots:
        assert plot["width"] > 100, plot
        assert plot["height"] > 100, plot
        assert plot["marks"] > 0, plot
    assert browser.evaluate("document.documentElement.scrollWidth") == width
    assert browser.evaluate(OVERFLOW) == []
    assert browser.complaints == []
    assert browser.network == []
    # the page itself was asked for, so requests are indeed seen
    assert any_report.report.resolve().as_uri() in browser.requests


#: Drawing in software takes a minute for these; the others show the same kinds of views.
LONG_VIEWS = ["comparison", "hexapod", "machine", "planar", "prototype", "tolerance"]


@pytest.mark.parametrize(
    "kind",
    ["model"] + [pytest.param(kind, marks=pytest.mark.slow) for kind in LONG_VIEWS],
)
def test_three_dimensional_views_show_something(
    browser: Browser, kind: str, request: pytest.FixtureRequest
) -> None:
    any_report: WrittenReport = request.getfixturevalue(f"{kind}_report")
    browser.open(any_report.report, WIDTHS[0])
    solids = browser.evaluate(
        "[...document.querySelectorAll('figure.plot')]"
        ".filter((f) => f.querySelector('.drawing').layout.scene).map((f) => f.id)"
    )
    assert solids, "the page has no 3-D view"

    colours = {key: browser.colours(f"#{key} canvas") for key in solids}

    # walls, grid and labels of an empty scene make 200 to 260, lit links and joints over 850, lines
    # with small balls 565, one smooth body of one colour 400
    least = {key: 300 if key.startswith("ellipsoid") else 450 for key in colours}
    # at the softest pose an ellipsoid may be a needle, a few points wide
    thick = {key: number for key, number in colours.items() if not key.endswith("-1")}
    empty = {key: number for key, number in thick.items() if number <= least[key]}
    assert empty == {}, colours


def test_names_of_a_model_are_text_and_never_markup(
    browser: Browser, model_report: WrittenReport
) -> None:
    browser.open(model_report.report, WIDTHS[0], unfolded=False)
    browser.draw("#structure-drawing")

    title = "Arm </script><script>document.title='taken'</script> & <b>co</b>"
    assert browser.evaluate("document.title") == title
    assert browser.evaluate("document.querySelector('h1').textContent") == title
    assert (
        browser.evaluate("document.querySelectorAll('main img[onerror], main b, main i').length")
        == 0
    )
    cells = "[...document.querySelectorAll('tbody th')].map((cell) => cell.textContent)"
    assert {"<img src=x onerror=alert(1)>", "B%{x}</script>", "<i>hinge</i>"} <= set(
        browser.evaluate(cells)
    )
    drawing = "document.querySelector('#structure-drawing .drawing')"
    plotted = f"{drawing}.data.flatMap((t) => t.text ?? [])"
    assert any("&lt;i&gt;hinge&lt;/i&gt;" in text for text in browser.evaluate(plotted))
    assert browser.complaints == []


def test_chapters_are_folded_until_somebody_follows_a_link(
    browser: Browser, model_report: WrittenReport
) -> None:
    browser.open(model_report.report, WIDTHS[0], unfolded=False)
    assert browser.evaluate("document.documentElement.scrollHeight") < 10 * 900
    chapter = "document.querySelector('#budget details')"
    plots = "document.querySelectorAll('#budget .js-plotly-plot').length"
    assert browser.evaluate(f"[{chapter}.open, {plots}]") == [False, 0]
    assert browser.evaluate("document.querySelectorAll('#cover-softest .js-plotly-plot').length")
    browser.evaluate("document.querySelector('.answers a[href=\"#budget\"]').click()")
    browser.wait_for(f"{chapter}.open && {plots} > 0")
    browser.wait_for("document.querySelector('nav [aria-current]')?.hash === '#budget'")
    # the same link opens it again after somebody has folded it
    browser.evaluate(f"{chapter}.open = false")
    browser.evaluate("document.querySelector('.answers a[href=\"#budget\"]').click()")
    browser.wait_for(f"{chapter}.open")
    assert browser.complaints == []


def test_page_can_be_walked_by_keyboard(browser: Browser, model_report: WrittenReport) -> None:
    browser.open(model_report.report, WIDTHS[0])

    targets: list[str] = browser.evaluate(
        "[...document.querySelectorAll('nav a, .skip')].map((a) => a.getAttribute('href'))"
    )
    assert len(targets) > 5
    for target in targets:
        assert browser.evaluate(f"document.querySelector('{target}') !== null"), target
    assert browser.evaluate(
        "[...document.querySelectorAll('.scroller')].every((s) => s.tabIndex === 0)"
    )
    named = "[...document.querySelectorAll('.scroller, .drawing')].every((e) => e.ariaLabel)"
    assert browser.evaluate(named)


def test_the_page_may_not_reach_the_network_even_if_asked(
    browser: Browser, model_report: WrittenReport
) -> None:
    browser.open(model_report.report, WIDTHS[0], unfolded=False)

    answer = browser.evaluate(
        "fetch('http://127.0.0.1:9/').then(() => 'reached', (error) => error.name)"
    )

    assert answer == "TypeError"
    assert any("Content Security Policy" in complaint for complaint in browser.complaints)
