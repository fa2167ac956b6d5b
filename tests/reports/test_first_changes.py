"""What to change first: the section, its numbers beside those of changed machines, its file."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from strutwork.machines.model_file import parse_model, read_model
from strutwork.machines.model_poses import at_pose
from strutwork.msa import axis_stiffness_free, tool_compliance
from strutwork.reports.chapters.first_changes import FILE, first_changes
from strutwork.reports.content import Figure, Note, Table, Text
from strutwork.reports.first_changes import effects
from strutwork.reports.subject import Subject
from strutwork.studies.parametric import Parametric

HEAD = Path("examples/machines/3-rps.toml")


@pytest.fixture(scope="module")
def subject() -> Subject:
    return Subject(read_model(HEAD), str(HEAD), "3-rps", file=HEAD)


def test_the_section_names_the_largest_effect_first(subject: Subject, tmp_path: Path) -> None:
    blocks, files = first_changes(subject)
    assert isinstance(blocks[0], Text)
    assert "linear estimate" in blocks[0].text
    figure = next(b for b in blocks if isinstance(b, Figure))
    assert figure.data == FILE
    table = next(b for b in blocks if isinstance(b, Table))
    assert table.rows[0][0] == "sections.cylinder.outer_diameter"
    assert any("(3)" in str(row[0]) for row in table.rows)
    assert any(isinstance(b, Note) and "bodies.platform.mass" in b.text for b in blocks)
    (file,) = files
    file.write(tmp_path / FILE)
    rows = list(csv.DictReader((tmp_path / FILE).read_text(encoding="utf-8").splitlines()))
    assert {r["quantity"] for r in rows} == {"stiffness_x", "stiffness_y", "stiffness_z"}


def test_the_estimate_is_that_of_a_machine_changed_a_little(subject: Subject) -> None:
    """A hundredth of the ten percent, for a group of three and for one section."""
    machine = Parametric.of(str(HEAD))
    for one, axis in zip(subject.first_changes, range(3), strict=True):
        task = {d: float(one[d][0]) for d in ("x", "y", "z", "rx", "ry", "rz") if d in one.coords}

        def stiffness(
            values: dict[str, float], axis: int = axis, task: dict[str, float] = task
        ) -> float:
            placed = at_pose(machine.model(values), task).placed
            return float(axis_stiffness_free(tool_compliance(placed))[axis])

        before = stiffness({})
        for effect in effects(one)[:4]:
            ends = [
                stiffness({p: machine.paths[p].value * (1 + h) for p in effect.names})
                for h in (1e-3, -1e-3)
            ]
            measured = 0.1 * (ends[0] - ends[1]) / 2e-3 / before
            assert effect.shares[0] == pytest.approx(measured, rel=1e-4, abs=1e-8)


def test_a_model_that_its_file_does_not_describe_has_no_section() -> None:
    """Another section than in the file of that name: its numbers would be those of the file."""
    text = HEAD.read_text(encoding="utf-8").replace('"70 mm"', '"71 mm"')
    other = Subject(parse_model(text), str(HEAD), "3-rps", file=HEAD)
    assert first_changes(other) == ((), ())
    nameless = Subject(parse_model(text), "no file", "3-rps")
    assert first_changes(nameless) == ((), ())
    moved = Subject(at_pose(read_model(HEAD), {"z": 0.7}), str(HEAD), "3-rps", file=HEAD)
    assert not np.any(moved.first_changes)
