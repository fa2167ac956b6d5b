"""The report of a calibration: what was found, how well it agrees, and where to measure next."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from strutwork.reports.build import Composed, WrittenReport, page_of, write_page
from strutwork.reports.calibration_words import (
    agreement_unit,
    interval_words,
    read_number,
    verdict_words,
)
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import (
    Answer,
    Answers,
    Block,
    Cell,
    Chapter,
    Column,
    Figure,
    Note,
    Points,
    Row,
    Table,
    Text,
    Tone,
)
from strutwork.reports.data_files import csv_file
from strutwork.reports.figures.calibration import halves, poses, ratios, response
from strutwork.reports.numbers import count, significant
from strutwork.studies.calibration_result import MachineCalibration
from strutwork.studies.experiment import Experiment
from strutwork.studies.measured_frf import MeasuredFrf
from strutwork.studies.pose_choice import PoseChoice

PARAMETERS, VALUES, POSES, EXPECTED = (
    *("parameters.csv", "measured-and-computed.csv"),
    *("poses.csv", "expected-intervals.csv"),
)

#: Responses that are drawn, those that agree least first.
DRAWN = 8


def write_calibration_report(
    experiment: Experiment,
    found: MachineCalibration | None,
    choice: PoseChoice | None,
    folder: Path,
) -> WrittenReport:
    """Write the report of a calibration, of a choice of poses, or of both.

    Parameters
    ----------
    experiment : Experiment
    found : MachineCalibration or None
    choice : PoseChoice or None
    folder : Path

    Raises
    ------
    OutputError
        The folder cannot be written, or holds a report on something else.
    """
    chapters: list[Chapter] = []
    if found is not None:
        chapters += [_values(found), _agreement(found)]
    if choice is not None:
        chapters.append(_poses(choice))
    title = f"Calibration of {experiment.machine.title}"
    settings = {
        "parameters": list(experiment.names),
        "measurements": [m.name for m in experiment.measurements],
    }
    content = {} if found is None else {"calibration": found.to_dict()}
    closing = closing_chapter(title, settings, content, chapters, "")
    every = (*chapters, closing)
    subtitle = (
        f"{count(len(experiment.unknowns), 'parameter')}, "
        f"{count(experiment.count, 'measured number')}"
    )
    page = page_of(title, subtitle, every)
    files = tuple(f for chapter in every for f in chapter.files)
    return write_page(Composed(page, files), folder, title)


def _values(found: MachineCalibration) -> Chapter:
    said = []
    for f in found.found:
        unit, factor = read_number(f.unit)
        value = f"{significant(f.value * factor, 4)} {unit}".strip()
        if f.interval is None:
            after = f", {verdict_words(f)}."
        else:
            after = f" (95 % interval {interval_words(f)} {unit}), {f.ratio:.3g} times the guess."
        said.append(
            Answer(f"{f.name} is calibrated to ", value, after, "agreement", f.interval is None)
        )
    rows: list[list[str | Cell]] = []
    for f in found.found:
        unit, factor = read_number(f.unit)
        tone: Tone = "good" if f.verdict == "identifiable" else "poor"
        rows.append(
            [
                f.name,
                *(unit, significant(f.guess * factor, 4), significant(f.value * factor, 4)),
                *(interval_words(f), f"{f.ratio:.3f}"),
                Cell(verdict_words(f), tone),
            ]
        )
    columns = [
        Column("parameter", numeric=False),
        Column("unit", numeric=False),
        Column("first guess"),
        Column("calibrated"),
        Column("95 % interval"),
        Column("ratio to the guess"),
        Column("from the measurements", numeric=False),
    ]
    low, high = (
        [f.interval[i] / f.guess if f.interval and f.guess else np.nan for f in found.found]
        for i in (0, 1)
    )
    blocks: list[Block] = [
        Answers(tuple(said)),
        Text(found.scatter_words),
        *(Note(group.words) for group in found.undetermined),
        Table("Calibrated parameters", columns, rows, PARAMETERS),
        Figure(
            "ratios",
            "Calibrated values as ratios of the first guess; a line shows the 95 % interval.",
            ratios([f.name for f in found.found], [f.ratio for f in found.found], low, high),
            "A point with an interval for each parameter, at its ratio to the first guess.",
            PARAMETERS,
            150 + 46 * len(found.found),
        ),
        Text(
            "The intervals follow from the stated scatter of the measurements and, where the "
            "file states one, from the prior of a parameter. A parameter is identifiable if the "
            "measurements alone bound it within a factor of ten. These values are calibrated: a "
            "computed value that was fitted to a measurement is not a prediction of it."
        ),
    ]
    heads = ["parameter", "unit", "first guess", "value", "low", "high", "from the measurements"]
    lines = [
        [f.name, f.unit, f.guess, f.value, *(f.interval or (None, None)), verdict_words(f)]
        for f in found.found
    ]
    files = (csv_file(PARAMETERS, "calibrated parameters, SI", heads, lines),)
    return Chapter("values", "What are the values?", tuple(blocks), files)


def _agreement(found: MachineCalibration) -> Chapter:
    rows = [
        [
            *(a.name, a.kind, a.pose, str(len(a.measured))),
            *(f"{a.rms(values):.3g}" for values in (a.before, a.after)),
        ]
        for a in found.agreements
    ]
    columns = [
        Column("measurement", numeric=False),
        Column("kind", numeric=False),
        Column("pose", numeric=False),
        Column("values"),
        Column("first guess", group="residual in scatters"),
        Column("calibrated", group="residual in scatters"),
    ]
    blocks: list[Block] = [
        Text(
            "A residual is the difference of computed and measured value, divided by the stated "
            "scatter; its root mean square is about 1 where model and scatter are right."
        ),
        Table("Residuals of each measurement", columns, rows, VALUES),
    ]
    single = []
    for a in found.agreements:
        if a.kind == "frf":
            continue
        for i, label in enumerate(a.labels):
            unit, factor = agreement_unit(a, i)
            numbers = (a.measured, a.scatter, a.before, a.after)
            single.append(
                [f"{a.name}, {label}", unit, *(significant(v[i] * factor, 4) for v in numbers)]
            )
    if single:
        heads = [
            Column("value", numeric=False),
            Column("unit", numeric=False),
            *(Column(t) for t in ("measured", "scatter", "first guess", "calibrated")),
        ]
        blocks.append(Table("Frequencies and deflections", heads, single, VALUES))
    figures: list[Figure] = []
    for m, a in zip(found.experiment.measurements, found.agreements, strict=True):
        if not isinstance(m, MeasuredFrf):
            continue
        n = len(m.frequencies)
        for k, (output, given) in enumerate(m.pairs):
            own = slice(k * n, (k + 1) * n)
            turns, twists = (str(p.direction).startswith("r") for p in (output, given))
            unit = f"{'rad' if turns else 'm'}/{'(N·m)' if twists else 'N'}"
            figures.append(
                Figure(
                    f"response-{len(figures)}",
                    f"{a.name}, {a.pose}: {output} over {given}, measured and computed.",
                    response(
                        m.frequencies,
                        np.exp(a.measured[own]),
                        np.exp(a.before[own]),
                        np.exp(a.after[own]),
                        unit,
                    ),
                    "Magnitude of the response over the frequency: measured points, the first "
                    "guess dashed, the calibrated machine as a line.",
                    VALUES,
                )
            )
    if figures:
        blocks.append(Row(tuple(figures[:DRAWN]), 420))
    if len(figures) > DRAWN:
        blocks.append(Text(f"{len(figures) - DRAWN} more responses are in {VALUES}."))
    said = (*found.notes, *found.failures)
    if said:
        blocks.append(Points(tuple(f"{n[:1].upper()}{n[1:]}." for n in said), "Notes"))
    lines = [
        [
            *(a.name, a.kind, a.pose, label, a.unit),
            *(float(v[i]) for v in (a.measured, a.scatter, a.before, a.after)),
        ]
        for a in found.agreements
        for i, label in enumerate(a.labels)
    ]
    names = ["measurement", "kind", "pose", "value", "unit"]
    names += ["measured", "scatter", "first guess", "calibrated"]
    files = (csv_file(VALUES, "measured and computed numbers, SI", names, lines),)
    return Chapter("agreement", "Does it agree with the measurements?", tuple(blocks), files)


def _poses(choice: PoseChoice) -> Chapter:
    axes = list(choice.axes)
    columns = [Column("pose"), *(Column(a.split(", ")[0], a.split(", ")[1]) for a in axes)]
    rows = [
        [str(i + 1), *(significant(v, 4) for v in choice.pose_cells(k))]
        for i, k in enumerate(choice.chosen)
    ]
    blocks: list[Block] = [
        Answers((Answer(*_gain(choice)),)),
        Text(
            f"Chosen among {count(choice.candidates, 'pose')}, at each of which are measured: "
            f"{', '.join(choice.kinds)}. The choice makes the determinant of the information "
            "matrix large (D-optimal): the volume of the confidence region of all parameters "
            "together becomes small."
        ),
        Table(f"The {count(len(choice.chosen), 'pose')} that determine most", columns, rows, POSES),
    ]
    every = np.array([choice.pose_cells(k) for k in range(choice.candidates)])
    varied = [i for i in range(len(axes)) if np.ptp(every[:, i]) > 0]
    titles = [f"{a.split(', ')[0]} ({a.split(', ')[1]})" for a in axes]
    pairs = [(varied[i], varied[j]) for i in range(len(varied)) for j in range(i + 1, len(varied))]
    figures = [
        Figure(
            f"poses-{n}",
            f"Chosen poses among the candidates: {titles[j]} over {titles[i]}.",
            poses(every[:, i], every[:, j], choice.chosen, titles[i], titles[j]),
            "A point for each candidate pose, the chosen ones larger.",
            POSES,
            380,
        )
        for n, (i, j) in enumerate(pairs[:3])
    ]
    if figures:
        blocks.append(Row(tuple(figures)))
    words = [
        [
            name,
            *(choice.spread_words(i, v[i]) for v in (choice.before, choice.after, choice.random)),
        ]
        for i, name in enumerate(choice.names)
    ]
    heads = ["now", "with these poses", "with random poses"]
    blocks += [
        Table(
            "Expected 95 % intervals",
            [Column("parameter", numeric=False), *(Column(h) for h in heads)],
            words,
            EXPECTED,
        ),
        Figure(
            "expected",
            "Expected half-widths of the 95 % intervals; random poses: the median of many choices.",
            halves(
                choice.names,
                {
                    heads[0]: 100 * choice.before,
                    heads[2]: 100 * choice.random,
                    heads[1]: 100 * choice.after,
                },
            ),
            "Three bars for each parameter: now, with random poses, with the chosen poses.",
            EXPECTED,
            170 + 70 * len(choice.names),
        ),
        *((Points(tuple(f"{n}." for n in choice.notes)),) if choice.notes else ()),
    ]
    files = (
        csv_file(
            POSES,
            "candidate poses, 1 for those that were chosen",
            [*titles, "chosen"],
            [[*row, int(k in choice.chosen)] for k, row in enumerate(every.tolist())],
        ),
        csv_file(
            EXPECTED,
            "expected half-widths of the 95 % intervals, as a share or in logarithms",
            ["parameter", *heads],
            list(zip(choice.names, choice.before, choice.after, choice.random, strict=True)),
        ),
    )
    return Chapter("poses", "Where to measure next?", tuple(blocks), files)


def _gain(choice: PoseChoice) -> tuple[str, str, str]:
    return (
        "Measurements at the chosen poses make the intervals narrower by a factor of ",
        f"{choice.gain:.3g}",
        f" on average; at random poses the factor is {choice.gain_random:.3g}.",
    )
