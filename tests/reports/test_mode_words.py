"""Modes are named by what moves, parts are grouped as the user named them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from strutwork.machines.load import load
from strutwork.reports.chapters.model import check_chapter
from strutwork.reports.chapters.part_budget import budget_chapter
from strutwork.reports.chapters.vibration import bends
from strutwork.reports.content import Details, Figure, Table, Text
from strutwork.reports.equal_axes import equal_axes
from strutwork.reports.mode_words import moves
from strutwork.reports.model_check import check_model
from strutwork.reports.vibration_study import study_model_vibration

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_a_column_on_mounts_is_named_by_its_parts() -> None:
    study = study_model_vibration(load(EXAMPLES / "08_column_on_mounts.toml"), "test")
    assert "mounts 9" in bends(study, 0)
    assert all(moves(study, i) for i in range(len(study.modes.frequencies)))


def test_a_tripod_moves_its_platform_and_the_band_reaches_its_stiff_axis() -> None:
    study = study_model_vibration(load(EXAMPLES / "03_tripod.toml"), "test")
    assert moves(study, 0).startswith("platform along ")
    # its z resonance lies beyond twice the sixth mode, and carries most of the compliance
    assert study.least[2].frequency > 2.0 * study.modes.frequencies[5]
    assert study.least[2].frequency < study.band[1]
    assert study.stop == ""


def test_twelve_springs_of_four_mounts_are_one_row_that_opens() -> None:
    chapter = budget_chapter(load(EXAMPLES / "08_column_on_mounts.toml"))
    (table,) = [b for b in chapter.blocks if isinstance(b, Table)]
    assert [row[0].text for row in table.cells] == ["mounts", "arm", "column", "total, µm/N"]
    (opens,) = [b for b in chapter.blocks if isinstance(b, Details)]
    assert opens.summary == "mounts: 12 parts and directions"
    (inner,) = opens.items
    assert isinstance(inner, Table)
    assert len(inner.rows) == 12
    assert {row[1].text for row in inner.cells} == {f"along its {a} (global {a})" for a in "xyz"}
    (figure,) = [b for b in chapter.blocks if isinstance(b, Figure)]
    shares = np.array([trace["x"] for trace in figure.spec["data"]])
    np.testing.assert_allclose(shares.sum(axis=0), 100.0, atol=0.01)


def test_motions_of_six_legs_are_a_sentence() -> None:
    chapter = check_chapter(check_model(load(EXAMPLES / "machines" / "6-ups.toml")))
    texts = [b.text for b in chapter.blocks if isinstance(b, Text)]
    assert "With the drives free the tool has 6 freedoms: x, y, z, rx, ry and rz." in texts
    (opens,) = [b for b in chapter.blocks if isinstance(b, Details)]
    table = opens.items[0]
    assert isinstance(table, Table)
    assert all(len(row[1].text) < 200 for row in table.cells)
    assert "drive1 to drive6 (6) in z" in table.cells[0][1].text


def test_directions_with_the_same_answer_are_joined() -> None:
    one = np.array([1.0, 2.0 + 1.0j])
    assert equal_axes([one, one * (1 + 1e-9), 2 * one], "xyz") == [("x", "y"), ("z",)]
