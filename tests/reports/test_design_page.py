"""The report of a design: its statements, the front one can click, its files."""

from __future__ import annotations

from pathlib import Path

import pytest

from strutwork.reports.design_page import write_design_report
from strutwork.studies.design import Design
from strutwork.studies.design_store import read_design_result, run_design
from tests.reports.browser import Browser

pytest.importorskip("pymoo")

RPS = Path(__file__).parents[2] / "examples/machines/3-rps.toml"


def test_a_click_on_a_point_shows_its_machine(tmp_path: Path, browser: Browser) -> None:
    design = Design.of(
        RPS,
        {"sections.cylinder.outer_diameter": ("45 mm", "90 mm")},
        "stiffness_z",
        "mass",
        workspace={},
        population=8,
        generations=2,
    )
    found = run_design(design)
    written = write_design_report(found, tmp_path)
    assert {p.name for p in written.data} >= {"machines.csv", "design.nc"}
    assert read_design_result(tmp_path / "design.nc").attrs["design_key"] == design.key
    browser.open(written.report, 1300)
    assert browser.complaints == []
    text = " ".join(browser.evaluate("document.body.innerText").split())
    largest = float(found["stiffness_z"][found["front"][0]]) / 1e6
    assert f"Largest stiffness z: {largest:.4g} N/µm with machine 1 of the front" in text
    assert "The machine as described (stiffness z" in text
    shown = "document.querySelector('.pick:not([hidden])').innerText"
    assert "--pick 1 -o machine-1.toml" in browser.evaluate(shown)
    drawing = "document.querySelector('#front .drawing')"
    browser.evaluate(f"{drawing}.emit('plotly_click', {{points: [{{customdata: 2}}]}})")
    assert "--pick 3 -o machine-3.toml" in browser.evaluate(shown)
    assert browser.evaluate("document.querySelector('.picks select').value") == "2"
    assert browser.evaluate(f"{drawing}.data[1].selectedpoints") == [2]
    # points beside the front stand for no machine that is listed
    browser.evaluate(f"{drawing}.emit('plotly_click', {{points: [{{}}]}})")
    assert "--pick 3 -o machine-3.toml" in browser.evaluate(shown)
    figures = browser.evaluate("document.querySelectorAll('figure').length")
    linked = browser.evaluate(
        "[...document.querySelectorAll('figure')].filter(f => f.querySelector('a[href]')).length"
    )
    assert figures == linked >= 3
    assert browser.evaluate("document.documentElement.scrollWidth") <= 1300
