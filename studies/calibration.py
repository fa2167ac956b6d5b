"""Calibration of a machine in Python: the tables of a calibration file as arguments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from strutwork.errors import ModelError
from strutwork.machines.model_errors import model_error
from strutwork.names import choices, visible
from strutwork.studies.calibration_file import PAGE, experiment_of
from strutwork.studies.calibration_fit import fit
from strutwork.studies.calibration_result import MachineCalibration
from strutwork.studies.calibration_schema import CalibrationTable
from strutwork.studies.parametric import Parametric
from strutwork.studies.progress import Progress, silent
from strutwork.studies.unknown import Unknown


def calibrate_machine(  # noqa: PLR0913 - the tables of a file
    machine: object,
    parameters: Mapping[str, Any] | Sequence[str],
    *,
    frequencies: Sequence[Mapping[str, Any]] = (),
    frf: Sequence[Mapping[str, Any]] = (),
    deflections: Sequence[Mapping[str, Any]] = (),
    priors: Mapping[str, float] | None = None,
    starts: int = 6,
    seed: int = 0,
    folder: str | Path = "",
    progress: Progress = silent,
) -> MachineCalibration:
    """Find the numbers of a machine that meet its measurements best.

    Parameters
    ----------
    machine : object
        As `Parametric.of`.
    parameters : mapping of path to (low, high), or sequence of str
        SI, or texts with units; without a range a tenth to ten times the machine's number.
    frequencies, frf, deflections : sequence of mappings
        With the keys of the tables of that name in a calibration file, docs/how-to/calibrate.md.
    priors : mapping of path to float, optional
        Standard deviations of what is known before, as shares of the machine's number, no unit.
    starts, seed : int
        Of the search.
    folder : str or Path
        Where names of files begin.
    progress : callable, optional
        Called after every start.

    Raises
    ------
    ModelError, UnitError, UnreachableError, NumericalError
        As `strutwork.studies.calibration_file.read_calibration` and
        `strutwork.studies.calibration_fit.fit`.
    """
    found = Parametric.of(machine)
    if isinstance(parameters, str):
        raise ModelError(
            "parameters", f'are the text "{visible(parameters)}".', "Give a list of paths."
        )
    named = parameters if isinstance(parameters, Mapping) else dict.fromkeys(parameters)
    known = priors or {}
    for path in known:
        if path not in named:
            raise ModelError(
                f"prior of {visible(path)}",
                "names no parameter of the calibration.",
                choices("Parameters", path, tuple(named)),
            )
    for path, ends in named.items():
        if ends is not None and (isinstance(ends, str) or np.shape(ends) != (2,)):
            raise ModelError(
                f"parameter {visible(path)}",
                "has no pair as its range.",
                'Give (low, high), as ("20 kg", "30 kg").',
            )
    unknowns = tuple(
        Unknown.of(found, path, None, None if ends is None else tuple(ends), prior=known.get(path))
        for path, ends in named.items()
    )
    data = {
        "machine": found.source or "machine",
        "parameters": [{"path": path} for path in named],
        "frequencies": [dict(f) for f in frequencies],
        "frf": [dict(f) for f in frf],
        "deflections": [dict(d) for d in deflections],
    }
    try:
        tables = CalibrationTable.model_validate(data)
    except ValidationError as error:
        raise model_error(error, data, "calibration", CalibrationTable, PAGE) from None
    return fit(experiment_of(found, unknowns, tables, Path(folder)), starts, seed, progress)
