"""The site of the documentation, built once for all processes of a test run."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.sharing import once

ROOT = Path(__file__).parents[2]


def built_site(folder: Path) -> tuple[Path, int, str]:
    """Folder of the built site, and the status and errors of its build.

    Every warning of Sphinx is an error, as in `scripts/docs`.
    """
    site = folder / "site"

    def build() -> tuple[int, str]:
        options = ("-W", "-n", "--keep-going", "-q", "-j", "2", "-d", folder / "doctrees")
        run = subprocess.run(
            [sys.executable, "-m", "sphinx", *options, ROOT / "docs", site],
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
        return run.returncode, run.stderr

    return site, *once("site", folder, build)
