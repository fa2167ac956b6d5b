"""Published numbers of Son 2002 on stiffness and manipulability, beside the reports."""

from __future__ import annotations

import csv
import json

import pytest

from strutwork.papers.published_rows import COLUMNS
from strutwork.papers.son_2002.manipulability import ROW
from strutwork.papers.son_2002.published import MANIPULABILITY, TABLE_6
from strutwork.reports.build import WrittenReport
from tests.reports.conftest import text_of


def lines(report: WrittenReport, name: str) -> list[dict[str, str]]:
    with (report.report.parent / name).open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        found = list(reader)
    assert tuple(reader.fieldnames or ()) == COLUMNS
    return found


def test_table_6_stands_in_both_readings(planar_report: WrittenReport) -> None:
    found = lines(planar_report, "published-son-2002-table-6.csv")
    assert len(found) == 2 * len(TABLE_6.values)
    printed = [float(line["published"]) for line in found if line["row"].endswith("as printed")]
    assert printed == [v.value for v in TABLE_6]
    assert {line["status"] for line in found} == {"not reproducible"}
    folder = planar_report.report.parent
    fits = json.loads((folder / "table-6-fits.json").read_text(encoding="utf-8"))
    assert [f["model"] for f in fits[:4]] == [f["model"] for f in fits[4:]]
    assert sum(f["model"] == "one constant a column" for f in fits) == 2
    page = text_of(planar_report.report)
    for words in ("last two rows swapped", "not determined", "that is not proven"):
        assert words in page


def test_manipulability_of_the_hexapod(hexapod_report: WrittenReport) -> None:
    found = lines(hexapod_report, "published-son-2002-manipulability.csv")
    published = [v for v in MANIPULABILITY if v.row == ROW]
    assert [float(line["published"]) for line in found] == [v.value for v in published]
    for line, value in zip(found, published, strict=True):
        assert line["quantity"] == value.quantity
        ours = float(line["computed"])
        difference = 100 * (ours - value.value) / value.value
        assert float(line["difference_percent"]) == pytest.approx(difference)


def test_hexapod_says_what_was_assumed(hexapod_report: WrittenReport) -> None:
    page = text_of(hexapod_report.report)
    for words in (
        "assumed: the k_i",
        "the drawing is missing",
        "the thesis prints none",
        "6 x 3 type",
    ):
        assert words in page
    content = json.loads((hexapod_report.report.parent / "report.json").read_text(encoding="utf-8"))
    assert (content["mobility"], content["redundant_constraints"]) == (6, 0)
    falls = {f["direction"]: f for f in content["falls"]["hexapod"]}
    # tilted, the tool turns away from a force along z
    assert falls["z"]["whole"] > 100 > falls["x"]["whole"]
