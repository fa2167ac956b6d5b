"""A small command reads only what it needs: its start is most of its time."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

PROGRAM = """
import sys
from strutwork.reports.cli import main
sys.argv = ["strutwork", "check", FILE]
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
    # any part of SciPy reads the test frameworks of NumPy and Python with it
    "scipy",
    "sfepy",
    "strutwork.fea",
    "strutwork.kinematics.jacobians",
    "strutwork.machines.catalogue",
    "strutwork.msa.solve",
    "strutwork.overconstraint.responses",
    "strutwork.reports.cli.workspace_command",
    "strutwork.studies",
    "threadpoolctl",
    "xarray",
}

#: Descriptions of tables that few files have: one of them needs all.
RARE = {
    "strutwork.machines.model_bearing_schema",
    "strutwork.machines.model_flexure_schema",
    "strutwork.machines.model_process_schema",
    "strutwork.machines.model_servo_schema",
    "strutwork.machines.model_solid_schema",
}
WITH_RARE = "examples/machines/3-rps.toml"


#: Two that move, one that has no tool, and what each of them is told.
FILES = {
    "examples/machines/6-ups.toml": "has 6 freedoms",
    "examples/machines/3-rps.toml": "has 3 freedoms",
    "examples/03_tripod.toml": "degrees of freedom of the flexible structure",
}


@pytest.mark.parametrize("file", FILES)
def test_a_check_reads_no_more_than_it_needs(file: str) -> None:
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM.replace("FILE", repr(file))],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert FILES[file] in run.stdout
    needless = NEEDLESS if file == WITH_RARE else NEEDLESS | RARE
    assert needless & set(run.stdout.splitlines()) == set()


def test_the_import_of_the_package_reads_no_numpy() -> None:
    program = "import sys, strutwork; print('numpy' in sys.modules, strutwork.Outcome.__name__)"
    run = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert run.stdout.split() == ["False", "Outcome"]


def test_help_of_a_command_makes_no_other() -> None:
    program = """
import sys
from strutwork.reports.cli import main
sys.argv = ["strutwork", "check", "--help"]
try:
    main()
except SystemExit:
    pass
print(*(name for name in sys.modules if name.endswith("_command")))
"""
    run = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert "--pose" in run.stdout
    assert run.stdout.splitlines()[-1] == ""
