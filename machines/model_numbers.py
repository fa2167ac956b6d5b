"""Every number of a model file by its path, with its unit and its meaning."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from strutwork.errors import ModelError, UnitError
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model_descriptions import DESCRIPTIONS
from strutwork.machines.model_fields import Quantity
from strutwork.machines.model_schema import ModelTable
from strutwork.names import listed
from strutwork.units import shown

#: Where a number stands: fields, keys and places of lists from the whole file down.
Steps = tuple[str | int, ...]

#: Tables of the file that say what the numbers within are; others name parts, which say it.
_SAID = frozenset({"home", "workspace", "damping", "process"})

#: What makes a name ambiguous within a path.
_QUOTED = re.compile(r"[.\"*\[\]]|^\s|\s$")


@dataclass(frozen=True)
class Whole:
    """A whole number within bounds.

    Parameters
    ----------
    low, high : int or None
        Any unit.
    """

    low: int | None = None
    high: int | None = None

    def read(self, value: object) -> int:
        """The whole number itself.

        Parameters
        ----------
        value : int or float
            Without unit.

        Raises
        ------
        PydanticCustomError
            It is not whole, or out of range.
        """
        low, high = self.low, self.high
        if (
            isinstance(value, int | float)
            and not isinstance(value, bool)
            and value == int(value if isfinite(value) else 0)
            and (low is None or value >= low)
            and (high is None or value <= high)
        ):
            return int(value)
        bounds = [] if low is None else [f"of at least {low}"]
        bounds += [] if high is None else [f"of at most {high}"]
        raise PydanticCustomError(
            "range",
            "{problem}",
            {
                "problem": f"{shown(value)} is not such a number.",
                "remedy": " ".join(["Give a whole number", listed(bounds)]).strip() + ".",
            },
        )


@dataclass(frozen=True)
class Number:
    """A number that can be changed.

    Parameters
    ----------
    path : str
        As `sections.strut.outer_diameter`.
    value : float
        In `unit`, which may be any unit.
    unit : str
        The SI unit; empty for a pure number.
    meaning : str
    places : tuple of steps
        Where it stands; an entry of a symmetric matrix and its mirror have two.
    kind : Quantity or Whole
        What it may be.
    """

    path: str
    value: float
    unit: str
    meaning: str
    places: tuple[Steps, ...]
    kind: Any

    def read(self, value: object) -> float:
        """A new value in SI.

        Parameters
        ----------
        value : float or str
            SI, or text with its unit.

        Raises
        ------
        ModelError, UnitError
            Another dimension, out of range, not finite; names the path.
        """
        try:
            number: float = self.kind.read(value)
        except PydanticCustomError as error:
            made = UnitError if error.type == "unit" else ModelError
            context = error.context or {}
            raise made(self.path, str(context["problem"]), str(context["remedy"])) from None
        return number


def model_numbers(tables: ModelTable) -> dict[str, Number]:
    """The numbers that a model file states, by path, in its order.

    Parts that have names go by them, others by their place in the list, counted from zero:
    `joints.hinge1.stiffness.rx`, `masses[0].mass`. Components of vectors are x, y and z, ends of a
    range low and high; of a symmetric matrix there is `inertia.x.y`, and no `inertia.y.x`. A name
    with a dot, star, bracket or quotation mark stands in quotation marks.

    Parameters
    ----------
    tables : ModelTable
    """
    found: dict[str, Number] = {}
    for number in _of_table(tables, "", (), ()):
        found[number.path] = number
    return found


def changed_tables(tables: ModelTable, values: Mapping[Steps, float]) -> ModelTable:
    """Tables with other numbers; those that are not changed are shared, not copied.

    Parameters
    ----------
    tables : ModelTable
    values : mapping of steps to float
        In the SI unit of each, any unit; within the range of its field.
    """
    if not values:
        return tables
    tree: dict[str | int, Any] = {}
    for steps, value in values.items():
        at = tree
        for step in steps[:-1]:
            at = at.setdefault(step, {})
        at[steps[-1]] = value
    made: ModelTable = _changed(tables, tree)
    return made


def _changed(value: Any, tree: Mapping[Any, Any]) -> Any:
    new = {
        step: _changed(_at(value, step), branch) if isinstance(branch, dict) else branch
        for step, branch in tree.items()
    }
    if isinstance(value, BaseModel):
        return value.model_copy(update=new)
    if isinstance(value, dict):
        return value | new
    entries = list(value)
    for i, entry in new.items():
        entries[i] = entry
    return tuple(entries)


def _at(value: Any, step: str | int) -> Any:
    return getattr(value, str(step)) if isinstance(value, BaseModel) else value[step]


def quoted(name: str) -> str:
    """A name as a path spells it.

    Parameters
    ----------
    name : str
    """
    return json.dumps(name, ensure_ascii=False) if _QUOTED.search(name) else name


def _of_table(
    table: BaseModel, path: str, steps: Steps, words: tuple[str, ...]
) -> Iterator[Number]:
    said = DESCRIPTIONS[type(table).__name__]
    for name, field in type(table).model_fields.items():
        value = getattr(table, name)
        if name not in table.model_fields_set or value is None:
            continue
        key = field.alias or name
        inner = f"{path}.{key}" if path else key
        more = (*words, said[key].partition(";")[0])
        yield from _of_value(value, _annotation(field), inner, (*steps, name), more)


def _of_value(
    value: Any, annotation: Any, path: str, steps: Steps, words: tuple[str, ...]
) -> Iterator[Number]:
    annotation, kind = _plain(annotation)
    if isinstance(value, BaseModel):
        part = len(steps) == 2 and steps[0] not in _SAID
        yield from _of_table(value, path, steps, () if part else words)
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from _of_value(
                entry, get_args(annotation)[1], f"{path}.{quoted(key)}", (*steps, key), words
            )
    elif isinstance(value, tuple):
        yield from _of_tuple(value, annotation, path, steps, words)
    elif isinstance(value, int | float) and not isinstance(value, bool) and kind is not None:
        unit = kind.dimension.unit if isinstance(kind, Quantity) else ""
        yield Number(path, value, unit, ": ".join(words), (steps,), kind)


def _of_tuple(
    value: tuple[Any, ...], annotation: Any, path: str, steps: Steps, words: tuple[str, ...]
) -> Iterator[Number]:
    kinds = get_args(annotation)
    if kinds[-1:] == (Ellipsis,):
        for i, entry in enumerate(value):
            name = getattr(entry, "name", None)
            inner = f"{path}.{quoted(name)}" if isinstance(name, str) else f"{path}[{i}]"
            yield from _of_value(entry, kinds[0], inner, (*steps, i), words)
        return
    names = ("low", "high") if len(value) == 2 else DIRECTIONS
    matrix = len(value) > 2 and all(isinstance(row, tuple) for row in value)
    for i, (entry, inner) in enumerate(zip(value, kinds, strict=True)):
        at = f"{path}.{names[i]}"
        if not matrix:
            yield from _of_value(entry, inner, at, (*steps, i), (*words, names[i]))
            continue
        columns = get_args(_plain(inner)[0])
        for j in range(i, len(value)):
            places = dict.fromkeys(((*steps, i, j), (*steps, j, i)))
            _, kind = _plain(columns[j])
            meaning = ": ".join((*words, f"{names[i]}, {names[j]}"))
            unit = kind.dimension.unit if isinstance(kind, Quantity) else ""
            yield Number(f"{at}.{names[j]}", entry[j], unit, meaning, tuple(places), kind)


def _annotation(field: FieldInfo) -> Any:
    """The type of a field with what marks it."""
    marks = tuple(field.metadata)
    return Annotated[(field.annotation, *marks)] if marks else field.annotation


def _plain(annotation: Any) -> tuple[Any, Quantity | Whole | None]:
    """A type without None and marks, and what its number may be."""
    marks: list[Any] = []
    while True:
        if get_origin(annotation) is Annotated:
            annotation, *more = get_args(annotation)
            marks += more
        elif get_origin(annotation) in (Union, UnionType):
            one = [a for a in get_args(annotation) if a is not type(None)]
            if len(one) != 1:
                return annotation, None
            annotation = one[0]
        else:
            break
    # pydantic keeps bounds among other marks in a FieldInfo of its own
    marks = [
        m for mark in marks for m in (mark.metadata if isinstance(mark, FieldInfo) else [mark])
    ]
    for mark in marks:
        if isinstance(mark, Quantity):
            return annotation, mark
    if annotation is not int:
        return annotation, None
    bounds = {
        side: next((int(getattr(m, side)) for m in marks if hasattr(m, side)), None)
        for side in ("ge", "le")
    }
    return annotation, Whole(bounds["ge"], bounds["le"])
