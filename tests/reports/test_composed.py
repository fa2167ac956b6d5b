"""The report of any machine: chapters that apply, and a cover that answers first."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.machines.model_file import parse_model
from strutwork.reports.build import WrittenReport, write_report
from strutwork.reports.composed import CHAPTERS, chapters_of, cover
from strutwork.reports.content import Answers, Table
from strutwork.reports.subject import Subject
from tests.model_files import EXAMPLES

MACHINE = Path(__file__).parents[2] / "examples/machines/3-rps.toml"


SERVOS = """
[[servos]]
joints = ["drive1", "drive2", "drive3"]
direction = "z"
position_gain = "40 1/s"
motor_velocity_gain = "0.5 N*m*s/rad"
integral_time = "15 ms"
pitch = "10 mm"
motor_inertia = "10 kg*cm^2"
"""


@pytest.fixture(scope="module")
def small() -> str:
    """The machine with few poses to look at, and controllers."""
    return (
        MACHINE.read_text()
        .replace("points = 7", "points = 3")
        .replace("points = 3 }", "points = 2 }", 1)
        + SERVOS
    )


@pytest.fixture(scope="module")
def written(small: str, tmp_path_factory: pytest.TempPathFactory) -> WrittenReport:
    folder = tmp_path_factory.mktemp("composed")
    file = folder / "head.toml"
    file.write_text(small)
    return write_report(str(file), folder / "report")


def keys_of(page: Path) -> list[str]:
    return re.findall(r'<li><a href="#([^"]+)">', page.read_text(encoding="utf-8"))


def test_a_machine_with_a_workspace_has_every_chapter(written: WrittenReport) -> None:
    wanted = ["summary", *(one.key for one in CHAPTERS), "files"]
    assert keys_of(written.report) == wanted


def test_every_chapter_is_a_question() -> None:
    assert all(one.title.endswith("?") for one in CHAPTERS)
    assert len({one.key for one in CHAPTERS}) == len(CHAPTERS)


def test_the_cover_links_to_chapters_of_the_page(written: WrittenReport) -> None:
    text = written.report.read_text(encoding="utf-8")
    links = re.findall(r'<a href="#([^"]+)"><strong>', text)
    assert {"tool", "budget", "workspace-stiffness", "vibration", "tolerances"} <= set(links)
    assert set(links) <= set(keys_of(written.report))


def test_the_files_hold_what_the_page_says(written: WrittenReport, small: str) -> None:
    files = {path.name: path for path in written.data}
    found = xr.open_dataset(files["stiffness-survey.nc"], engine="h5netcdf")
    with files["stiffness-survey.csv"].open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == found.attrs["poses"] == found["status"].size
    column = np.array([float(r["stiffness_free x, N/m"] or "nan") for r in rows])
    values = found["stiffness_free"].sel(direction="x").to_numpy().ravel()
    np.testing.assert_array_equal(column, values)
    # the softest pose of the cover is the least of the file
    subject = Subject(parse_model(small), "head.toml", "head")
    answers = next(b for b in cover(subject).blocks if isinstance(b, Answers))
    softest = next(a for a in answers.items if a.before.startswith("In its workspace"))
    numbers = [float(n) for n in re.findall(r"[\d.]+", softest.number)]
    assert answers.items[0].sentence.endswith("with the other directions free to follow.")
    assert len(answers.items) <= 8
    least = np.nanmin(found["stiffness_free"].sel(direction=["x", "y", "z"]).to_numpy())
    assert min(numbers) == pytest.approx(least / 1e6, rel=5e-3)


def test_a_structure_without_workspace_says_what_is_missing(tmp_path: Path) -> None:
    page = write_report(str(EXAMPLES[0]), tmp_path / "report").report
    keys = keys_of(page)
    assert "absent" in keys
    assert not {"motion", "workspace-stiffness", "accuracy"} & set(keys)
    text = page.read_text(encoding="utf-8")
    assert "How stiff is it over the workspace? The file names no poses to look at" in text


def test_a_limit_out_of_which_poses_fall_is_named(small: str) -> None:
    text = small.replace('["520 mm", "720 mm"]', '["540 mm", "640 mm"]')
    subject = Subject(parse_model(text), "head.toml", "head")
    chapters, _ = chapters_of(subject, [c for c in CHAPTERS if c.key == "workspace-stiffness"])
    tables = [b for b in chapters[0].blocks if isinstance(b, Table)]
    lost = next(t for t in tables if t.caption == "Poses that the machine cannot reach")
    assert any("drive1: z of the prismatic joint, 540 to 640 mm" in str(r[0]) for r in lost.rows)
