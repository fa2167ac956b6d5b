"""The chapter on the machine's size, and its lines where both axes are logarithmic."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from strutwork.machines import MitSS1
from strutwork.papers.son_2002.chapters.size import scale_chapter
from strutwork.reports.content import Chapter, Figure, Page, Row, Table, Text
from strutwork.reports.figures.curves import Curve
from strutwork.reports.figures.scaling import powers
from strutwork.reports.page import render
from strutwork.studies.scale import ScaleStudy, scale_study

SIZES = (0.5, 1.0, 2.0)


def study(count: int) -> ScaleStudy:
    machine = MitSS1(elements=2)
    return scale_study(machine.structure.at(machine.place(machine.home())), SIZES, count=count)


@pytest.fixture(scope="module")
def moving() -> ScaleStudy:
    return study(4)


@pytest.fixture(scope="module")
def chapter(moving: ScaleStudy) -> Chapter:
    # the chapter asks the machine on its granite for ten frequencies; any machine has them
    return scale_chapter(moving, study(10))


def test_lines_carry_their_exponents() -> None:
    some = [Curve("a", np.array([20.0, 40.0, 80.0]), "#000000")]
    figure = powers(SIZES, some, "stiffness (N/µm)", [1.0])
    (line,) = figure["data"]
    assert line["name"] == "a: L^1.00"
    assert line["y"] == [20.0, 40.0, 80.0]
    vertical, across = figure["layout"]["yaxis"], figure["layout"]["xaxis"]
    assert (vertical["type"], across["type"]) == ("log", "log")
    assert vertical["tickvals"] == [10.0, 20.0, 50.0, 100.0, 200.0, 500.0]
    assert vertical["title"]["text"] == "stiffness (N/µm)"


def test_figures_show_what_the_study_found(chapter: Chapter, moving: ScaleStudy) -> None:
    rows = [b.figures for b in chapter.blocks if isinstance(b, Row)]
    figures = {f.key: f for row in rows for f in row}
    figures |= {b.key: b for b in chapter.blocks if isinstance(b, Figure)}
    assert len(figures) == 4
    lines = {t["name"]: t["y"] for t in figures["size-stiffness"].spec["data"]}
    assert lines["y, similar joints: L^1.00"] == pytest.approx(
        1e-6 * moving.stiffness[0, :, 1], rel=1e-5
    )
    assert len(lines) == 9
    deflections = figures["size-deflection"].spec["data"]
    at_own_size = [t["y"][1] for t in deflections]
    assert at_own_size == [1.0] * 9
    similar = next(t for t in deflections if t["name"].startswith("n = 3.5, similar"))
    assert similar["y"] == pytest.approx([2**1.25, 1, 2**-1.25], rel=1e-5)


def test_tables_and_words(chapter: Chapter, moving: ScaleStudy) -> None:
    exponents, removal = (b for b in chapter.blocks if isinstance(b, Table))
    assert [c.text for c in exponents.cells[0][1:8]] == ["1.000"] * 3 + ["−1.000"] * 4
    assert len(removal.rows) == 2 * 3
    assert {len(row) for row in removal.rows} == {1 + 3 * 3}
    words = " ".join(b.text for b in chapter.blocks if isinstance(b, Text))
    assert f"{100 * moving.joint_share[0]:.1f} % of the deflection in x" in words


def test_data_beside_the_report(chapter: Chapter, moving: ScaleStudy, tmp_path: Path) -> None:
    for file in chapter.files:
        file.write(tmp_path / file.name)
    with (tmp_path / "size.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 2 * 3 * len(SIZES)
    assert float(rows[1]["stiffness_x_N_per_m"]) == moving.stiffness[0, 1, 0]
    assert rows[1]["frequency_10_Hz"] == ""
    assert float(rows[-1]["frequency_10_Hz"]) > 0
    told = json.loads((tmp_path / "size.json").read_text(encoding="utf-8"))
    assert told["rails held"] == moving.to_dict()
    names = [b.data for b in chapter.blocks if isinstance(b, Figure | Table)]
    assert set(names) <= {f.name for f in chapter.files}


def test_the_chapter_makes_a_page(chapter: Chapter) -> None:
    page = render(Page("Size", "", (chapter,), ""))
    assert 'id="size"' in page
