"""`strutwork calibrate`: numbers of a machine from measurements, and the poses to measure next."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from strutwork.errors import ModelError
from strutwork.files import write_whole
from strutwork.machines.model_edit import edited_text
from strutwork.machines.model_file import file_text, parse_model
from strutwork.names import visible
from strutwork.reports.calibration_words import (
    agreement_unit,
    interval_words,
    read_number,
    verdict_words,
)
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown
from strutwork.studies.calibration_file import CalibrationFile, read_calibration
from strutwork.studies.calibration_fit import fit
from strutwork.studies.calibration_result import MachineCalibration
from strutwork.studies.pose_choice import PoseChoice, choose_poses


def run(file: str, out: str | None, report: str | None, poses: int | None, *, json: bool) -> None:
    """Calibrate, write what is asked for and print the result."""
    read = read_calibration(file)
    if out is not None and read.machine_file is None:
        raise ModelError(
            out,
            "cannot be written: the machine is one of the catalogue and has no model file.",
            "Omit --out, or describe the machine in a model file.",
        )
    if out is not None and not out.endswith(".toml"):
        raise ModelError(out, "does not end in .toml.", "Name a model file, as calibrated.toml.")
    found: MachineCalibration | None = None
    if read.experiment.measurements or poses is None:
        with shown("starts") as started:
            progress = started("calibration")
            found = fit(read.experiment, read.starts, read.seed, progress)
    choice = None
    if poses is not None:
        choice = choose_poses(read.experiment, read.candidates, poses, found, seed=read.seed)
    result: dict[str, Any] = {} if found is None else found.to_dict()
    if choice is not None:
        result |= {"calibration": file, "model": read.experiment.machine.title}
        result["poses"] = choice.to_dict()
    if out is not None and found is not None:
        result["written"] = str(_write(read, found, Path(out)))
    if report is not None:
        from strutwork.reports.calibration_page import write_calibration_report

        made = write_calibration_report(read.experiment, found, choice, Path(report))
        result["report"] = str(made.report)
    if json:
        print_json(result)
        return
    out_ = console()
    out_.print(visible(read.experiment.machine.title), markup=False, style="bold")
    if found is not None:
        _print(found)
    if choice is not None:
        _print_choice(choice)
    if "written" in result:
        out_.print(f"Written: {visible(result['written'])}", markup=False, soft_wrap=True)
    if "report" in result:
        out_.print(f"Report: {visible(result['report'])}", markup=False, soft_wrap=True)


def _write(read: CalibrationFile, found: MachineCalibration, out: Path) -> Path:
    """The machine's file with the calibrated numbers, which must read as the calibrated machine."""
    assert read.machine_file is not None  # noqa: S101 - asked by the caller
    name = Path(read.experiment.source).name
    text = edited_text(
        file_text(read.machine_file, "model file"),
        {read.experiment.machine.paths[p].places: v for p, v in found.numbers.items()},
        f"calibrated: {visible(name)}",
    )
    # files of solids and shapes are found from the folder of the machine
    parse_model(text, str(out), read.machine_file.parent)
    return write_whole(out, lambda path: path.write_text(text, encoding="utf-8"))


def _print(found: MachineCalibration) -> None:
    out = console()
    rows = []
    for f in found.found:
        unit, factor = read_number(f.unit)
        rows.append(
            (
                f.name,
                unit,
                float(f.guess * factor),
                float(f.value * factor),
                interval_words(f),
                f"{f.ratio:.3f}",
                verdict_words(f),
            )
        )
    columns = [
        "parameter",
        "unit",
        "guess",
        "calibrated",
        "95 % interval",
        "ratio",
        "from the data",
    ]
    out.print(table("Calibrated parameters", columns, rows, names=2))
    lines = [
        (a.name, a.kind, a.pose, len(a.measured), a.rms(a.before), a.rms(a.after))
        for a in found.agreements
    ]
    columns = ["measurement", "kind", "pose", "values", "before", "after"]
    out.print(table("Residuals (root mean square, in scatters)", columns, lines, names=3))
    single = [a for a in found.agreements if a.kind != "frf"]
    if single:
        values = [
            (
                f"{a.name}, {label}",
                unit,
                *(float(v[i] * factor) for v in (a.measured, a.before, a.after)),
            )
            for a in single
            for i, label in enumerate(a.labels)
            for unit, factor in (agreement_unit(a, i),)
        ]
        columns = ["value", "unit", "measured", "before", "after"]
        out.print(table("Measured and computed values", columns, values, names=2))
    for group in found.undetermined:
        out.print(visible(group.words), markup=False, soft_wrap=True)
    for note in (*found.notes, *found.failures):
        out.print(f"Note: {visible(note)}.", markup=False, soft_wrap=True)
    out.print(found.scatter_words, markup=False, soft_wrap=True)


def _print_choice(choice: PoseChoice) -> None:
    out = console()
    out.print(
        table(
            f"The {len(choice.chosen)} poses that determine most, of {choice.candidates}",
            ["pose", *choice.axes],
            [(i + 1, *choice.pose_cells(k)) for i, k in enumerate(choice.chosen)],
        )
    )
    rows = [
        (
            name,
            *(choice.spread_words(i, v[i]) for v in (choice.before, choice.after, choice.random)),
        )
        for i, name in enumerate(choice.names)
    ]
    out.print(
        table(
            "Expected 95 % intervals",
            ["parameter", "now", "with these poses", "with random poses"],
            rows,
        )
    )
    for note in choice.notes:
        out.print(f"Note: {visible(note)}.", markup=False, soft_wrap=True)
    out.print(choice.words, markup=False, soft_wrap=True)
