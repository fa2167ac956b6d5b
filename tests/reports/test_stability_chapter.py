"""The chapter on the stability of cutting: its numbers are those of its files."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.load import load
from strutwork.reports.chapters import stability
from strutwork.reports.content import Chapter, Figure, Row, Table
from strutwork.reports.subject import Subject

HEAD = str(Path(__file__).parents[2] / "examples" / "machines" / "3-rps.toml")


@pytest.fixture(scope="module")
def subject() -> Subject:
    grid = TaskGrid({"rx": np.array([-0.05, 0.05]), "ry": np.array([0.0, 0.05])})
    model = load(HEAD)
    assert model.process is not None
    few = replace(model.process, points=9)
    return Subject(replace(model, workspace=grid, process=few), "head", "head")


@pytest.fixture(scope="module")
def chapter(subject: Subject) -> Chapter:
    assert stability.missing(subject) == ""
    return stability.write(subject)


def figures(chapter: Chapter) -> dict[str, Figure]:
    found = [b for b in chapter.blocks if isinstance(b, Figure)]
    found += [f for b in chapter.blocks if isinstance(b, Row) for f in b.figures]
    return {figure.key: figure for figure in found}


def test_every_figure_has_a_file_of_the_chapter(chapter: Chapter) -> None:
    known = {file.name for file in chapter.files}
    shown = figures(chapter)
    assert {"stability-lobes", "stability-rose", "stability-mode"} <= set(shown)
    assert {figure.data for figure in shown.values()} <= known


def test_the_lobes_are_those_of_the_file(chapter: Chapter, tmp_path: Path) -> None:
    file = next(f for f in chapter.files if f.name == "stability-lobes.csv")
    file.write(tmp_path / file.name)
    with (tmp_path / file.name).open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    drawn = figures(chapter)["stability-lobes"].spec["data"]
    exact = next(t for t in drawn if t["name"] == "exact")
    kept = [1e3 * float(r["exact depth [m]"]) for r in rows]
    np.testing.assert_allclose(exact["y"], kept, rtol=1e-4)
    assert chapter.answer.startswith("At home a depth of ")


def test_the_mode_that_limits_moves(chapter: Chapter, subject: Subject) -> None:
    motion = figures(chapter)["stability-mode"].spec["motion"]
    (mode,) = motion["modes"]
    limiting = subject.cut.lobes.effects.limiting_mode
    assert float(subject.cut.mode.modes.frequencies[0]) == pytest.approx(limiting, rel=1e-6)
    assert f"{limiting:.1f}"[:4] in mode["label"]


def test_parts_are_named_by_their_effect(chapter: Chapter) -> None:
    table = next(
        b for b in chapter.blocks if isinstance(b, Table) and b.caption.startswith("What limits")
    )
    effects = [float(str(row[1]).replace("−", "-")) for row in table.rows]
    assert effects == sorted(effects, reverse=True)
    assert effects[0] > 0.1


def test_what_is_missing_is_said(subject: Subject) -> None:
    bare = Subject(replace(subject.model, process=None), "head", "head")
    assert "no cut is given" in stability.missing(bare)
    quiet = Subject(replace(subject.model, damping=None), "head", "head")
    assert "mass and damping" in stability.missing(quiet)
