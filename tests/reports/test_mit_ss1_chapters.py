"""The MIT-SS-1 whole in its report: what is calibrated is said so, files hold what is plotted."""

from __future__ import annotations

import json
import re

import meshio
import numpy as np
import pytest
import xarray as xr

from strutwork.papers.published_rows import COLUMNS
from strutwork.papers.son_2002.published import MODES, MOUNT_MODES
from strutwork.reports.build import WrittenReport
from tests.reports.browser import Browser
from tests.reports.conftest import text_of
from tests.reports.test_data_files import rows_of, specs

CHAPTERS = (
    # what every machine has stands before and after what its document adds
    "cover",
    "summary",
    "drawing",
    "kinematics",
    "stiffness",
    "modes",
    "dynamic-stiffness",
    "calibration",
    "overconstraint",
    "table-2",
    "scale",
    "designs",
    "size",
    "assumptions",
    "structure",
    "check",
    "motion",
    "workspace-size",
    "singularities",
    "assembly-modes",
    "reversals",
    "tool",
    "ellipsoids",
    "budget",
    "workspace-stiffness",
    "stability",
    "accuracy",
    "dynamics",
    "inputs",
    "files",
)

#: How the columns of strain energy begin, by kind of part.
ENERGY = ("share_beam", "share_joint", "share_element")


def test_the_first_screen_answers_from_the_chapters_of_the_document(
    planar_report: WrittenReport,
) -> None:
    text = re.sub("<[^>]+>", "", text_of(planar_report.report))
    folder = planar_report.report.parent
    minima = rows_of(folder / "whole-machine-minima.csv")
    least = min(float(row["least_N/m"]) for row in minima)
    assert f"its least dynamic stiffness at home is {least / 1e6:.3g} N/µm" in text
    modes = [row for row in rows_of(folder / "modes.csv") if row["machine"] == "numerical"]
    first = min(float(row["frequency_Hz"]) for row in modes)
    assert f"its lowest natural frequency at home is {first:.3g} Hz; the lowest of" in text
    assert "Manufacturing errors lock in up to " in text
    assert "bearings are calibrated, their rating and some tolerances assumed" in text


def test_page_has_all_chapters_and_stays_small(planar_report: WrittenReport) -> None:
    text = text_of(planar_report.report)
    assert tuple(re.findall(r'<section id="([^"]+)"', text)) == CHAPTERS
    # plotly itself is 4.5 MB
    assert planar_report.report.stat().st_size < 15e6


def test_the_error_sheet_says_that_its_causes_are_assumed(planar_report: WrittenReport) -> None:
    text = text_of(planar_report.report)
    (section,) = re.findall(r'<section id="accuracy".*?</section>', text, re.DOTALL)
    assert "Assumed, because the thesis states no error budget" in section
    rows = rows_of(planar_report.report.parent / "error-sheet.csv")
    causes = {row["cause"] for row in rows}
    assert causes == {"geometry", "gravity", "thermal", "cutting", "drives", "ground", "all"}
    assert "--errors" not in section


def test_published_frequencies_stand_beside_ours(planar_report: WrittenReport) -> None:
    folder = planar_report.report.parent
    modes = rows_of(folder / "modes.csv")
    for table, count in ((MODES, 9), (MOUNT_MODES, 3)):
        rows = rows_of(folder / f"published-{table.key}.csv")
        assert list(rows[0]) == list(COLUMNS)
        assert len(rows) == count
        assert {r["status"] for r in rows} == {"calibrated"}
        assert all("calibrated" in r["note"] for r in rows)
        for row in rows:
            assert float(row["published"]) == table.value(row["row"], row["quantity"])
            # every number of ours is a mode of one of the three machines
            near = min(abs(float(m["frequency_Hz"]) / float(row["computed"]) - 1) for m in modes)
            assert near < 1e-9
    text = text_of(planar_report.report)
    for value in (111.2, 182.3, 269.4, 320.9, 79.2, 154.12, 238.64, 268.25, 319.95, 22.6, 39.3):
        assert f">{value}</td>" in text


def test_energy_shares_add_to_one(planar_report: WrittenReport) -> None:
    rows = rows_of(planar_report.report.parent / "modes.csv")
    assert len(rows) == 3 * 18
    for row in rows:
        shares = [float(v) for k, v in row.items() if k.startswith(ENERGY) and v]
        # strain-energy shares add to one but for rounding
        assert sum(shares) == pytest.approx(1.0, abs=1e-9)
    bars = specs(planar_report.report)["mode-energies"]["data"]
    # the page leaves out what is below 0.05 % and rounds to four digits
    np.testing.assert_allclose(np.sum([b["x"] for b in bars], axis=0), 100.0, atol=0.2)


