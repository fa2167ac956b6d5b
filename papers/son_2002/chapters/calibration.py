"""What the MIT-SS-1's unpublished numbers were calibrated on, and what stays open."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from types import MappingProxyType

from strutwork.papers.son_2002.calibration import Part
from strutwork.papers.son_2002.whole_study import WholeStudy
from strutwork.papers.tables import nearly, numbers, texts
from strutwork.reports.content import Block, Cell, Chapter, Figure, Points, Table, Text
from strutwork.reports.data_files import csv_file, json_file
from strutwork.reports.figures.modes import singular_values
from strutwork.reports.long_tables import parted
from strutwork.reports.numbers import MINUS, count, percent, significant
from strutwork.studies.calibrate import Calibration

FILE = "calibration.json"

#: The steps in words.
STEPS: Mapping[Part, str] = MappingProxyType(
    {
        "granite": "granite and mounts",
        "moving": "moving structure",
        "measured": "measured machine",
        "ball screw": "ball screws",
    }
)

#: Parameters in words, shown unit and factor.
WORDS: Mapping[str, tuple[str, str, float]] = MappingProxyType(
    {
        "plate": ("thickness of the plate", "mm", 1e3),
        "base": ("thickness of the base", "mm", 1e3),
        "horizontal": ("mount across", "N/µm", 1e-6),
        "vertical": ("mount down", "N/µm", 1e-6),
        "radial_stiffness": ("bearing on the housing, radial", "N/µm", 1e-6),
        "axial_stiffness": ("bearing on the housing, axial", "N/µm", 1e-6),
        "block_radial_stiffness": ("bearing on a block, radial", "N/µm", 1e-6),
        "block_axial_stiffness": ("bearing on a block, axial", "N/µm", 1e-6),
        "housing_mass": ("mass of the housing", "kg", 1.0),
        "housing_inertia": ("inertia of the housing", "kg m²", 1.0),
        "strut_mass": ("mass of a strut", "kg", 1.0),
        "preload_factor": ("far over near bearings' stiffness", "", 1.0),
        "drive_stiffness": ("drive", "N/µm", 1e-6),
    }
)

#: A weight in an undetermined combination below this is not told.
TOLD = 0.1


def calibration_chapter(study: WholeStudy) -> Chapter:
    """Parameters with their errors, targets with their residuals, what is not determined."""
    found = study.calibrations
    threshold = next(iter(found.values())).identified.threshold
    blocks: list[Block] = [
        Text(
            "The calibration has four steps of bounded least squares, each based on the results "
            "of those before; frequencies are weighted with 0.5 %. The constants are stored; for "
            "this page they were assessed, not searched again: the residuals, and the "
            "combinations of parameters that the sensitivities of the targets determine. A "
            "standard error is that of the weights, to first order, and does not cover what the "
            "model omits."
        ),
        *parted(_parameters(found), 6),
        *parted(_targets(found), 6),
        Figure(
            "singular-values",
            "Singular values of the targets' sensitivities, relative to the largest of each "
            "step. Below the dashed line a combination of parameters is not determined; zeros "
            "are at the bottom.",
            singular_values(
                {STEPS[k]: c.identified.singular_values.tolist() for k, c in found.items()},
                threshold,
            ),
            "Singular values of four calibrations; two of the moving structure's are zero.",
            "calibration-singular-values.csv",
            420,
        ),
        Points(_open(found)),
    ]
    return Chapter(
        "calibration",
        "Calibration",
        tuple(blocks),
        (
            json_file(
                FILE,
                "parameters, targets, residuals, Jacobians, singular values and directions",
                {part: c.to_dict() for part, c in found.items()},
            ),
            csv_file(
                "calibration-singular-values.csv",
                "singular values and their combinations",
                ["step", "combination", "singular_value", "determined", "weights"],
                [
                    [part, i + 1, float(v), i < c.identified.rank, _weights(c, i)]
                    for part, c in found.items()
                    for i, v in enumerate(c.identified.singular_values)
                ],
            ),
        ),
    )


def _parameters(found: Mapping[Part, Calibration]) -> Table:
    rows: list[list[str | Cell]] = []
    for part, c in found.items():
        errors = c.identified.standard_errors
        for p, value, error in zip(c.parameters, c.values, errors, strict=True):
            words, unit, factor = WORDS[p.name]
            known = isfinite(error)
            bound = p.name in c.on_bounds
            rows.append(
                [
                    words,
                    significant(factor * float(value)),
                    unit,
                    f"±{100 * float(error):.1f} %" if known else Cell("not determined", "poor"),
                    f"{significant(factor * p.low, 2)} to {significant(factor * p.high, 2)}",
                    Cell("at its bound", "poor") if bound else "within",
                    STEPS[part],
                ]
            )
    return Table(
        "Calibrated parameters",
        (
            *texts("parameter"),
            *numbers("value"),
            *texts("unit"),
            *numbers("standard error"),
            *texts("bounds", "", "step"),
        ),
        rows,
        FILE,
    )


def _targets(found: Mapping[Part, Calibration]) -> Table:
    rows: list[list[str | Cell]] = []
    for part, c in found.items():
        for t, computed, residual in zip(c.targets, c.computed, c.residuals, strict=True):
            size = abs(float(residual))
            # a rounded zero has no sign
            shown = 0.0 if size < 0.005 else float(residual)
            rows.append(
                [
                    t.name,
                    f"{significant(t.value, 4)} ± {significant(t.uncertainty, 2)}",
                    significant(float(computed), 4),
                    t.unit.replace("um", "µm"),
                    percent(nearly(100 * (float(computed) / t.value - 1))),
                    Cell(
                        f"{shown:+.2f}".replace("-", MINUS) if shown else "0.00",
                        "good" if size <= 2 else "poor",
                    ),
                    STEPS[part],
                ]
            )
    return Table(
        "Targets; residuals in units of the stated uncertainty, red beyond two",
        (
            *texts("target"),
            *numbers("published and weight", "computed"),
            *texts("unit"),
            *numbers("difference", "residual"),
            *texts("step"),
        ),
        rows,
        FILE,
    )


def _open(found: Mapping[Part, Calibration]) -> tuple[str, ...]:
    lines = []
    for part, c in found.items():
        number, rank = len(c.parameters), c.identified.rank
        if rank == number:
            what = "parameter" if number == 1 else "parameters"
            lines.append(
                f"{STEPS[part].capitalize()}: {count(len(c.targets), 'target')} "
                f"{'determines' if len(c.targets) == 1 else 'determine'} "
                f"{'the' if number == 1 else 'all ' + str(number)} {what}."
            )
            continue
        some = "; ".join(
            ", ".join(
                f"{WORDS[n][0]} {w:.2f}".replace("-", MINUS)
                for n, w in sorted(one.items(), key=lambda item: -abs(item[1]))
                if abs(w) >= TOLD
            )
            for one in c.identified.undetermined
        )
        lines.append(
            f"{STEPS[part].capitalize()}: {len(c.targets)} targets determine {rank} of {number} "
            "combinations. Free, with the weights of the logarithms of the parameters: "
            f"{some}."
        )
    return tuple(lines)


def _weights(c: Calibration, i: int) -> str:
    pairs = zip(c.identified.names, c.identified.directions[i], strict=True)
    return "; ".join(f"{n} {float(w)!r}" for n, w in pairs)
