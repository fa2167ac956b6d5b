"""An installation that cannot be written, and users who cannot write anywhere else either."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

import pytest

from tests.unit.test_package import ROOT

#: A user whom no system knows.
STRANGER = 54321


@contextmanager
def installation(*, writable: bool) -> Iterator[Path]:
    """A copy of all packages and examples without any compiled code, gone afterwards."""
    # beside pytest's own folders, which are for their owner only
    folder = Path(mkdtemp(prefix="strutwork-installation-"))
    try:
        # the copy of the package holds what its links lead to
        for name in ("strutwork", "examples"):
            shutil.copytree(
                ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__")
            )
        _rights(folder, 0o755 if writable else 0o555)
        yield folder
    finally:
        _rights(folder, 0o755)
        shutil.rmtree(folder)


def _rights(folder: Path, mode: int) -> None:
    for place in (folder, *(p for p in folder.rglob("*") if p.is_dir())):
        place.chmod(mode)


def strutwork(
    installed: Path,
    arguments: Sequence[str],
    env: Mapping[str, str],
    *,
    stranger: bool = False,
    largest_file: int | None = None,
) -> subprocess.CompletedProcess[str]:
    """Run the program of an installation in a child process.

    Parameters
    ----------
    env : mapping
        All of its environment besides the paths and the number of threads.
    stranger : bool
        As a user without an entry in the system's list, where we are root: root writes anywhere.
        This user may read everything, since interpreters lie in homes that others cannot enter.
    largest_file : int, optional
        Bytes; a longer file cannot be written, as on a full disk.
    """
    command = [
        sys.executable,
        "-B",
        "-c",
        "from strutwork.reports.cli import main; main()",
        *arguments,
    ]
    if stranger and os.geteuid() == 0:
        setpriv = shutil.which("setpriv")
        if setpriv is None:
            pytest.fail("setpriv is missing, and root writes in every folder: install util-linux")
        identity = [f"--reuid={STRANGER}", f"--regid={STRANGER}", "--clear-groups"]
        reading = ["--inh-caps=+dac_read_search", "--ambient-caps=+dac_read_search"]
        command = [setpriv, *identity, *reading, *command]

    def limit() -> None:
        if largest_file is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))

    return subprocess.run(
        command,
        cwd=installed,
        env={
            "PATH": os.environ["PATH"],
            "PYTHONPATH": str(installed),
            "OMP_NUM_THREADS": "1",
            "OPENBLAS_NUM_THREADS": "1",
            **env,
        },
        preexec_fn=limit,
        capture_output=True,
        text=True,
        check=False,
    )
