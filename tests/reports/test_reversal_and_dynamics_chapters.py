"""Chapters of reversals and of rigid-body dynamics: their numbers are those of the studies."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.load import load
from strutwork.reports.chapters import dynamics, reversals
from strutwork.reports.content import Chapter, Facts, Figure, Table
from strutwork.reports.numbers import significant
from strutwork.reports.subject import Subject

EXAMPLES = Path(__file__).parents[2] / "examples" / "machines"


@pytest.fixture(scope="module")
def hexapod() -> Subject:
    return Subject(load(EXAMPLES / "6-ups.toml"), "6-ups", "6-ups")


def tables(chapter: Chapter) -> list[Table]:
    return [b for b in chapter.blocks if isinstance(b, Table)]


def test_every_drive_has_its_row(hexapod: Subject) -> None:
    chapter = reversals.write(hexapod)
    (table,) = tables(chapter)
    study = hexapod.reversals
    drives = [f"{j}:{d}" for j, d in hexapod.model.structure.linkage.driven]
    assert [row[0] for row in table.rows] == drives
    lines = {name: len(found) for name, found in study.lines.items()}
    assert [int(str(row[4])) for row in table.rows] == [lines.get(d, 0) for d in drives]
    assert sum(lines.values()) > 0
    assert {str(row[6]) for row in table.rows} == {"yes"}
    (figure,) = [b for b in chapter.blocks if isinstance(b, Figure)]
    drawn = [t for t in figure.spec["data"] if t["name"].endswith("reverses")]
    assert len(drawn) == sum(lines.values())
    # in mm, as the axis says
    for trace in drawn:
        assert np.abs(trace["x"]).max() <= 150.0 + 1e-9


@pytest.mark.slow
def test_a_serial_machine_turns_back_nowhere() -> None:
    subject = Subject(load(EXAMPLES / "gantry.toml"), "gantry", "gantry")
    assert not reversals.missing(subject)
    chapter = reversals.write(subject)
    (figure,) = [b for b in chapter.blocks if isinstance(b, Figure)]
    assert "No drive reverses" in figure.caption
    facts = next(b for b in chapter.blocks if isinstance(b, Facts))
    assert [f.value for f in facts.items if f.label == "Plates"] == ["1"]


def test_dynamics_say_what_the_study_found(hexapod: Subject) -> None:
    chapter = dynamics.write(hexapod)
    found = hexapod.standard_motion
    facts = next(b for b in chapter.blocks if isinstance(b, Facts))
    values = {f.label: f.value for f in facts.items}
    assert values["Effective mass along x"] == significant(found.free[0])
    assert found.surely is not None
    assert values["Force it can exert in every direction"] == significant(found.surely)
    _, standing, circle = tables(chapter)
    largest = np.abs(found.standing).max(axis=0)
    shown = [abs(float(str(row[1]).replace("−", "-"))) for row in standing.rows]
    assert shown == pytest.approx(largest, rel=6e-3)
    assert found.round is not None
    first = found.round.demands[0]
    assert str(circle.rows[0][3]).startswith(significant(first.force.value))
    assert str(circle.rows[0][3]).endswith(f"of {significant(first.force.limit or 0.0)}")
    assert {file.name for file in chapter.files} == {"dynamics-standing.csv", "dynamics-circle.csv"}


def test_what_a_drive_cannot_do_is_said(hexapod: Subject) -> None:
    model = hexapod.model
    weak = tuple(replace(d, force=100.0) if k == 0 else d for k, d in enumerate(model.drives))
    subject = Subject(replace(model, drives=weak), "weak", "weak")
    circle = tables(dynamics.write(subject))[-1]
    assert "beyond their limits: drive1:z." in circle.caption


def test_why_a_chapter_is_not_there() -> None:
    massless = Subject(load("proposed-3pprs"), "p", "p")
    assert "no mass" in dynamics.missing(massless)
    model = load(EXAMPLES / "6-ups.toml")
    still = Subject(replace(model, workspace=None), "s", "s")
    assert "[workspace]" in dynamics.missing(still)
    assert "[workspace]" in reversals.missing(still)
    axes = {"x": np.linspace(-0.1, 0.1, 3)}
    line = Subject(replace(model, workspace=TaskGrid(axes)), "l", "l")
    assert "plane" in reversals.missing(line)


@pytest.mark.slow
def test_singularities_are_drawn_where_their_distance_changes() -> None:
    """Three slides carry the head: over x and y nothing changes, over its tilt all does."""
    subject = Subject(load("serial-five-axis"), "s", "s")
    assert list(subject.wide_directions) == ["x", "y", "rx"]
    plane = subject.singular_plane
    assert plane is not None
    assert plane.names == ("x", "rx")
    assert plane.changes
