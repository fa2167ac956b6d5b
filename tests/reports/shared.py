"""Reports written once for all processes of a test run; the longest before the run begins."""

from __future__ import annotations

import os
from pathlib import Path

from strutwork.reports.build import WrittenReport, write_report
from tests.sharing import FOLDER, once


def shared_report(name: str, target: str, folder: Path) -> WrittenReport:
    """The report of a target, written by whoever asks first."""
    return once(name, folder, lambda: write_report(target, folder / f"report-{name}"))


if __name__ == "__main__":
    shared_report("comparison", "azulay-2014", Path(os.environ[FOLDER]))
    shared_report("planar", "mit-ss1", Path(os.environ[FOLDER]))
