"""`strutwork design`: parameters that are best in several objectives."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.errors import OutputError
from strutwork.names import visible
from strutwork.reports.cli.manner import MANNER
from strutwork.reports.cli.output import console, print_json, table, tell
from strutwork.reports.cli.progress import shown
from strutwork.reports.design_words import (
    comparison,
    extremes,
    on_front,
    rounds_words,
    starts_words,
    unit_of,
)
from strutwork.reports.study_words import title_of
from strutwork.studies.design import Design
from strutwork.studies.design_file import read_design
from strutwork.studies.design_pick import write_machine
from strutwork.studies.design_search import pymoo
from strutwork.studies.design_store import parts_of, read_design_result, run_design
from strutwork.studies.design_table import design_parameters, design_quantities, reasons_of
from strutwork.studies.design_terms import GRADIENT
from strutwork.studies.finished_parts import any_finished

#: Machines of the front that a terminal shows.
ROWS = 12


def run(
    file: str,
    out: str | None,
    report: str | None = None,
    *,
    resume: bool,
    workers: int | None,
    json: bool,
) -> None:
    """Search, and print the front."""
    # before any work
    pymoo("core.problem")
    design = read_design(file)
    along = design.search.method == GRADIENT
    with shown("starts" if along else "machines") as started:
        progress = started(f"design of {visible(design.machine.source or design.machine.title)}")
        found = _searched(
            design,
            out,
            resume=resume,
            workers=workers,
            progress=progress,
            told=_told(design) if MANNER.whole else None,
        )
    result = _result(file, found)
    if out is not None:
        result["data"] = [out, str(Path(out).with_suffix(".csv"))]
    if report is not None:
        from strutwork.reports.design_page import write_design_report

        result["report"] = str(write_design_report(found, Path(report)).report)
    if json:
        print_json(result)
    else:
        _print(found, result)


def pick(file: str, number: int, out: str, *, json: bool) -> None:
    """Write a machine of the front as a model file."""
    written = write_machine(read_design_result(file), number, out)
    if json:
        print_json({"design": file, "machine": number, "data": [str(written)]})
    else:
        console().print(f"Written: {visible(str(written))}", markup=False, soft_wrap=True)


def _told(design: Design) -> Any:
    total = design.search.rounds
    word = "start" if design.search.method == GRADIENT else "generation"

    def say(number: int, feasible: int, front: int) -> None:
        words = f"{feasible} feasible so far, {front} on the front"
        tell(f"{word} {number} of {total}: {words}")

    return say


def _searched(design: Design, out: str | None, **options: Any) -> xr.Dataset:
    try:
        return run_design(design, out, **options)
    except (KeyboardInterrupt, SystemExit, OutputError):
        if out is not None and any_finished(parts_of(design, Path(out))):
            tell(f"Finished generations are kept beside {out}: give --resume to go on.")
        raise


def _result(file: str, found: xr.Dataset) -> dict[str, Any]:
    columns = [*design_parameters(found), *design_quantities(found)]
    front = found["front"].to_numpy()
    return {
        "design": file,
        "title": str(found.attrs["title"]),
        "machines": int(found.sizes["machine"]),
        "feasible": int(np.count_nonzero(found["status"].to_numpy() == 0)),
        "dropped_by_reason": reasons_of(found),
        "units": {c.name: c.unit for c in columns},
        "stated": {c.name: float(found[c.name].attrs["stated"]) for c in columns},
        "front": [{c.name: float(c.values[i]) for c in columns} for i in front],
        "method": str(found.attrs.get("method", "")),
        "design_key": str(found.attrs["design_key"]),
        "data": [],
    }


def _print(found: xr.Dataset, result: dict[str, Any]) -> None:
    out = console()
    out.print(visible(result["title"][0].upper() + result["title"][1:]), markup=False, style="bold")
    out.print(f"{rounds_words(found)}; {result['feasible']} feasible", markup=False, soft_wrap=True)
    for reason, count in result["dropped_by_reason"].items():
        out.print(f"  {count}: {visible(reason)}", markup=False, soft_wrap=True)
    if starts_words(found):
        out.print(visible(starts_words(found)), markup=False, soft_wrap=True)
    columns = [*design_quantities(found), *design_parameters(found)]
    units = [unit_of(c, found) for c in columns]
    values = [on_front(c, found).values for c in columns]
    count = len(result["front"])
    # both ends of the front and machines between them
    shown_rows = np.unique(np.linspace(0, count - 1, min(ROWS, count)).round().astype(int)).tolist()
    rows = [
        (i + 1, *(float(v[i] * f) for v, (_, f) in zip(values, units, strict=True)))
        for i in shown_rows
    ]
    heads = [
        f"{title_of(c)}, {u}" if u else title_of(c)
        for c, (u, _) in zip(columns, units, strict=True)
    ]
    title = "Front" if count <= ROWS else f"Front, {len(rows)} of {count} machines"
    out.print(table(title, ["", *heads], rows, names=0))
    for path in result["data"]:
        out.print(visible(path), markup=False, soft_wrap=True)
    if "report" in result:
        out.print(f"Report: {visible(result['report'])}", markup=False, soft_wrap=True)
    for title, value, which in extremes(found):
        out.print(f"{title}: {value}, {visible(which)}.", markup=False, soft_wrap=True)
    out.print(visible("".join(comparison(found))), markup=False, soft_wrap=True)
