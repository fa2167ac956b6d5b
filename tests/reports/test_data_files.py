"""The files beside a report: complete, readable, and the numbers that the page plots."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import MechanismError, ModelError, NumericalError
from strutwork.papers.published_rows import COLUMNS
from strutwork.reports.build import WrittenReport, write_report
from strutwork.reports.data_files import csv_file, json_file
from tests.reports.conftest import text_of

MECHANISM = """
[materials.steel]
youngs_modulus = "205 GPa"
poissons_ratio = 0.29
density = 7870

[sections.tube]
shape = "rod"
diameter = "19 mm"

[nodes]
A = [0, 0, 0]
B = [0, 0, 0]
C = ["200 mm", 0, 0]

[[beams]]
name = "link"
from = "B"
to = "C"
material = "steel"
section = "tube"

[[joints]]
name = "hinge"
type = "revolute"
between = ["A", "B"]
axis = [0, 1, 0]

[[supports]]
node = "A"
fixed = "all"

[[loads]]
node = "C"
force = [0, 0, "1 N"]
"""


def specs(report: Path) -> dict[str, Any]:
    """Every plot of a page by its key."""
    found = re.findall(
        r'<figure class="plot" id="([^"]+)">.*?<script type="application/json">(.*?)</script>',
        text_of(report),
        re.DOTALL,
    )
    return {key: json.loads(text) for key, text in found}


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_every_file_is_there_and_linked(any_report: WrittenReport) -> None:
    folder = any_report.report.parent
    assert {p.name for p in folder.iterdir() if p.is_file()} >= {
        p.name for p in (any_report.report, *any_report.data)
    }
    assert not [p for p in folder.iterdir() if p.name.startswith(".")]
    text = text_of(any_report.report)
    links = set(re.findall(r'<li><a href="([^"#]+)"', text))
    assert links == {p.name for p in any_report.data}
    named = set(re.findall(r'class="data" href="([^"]+)"', text))
    assert named <= links
    # every plot says in which file its numbers are
    assert text.count('<figure class="plot"') == len(
        re.findall(
            # a caption may hold a formula
            r'<figcaption>(?:(?!</figcaption>).)*<a class="data"[^<]*</a></figcaption>\s*</figure>',
            text,
            re.DOTALL,
        )
    )


def test_maps_on_the_page_are_those_of_the_files(machine_report: WrittenReport) -> None:
    folder, plots = machine_report.report.parent, specs(machine_report.report)
    for model in ("spherical", "apparent"):
        with xr.open_dataset(folder / f"stiffness-map-{model}.nc", engine="h5netcdf") as file:
            stiffness = file["stiffness_blocked"].load()
        for axis in "xyz":
            heat = plots[f"map-{model}-{axis}"]["data"][0]
            plotted = np.array([v for row in heat["z"] for v in row if v is not None])
            ours = stiffness.sel(direction=axis).to_numpy() / 1e6
            assert plotted.size == 317
            # the page rounds to five digits
            np.testing.assert_allclose(np.sort(plotted), np.sort(ours), rtol=1e-4)
            head = f"stiffness_blocked_{axis} [N/m]"
            table = [float(r[head]) / 1e6 for r in rows_of(folder / f"stiffness-map-{model}.csv")]
            np.testing.assert_allclose(table, ours, rtol=1e-12)


def test_budgets_on_the_page_are_those_of_the_file_and_add_to_one(
    machine_report: WrittenReport,
) -> None:
    folder, plots = machine_report.report.parent, specs(machine_report.report)
    rows = rows_of(folder / "budget-spherical.csv")
    bars = plots["budget-spherical"]["data"]
    for i, label in enumerate(bars[0]["y"]):
        force, rank = label.split(", ")
        some = [r for r in rows if (r["force"], r["rank"]) == (force, rank)]
        # strain-energy shares of a linear structure add to one but for rounding
        assert sum(float(r["share"]) for r in some) == pytest.approx(1.0, abs=1e-9)
        link = sum(float(r["share"]) for r in some if re.search(r"beam leg\d/link$", r["part"]))
        plotted = next(b["x"][i] for b in bars if b["name"] == "link")
        assert plotted == pytest.approx(100 * link, rel=1e-4, abs=1e-6)


@pytest.mark.parametrize(
    "table", ["azulay-2014-table-2", "azulay-2014-table-4", "azulay-2014-table-5"]
)
def test_published_tables_stand_beside_the_report(
    comparison_report: WrittenReport, table: str
) -> None:
    path = comparison_report.report.parent / f"published-{table}.csv"
    rows = rows_of(path)
    assert tuple(rows[0]) == COLUMNS
    assert {r["status"] for r in rows} <= {"predicted", "calibrated", "not reproducible"}
    for row in rows:
        published, computed = float(row["published"]), float(row["computed"])
        assert float(row["difference_percent"]) == pytest.approx(
            100 * (computed - published) / published
        )
    models = ("true spherical joints", "as the paper's numbers suggest")
    for label in ("calibrated", "blind") if table.endswith("5") else models:
        assert any(r["row"].endswith(label) for r in rows), label


def test_bars_of_the_comparison_are_the_published_and_computed_means(
    comparison_report: WrittenReport,
) -> None:
    folder, plots = comparison_report.report.parent, specs(comparison_report.report)
    rows = rows_of(folder / "published-azulay-2014-table-4.csv")
    for axis in "xyz":
        published, ours, _ = plots[f"means-{axis}"]["data"]
        some = [
            r
            for r in rows
            if r["quantity"] == f"K{axis * 2} mean" and r["row"].endswith("true spherical joints")
        ]
        assert published["y"] == pytest.approx([float(r["published"]) for r in some])
        assert ours["y"] == pytest.approx([float(r["computed"]) for r in some], rel=1e-5)


def test_deformed_shape_ends_where_the_solution_does(model_report: WrittenReport) -> None:
    folder = model_report.report.parent
    solution = json.loads(text_of(folder / "solution.json"))
    rows = rows_of(folder / "deformed-shapes.csv")
    for name, case in solution["cases"].items():
        moved = [float(r["displacement_m"]) for r in rows if r["case"] == name and r["x_m"]]
        largest = max(np.linalg.norm(u[:3]) for u in case["displacements"].values())
        # between nodes the cubic shape may pass the largest nodal displacement a little
        assert max(moved) == pytest.approx(largest, rel=0.02)


def test_drawn_positions_are_those_of_the_drawing_file(machine_report: WrittenReport) -> None:
    drawing = json.loads(text_of(machine_report.report.parent / "drawing-proposed-3pprs.json"))
    plot = specs(machine_report.report)["drawing-proposed-3pprs"]
    tool = next(t for t in plot["data"] if t["name"] == "tool centre point")
    centre = [1e-3 * (min(tool[a]) + max(tool[a])) / 2 for a in "xyz"]
    assert centre == pytest.approx(drawing["nodes"]["tool"], abs=1e-6)
    layout = plot["layout"]["scene"]
    spans = [np.diff(layout[f"{a}axis"]["range"])[0] for a in "xyz"]
    shown = [layout["aspectratio"][a] for a in "xyz"]
    # the same scale on all axes
    assert np.ptp(np.divide(shown, spans)) <= 1e-9 * shown[0]
    assert all("(mm)" in layout[f"{a}axis"]["title"]["text"] for a in "xyz")


def test_a_failure_leaves_nothing_behind(tmp_path: Path) -> None:
    model = tmp_path / "loose.toml"
    model.write_text(MECHANISM, encoding="utf-8")
    folder = tmp_path / "out"

    with pytest.raises(MechanismError, match="hinge"):
        write_report(str(model), folder)

    assert not folder.exists()


def test_a_file_that_cannot_be_written_leaves_the_old_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = tmp_path / "held.toml"
    model.write_text(MECHANISM.replace("revolute", "fixed"), encoding="utf-8")
    first = write_report(str(model), tmp_path / "out")
    before = {p.name: p.read_bytes() for p in first.report.parent.iterdir()}
    write_text = Path.write_text

    def fail(self: Path, *arguments: Any, **options: Any) -> int:
        if self.name == "report.html":
            raise OSError(28, "No space left on device")
        return write_text(self, *arguments, **options)

    model.write_text(MECHANISM.replace("revolute", "fixed").replace('"1 N"', '"2 N"'), "utf-8")
    monkeypatch.setattr(Path, "write_text", fail)
    with pytest.raises(ModelError, match="No space left"):
        write_report(str(model), tmp_path / "out")

    assert {p.name: p.read_bytes() for p in (tmp_path / "out").iterdir()} == before


def test_an_unknown_target_names_what_there_is(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"proposed-3pprs.*azulay-2014"):
        write_report("hexapod", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_no_number_that_is_not_finite_reaches_a_file() -> None:
    with pytest.raises(NumericalError, match=r"numbers\.json"):
        json_file("numbers.json", "", {"value": float("nan")})
    with pytest.raises(NumericalError, match=r"numbers\.csv"):
        csv_file("numbers.csv", "", ("value",), [[float("inf")]])
