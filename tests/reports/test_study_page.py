"""The report of a study: what its sentences, tables and files say."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from strutwork.reports.study_page import main_answers, write_study_report
from strutwork.studies.parameter import Parameter
from strutwork.studies.sample import Sample
from strutwork.studies.study import Study
from strutwork.studies.study_store import read_result
from tests.reports.browser import Browser

HEXAPOD = Path(__file__).parents[2] / "examples/machines/6-ups.toml"


def test_the_page_shows_the_best_machine_and_links_every_figure(
    tmp_path: Path, browser: Browser
) -> None:
    study = Study.of(
        HEXAPOD,
        {"sections.cylinder.outer_diameter": ["60 mm", "80 mm", "90 mm", "100 mm"]},
        "stiffness",
        "mass",
        workspace={"x": [0.0, "100 mm"]},
    )
    found = study.run()
    written = write_study_report(study, found, tmp_path)
    names = [c.name for c in main_answers(study, found)]
    assert names == [f"stiffness_free_worst {d}" for d in "xyz"] + ["mass"]
    assert {p.name for p in written.data} >= {"machines.csv", "rank-correlations.csv", "study.nc"}
    assert read_result(tmp_path / "study.nc").attrs["study_key"] == study.key
    with (tmp_path / "machines.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert [r["status"] for r in rows] == ["cannot_be", "solved", "solved", "solved"]
    assert "inner_diameter" in rows[0]["reason"]
    browser.open(written.report, 1300)
    assert browser.complaints == []
    # number and unit hang together by a space that does not break
    text = " ".join(browser.evaluate("document.body.innerText").split())
    best = float(found["stiffness_free_worst"].sel(direction="z").max()) / 1e6
    assert f"{best:.3g} N/µm" in text
    # of masses the least is the best
    lightest = float(np.nanmin(found["mass"]))
    assert f"the best is {lightest:.3g} kg with sections.cylinder.outer_diameter 80 mm" in text
    assert "3 of 4 machines can be" in text
    figures = browser.evaluate("document.querySelectorAll('figure').length")
    linked = browser.evaluate(
        "[...document.querySelectorAll('figure')].filter(f => f.querySelector('a[href]')).length"
    )
    assert figures == linked >= 5
    assert browser.evaluate("document.documentElement.scrollWidth") <= 1300


SPRING = """
title = "mass on a spring"
[nodes]
A = [0, 0, 0]
T = [0, 0, 0]
[tool]
tcp = "T"
[[supports]]
node = "A"
fixed = "all"
[[joints]]
name = "spring"
type = "bushing"
between = ["A", "T"]
stiffness = { x = 8e8, y = 9e8, z = 2e8, rx = 1e8, ry = 1e8, rz = 1e8 }
"""


def test_the_page_shows_scatter_and_indices_with_their_data(
    tmp_path: Path, browser: Browser
) -> None:
    pytest.importorskip("SALib")
    parameters = [
        Parameter(f"joints.spring.stiffness.{d}", distribution="normal", scatter="10 %")
        for d in "xz"
    ]
    sample = Sample("saltelli", 16, second_order=True)
    study = Study.of(SPRING, parameters, sample=sample, workspace={})
    found = study.run(workers=1)
    written = write_study_report(study, found, tmp_path)
    names = {p.name for p in written.data}
    assert names >= {"scatter.csv", "sobol-indices.csv", "sobol-second-order.csv"}
    with (tmp_path / "scatter.csv").open(encoding="utf-8") as stream:
        rows = {r["answer"]: r for r in csv.DictReader(stream)}
    one = found.sel(answer="stiffness_free_home z")
    assert float(rows["stiffness_free_home z"]["mean"]) == float(one["scatter_mean"])
    assert rows["stiffness_free_home z"]["unit"] == "N/m"
    browser.open(written.report, 420)
    assert browser.complaints == []
    text = " ".join(browser.evaluate("document.body.innerText").split())
    mean = float(one["scatter_mean"]) / 1e6
    assert f"Stiffness free home z: {mean:.4g} ±" in text
    assert "The variance of stiffness free home z comes most from joints.spring.stiffness.z" in text
    assert "No indices of stiffness free home y: it does not vary." in text
    unlinked = "[...document.querySelectorAll('figure')].filter(f => !f.querySelector('a[href]'))"
    assert browser.evaluate(f"{unlinked}.length") == 0
    assert browser.evaluate("document.documentElement.scrollWidth") <= 420
