"""Every benchmark at its smallest size: it runs, its programs and solvers agree, its table comes.

Nothing here is timed: benchmarks assert ratios at their usual sizes only, in the nightly run.
"""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "benchmarks"

#: Run by `solid_speed` on another Python, with arguments of its own.
PARTS = {"slepc_modes"}


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
LONG = {"executor_speed", "solid_speed", "static_speed", "tolerance_speed"}


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
def test_figures_of_the_smallest_size_are_never_written(name: str, tmp_path: Path) -> None:
    pages = {p: p.read_bytes() for p in (ROOT / "docs").glob("performance*.md")}
    done = run(name, tmp_path, "--smallest", "--write")
    assert done.returncode != 0
    assert "--smallest is a check; its figures are not written" in done.stderr
    assert {p: p.read_bytes() for p in (ROOT / "docs").glob("performance*.md")} == pages


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_nightly_run_times_every_benchmark(name: str) -> None:
    nightly = (ROOT / ".ci" / "nightly").read_text(encoding="utf-8")
    assert re.search(rf"^benchmark {name}\b", nightly, re.MULTILINE)
