"""Every benchmark at its smallest size: it runs, its programs and solvers agree, its table comes.

Nothing here is timed: benchmarks assert ratios at their usual sizes only, in the nightly run.
"""

from __future__ import annotations

import ast
import importlib
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.page import PARTS as ON_THE_PAGE
from benchmarks.page import Part, Result, page, section, versions

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "benchmarks"

#: Run by `solid_speed` on another Python, with arguments of its own; runs all the others.
PARTS = {"slepc_modes", "page"}


def is_program(path: Path) -> bool:
    """Whether a module compares its own name with "__main__"."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return any(
        isinstance(node, ast.Constant) and node.value == "__main__" for node in ast.walk(tree)
    )


PROGRAMS = sorted(p.stem for p in FOLDER.glob("*.py") if is_program(p) and p.stem not in PARTS)


def run(name: str, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    one = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL")}
    path = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
    return subprocess.run(
        [sys.executable, "-m", f"benchmarks.{name}", *arguments],
        cwd=folder,
        env={**os.environ, **one, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


def test_no_benchmark_is_forgotten() -> None:
    """A module called `..._speed` is a benchmark, and a program is called so."""
    named = sorted(p.stem for p in FOLDER.glob("*_speed.py"))
    assert named == PROGRAMS
    assert {"static_speed", "modal_speed", "solid_speed", "tolerance_speed"} <= set(PROGRAMS)
    assert all((FOLDER / f"{part}.py").is_file() for part in PARTS)


#: Those that take longest even so; nightly, where their usual sizes run too.
LONG = {"executor_speed", "growth_speed", "solid_speed", "static_speed", "tolerance_speed"}


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] * (n in LONG)) for n in PROGRAMS]
)
def test_a_benchmark_runs_at_its_smallest_size(name: str, tmp_path: Path) -> None:
    done = run(name, tmp_path, "--smallest")
    assert done.returncode == 0, done.stderr[-3000:]
    rows = re.findall(r"^\|.*\|$", done.stdout, re.MULTILINE)
    assert len(rows) >= 3, done.stdout
    assert not re.search(r"\bnan\b", done.stdout)
    # what a peer writes where it runs stays in a folder of its own
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", PROGRAMS)
def test_figures_of_the_smallest_size_are_never_written(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Refused when the arguments are read: in this process, which has the libraries."""
    pages = {p: p.read_bytes() for p in (ROOT / "docs").glob("performance*.md")}
    program = importlib.import_module(f"benchmarks.{name}")
    monkeypatch.setattr(sys, "argv", [name, "--smallest", "--write"])
    with pytest.raises(SystemExit) as end:
        program.main()
    assert end.value.code == 2
    assert "--smallest is a check; its figures are not written" in capsys.readouterr().err
    assert {p: p.read_bytes() for p in (ROOT / "docs").glob("performance*.md")} == pages


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_nightly_run_times_every_benchmark(name: str) -> None:
    nightly = (ROOT / ".ci" / "nightly").read_text(encoding="utf-8")
    assert re.search(rf"^benchmark {name}\b", nightly, re.MULTILINE)


def test_every_benchmark_is_on_the_page() -> None:
    assert sorted(part.program for part in ON_THE_PAGE) == PROGRAMS
    assert all((ROOT / "docs" / part.page).is_file() for part in ON_THE_PAGE)


PRINTED = """# Performance: ropes

Written by `python -m benchmarks.rope_speed --write`: compare ratios. One thread,
processor time.
Machine: wood, 2 cores.

## Short ropes

| ropes | s |
|---|---|
| 3 | 0.1 |

### Knots

None.
"""
ROPES = Part("rope_speed", "Ropes", "performance-ropes.md", "strings", "Hemp.", ("--poses", "3"))


def test_a_section_has_the_tables_and_no_head_of_its_own() -> None:
    lines = section(Result(ROPES, PRINTED, 2.4, "", ROPES.arguments))
    text = "\n".join(lines)
    assert lines[0] == "## Ropes"
    assert "`python -m benchmarks.rope_speed --poses 3`, 2 s. Compared with strings;" in text
    assert "### Short ropes\n\n| ropes | s |\n|---|---|\n| 3 | 0.1 |\n\n#### Knots" in text
    assert "*What limits it:* Hemp." in text
    assert not re.search("Written by|processor time|wood|failed", text)


def test_a_benchmark_that_fails_is_named_and_keeps_its_tables() -> None:
    whole = page([Result(ROPES, PRINTED, 90.0, "RuntimeError: ropes tear")], 0.5)
    assert "**This run failed: RuntimeError: ropes tear**" in whole
    assert "| 3 | 0.1 |" in whole
    assert "in one run of 2 minutes" in whole
    assert "numpy " in versions()


def test_the_page_takes_the_tables_of_the_programs(tmp_path: Path) -> None:
    before = (ROOT / "docs" / "benchmarks.md").read_bytes()
    done = run("page", tmp_path, "--quick", "--only", "modal_speed")
    assert done.returncode == 0, done.stderr[-3000:]
    assert re.search(r"^\| Strutwork, ten frequencies and shapes \|", done.stdout, re.MULTILINE)
    assert "`python -m benchmarks.modal_speed --smallest`" in done.stdout
    assert done.stderr.startswith("modal_speed: ")
    assert (ROOT / "docs" / "benchmarks.md").read_bytes() == before


@pytest.mark.slow
def test_all_benchmarks_run_for_the_page_at_their_smallest_size(tmp_path: Path) -> None:
    done = run("page", tmp_path, "--quick")
    assert done.returncode == 0, done.stderr[-3000:]
    headings = re.findall(r"^## (.*)$", done.stdout, re.MULTILINE)
    assert headings == [part.title for part in ON_THE_PAGE]


@pytest.mark.parametrize("options", [["--only", "modal_speed"], ["--quick", "--output", "x.md"]])
def test_a_page_of_some_figures_is_not_written(options: list[str], tmp_path: Path) -> None:
    done = run("page", tmp_path, *options)
    assert done.returncode == 2
    assert list(tmp_path.iterdir()) == []
