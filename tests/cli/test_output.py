"""Results that cannot be written: one message, its own exit status, no traceback."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.warm import run_warm

PROGRAM = (sys.executable, "-c", "from strutwork.reports.cli import main; main()")
MODEL = "examples/04_four_bar.toml"
SMALL = "examples/01_cantilever.toml"
ROOT = Path(__file__).parents[2]


def run(
    *arguments: str | Path, out: int = subprocess.PIPE, before: Callable[[], None] | None = None
) -> tuple[int, str]:
    done = subprocess.run(
        [*PROGRAM, *map(str, arguments)],
        stdout=out,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        preexec_fn=before,
        check=False,
    )
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr
    return done.returncode, done.stderr


def run_here(*arguments: str | Path) -> tuple[int, str]:
    """As `run`, where neither the end of the process nor a limit on it is tested."""
    done = run_warm([*map(str, arguments)], ROOT, dict(os.environ), timeout=600)
    assert "Traceback" not in done.stderr
    return done.returncode, done.stderr


@pytest.mark.parametrize("arguments", [("check", MODEL), ("check", MODEL, "--json"), ("--help",)])
def test_a_full_standard_output(arguments: tuple[str, ...]) -> None:
    handle = os.open("/dev/full", os.O_WRONLY)
    status, said = run(*arguments, out=handle)
    os.close(handle)
    assert status == 3
    assert said.startswith("Error: standard output: cannot be written (No space left on device).")


def test_a_closed_standard_output() -> None:
    status, said = run("check", MODEL, before=lambda: os.close(1))
    assert status == 3
    assert said.startswith("Error: standard output: is closed.")


@pytest.mark.parametrize("arguments", [("check", MODEL), ("check", MODEL, "--json"), ("--help",)])
def test_a_reader_that_went_away(arguments: tuple[str, ...]) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    status, said = run(*arguments, out=writing)
    os.close(writing)
    assert status == 141
    assert said == ""


def _small_files() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))


@pytest.mark.parametrize(
    "arguments",
    [
        ("map", "proposed-3pprs", "--lattice", "1"),
        ("tolerance", "mit-ss1", "--samples", "100"),
        ("modes", "examples/03_tripod.toml", "-n", "2"),
        # what these write goes through the same two functions
        pytest.param(("scale", "mit-ss1", "--lengths", "2"), marks=pytest.mark.slow),
        pytest.param(("report", MODEL), marks=pytest.mark.slow),
    ],
    ids=["map", "tolerance", "modes", "scale", "report"],
)
def test_a_full_disk(tmp_path: Path, arguments: tuple[str, ...]) -> None:
    # once without the limit, which also fills the caches
    assert run_here(*arguments, "-o", tmp_path / "good")[0] == 0
    assert any((tmp_path / "good").iterdir())
    status, said = run(*arguments, "-o", tmp_path / "full", before=_small_files)
    assert status == 3
    assert "cannot be written (File too large)" in said
    assert not [p for p in tmp_path.rglob("*") if p.is_file() and p.parent.name != "good"]


@pytest.mark.parametrize("out", [pytest.param("/dev/full", marks=pytest.mark.slow), MODEL])
def test_an_output_that_is_no_folder(out: str) -> None:
    for command in (("tolerance", "mit-ss1", "--samples", "100"), ("report", SMALL)):
        status, said = run_here(*command, "-o", out)
        assert status == 3
        assert out in said


def test_a_report_is_verified(tmp_path: Path) -> None:
    assert run_here("report", SMALL, "-o", tmp_path / "r")[0] == 0
    assert run_here("report", tmp_path / "r", "--verify")[0] == 0
    (tmp_path / "r" / "check.json").write_text("{}")
    status, said = run_here("report", tmp_path / "r", "--verify")
    assert status == 1
    assert "check.json" in said
