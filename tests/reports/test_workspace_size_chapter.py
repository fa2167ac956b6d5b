"""The largest box about home in the chapter on the workspace's size: told, drawn, in its data."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.machines.load import load
from strutwork.reports.chapters import workspace_size
from strutwork.reports.content import Figure, Text
from strutwork.reports.subject import Subject


def test_the_largest_box_about_home() -> None:
    subject = Subject(load("proposed-3pprs"), "proposed-3pprs", "proposed")
    inside = subject.largest_box
    assert inside is not None
    # in the proportions of what is looked over, and good on its border and within
    spans = [float(np.ptp(axis)) for axis in subject.workspace.grid.axes]
    np.testing.assert_allclose(inside.sides / inside.sides[0], np.array(spans) / spans[0])
    margin, _ = subject._sized
    ends = 2.0 * np.indices((2, 2, 2)).reshape(3, -1).T - 1.0
    corners = inside.centre + 0.5 * inside.sides * ends
    assert margin(corners).good.all()
    # and a little larger it is not
    beyond = inside.centre + 1.01 * (inside.critical - inside.centre)
    assert margin(beyond[None]).value[0] < 0.0
    chapter = workspace_size.write(subject)
    words = " ".join(block.text for block in chapter.blocks if isinstance(block, Text))
    assert f"{1e3 * inside.sides[0]:.3g} ×" in words
    (figure,) = (block for block in chapter.blocks if isinstance(block, Figure))
    (drawn,) = (t for t in figure.spec["data"] if t.get("name") == "largest box about home")
    assert np.ptp(drawn["x"]) == pytest.approx(1e3 * inside.sides[0], rel=1e-3)
    assert figure.data in {file.name for file in chapter.files}


def test_no_box_where_turns_are_looked_over() -> None:
    subject = Subject(load("examples/machines/planar-3-rrr.toml"), "planar", "planar")
    assert subject.largest_box is None