def test_shapes_on_the_page_are_those_of_the_file(planar_report: WrittenReport) -> None:
    folder = planar_report.report.parent
    read = meshio.read(folder / "mode-shapes.vtu")
    figure = specs(planar_report.report)["mode-shapes"]
    modes = figure["motion"]["modes"]
    assert len(modes) == len(read.point_data) == 11
    nodes = np.unique(read.cells_dict["quad"])
    for mode in modes:
        field = read.point_data[mode["label"].replace(",", "")]
        assert np.abs(field).max() == pytest.approx(1.0)
        drawn = np.stack([mode[a] for a in "xyz"], axis=1)[: len(nodes)]
        factor = np.linalg.norm(drawn) / np.linalg.norm(field[nodes])
        # the page rounds to four digits
        np.testing.assert_allclose(drawn, factor * field[nodes], rtol=1e-3, atol=1e-3)
    for name in ("spindle-housing-tilt", "granite-bending", "ball-screw"):
        assert (folder / f"mode-{name}.glb").read_bytes()[:4] == b"glTF"


def test_maps_of_the_calibrated_machine_are_those_of_the_files(
    planar_report: WrittenReport,
) -> None:
    folder = planar_report.report.parent
    rows = rows_of(folder / "stiffness-calibrated.csv")
    with xr.open_dataset(folder / "stiffness-calibrated.nc", engine="h5netcdf") as file:
        found = file["stiffness"].load()
    for axis in "xyz":
        heat = specs(planar_report.report)[f"stiffness-calibrated-{axis}"]["data"][0]
        ours = found.sel(base="rails held", direction=axis).to_numpy() / 1e6
        np.testing.assert_allclose(np.array(heat["z"], dtype=float).T, ours, rtol=1e-4)
        table = [float(r[f"K{axis * 2} rails held [N/m]"]) / 1e6 for r in rows]
        np.testing.assert_allclose(table, ours.ravel(), rtol=1e-12)
    # what stands on soft mounts is softer than what is held
    both = found.to_numpy()
    assert (both[1] < both[0]).all()


def test_what_the_data_leave_open_is_said(planar_report: WrittenReport) -> None:
    folder = planar_report.report.parent
    content = json.loads(text_of(folder / "calibration.json"))
    assert list(content) == ["granite", "moving", "measured", "ball screw"]
    known = {p["name"]: p["determined"] for found in content.values() for p in found["parameters"]}
    text = text_of(planar_report.report)
    section = re.findall(r'<section id="calibration".*?</section>', text, re.DOTALL)[0]
    assert section.count("not determined</td>") == sum(not v for v in known.values()) == 5
    assert section.count("at its bound") == 2
    assert "5 targets determine 5 of 7 combinations" in section
    values = rows_of(folder / "calibration-singular-values.csv")
    assert len(values) == len(known)
    assert [r["determined"] for r in values if r["step"] == "moving"].count("False") == 2


def test_least_dynamic_stiffness_is_the_highest_point(planar_report: WrittenReport) -> None:
    folder = planar_report.report.parent
    lines = rows_of(folder / "whole-machine-frf.csv")
    for name, low in (("whole-machine", 5.0), ("whole-machine-beyond-mounts", 100.0)):
        for row in rows_of(folder / f"{name}-minima.csv"):
            least, axis = float(row["least_N/m"]), row["axis"]
            peak = max(
                np.hypot(float(r[f"real_{axis}_m/N"]), float(r[f"imaginary_{axis}_m/N"]))
                for r in lines
                if float(r["frequency_Hz"]) >= low
            )
            # no drawn line is higher than the exact peak
            assert peak <= (1 + 1e-6) / least
            assert low <= float(row["frequency_Hz"]) <= 400.0
            assert row["proof"] == "True"
    text = text_of(planar_report.report)
    assert "Damping is assumed: 1 %" in text


@pytest.mark.slow
def test_granite_swings_by_the_mode_and_the_slider(
    browser: Browser, planar_report: WrittenReport
) -> None:
    browser.open(planar_report.report, 1400)
    figure = "document.querySelector('#mode-shapes')"
    trace = f"{figure}.querySelector('.drawing').data[0]"
    browser.evaluate(f"{figure}.scrollIntoView()")

    def choose(control: str, value: str) -> None:
        element = f"{figure}.querySelector('.modes {control}')"
        browser.evaluate(f"{element}.value = '{value}'")
        browser.evaluate(f"{element}.dispatchEvent(new Event('change'))")

    colours = browser.evaluate(f"JSON.stringify({trace}.intensity)")
    choose("select", "3")
    browser.wait_for(f"JSON.stringify({trace}.intensity) !== {json.dumps(colours)}", 30)
    choose("input", "0")
    motion = specs(planar_report.report)["mode-shapes"]["motion"]
    still = json.dumps(motion["rest"]["z"], separators=(",", ":"))
    at_rest = f"JSON.stringify({trace}.z) === JSON.stringify({still})"
    browser.wait_for(at_rest, 30)
    choose("input", "2")
    browser.wait_for(f"!({at_rest})", 30)
    drawn = np.array(browser.evaluate(f"{trace}.z"))
    shift = 2 * np.array(motion["modes"][3]["z"])
    np.testing.assert_allclose(drawn - motion["rest"]["z"], shift, atol=1e-9)
    assert browser.complaints == []
