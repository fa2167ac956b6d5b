"""The chapters on assembly forces: the files hold what is plotted, and what is assumed is said."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.papers.published_rows import COLUMNS
from strutwork.papers.son_2002.published import TABLE_2
from strutwork.papers.son_2002.tolerances import STATIC_RATING
from strutwork.reports.build import WrittenReport, write_report
from strutwork.reports.chapters.overconstraint_forces import MOST
from tests.reports.conftest import text_of
from tests.reports.test_data_files import rows_of, specs

SAMPLES = 100_000

#: Report fixture and key of its assembly forces.
STUDIES = [
    ("planar_report", "assembly"),
    ("planar_report", "table-2-case-I"),
    ("tolerance_report", "tolerances"),
]

#: A plate that six springs hold: whatever their heights, nothing is constrained twice.
PERFECT = """
title = "Three feet"

[nodes]
A = [0, 0, 0]
B = ["1 m", 0, 0]
C = [0, "1 m", 0]
a = [0, 0, 0]
b = ["1 m", 0, 0]
c = [0, "1 m", 0]
TCP = ["300 mm", "300 mm", 0]

[[bodies]]
name = "plate"
nodes = ["a", "b", "c", "TCP"]

[[bodies]]
name = "bed"
nodes = ["A", "B", "C"]

[[supports]]
node = "A"
fixed = "all"

[[joints]]
name = "foot A"
type = "bushing"
between = ["A", "a"]
stiffness = { x = "100 N/um", y = "100 N/um", z = "100 N/um" }

[[joints]]
name = "foot B"
type = "bushing"
between = ["B", "b"]
stiffness = { z = "100 N/um", y = "100 N/um" }

[[joints]]
name = "foot C"
type = "bushing"
between = ["C", "c"]
stiffness = { z = "100 N/um" }

[[tolerances]]
name = "height"
kind = "flatness"
joints = ["foot B", "foot C"]
axis = [0, 0, 1]
datum = "B"
size = "10 um"

