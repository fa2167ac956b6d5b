from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from strutwork.machines.naming import named_machine
from strutwork.reports.manifest import MANIFEST
from tests.cli.conftest import Program
from tests.model_files import EXAMPLES, SAMPLE, Content, put, sample


def test_report_of_a_model_file(strutwork: Program, tmp_path: Path) -> None:
    folder = tmp_path / "made" / "here"
    found = strutwork("report", EXAMPLES[0], "-o", folder, "--json").result
    assert set(found) == {"report", "data"}
    assert Path(found["report"]).parent == folder
    assert Path(found["report"]).suffix == ".html"
    assert found["data"]
    written = set(folder.iterdir())
    assert written - {folder / MANIFEST} == {Path(found["report"]), *map(Path, found["data"])}


def test_the_installed_program_needs_nothing_of_the_folder_it_runs_in(tmp_path: Path) -> None:
    # a user's own module of the name of one of our folders is no matter, and neither is its absence
    (tmp_path / "kinematics.py").write_text("raise RuntimeError('not ours')\n", encoding="utf-8")
    (tmp_path / "reports.py").write_text("raise RuntimeError('not ours')\n", encoding="utf-8")
    program = Path(sys.executable).with_name("strutwork")
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    for first in ([str(program)], [sys.executable, "-m", "strutwork"]):
        done = subprocess.run(
            [*first, "report", str(EXAMPLES[0]), "-o", "out"],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        assert (tmp_path / "out" / "report.html").is_file()


def test_path_for_people(strutwork: Program, tmp_path: Path) -> None:
    run = strutwork("report", EXAMPLES[0], "-o", tmp_path)
    assert run.status == 0
    assert f"Report: {tmp_path / 'report.html'}" in run.out


@pytest.mark.slow
@pytest.mark.parametrize("name", ["eclipse-3pprs:apparent", "eclipse-machine:7a", "biglide:plane"])
def test_models_of_a_machine_have_reports(
    strutwork: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    found = strutwork("report", name, "--json").result
    page = tmp_path / found["report"]
    assert page.parent == tmp_path / "out" / named_machine(name).stem
    assert named_machine(name).variant.name in page.read_text(encoding="utf-8").partition("<h2")[0]
    assert strutwork("report", page.parent, "--verify").status == 0


def test_nothing_is_written_for_a_wrong_target(
    strutwork: Program, write: Callable[[Content], Path], tmp_path: Path
) -> None:
    folder = tmp_path / "out"
    wrong = write(sample(put("beams.0.section", "q")))
    for target, expected in (("hexapod", "hexapod"), (str(wrong), '"q"')):
        run = strutwork("report", target, "-o", folder, "--json")
        assert (run.status, run.out) == (1, "")
        assert expected in run.err
        assert not folder.exists()


def test_folder_that_is_a_file(
    strutwork: Program, write: Callable[[Content], Path], tmp_path: Path
) -> None:
    blocked = tmp_path / "blocked"
    blocked.write_text("", encoding="utf-8")
    run = strutwork("report", write(SAMPLE), "-o", blocked, "--json")
    assert (run.status, run.out) == (3, "")
    assert "blocked" in run.err
