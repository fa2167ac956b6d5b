"""Commands in processes that start warm: one process reads the libraries, each command is its fork.

A command of its own has its own folder, environment and exit status, as from a terminal, without
the second or two in which it would read NumPy, SciPy and the package again.
"""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import tempfile
from multiprocessing.context import ForkServerContext
from pathlib import Path

from strutwork.reports.cli import main

#: What commands read late; the program itself comes with them.
LIBRARIES = [
    "tests.warm",
    "strutwork.reports.cli",
    "strutwork.studies",
    "strutwork.reports.build",
    "scipy.sparse.linalg",
    "scipy.optimize",
    "scipy.interpolate",
    "xarray",
    "pandas",
    "numba",
    "rich.progress",
    "rich.table",
]


def _context() -> ForkServerContext:
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(LIBRARIES)
    return context


def _command(
    arguments: list[str], folder: str, environment: dict[str, str], out: str, error: str
) -> None:
    for path, stream in ((os.devnull, 0), (out, 1), (error, 2)):
        handle = os.open(path, os.O_RDWR)
        os.dup2(handle, stream)
        os.close(handle)
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(folder)
    sys.argv = ["strutwork", *arguments]
    main()


def run_warm(
    arguments: list[str], folder: Path, environment: dict[str, str], timeout: float
) -> subprocess.CompletedProcess[str]:
    """Run the program with `arguments` in `folder`; what it left.

    Parameters
    ----------
    timeout : float
        s, after which it is killed.

    Raises
    ------
    subprocess.TimeoutExpired
        It took longer.
    """
    with tempfile.TemporaryDirectory() as kept:
        out, error = Path(kept, "out"), Path(kept, "error")
        out.touch()
        error.touch()
        process = _context().Process(
            target=_command,
            args=(arguments, str(folder), environment, str(out), str(error)),
        )
        process.start()
        process.join(timeout)
        if process.exitcode is None:
            process.kill()
            process.join()
            raise subprocess.TimeoutExpired(arguments, timeout)
        return subprocess.CompletedProcess(
            arguments, process.exitcode, out.read_text("utf-8"), error.read_text("utf-8")
        )
