"""The site of the documentation, built once for all processes of a test run, and a browser."""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.reports.browser import Browser, chromium

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the built site; every warning of Sphinx is a failure, as in `scripts/docs`."""
    base = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        # what the workers have in common
        base = base.parent
    folder = base / "site"
    with (base / "site.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (base / "site.log").exists():
            options = ("-W", "-n", "--keep-going", "-q", "-j", "2", "-d", base / "doctrees")
            run = subprocess.run(
                [sys.executable, "-m", "sphinx", *options, ROOT / "docs", folder],
                cwd=ROOT,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                timeout=600,
                check=False,
            )
            (base / "site.log").write_text(f"{run.returncode}\n{run.stderr}", encoding="utf-8")
    status, _, said = (base / "site.log").read_text(encoding="utf-8").partition("\n")
    assert (status, said) == ("0", ""), said
    return folder


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with chromium() as opened:
        yield opened