[tool]
tcp = "TCP"
"""


@pytest.fixture(params=STUDIES, ids=[key for _, key in STUDIES])
def assembled(request: pytest.FixtureRequest) -> tuple[WrittenReport, str]:
    name, key = request.param
    return request.getfixturevalue(name), key


def test_bars_and_limits_are_those_of_the_file(assembled: tuple[WrittenReport, str]) -> None:
    report, key = assembled
    rows = {(r["joint"], r["kind"]): r for r in rows_of(report.report.parent / f"{key}-forces.csv")}
    plot = specs(report.report)[f"forces-{key}"]
    limits = {float(r["limit"]) for r in rows.values() if r["limit"]}
    (limit,) = limits
    assert [s["y0"] for s in plot["layout"]["shapes"]] == pytest.approx([limit / 1e3])
    bars = [t for t in plot["data"] if t["type"] == "bar"]
    assert bars
    for bar in bars:
        kind = bar["name"].removeprefix("worst case, ")
        assert len(bar["customdata"]) <= MOST
        ours = [float(rows[joint, kind]["worst_case"]) / 1e3 for joint in bar["customdata"]]
        # the page rounds to six digits
        assert bar["y"] == pytest.approx(ours, rel=1e-5)


def test_quantiles_lie_below_the_worst_case(assembled: tuple[WrittenReport, str]) -> None:
    report, key = assembled
    for row in rows_of(report.report.parent / f"{key}-forces.csv"):
        levels = [float(row[f"q{s}"]) for s in ("0.5", "0.9", "0.95", "0.99", "0.999")]
        assert levels == sorted(levels)
        assert levels[-1] <= float(row["worst_case"]) * (1 + 1e-9)
        assert float(row["q0.95_low"]) <= float(row["q0.95"]) <= float(row["q0.95_high"])


def test_histograms_hold_every_sample(assembled: tuple[WrittenReport, str]) -> None:
    report, key = assembled
    rows = rows_of(report.report.parent / f"{key}-histograms.csv")
    plots = specs(report.report)
    names = list(dict.fromkeys(r["quantity"] for r in rows))
    drawn = [k for k in plots if k.startswith(f"spread-{key}-")]
    assert len(drawn) == len(names) > 0
    for name, k in zip(names, drawn, strict=True):
        some = [r for r in rows if r["quantity"] == name]
        counts = np.array([int(r["samples"]) for r in some])
        assert counts.sum() == SAMPLES
        np.testing.assert_allclose(
            plots[k]["data"][0]["y"], 100 * counts / SAMPLES, rtol=1e-3, atol=1e-12
        )
        worst = next(a for a in plots[k]["layout"]["annotations"] if "worst" in a["text"])
        assert worst["x"] == pytest.approx(float(some[-1]["to_N"]) / 1e3, rel=1e-9)


def test_shares_add_to_one(assembled: tuple[WrittenReport, str]) -> None:
    report, key = assembled
    for row in rows_of(report.report.parent / f"{key}-shares.csv"):
        cells = [v for name, v in row.items() if name != "quantity"]
        # nothing moves a quantity at all, and then it has no parts, or everything together does
        assert not any(cells) or sum(map(float, cells)) == pytest.approx(1.0, abs=1e-9)
    for bar in specs(report.report)[f"shares-{key}"]["data"]:
        assert all(0 <= v <= 100 for v in bar["x"])


def test_every_place_of_the_page_has_its_own_name(any_report: WrittenReport) -> None:
    names = re.findall(r' id="([^"]+)"', text_of(any_report.report))
    assert len(names) == len(set(names)) > 20


def test_table_2_stands_beside_the_report(planar_report: WrittenReport) -> None:
    folder = planar_report.report.parent
    rows = rows_of(folder / "published-son-2002-table-2.csv")
    assert tuple(rows[0]) == COLUMNS
    assert len(rows) == 36
    assert {r["unit"] for r in rows} == {"kN"}
    assert {r["status"] for r in rows} == {"calibrated"}
    for row in rows:
        published, computed = float(row["published"]), float(row["computed"])
        assert published == TABLE_2.value(row["row"], row["quantity"])
        # the stored reconstruction: 4 %, or 0.06 kN of rounding where a force is small
        assert abs(computed - published) <= max(0.04 * published, 0.06)
        assert float(row["difference_percent"]) == pytest.approx(
            100 * (computed - published) / published
        )
    fitted = rows_of(folder / "published-son-2002-table-2-fitted-to-case-I.csv")
    assert {r["status"] for r in fitted} == {"calibrated"}


def test_what_is_not_published_is_said(planar_report: WrittenReport) -> None:
    text = text_of(planar_report.report)
    section = re.findall(r'<section id="table-2".*?</section>', text, re.DOTALL)[0]
    assert "Reconstructed" in section
    assert "not available" in section
    assert (
        "as interpreted here"
        in re.findall(r'<section id="designs".*?</section>', text, re.DOTALL)[0]
    )
    assumptions = re.findall(r'<section id="assumptions".*?</section>', text, re.DOTALL)[0]
    for words in ("Static rating", "calibrated", "section 6.6", "assumed"):
        assert words in assumptions


def test_published_forces_are_markers_on_the_bars(planar_report: WrittenReport) -> None:
    for case in ("I", "II", "III"):
        plot = specs(planar_report.report)[f"forces-table-2-case-{case}"]
        for kind, quantity in (("radial force", "Fr"), ("axial force", "Fa")):
            marks = next(t for t in plot["data"] if t["name"] == f"Table 2, {kind}")
            printed = [TABLE_2.value(f"case {case} joint {n}", quantity) for n in range(1, 7)]
            assert marks["y"] == printed


def test_forces_over_the_workspace(planar_report: WrittenReport) -> None:
    folder, plots = planar_report.report.parent, specs(planar_report.report)
    with xr.open_dataset(folder / "assembly-map.nc", engine="h5netcdf") as file:
        force = file["force"].load()
    for k, kind in enumerate(("radial", "axial")):
        plot = plots[f"assembly-map-{kind}"]
        ours = force.to_numpy()[:, :, k].max(axis=-1) / 1e3
        np.testing.assert_allclose(np.transpose(plot["data"][0]["z"]), ours, rtol=1e-4)
        # the worst pose is marked
        i, j = np.unravel_index(int(ours.argmax()), ours.shape)
        place = plot["data"][1]["x"][0], plot["data"][1]["y"][0]
        expected = 1e3 * force["x"].to_numpy()[i], np.degrees(force["b"].to_numpy()[j])
        assert place == pytest.approx(expected)
    rows = rows_of(folder / "assembly-forces.csv")
    largest = max(float(r["worst_case"]) for r in rows if r["kind"] == "radial force")
    # the table and the map tell of the same poses
    assert largest == pytest.approx(float(force.to_numpy()[:, :, 0].max()), rel=1e-9)


def test_forces_against_length(planar_report: WrittenReport) -> None:
    folder, plots = planar_report.report.parent, specs(planar_report.report)
    rows = rows_of(folder / "assembly-scale.csv")
    assert [float(rows[i]["length_m"]) for i in (0, -1)] == [0.1, 3.0]
    lines = {t["name"]: t["y"] for t in plots["scale-fr"]["data"] if t["mode"] == "lines"}
    ours = [float(r["radial_joint2_N"]) / 1e3 for r in rows]
    assert lines["joint 2, near"] == pytest.approx(ours, rel=1e-5)
    assert [s["y0"] for s in plots["scale-fr"]["layout"]["shapes"]] == [STATIC_RATING / 1e3]


def test_allocation_keeps_every_limit(planar_report: WrittenReport) -> None:
    content = json.loads(text_of(planar_report.report.parent / "report.json"))
    for allocation in content["allocations"].values():
        assert np.max(allocation["utilisation"]) == pytest.approx(1.0, abs=1e-6)
        assert allocation["active"]
    rows = rows_of(planar_report.report.parent / "assembly-allocation.csv")
    assert {r["tolerance"] for r in rows} >= {"block pin 1", "housing pin 3", "rail 2"}


def test_the_drawn_misfit_is_the_worst_case(planar_report: WrittenReport) -> None:
    folder = planar_report.report.parent
    drawn = json.loads(text_of(folder / "misfit-table-2-case-I.json"))
    sizes = {joint: float(np.linalg.norm(f)) for joint, f in drawn["forces_on_second_side"].items()}
    rows = rows_of(folder / "table-2-case-I-forces.csv")
    radial = {r["joint"]: float(r["worst_case"]) for r in rows if r["kind"] == "radial force"}
    top = max(radial, key=lambda joint: radial[joint])
    force = drawn["forces_on_second_side"][top]
    # pins lie along y: what is across is radial
    assert np.hypot(force[0], force[2]) == pytest.approx(radial[top], rel=1e-6)
    assert all(np.isfinite(size) for size in sizes.values())


def test_a_structure_without_self_stress_says_so(tmp_path: Path) -> None:
    model = tmp_path / "feet.toml"
    model.write_text(PERFECT, encoding="utf-8")
    report = write_report(str(model), tmp_path / "out")
    text = text_of(report.report)
    assert "No force is locked in" in text
