"""Reports written once for all processes of a test run."""

from __future__ import annotations

from pathlib import Path

from strutwork.reports.build import WrittenReport, write_report
from tests.sharing import once


def shared_report(name: str, target: str, folder: Path) -> WrittenReport:
    """The report of a target, written by whoever asks first."""
    return once(name, folder, lambda: write_report(target, folder / f"report-{name}"))
