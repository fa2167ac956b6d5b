"""`strutwork study`: numbers of a machine are varied, and each machine is asked."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.errors import OutputError
from strutwork.names import visible
from strutwork.reports.cli.manner import MANNER
from strutwork.reports.cli.output import console, print_json, table, tell
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.study_tables import analysis, print_analysis
from strutwork.reports.numbers import count as counted
from strutwork.reports.study_words import gap_words, machine_words, read_value, reading, title_of
from strutwork.studies.finished_parts import any_finished
from strutwork.studies.parametric import Parametric
from strutwork.studies.study import Study
from strutwork.studies.study_file import read_study
from strutwork.studies.study_store import parts_of, run_to_file
from strutwork.studies.study_table import (
    NumberColumn,
    answer_columns,
    leading,
    parameter_columns,
)
from strutwork.studies.travel_answer import TRAVELLED

#: Labels of directions and modes that a short answer shows.
_SHORT = ("x", "y", "z", "1", "")


def list_paths(target: str, *, json: bool) -> None:
    """Print every number that a study can vary."""
    machine = Parametric.of(target)
    if json:
        print_json(
            {
                "machine": target,
                "paths": {
                    path: {"value": n.value, "unit": n.unit, "meaning": n.meaning}
                    for path, n in machine.paths.items()
                },
            }
        )
        return
    rows = [(n.path, n.meaning, n.unit, float(n.value)) for n in machine.paths.values()]
    out = console()
    out.print(visible(machine.title), markup=False, style="bold")
    out.print(table("Numbers", ["path", "meaning", "unit", "value, SI"], rows, names=3))


def run(
    file: str,
    out: str | None,
    report: str | None = None,
    *,
    resume: bool,
    workers: int | None,
    json: bool,
) -> None:
    """Run a study and print how its answers follow its parameters."""
    study = read_study(file)
    with shown("machines") as started:
        progress = started(f"study of {visible(study.machine.source or study.machine.title)}")
        if out is None:
            found = study.run(workers=workers, progress=progress)
        else:
            found = _to_file(study, out, resume=resume, workers=workers, progress=progress)
    result = _result(file, study, found)
    if out is not None:
        result["data"] = [out, str(Path(out).with_suffix(".csv"))]
    if report is not None:
        from strutwork.reports.study_page import write_study_report

        result["report"] = str(write_study_report(study, found, Path(report)).report)
    if json:
        print_json(result)
    else:
        _print(study, found, result)


def _to_file(study: Study, out: str, **options: Any) -> xr.Dataset:
    try:
        return run_to_file(study, out, **options)
    except (KeyboardInterrupt, SystemExit, OutputError):
        if any_finished(parts_of(study, Path(out))):
            tell(f"What is finished is kept beside {out}: give --resume to go on.")
        raise


def _result(file: str, study: Study, found: xr.Dataset) -> dict[str, Any]:
    status = found["status"].to_numpy().ravel()
    texts = [str(t) for t in found["reason_text"].to_numpy()]
    reasons = Counter(texts[int(i)] for i in found["reason"].to_numpy().ravel() if i)
    parameters = parameter_columns(found)
    answers = {}
    for column in answer_columns(found):
        extremes = _extremes(column, parameters)
        name, rank = leading(parameters, column.values)
        answers[column.name] = {
            "unit": column.unit,
            **extremes,
            "follows": {"parameter": name, "rank_correlation": rank} if name else None,
        }
    return {
        "study": file,
        "model": study.machine.title,
        "machines": len(study),
        "solved": int(np.count_nonzero(status == 0)),
        "dropped_by_reason": dict(reasons),
        "parameters": study.settings["parameters"],
        "answers": answers,
        **analysis(found),
        "study_key": str(found.attrs["study_key"]),
        "data": [],
    }


def _extremes(column: NumberColumn, parameters: tuple[NumberColumn, ...]) -> dict[str, Any]:
    """Least and largest with the machines that have them; None where nothing is finite."""
    values = np.where(np.isfinite(column.values), column.values, np.nan)
    if not np.isfinite(values).any():
        return {"least": None, "largest": None}
    return {
        name: {
            "value": float(values[row]),
            "machine": row,
            "at": {p.name: float(p.values[row]) for p in parameters},
        }
        for name, row in (
            ("least", int(np.nanargmin(values))),
            ("largest", int(np.nanargmax(values))),
        )
    }


def _print(study: Study, found: xr.Dataset, result: dict[str, Any]) -> None:
    out = console()
    parameters = parameter_columns(found)
    out.print(visible(result["model"]), markup=False, style="bold")
    poses = 0 if study.workspace is None else len(study.workspace)
    where = f"{counted(poses, 'pose')} and home" if poses else "home"
    out.print(
        f"{counted(result['machines'], 'machine')} ({study.drawn.kind}), each at {where}; "
        f"{result['solved']} can be built",
        markup=False,
    )
    for reason, count in result["dropped_by_reason"].items():
        out.print(f"  {count}: {visible(reason)}", markup=False, soft_wrap=True)
    columns = [c for c in answer_columns(found) if MANNER.whole or _is_short(study, c)]
    rows = []
    for column in columns:
        entry = result["answers"][column.name]
        unit, factor = reading(column)
        if entry["least"] is None:
            rows.append((title_of(column), unit, "none", "none", ""))
            continue
        low, high = entry["least"], entry["largest"]
        rows.append(
            (
                title_of(column),
                unit,
                low["value"] * factor,
                high["value"] * factor,
                _follows(entry["follows"]),
            )
        )
    out.print(
        table(
            "Answers over the machines",
            ["", "unit", "least", "largest", "rank correlation"],
            rows,
            names=2,
        )
    )
    for sentence in gap_words(found, poses, columns):
        out.print(visible(sentence), markup=False, soft_wrap=True)
    last = print_analysis(out, found, columns)
    for path in result["data"]:
        out.print(visible(path), markup=False, soft_wrap=True)
    if "report" in result:
        out.print(f"Report: {visible(result['report'])}", markup=False, soft_wrap=True)
    if last:
        out.print(last, markup=False, soft_wrap=True)
    else:
        _print_best(out, columns, parameters, result)


def _is_short(study: Study, column: NumberColumn) -> bool:
    """One reduction of each answer, and its first labels."""
    wanted = "_home" if study.workspace is None or "worst" not in study.reductions else "_worst"
    if column.variable == TRAVELLED:
        return True
    if column.variable != "mass" and not column.variable.endswith(wanted):
        return False
    return "blocked" not in column.variable and column.label in _SHORT


def _follows(follows: dict[str, Any] | None) -> str:
    if follows is None:
        return ""
    rank = follows["rank_correlation"]
    way = "rises with" if rank > 0 else "falls with"
    return f"{way} {visible(follows['parameter'])} ({abs(rank):.2f})"


def _print_best(
    out: Any,
    columns: list[NumberColumn],
    parameters: tuple[NumberColumn, ...],
    result: dict[str, Any],
) -> None:
    """The answer, last: which machine is best in what stands first."""
    for column in columns:
        entry = result["answers"][column.name]
        if entry["least"] is None:
            continue
        best = entry["largest"]
        out.print(
            f"Largest {title_of(column)}: {read_value(column, best['value'])} with "
            f"{visible(machine_words(parameters, best['machine']))}",
            markup=False,
            soft_wrap=True,
        )
        return
