"""Whether a machine's dimensions fit one another."""

from __future__ import annotations

from collections.abc import Mapping
from statistics import median

from strutwork.errors import ModelError

#: A dimension this many times the middle one of the others, or a part of it as small, is taken
#: for another unit: in the machines of the literature the ratio stays below fifteen.
FARTHEST = 100.0


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
        f"is {dimensions[name]:g} m, out of all proportion to the machine's other lengths of "
        f"{min(others):g} to {max(others):g} m.",
        "Lengths are in metres: write 0.216 for 216 mm.",
    )
