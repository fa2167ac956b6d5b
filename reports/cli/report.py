"""`strutwork report`: the report of a machine, a comparison or a model file."""

from __future__ import annotations

from pathlib import Path

from strutwork.machines.naming import MARK
from strutwork.machines.process_file import read_process
from strutwork.names import visible
from strutwork.reports.build import write_report
from strutwork.reports.cli.output import console, print_json, tell
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import HOME, Where
from strutwork.reports.manifest import verify_report


def run(
    target: str,
    out: str | None,
    json: bool,
    at: Where = HOME,
    *,
    pdf: bool = False,
    fresh: bool = False,
    errors: str | None = None,
    process: str | None = None,
) -> None:
    """Write the report and say where it lies."""
    folder = Path(out) if out is not None else Path("out") / Path(target).stem.replace(MARK, "-")
    cut = None if process is None else read_process(process)
    with shown("steps") as started:
        put = None if at.home else at.put
        beside = None if errors is None else Path(errors)
        written = write_report(
            target, folder, started, put, pdf=pdf, fresh=fresh, errors=beside, process=cut
        )
    if json:
        printed_as = {} if written.pdf is None else {"pdf": str(written.pdf)}
        data = [str(p) for p in written.data]
        print_json({"report": str(written.report), "data": data, **printed_as})
        return
    printed = console()
    printed.print(f"Report: {visible(str(written.report))}", markup=False, soft_wrap=True)
    if written.pdf is not None:
        printed.print(f"Printed: {visible(str(written.pdf))}", markup=False, soft_wrap=True)
    printed.print(f"Data files beside it: {len(written.data)}", markup=False)


def run_all(out: str | None, json: bool, *, fresh: bool = False) -> None:
    """Write every report and the page that compares the machines."""
    from strutwork.reports.every_machine import write_every_report

    folder = Path("out") / "all" if out is None else Path(out)
    written = []
    with shown("steps") as started:
        for report in write_every_report(folder, started, fresh=fresh):
            written.append(str(report.report))
            tell(f"Written: {visible(written[-1])}")
    if json:
        print_json({"report": written[-1], "reports": written[:-1]})
        return
    printed = console()
    printed.print(f"Report: {visible(written[-1])}", markup=False, soft_wrap=True)
    printed.print(f"Reports of machines and documents: {len(written) - 1}", markup=False)


def verify(folder: str, json: bool) -> None:
    """Compare a report with its manifest and say that it is whole."""
    found = verify_report(Path(folder))
    if json:
        print_json({"report": folder, "files": len(found.files), "whole": True})
        return
    whole = f"Complete: {visible(folder)}, {len(found.files)} files"
    console().print(whole, markup=False, soft_wrap=True)
