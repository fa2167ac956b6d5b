"""The report of a calibration: what it says and that every figure has its data."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np

from strutwork.fea import Port
from strutwork.reports.calibration_page import write_calibration_report
from strutwork.studies.calibration_fit import fit
from strutwork.studies.experiment import Experiment
from strutwork.studies.measured_frf import MeasuredFrf
from strutwork.studies.parametric import Parametric
from strutwork.studies.pose_choice import PoseChoice
from tests.calibrations import SPRINGS, pulled, synthetic, unknowns
from tests.reports.browser import Browser


def test_the_page_says_what_is_known_and_links_every_figure(
    tmp_path: Path, browser: Browser
) -> None:
    machine = Parametric.of(SPRINGS)
    paths = ("joints.a.stiffness.z", "joints.b.stiffness.z", "masses[0].mass")
    lines = np.linspace(20.0, 200.0, 30)
    port = Port("tip", "x")
    frf = MeasuredFrf("tap", {}, ((port, port),), lines, 0 * lines, 0 * lines + 0.05, 0.02)
    pull = pulled("x", 1e-7, (500.0, 0, 0, 0, 0, 0))
    bare = Experiment(machine, unknowns(machine, *paths), (frf, pull))
    experiment = synthetic(bare, (2.3e6, 2.7e6, 5.6), 1)
    found = fit(replace(experiment, source="springs.toml"), 1)
    corners = {"x": np.array([0.0, 0.1, 0.2]), "y": np.array([0.0, 0.1, 0.0])}
    three = np.array([0.5, 0.5, 0.1])
    choice = PoseChoice(
        *(bare.names, (True,) * 3, corners, (1, 2), 0, three, three / 3, three / 2),
        *(3.0, 2.0, 0.99, ("frf",)),
    )
    written = write_calibration_report(experiment, found, choice, tmp_path)
    assert {p.name for p in written.data} >= {
        *("parameters.csv", "measured-and-computed.csv", "poses.csv", "expected-intervals.csv")
    }
    with (tmp_path / "measured-and-computed.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 31
    assert [float(r["measured"]) for r in rows[:30]] == found.agreements[0].measured.tolist()
    for width in (1400, 420):
        browser.open(written.report, width)
        assert browser.complaints == []
        assert browser.evaluate("document.documentElement.scrollWidth") <= width
    text = " ".join(browser.evaluate("document.body.innerText").split())
    law = "1/joints.a.stiffness.z + 1/joints.b.stiffness.z"
    assert f"they determine only {law}" in text
    assert "not identifiable" in text
    assert "narrower by a factor of 3 on average" in text
    figures = browser.evaluate("document.querySelectorAll('figure').length")
    linked = browser.evaluate(
        "[...document.querySelectorAll('figure')].filter(f => f.querySelector('a[href]')).length"
    )
    # four plots and five tables
    assert figures == linked == 9
