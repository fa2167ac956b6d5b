"""The error sheet in a report: its numbers are those of the study, its files are named."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.load import load
from strutwork.reports.chapters import accuracy
from strutwork.reports.chapters.error_heat import heat_blocks
from strutwork.reports.chapters.error_sheet import error_blocks
from strutwork.reports.content import Details, Figure, Row, Table
from strutwork.reports.numbers import significant
from strutwork.reports.subject import Subject
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_file import read_errors

EXAMPLES = Path(__file__).parents[2] / "examples"
ERRORS = EXAMPLES / "errors" / "gantry.toml"


@pytest.fixture(scope="module")
def gantry() -> Subject:
    grid = TaskGrid({"x": np.array([-0.1, 0.0, 0.1]), "y": np.array([-0.3, 0.0])})
    model = replace(load(str(EXAMPLES / "machines" / "gantry.toml")), workspace=grid)
    return Subject(model, "gantry", "gantry", errors=ERRORS)


def test_the_sheet_has_its_numbers_and_files(gantry: Subject) -> None:
    blocks, files = error_blocks(gantry)
    sheet = error_sheet(gantry.model, read_errors(ERRORS, gantry.model))
    tables = [b for b in blocks if isinstance(b, Table)]
    first = tables[0]
    assert [str(row[0]) for row in first.rows] == [*sheet.causes, "all causes"]
    assert [str(v) for v in first.rows[-1][1:4]] == [
        significant(1e6 * float(v)) for v in sheet.worst[:3]
    ]
    (parts,) = [t for b in blocks if isinstance(b, Details) for t in b.items]
    assert isinstance(parts, Table)
    assert len(parts.rows) == len(sheet.rows)
    assert [t.caption for t in tables[1:]] == [f"Errors along {d}, as in ISO 230-1" for d in "xy"]
    names = {f.name for f in files}
    figures = [b for b in blocks if isinstance(b, Figure)]
    figures += [f for b in blocks if isinstance(b, Row) for f in b.figures]
    assert {f.key for f in figures} == {"error-causes", "error-drift", "error-ground", "error-map"}
    # every figure and table names the file of its numbers
    assert {f.data for f in (*figures, *tables)} <= names


def test_without_a_file_the_chapter_is_as_before(gantry: Subject) -> None:
    blocks, files = error_blocks(replace(gantry, errors=None))
    assert (blocks, files) == ([], ())
    bare = replace(gantry.model, tolerances=(), drives=())
    assert accuracy.missing(replace(gantry, model=bare, errors=None))
    assert not accuracy.missing(replace(gantry, model=bare))


def test_uneven_temperatures_of_solids_are_drawn_with_their_file(gantry: Subject) -> None:
    inputs = read_errors(EXAMPLES / "errors" / "gantry-warm-bed.toml", gantry.model)
    (figure,), (file,) = heat_blocks(gantry.model, inputs)
    assert isinstance(figure, Figure)
    assert figure.data == file.name
    (bed,) = gantry.model.solids
    ((heat,),) = (t.solids for t in inputs.temperatures)
    (trace,) = figure.spec["data"]
    assert len(trace["x"]) == len(bed.points) == len(heat.surface)
    # the bottom keeps its temperature, the front is the coldest
    bottom = np.isclose(bed.points[:, 2], -0.2)
    np.testing.assert_allclose(heat.surface[bottom], 0.0, atol=1e-12)
    assert np.isclose(bed.points[heat.surface.argmin(), 1], -0.45)
    uniform = replace(inputs.temperatures[0], solids=())
    assert heat_blocks(gantry.model, replace(inputs, temperatures=(uniform,))) == ([], [])
