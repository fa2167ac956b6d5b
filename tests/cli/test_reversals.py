"""`strutwork reversals`: singular points, lines, paths and plates of any machine."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from strutwork.machines import HexelHexapod
from tests.cli.conftest import Program

OVER = ("--over", "x=-350mm..350mm:9,y=-350mm..350mm:9")


def test_singular_points_of_a_hexapod(strutwork: Program, tmp_path: Path) -> None:
    run = strutwork("reversals", "hexel-hexapod", *OVER, "--feed", "x", "--json", "-o", tmp_path)
    found = run.result
    machine = HexelHexapod()
    wanted = (machine.feet - machine.seats)[:, :2]
    for entry, place in zip(found["drives"], wanted, strict=True):
        (point,) = entry["points"]
        assert (point["kind"], entry["complete"], entry["winding"]) == ("strong", True, 1)
        assert [point["at"]["x"], point["at"]["y"]] == pytest.approx(place, abs=1e-9)
        # fed along x a leg turns back abreast of its point
        (line,) = found["reversal_lines"][entry["drive"]]
        assert np.array(line)[:, 0] == pytest.approx(np.full(len(line), place[0]), abs=1e-9)
    assert found["longest_path"]["length"] == pytest.approx(0.25, abs=1e-9)
    assert (found["points"], found["reachable"], found["still"]) == (81, 81, [])
    grid, points, lines = (Path(p) for p in found["data"])
    with grid.open(encoding="utf-8") as stream:
        assert len(list(csv.DictReader(stream))) == 81
    with points.open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert [r["drive"] for r in rows] == [e["drive"] for e in found["drives"]]
    assert "reversal" in lines.read_text(encoding="utf-8")


def test_words_for_people(strutwork: Program) -> None:
    run = strutwork(
        "reversals", "hexel-hexapod", "--over", "x=-40mm..40mm:5,y=-40mm..40mm:5",
        "--surface", "sphere:r=200mm", "--orientation", "normal", "--feed", "y",
    )  # fmt: skip
    assert run.status == 0, run.err
    assert "on a sphere:r=200mm, tool normal; 25 can be reached" in run.out
    assert "Longest straight path without a reversal along y" in run.out
    assert "Plates that the grid distinguishes" in run.out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--over", "x=-10mm..10mm"), "gives 1 directions"),
        ((*OVER, "--surface", "cube:r=1mm"), '"cube:r=1mm" is not a surface'),
        ((*OVER, "--orientation", "normal"), "normal to a plane"),
        ((*OVER, "--feed", "z"), '"z" is neither x nor y'),
        (("--over", "x=-9mm..9mm,z=390mm..410mm", "--surface", "sphere:r=1m"), "over x and y"),
        (("--over", "x=-1mm..1mm:3000,y=-1mm..1mm:3000"), "would take about"),
    ],
)
def test_what_is_wrong_is_said(strutwork: Program, words: tuple[str, ...], said: str) -> None:
    run = strutwork("reversals", "hexel-hexapod", *words)
    assert run.status == 1
    assert said in run.err
