"""A small command reads only what it needs: its start is most of its time."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]

PROGRAM = """
import sys
from strutwork.reports.cli import main
sys.argv = ["strutwork", "check", "examples/machines/6-ups.toml"]
try:
    main()
except SystemExit as end:
    assert not end.code
print(*sorted(sys.modules), sep="\\n")
"""

#: Libraries and parts of the package that a check of a model file has no use for.
NEEDLESS = {
    "numba",
    "pandas",
    "pint",
    "plotly",
    "pyvista",
    "scipy.optimize",
    "scipy.spatial",
    "scipy.special",
    "sfepy",
    "strutwork.fea",
    "strutwork.machines.catalogue",
    "strutwork.studies",
    "xarray",
}


def test_a_check_reads_no_more_than_it_needs() -> None:
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert "has 6 freedoms" in run.stdout
    assert NEEDLESS & set(run.stdout.splitlines()) == set()
