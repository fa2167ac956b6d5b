"""Threads of the BLAS: one for the program's stacks of small matrices, unless asked otherwise."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

PROGRAM = """
import sys
from strutwork.reports.cli import main
sys.argv = ["strutwork", "check", sys.argv[1]]
try:
    main()
except SystemExit:
    pass
from threadpoolctl import threadpool_info
found = {p["num_threads"] for p in threadpool_info() if p["internal_api"] == "openblas"}
sys.stderr.write(f"threads {sorted(found)}")
"""


@pytest.mark.parametrize(("asked", "found"), [(None, 1), ("2", 2)])
def test_one_thread_unless_the_environment_says_how_many(asked: str | None, found: int) -> None:
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    environment = {k: v for k, v in os.environ.items() if k not in names}
    if asked is not None:
        environment["OMP_NUM_THREADS"] = asked
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM, "examples/01_cantilever.toml"],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    # there are never more of them than processors
    assert run.stderr.endswith(f"threads [{min(found, len(os.sched_getaffinity(0)))}]")
