"""Reading a calibration file: a machine, the numbers to be found, and what was measured."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.beside_model import tables_beside_model
from strutwork.machines.model import Model
from strutwork.studies.calibration_schema import (
    CalibrationTable,
    CandidatesTable,
    DeflectionsTable,
    FrequenciesTable,
    LoadTable,
    PoseTable,
    UnknownTable,
)
from strutwork.studies.experiment import Experiment
from strutwork.studies.measured_deflections import MeasuredDeflections
from strutwork.studies.measured_files import frequencies_of_file, frf_of_file
from strutwork.studies.measured_frequencies import MeasuredFrequencies
from strutwork.studies.measurement import Measurement, checked_scatter
from strutwork.studies.parametric import Parametric
from strutwork.studies.study_file import machine_beside
from strutwork.studies.unknown import Unknown

#: Where the file is described.
PAGE = "docs/how-to/calibrate.md"


@dataclass(frozen=True)
class CalibrationFile:
    """What a calibration file describes.

    Parameters
    ----------
    experiment : Experiment
    starts, seed : int
        Of the search.
    candidates : CandidatesTable or None
        Poses that could be measured.
    machine_file : Path or None
        The machine's model file; None for one of the catalogue.
    """

    experiment: Experiment
    starts: int
    seed: int
    candidates: CandidatesTable | None
    machine_file: Path | None


def read_calibration(path: str | Path) -> CalibrationFile:
    """Read a calibration file.

    Parameters
    ----------
    path : str or Path
        TOML; its tables are those of docs/how-to/calibrate.md. Files that it names lie beside it
        or below it, or have a full path.

    Raises
    ------
    ModelError, UnitError
        The file, the machine or a measurement's file cannot be read, a key is unknown or wrong; a
        parameter, node or direction that does not exist.
    UnreachableError
        A pose that the machine cannot take.
    """
    place = Path(path)
    tables = tables_beside_model(place, "calibration", CalibrationTable, PAGE)
    machine = machine_beside(place, tables.machine)
    own = Path(machine.source) if machine.source.endswith(".toml") else None
    unknowns = tuple(_unknown(machine, table) for table in tables.parameters)
    return CalibrationFile(
        experiment_of(machine, unknowns, tables, place.parent, str(path)),
        tables.fit.starts,
        tables.fit.seed,
        tables.candidates,
        own,
    )


def experiment_of(
    machine: Parametric,
    unknowns: tuple[Unknown, ...],
    tables: CalibrationTable,
    folder: Path,
    source: str = "",
) -> Experiment:
    """The measurements of tables on a machine.

    Parameters
    ----------
    machine : Parametric
    unknowns : tuple of Unknown
    tables : CalibrationTable
    folder : Path
        Where names of files begin.
    source : str
        The calibration file; empty for none.

    Raises
    ------
    ModelError, UnreachableError
        As `read_calibration`.
    """
    bare = Experiment(machine, unknowns)
    model = machine.model(bare.numbers(bare.values(bare.guess)))
    found: list[Measurement] = []
    for i, f in enumerate(tables.frequencies, 1):
        found.append(_frequencies(f, f.name or f"frequencies {i}", model, folder))
    for i, r in enumerate(tables.frf, 1):
        found.append(frf_of_file(r, r.name or f"frf {i}", task_of(r.pose), model, folder))
    for i, d in enumerate(tables.deflections, 1):
        found.append(_deflections(d, d.name or f"deflections {i}"))
    names = [m.name for m in found]
    for name in names:
        if names.count(name) > 1:
            raise ModelError(f"measurement {name}", "is named twice.", "Give each its own name.")
    return Experiment(machine, unknowns, tuple(found), source)


def task_of(pose: PoseTable) -> dict[str, float]:
    """A pose as it is asked of a machine, m and rad.

    Parameters
    ----------
    pose : PoseTable
    """
    return {d: float(v) for d in DIRECTIONS if (v := getattr(pose, d)) is not None}


def load_of(table: LoadTable) -> tuple[float, ...]:
    """Force and moment, (6,), N and N·m.

    Parameters
    ----------
    table : LoadTable
    """
    return tuple(float(getattr(table, d)) for d in DIRECTIONS)


def _unknown(machine: Parametric, table: UnknownTable) -> Unknown:
    return Unknown.of(
        machine,
        table.path,
        table.guess,
        table.range,
        prior=table.prior,
        relative=table.relative,
        scale=table.scale,
        name=table.name or "",
    )


def _frequencies(table: FrequenciesTable, name: str, model: Model, folder: Path) -> Measurement:
    if (table.values is None) == (table.file is None):
        what = "neither values nor a file" if table.file is None else "both values and a file"
        raise ModelError(name, f"has {what}.", 'Give values = ["33.5 Hz"], or file = "test.uff".')
    if (table.scatter is None) == (table.relative_scatter is None):
        raise ModelError(
            name,
            "has no scatter." if table.scatter is None else "states its scatter twice.",
            'Give scatter = "0.3 Hz", or relative_scatter = "1 %".',
        )
    task = task_of(table.pose)
    shapes = None
    numbers: tuple[int, ...] = ()
    if table.file is not None:
        values, shapes = frequencies_of_file(table, name, model, task, folder)
    else:
        values = np.array(table.values, dtype=float)
        if not len(values):
            raise ModelError(name, "has no value.", 'Give values = ["33.5 Hz", "61 Hz"].')
        if np.any(np.diff(values) < 0):
            raise ModelError(name, "has values that do not ascend.", "Sort them.")
        numbers = table.modes or tuple(range(1, len(values) + 1))
        if len(numbers) != len(values) or list(numbers) != sorted(set(numbers)):
            raise ModelError(
                name,
                f"has {len(values)} values for the modes {list(numbers)}.",
                "Name one mode for each value, ascending.",
            )
    if table.scatter is not None:
        scatter = checked_scatter(name, table.scatter, len(values))
    else:
        scatter = float(table.relative_scatter or 0.0) * values
    return MeasuredFrequencies(name, task, values, scatter, numbers, shapes)


def _deflections(table: DeflectionsTable, name: str) -> Measurement:
    at, values, scatter = [], [], []
    for node, moved in table.displacements.items():
        for direction, value in task_of(moved).items():
            turns = direction.startswith("r")
            given = table.angular_scatter if turns else table.scatter
            if given is None:
                key, example = ("angular_scatter", "1 urad") if turns else ("scatter", "0.5 um")
                raise ModelError(f"{name}.{key}", "is missing.", f'Give {key} = "{example}".')
            at.append((node, direction))
            values.append(value)
            scatter.append(given)
    return MeasuredDeflections(
        name,
        task_of(table.pose),
        table.load.node,
        load_of(table.load),
        tuple(at),
        np.array(values, dtype=float),
        np.array(scatter, dtype=float),
    )
