"""Reports written once for all processes of a test run; the longest before the run begins."""

from __future__ import annotations

import fcntl
import os
import pickle
from pathlib import Path

from strutwork.reports.build import WrittenReport, write_report

#: Variable that names the folder in which they lie.
FOLDER = "STRUTWORK_TEST_REPORTS"


def shared_report(name: str, target: str, folder: Path) -> WrittenReport:
    """The report of a target, written by whoever asks first."""
    found = folder / f"{name}.pickle"
    with (folder / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not found.exists():
            written = write_report(target, folder / f"report-{name}")
            found.write_bytes(pickle.dumps(written))
    return pickle.loads(found.read_bytes())  # type: ignore[no-any-return]  # noqa: S301 - our own


if __name__ == "__main__":
    shared_report("comparison", "azulay-2014", Path(os.environ[FOLDER]))
