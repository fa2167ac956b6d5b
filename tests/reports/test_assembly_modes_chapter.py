"""The chapter on assembly modes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from strutwork.machines.load import load
from strutwork.machines.model_poses import at_pose
from strutwork.reports.chapters import assembly_modes as chapter_of
from strutwork.reports.content import Details, Facts, Row, Table
from strutwork.reports.subject import Subject
from strutwork.studies.machine_modes import machine_modes

EXAMPLES = Path(__file__).parents[2] / "examples" / "machines"


def test_every_mode_is_drawn_and_listed() -> None:
    subject = Subject(load(EXAMPLES / "3-rps.toml"), "3-rps", "3-rps")
    assert not chapter_of.missing(subject)
    chapter = chapter_of.write(subject)
    folded = [item for b in chapter.blocks if isinstance(b, Details) for item in b.items]
    facts, row, table = (
        next(b for b in (*chapter.blocks, *folded) if isinstance(b, kind))
        for kind in (Facts, Row, Table)
    )
    assert isinstance(facts, Facts)
    assert isinstance(row, Row)
    assert isinstance(table, Table)
    assert [f.value for f in facts.items if f.label == "Assembly modes"] == ["16"]
    assert len(row.figures) == len(table.rows) == 16
    own = [float(str(v)) for v in table.rows[0][1:4]]
    np.testing.assert_allclose(own, 1e3 * subject.model.motion.home_pose.position, rtol=1e-3)
    # axes of all pictures are the same, so that they compare
    ranges = {str(figure.spec["layout"]["xaxis"]["range"]) for figure in row.figures}
    assert len(ranges) == 1


def test_modes_found_from_starts_are_said_to_be_so() -> None:
    subject = Subject(load("mit-ss1"), "mit-ss1", "mit-ss1")
    chapter = chapter_of.write(subject)
    text = " ".join(getattr(b, "text", "") for b in chapter.blocks)
    assert "starting points, of which" in text
    assert "all there are" not in text


def test_modes_where_it_was_moved_to() -> None:
    model = load(EXAMPLES / "3-rps.toml")
    there = at_pose(model, {"z": 0.7, "rx": 0.1})
    modes = machine_modes(there)
    np.testing.assert_allclose(modes.tool.position[0], there.motion.home_pose.position, atol=1e-10)
