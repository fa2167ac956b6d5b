"""Numbers of a study in the units in which designers read them, and its machines in words."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, isfinite

import numpy as np
import xarray as xr

from strutwork.reports.numbers import count as counted
from strutwork.studies.study_table import NumberColumn

#: Unit and factor by SI unit.
_READ = {
    "m": ("mm", 1e3),
    "rad": ("deg", degrees(1.0)),
    "Pa": ("GPa", 1e-9),
    "N/m": ("N/µm", 1e-6),
    "N m/rad": ("kN·m/rad", 1e-3),
    "N*m/rad": ("kN·m/rad", 1e-3),
    "N m": ("N·m", 1.0),
    "1": ("", 1.0),
    "": ("", 1.0),
}
#: Displacements by errors are micrometres, not millimetres.
_SMALL = {"m": ("µm", 1e6), "rad": ("µrad", 1e6)}


#: Answers that are deviations.
_ERRORS = (
    "accuracy_",
    "assembly_",
    "worst_case",
    "root_sum_square",
    "standard_deviation",
    "largest_displacement",
    "contribution",
)


def reading(column: NumberColumn) -> tuple[str, float]:
    """The unit in which a column is read, and its factor from SI."""
    table = _SMALL if column.variable.startswith(_ERRORS) else {}
    return (_READ | table).get(column.unit, (column.unit.replace("*", "·"), 1.0))


def read_value(column: NumberColumn, value: float, digits: int = 4) -> str:
    """A value of a column with its unit."""
    unit, factor = reading(column)
    return f"{value * factor:.{digits}g} {unit}".strip()


def machine_words(parameters: Sequence[NumberColumn], row: int, digits: int = 4) -> str:
    """A machine by the values of its parameters."""
    return ", ".join(f"{p.name} {read_value(p, float(p.values[row]), digits)}" for p in parameters)


def title_of(column: NumberColumn) -> str:
    """A column's name with spaces."""
    return column.name.replace("_", " ")


def index_words(value: float, half: float) -> str:
    """A Sobol index with half the width of its interval."""
    return f"{value:.2f} ± {half:.2f}".replace("-0.00", "0.00").replace("-", "−")


def interval_words(value: float, low: float, high: float) -> str:
    """A value with its interval; an end for which there are too few machines is left open."""
    if not isfinite(low) and not isfinite(high):
        return f"{value:.4g}"
    ends = "–".join(f"{end:.4g}" if isfinite(end) else "…" for end in (low, high))
    return f"{value:.4g} ({ends})"


def gap_words(found: xr.Dataset, poses: int, columns: Sequence[NumberColumn]) -> list[str]:
    """Sentences on poses that machines miss, and on numbers that are not finite.

    Parameters
    ----------
    found : xarray.Dataset
        Of a study.
    poses : int
        At which each machine was asked, besides home.
    columns : sequence of NumberColumn
        Answers that are read.
    """
    built = found["status"].to_numpy().ravel() == 0
    kept = found["poses_kept"].to_numpy().ravel()[built]
    said = []
    if poses and kept.size and kept.min() < poses:
        low, high = int(kept.min()), int(kept.max())
        why = "out of reach, outside a joint range, or without an answer"
        if high == 0:
            said.append(f"No machine can be asked at any of the {counted(poses, 'pose')} ({why}).")
        else:
            asked = str(low) if low == high else f"{low} to {high}"
            said.append(
                f"The machines can be asked at {asked} of the {counted(poses, 'pose')} (others are "
                f"{why}); the worst and the mean are those of these poses. "
                'With reductions = ["poses"] the result lists them.'
            )
    lacking: dict[str, np.ndarray] = {}
    for column in columns:
        rows = ~np.isfinite(column.values[built])
        lacking[column.variable] = lacking.get(column.variable, False) | rows
    for name, rows in lacking.items():
        count = int(np.count_nonzero(rows))
        which = "any machine" if count == len(rows) else f"{count} of {len(rows)} machines"
        if count:
            said.append(f"{name.replace('_', ' ').capitalize()} has no finite value in {which}.")
    return said
