"""Whether a machine's dimensions are positive, and fit one another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import isfinite
from statistics import median

from strutwork.errors import ModelError

#: A dimension this many times the middle one of the others, or a part of it as small, is taken
#: for another unit: in the machines of the literature the ratio stays below fifteen.
FARTHEST = 100.0


POSITIVE, LENGTH = "Give a positive number, SI.", "Give a positive length, m."
OR_RIGID = "Give a positive number, N/m, or None for rigid."
OR_ANY = "Give a positive number, SI, or None for no limit."


def check_positive(machine: object, fields: Iterable[str], remedy: str = POSITIVE) -> None:
    """Refuse fields of a machine that are not positive; `OR_RIGID` and `OR_ANY` allow None.

    Parameters
    ----------
    machine : object
        With the fields; its type is named in the error.
    fields : iterable of str
    remedy : str

    Raises
    ------
    ModelError
        Names the field and its value.
    """
    for name in fields:
        value = getattr(machine, name)
        if value is None and remedy in (OR_RIGID, OR_ANY):
            continue
        if not (isfinite(value) and value > 0):
            raise ModelError(f"{type(machine).__name__}.{name}", f"is {value!r}.", remedy)


def check_proportions(machine: str, dimensions: Mapping[str, float]) -> None:
    """Refuse a dimension that is out of all proportion to the others.

    Parameters
    ----------
    machine : str
        Named in the error.
    dimensions : mapping of field to float
        Positive lengths, m.

    Raises
    ------
    ModelError
        Names the field that is farthest from the others.
    """
    if len(dimensions) < 3:
        return

    def ratio(name: str) -> float:
        middle = median(v for n, v in dimensions.items() if n != name)
        return max(dimensions[name] / middle, middle / dimensions[name])

    name = max(dimensions, key=ratio)
    if ratio(name) < FARTHEST:
        return
    others = [v for n, v in dimensions.items() if n != name]
    raise ModelError(
        f"{machine}.{name}",
        f"is {dimensions[name]:g} m, out of proportion to the machine's other lengths of "
        f"{min(others):g} to {max(others):g} m.",
        "Lengths are in metres: write 0.216 for 216 mm.",
    )
