"""`strutwork report`: the report of a machine, a comparison or a model file."""

from __future__ import annotations

from pathlib import Path

from strutwork.names import visible
from strutwork.reports.build import write_report
from strutwork.reports.cli.output import console, print_json
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import HOME, Where
from strutwork.reports.manifest import verify_report


def run(target: str, out: str | None, json: bool, at: Where = HOME) -> None:
    """Write the report and say where it lies."""
    folder = Path(out) if out is not None else Path("out") / Path(target).stem
    with shown("steps") as started:
        written = write_report(target, folder, started, None if at.home else at.put)
    if json:
        print_json({"report": str(written.report), "data": [str(p) for p in written.data]})
        return
    printed = console()
    printed.print(f"Report: {visible(str(written.report))}", markup=False, soft_wrap=True)
    printed.print(f"Data files beside it: {len(written.data)}", markup=False)


def verify(folder: str, json: bool) -> None:
    """Compare a report with its manifest and say that it is whole."""
    found = verify_report(Path(folder))
    if json:
        print_json({"report": folder, "files": len(found.files), "whole": True})
        return
    whole = f"Whole: {visible(folder)}, {len(found.files)} files"
    console().print(whole, markup=False, soft_wrap=True)
