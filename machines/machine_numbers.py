"""Every number of a machine written in Python by its path, and the machine with other numbers."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from typing import Any

from pydantic_core import PydanticCustomError

from strutwork import units
from strutwork.machines.model_fields import Quantity
from strutwork.machines.model_numbers import Number, Steps, Whole, quoted
from strutwork.msa.sections import Section, box, rectangle, rod, tube
from strutwork.units import Dimension, shown

#: Sections that are given by sizes: their other numbers follow from these.
_SHAPES: Mapping[str, tuple[Callable[..., Section], tuple[str, ...]]] = {
    "rod": (rod, ("diameter",)),
    "tube": (tube, ("outer_diameter", "inner_diameter")),
    "rectangle": (rectangle, ("width_y", "height_z")),
    "box": (box, ("width_y", "height_z", "thickness")),
}

#: Units as descriptions of fields state them.
_UNITS = {
    "m": units.LENGTH,
    "m²": units.AREA,
    "m⁴": units.SECOND_MOMENT,
    "rad": units.ANGLE,
    "N": units.FORCE,
    "N·m": units.MOMENT,
    "N m": units.MOMENT,
    "N/m": units.STIFFNESS,
    "N·m/rad": units.ROTATIONAL_STIFFNESS,
    "N m/rad": units.ROTATIONAL_STIFFNESS,
    "N·s/m": units.DAMPING,
    "Pa": units.PRESSURE,
    "kg": units.MASS,
    "kg/m³": units.DENSITY,
    "kg·m²": units.INERTIA,
    "kg m²": units.INERTIA,
    "Hz": units.FREQUENCY,
    "m/s": units.SPEED,
    "m/s²": units.ACCELERATION,
    "no unit": units.NUMBER,
    "a ratio": units.NUMBER,
}
#: Shorter descriptions are letters of formulas.
_BRIEF = 9

_UNIT = re.compile(
    r"(?:^|[,\s])(" + "|".join(sorted(map(re.escape, _UNITS), key=len, reverse=True)) + r")"
    r"(?=\s*[.(;,:]|$)"
)


@dataclass(frozen=True)
class Plain:
    """A number of which the field's description states no unit, or no range.

    Parameters
    ----------
    dimension : Dimension or None
        None where no unit is stated: such a number is given in SI alone.
    """

    dimension: Dimension | None = None

    def read(self, value: object) -> float:
        """The number in SI.

        Parameters
        ----------
        value : float or str
            SI, or text with its unit where the description states one.

        Raises
        ------
        PydanticCustomError
            No number, or of another dimension.
        """
        if self.dimension is None and isinstance(value, str):
            raise PydanticCustomError(
                "unit",
                "{problem}",
                {
                    "problem": f"{shown(value)} has a unit, and the machine states none here.",
                    "remedy": "Give a plain number, SI.",
                },
            )
        return Quantity(self.dimension or units.NUMBER).read(value)


def machine_numbers(machine: object) -> dict[str, Number]:
    """The numbers of a machine that is a frozen dataclass, by path, in the order of its fields.

    Fields of dataclasses within it follow after a dot, entries of tuples in brackets, counted from
    zero: `link_length`, `section.outer_diameter`, `strut_lengths[0]`. A section that is given by
    its sizes has these alone. Units and meanings are read from the descriptions of the classes.

    Parameters
    ----------
    machine : dataclass
    """
    return {n.path: n for n in _of_fields(machine, "", ())}


def changed_machine(machine: Any, values: Mapping[Steps, float]) -> Any:
    """The same machine with other numbers; its own checks are made anew.

    Parameters
    ----------
    machine : dataclass
    values : mapping of steps to float
        In the SI unit of each, any unit.

    Raises
    ------
    ModelError
        What the machine refuses.
    """
    for steps, value in values.items():
        machine = _with(machine, steps, value)
    return machine


def _with(value: Any, steps: Steps, new: float) -> Any:
    """All changes of one object at once would be quicker; there are few."""
    if not steps:
        return new
    step, rest = steps[0], steps[1:]
    if isinstance(value, Section) and value.shape in _SHAPES:
        make, names = _SHAPES[value.shape]
        sizes = dict(zip(names, (size for _, size in value.dimensions), strict=True))
        return make(*(sizes | {str(step): new}).values(), name=value.name)
    if isinstance(value, Mapping):
        return {**value, step: _with(value[step], rest, new)}
    if isinstance(value, tuple):
        return (*value[: int(step)], _with(value[int(step)], rest, new), *value[int(step) + 1 :])
    return replace(value, **{str(step): _with(getattr(value, str(step)), rest, new)})


def _of_fields(value: Any, path: str, steps: Steps) -> Iterator[Number]:
    kind: Any = type(value)
    said = _descriptions(kind)
    for f in fields(value):
        if f.init:
            inner = f"{path}.{f.name}" if path else f.name
            meaning, dimension = said.get(f.name, ("", None))
            if len(meaning) < _BRIEF:
                # a formula's letter, or nothing: the name says more
                meaning = ": ".join(w for w in (f.name.replace("_", " "), meaning) if w)
            yield from _of_value(
                getattr(value, f.name), inner, (*steps, f.name), meaning, dimension
            )


def _of_value(
    value: Any, path: str, steps: Steps, words: str, dimension: Dimension | None
) -> Iterator[Number]:
    if isinstance(value, bool | str) or value is None:
        return
    if isinstance(value, int | float):
        kind: Any = Whole() if isinstance(value, int) and dimension is None else Plain(dimension)
        yield Number(path, value, dimension.unit if dimension else "", words, (steps,), kind)
    elif isinstance(value, Section) and value.shape in _SHAPES:
        for name, (what, size) in zip(_SHAPES[value.shape][1], value.dimensions, strict=True):
            kind = Quantity(units.LENGTH, above=0.0)
            meaning = f"{what} of the {path.rpartition('.')[2].replace('_', ' ')}"
            yield Number(f"{path}.{name}", size, "m", meaning, ((*steps, name),), kind)
    elif isinstance(value, Mapping):
        for key, entry in value.items():
            if isinstance(key, str):
                at = f"{path}.{quoted(key)}"
                yield from _of_value(entry, at, (*steps, key), f"{words}: {key}", dimension)
    elif isinstance(value, tuple):
        for i, entry in enumerate(value):
            at = f"{path}[{i}]"
            yield from _of_value(entry, at, (*steps, i), f"{words} [{i}]", dimension)
    elif is_dataclass(value) and not isinstance(value, type):
        yield from _of_fields(value, path, steps)


@cache
def _descriptions(kind: Hashable) -> dict[str, tuple[str, Dimension | None]]:
    """Meaning and dimension of the fields that a class and its bases describe."""
    found: dict[str, tuple[str, Dimension | None]] = {}
    for base in reversed(getattr(kind, "__mro__", ())):
        text = inspect.cleandoc(base.__doc__ or "")
        _, _, section = text.partition("Parameters\n----------\n")
        entry: list[str] = []
        names: list[str] = []
        for line in [*section.split("\n\n")[0].splitlines(), "end : of them"]:
            if line.startswith(" "):
                entry.append(line.strip())
                continue
            for name in names:
                found[name] = _meaning(" ".join(entry))
            names, entry = [n.strip() for n in line.partition(" : ")[0].split(",")], []
    return found


def _meaning(text: str) -> tuple[str, Dimension | None]:
    """What the first sentence says beside the unit, which any sentence may state."""
    unit = _UNIT.search(text)
    plain = (text[: unit.start()] + text[unit.end() :]) if unit else text
    plain = re.sub(r"\s*\([^()]*\)", "", plain)
    words = re.split(r"[.;:](?:\s|$)", plain)[0].replace(",,", ",").strip(" ,")
    return words, _UNITS[unit[1]] if unit else None
