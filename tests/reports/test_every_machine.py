"""The page that sets all machines side by side."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import pytest

from strutwork.errors import ModelError
from strutwork.machines.catalogue import CATALOGUE
from strutwork.machines.load import load
from strutwork.reports import every_machine
from strutwork.reports.build import Composed, page_of
from strutwork.reports.content import Chapter, Points, Text
from strutwork.reports.every_machine import comparison_page, write_every_report
from strutwork.reports.subject import Subject
from strutwork.studies.comparison import machine_answers

NAMES = ("alizade-3prps", "mit-ss1", "hexel-hexapod")


def composed(name: str, *_: object, fresh: bool = False) -> Composed:
    """In place of whole reports, which have tests of their own."""
    assert fresh
    if name == "hexel-hexapod":
        raise ModelError("hexel-hexapod", "has <b>no</b> report.", "None.")
    subject = Subject(load(name), name, name) if name in CATALOGUE else None
    chapters = (Chapter("one", "Is it there?", (Text("Yes."),)),)
    return Composed(page_of(f"page of {name}", "", chapters), (), subject)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("every")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(every_machine, "CATALOGUE", {n: CATALOGUE[n] for n in NAMES})
        patch.setattr(every_machine, "compose", composed)
        patch.setattr(every_machine, "_size", lambda _: "")
        reports = [
            str(w.report.relative_to(folder)) for w in write_every_report(folder, fresh=True)
        ]
    assert reports[:2] == ["alizade-3prps/report.html", "mit-ss1/report.html"]
    assert reports[-1] == "report.html"
    return folder


def test_every_number_is_that_of_the_machine(written: Path) -> None:
    with (written / "comparison.csv").open(encoding="utf-8") as stream:
        rows = {row["machine"]: row for row in csv.DictReader(stream)}
    assert list(rows) == ["alizade-3prps", "mit-ss1"]
    answers = machine_answers(load("mit-ss1"))
    row = rows["mit-ss1"]
    assert int(row["mobility"]) == 3
    assert int(row["redundant_constraints"]) == 12
    assert float(row["least_stiffness_y_N_per_m"]) == pytest.approx(answers.worst[1], rel=1e-9)
    assert float(row["first_frequency_Hz"]) == pytest.approx(answers.frequency, rel=1e-9)
    content = json.loads((written / "report.json").read_text(encoding="utf-8"))
    assert content["machines"]["mit-ss1"]["poses_reached"] == answers.reached


def test_it_names_the_model_that_a_frequency_is_of(written: Path) -> None:
    page = (written / "report.html").read_text(encoding="utf-8")
    assert "alizade-3prps: the frequency is that of its model alizade-3prps:calibrated" in page
    assert "mit-ss1: the frequency" not in page


def test_links_lead_to_the_reports(written: Path) -> None:
    page = (written / "report.html").read_text(encoding="utf-8")
    links = re.findall(r'<a href="([^"#]+/report\.html)"', page)
    assert links[:2] == ["alizade-3prps/report.html", "mit-ss1/report.html"]
    assert all((written / link).is_file() for link in links)
    # the page carries its data where it is mailed alone, and says what it does not carry
    assert "Passed on alone, this page keeps" in page
    assert page.index("Passed on alone") < page.index(f'href="{links[0]}"')


def test_without_reports_no_links_are_promised() -> None:
    chapter = comparison_page([], [], {"mit-ss1": "has no report."}).page.chapters[1]
    assert [type(block) for block in chapter.blocks] == [Text, Points]


def test_a_machine_without_a_report_is_named_with_the_reason(written: Path) -> None:
    page = (written / "report.html").read_text(encoding="utf-8")
    assert "hexel-hexapod: hexel-hexapod: has &lt;b&gt;no&lt;/b&gt; report." in page
    assert not (written / "hexel-hexapod").exists()
