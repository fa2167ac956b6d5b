"""Long work is told on standard error, ended by Ctrl-C, and never ends in a traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from strutwork.errors import NumericalError
from strutwork.memory import out_of_memory, require_dense
from strutwork.stages import Stage, current, stage
from tests.cli.conftest import Program
from tests.model_files import EXAMPLES

#: A command whose work never ends: in Python, or in compiled code that Python cannot end.
ENDLESS = """
import sys, time
import numpy as np
import strutwork.reports.cli.watch as watch
from strutwork.reports.cli import app as program
from strutwork.stages import stage

watch.PATIENCE, watch.INTERVAL, watch.GRACE = 0.2, 0.2, 0.2

def work(file, json):
    with stage("waits for nothing", 7.0):
        sys.stdout.write("begun\\n")
        sys.stdout.flush()
        {wait}

import strutwork.reports.cli.check
strutwork.reports.cli.check.run = work
sys.argv = ["strutwork", "check", "mit-ss1"]
program.main()
"""

WAITS = {
    "python": "time.sleep(600)",
    "compiled": "np.linalg.svd(np.random.default_rng(0).normal(size=(4000, 4000)))",
}


def endless(wait: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", ENDLESS.format(wait=WAITS[wait])],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
        # tests in the background of a shell inherit a signal that is ignored
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509
    )


@pytest.mark.skipif(os.name != "posix", reason="signals are sent as POSIX has them")
@pytest.mark.parametrize("wait", WAITS)
def test_ctrl_c_ends_any_work_with_one_line_and_130(wait: str) -> None:
    process = endless(wait)
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "begun\n"
        # the compiled code has the time to begin
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 130
    assert err.splitlines()[-1] == "Interrupted: no file is left half written."
    assert "Traceback" not in err
    assert "Waits for nothing" in err
    assert "of about 7 s" in err


def test_the_innermost_work_is_told() -> None:
    assert current() is None
    with stage("outer"):
        with stage("inner", 60.0):
            found = current()
            assert found is not None
            assert found.line(found.begun + 3.0) == "inner, 3 s so far of about 60 s"
        found = current()
        assert found is not None
        assert found.what == "outer"
    assert current() is None


def test_work_without_a_name_tells_its_time() -> None:
    at = Stage("")
    assert at.line(at.begun + 2.4) == "works, 2 s so far"


def test_memory_that_runs_out_is_an_error(
    strutwork: Program, monkeypatch: pytest.MonkeyPatch
) -> None:
    def work(*_: object) -> None:
        raise MemoryError("Unable to allocate 29.3 GiB")

    monkeypatch.setattr("strutwork.reports.cli.check.run", work)
    run = strutwork("check", EXAMPLES[0])
    assert run.status == 1
    assert run.err == f"Error: {out_of_memory(MemoryError('Unable to allocate 29.3 GiB'))}\n"
    assert "Divide beams" in run.err


def test_dense_work_is_refused_before_it_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    require_dense("structure", "matrices", 1e6, "Less.")
    with pytest.raises(NumericalError, match=r"about 5 GB; 3 GB are the limit"):
        require_dense("structure", "matrices", 5e9, "Less.")
    monkeypatch.setattr("strutwork.memory.available_memory", lambda: 1e5)
    with pytest.raises(NumericalError, match=r"about 0.001 GB; 0.0001 GB are available"):
        require_dense("structure", "matrices", 1e6, "Less.")


def test_a_program_without_the_signal_is_left_alone(strutwork: Program) -> None:
    mine = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assert strutwork("check", EXAMPLES[0]).status == 0
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        assert strutwork("check", EXAMPLES[0]).status == 0
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, mine)
