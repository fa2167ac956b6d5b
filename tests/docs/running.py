"""Running what a page shows, its commands and its Python, and holding the page to the output."""

from __future__ import annotations

import contextlib
import doctest
import io
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from tests.warm import run_warm


def matches(wanted: str, got: str) -> bool:
    """Whether the page shows what came, `...` standing for anything."""
    flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    return doctest.OutputChecker().check_output(wanted, got, flags)


def steps(console: str) -> list[tuple[str, str]]:
    """The commands of a console block, and what each prints."""
    return re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", console, re.MULTILINE)


def run_line(line: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run one command line of a page, as a reader with a terminal of 100 characters does."""
    program, *arguments = shlex.split(line)
    environment = {**os.environ, "COLUMNS": "100", "NO_COLOR": "1"}
    if program == "strutwork":
        return run_warm(arguments, folder, environment, timeout=600)
    return subprocess.run(
        [{"python": sys.executable}[program], *arguments],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


def hold_console(console: str, folder: Path, where: object) -> None:
    """Run the commands of a console block, and hold the block to what they print."""
    found = steps(console)
    assert found, f"{where}: a console block starts with a prompt"
    for line, wanted in found:
        run = run_line(line, folder)
        assert run.returncode == 0, f"{where}: {line}\n{run.stderr}"
        if wanted.strip():
            assert matches(wanted, run.stdout), f"{where} says\n{wanted}but got\n{run.stdout}"


def run_python(text: str, page: Path, line: int, names: dict[str, object]) -> str:
    """Run a Python block of a page in the session `names`; what it prints."""
    output = io.StringIO()
    # so that a traceback names the line of the page
    source = "\n" * (line - 1) + text
    with contextlib.redirect_stdout(output):
        exec(compile(source, str(page), "exec"), names)  # noqa: S102 - our own pages
    return output.getvalue()
