"""Numbers of a study in the units in which designers read them, and its machines in words."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, isfinite

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
