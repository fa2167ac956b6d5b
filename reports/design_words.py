"""A design in words: its extremes, and how the machine as described compares."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from strutwork.names import listed
from strutwork.reports.numbers import count
from strutwork.reports.study_words import machine_words, read_value, reading, title_of
from strutwork.studies.design_table import design_objectives, design_parameters
from strutwork.studies.study_table import NumberColumn


def on_front(column: NumberColumn, found: xr.Dataset) -> NumberColumn:
    """A column of the machines of the front alone, in order."""
    return replace(column, values=column.values[found["front"].to_numpy()])


def unit_of(column: NumberColumn, found: xr.Dataset) -> tuple[str, float]:
    """The unit in which a column is read, and its factor from SI; a currency of cost."""
    unit, factor = reading(column)
    return str(found[column.name].attrs.get("currency", unit)), factor


def value_words(column: NumberColumn, value: float, found: xr.Dataset, digits: int = 4) -> str:
    """A value with its unit."""
    currency = found[column.name].attrs.get("currency")
    if currency:
        return f"{value:.{digits}g} {currency}"
    return read_value(column, value, digits)


def rounds_words(found: xr.Dataset) -> str:
    """How many machines were made, and how: "24 machines in 3 generations"."""
    machines = count(int(found.sizes["machine"]), "machine")
    rounds, method = int(found.attrs["generations"]), str(found.attrs.get("method", ""))
    if method.startswith("SLSQP"):
        return f"{machines} along the gradients from {count(rounds, 'start')} (SLSQP)"
    if "SLSQP" in method:
        return (
            f"{machines} in {count(rounds - 1, 'generation')} and along the gradients from the "
            "front (SLSQP)"
        )
    return f"{machines} in {count(rounds, 'generation')}"


def starts_words(found: xr.Dataset) -> str:
    """Where each start along gradients ends: all at one machine, or not; empty of other methods."""
    if not str(found.attrs.get("method", "")).startswith("SLSQP"):
        return ""
    (column, goal), *_ = design_objectives(found)
    good = found["status"].to_numpy() == 0
    generation = found["generation"].to_numpy()
    ends = []
    for number in range(1, int(found.attrs["generations"]) + 1):
        values = column.values[good & (generation == number)]
        best = (values.min() if goal == "minimise" else values.max()) if values.size else np.nan
        ends.append(float(best))
    known = [e for e in ends if np.isfinite(e)]
    said = []
    if len(known) < len(ends):
        said.append(f"{count(len(ends) - len(known), 'start')} ended at no feasible machine.")
    shown = list(dict.fromkeys(value_words(column, e, found) for e in known))
    if len(known) > 1 and len(shown) == 1:
        said.append(f"{len(known)} starts ended at the same {title_of(column)}.")
    if len(shown) > 1:
        said.append(f"The starts ended at {listed(shown)}: with more of them it may become better.")
    return " ".join(said)


def extremes(found: xr.Dataset) -> list[tuple[str, str, str]]:
    """For each objective: its title with the goal, its best value, and the machine that has it."""
    parameters = [on_front(p, found) for p in design_parameters(found)]
    said = []
    for column, goal in design_objectives(found):
        values = on_front(column, found).values
        row = int((np.argmin if goal == "minimise" else np.argmax)(values))
        way = "Least" if goal == "minimise" else "Largest"
        said.append(
            (
                f"{way} {title_of(column)}",
                value_words(column, float(values[row]), found),
                f"machine {row + 1} of the front ({machine_words(parameters, row, 3)})",
            )
        )
    return said


def better(found: xr.Dataset) -> list[int]:
    """Machines of the front, from one, that are at least as good as the described one in all."""
    wins = np.ones(found.sizes["front"], dtype=bool)
    for column, goal in design_objectives(found):
        stated = float(found[column.name].attrs["stated"])
        values = on_front(column, found).values
        wins &= values <= stated if goal == "minimise" else values >= stated
    return (np.flatnonzero(wins) + 1).tolist()


def comparison(found: xr.Dataset) -> tuple[str, str, str]:
    """How the machine as described stands beside the front: a sentence in three parts.

    The one in the middle names machines of the front.
    """
    objectives = design_objectives(found)
    stated = [float(found[c.name].attrs["stated"]) for c, _ in objectives]
    if not np.isfinite(stated).all():
        return "The machine as described has no value of some objective.", "", ""
    words = ", ".join(
        f"{title_of(c)} {value_words(c, v, found)}"
        for (c, _), v in zip(objectives, stated, strict=True)
    )
    numbers = better(found)
    before = f"The machine as described ({words}): "
    if not numbers:
        return before, "no machine", " of the front is at least as good in every objective."
    which = f"machine {numbers[0]}" if len(numbers) == 1 else f"machines {_range(numbers)}"
    verb = "is" if len(numbers) == 1 else "are"
    return before, which, f" of the front {verb} at least as good in every objective."


def _range(numbers: Sequence[int]) -> str:
    if len(numbers) > 2 and numbers[-1] - numbers[0] == len(numbers) - 1:
        return f"{numbers[0]} to {numbers[-1]}"
    return ", ".join(map(str, numbers[:6])) + (" and others" if len(numbers) > 6 else "")


def limits_words(found: xr.Dataset) -> list[str]:
    """The constraints, each in a few words."""
    said = []
    for limit in json.loads(found.attrs["settings"])["constraints"]:
        name = limit["quantity"]
        column = NumberColumn(name, found[name].attrs["units"], found[name].to_numpy(), name)
        words = [
            f"{label} {value_words(column, limit[key], found)}"
            for key, label in (("at_least", "at least"), ("at_most", "at most"))
            if key in limit
        ]
        said.append(f"{title_of(column)} {' and '.join(words)}")
    return said


def machine_code(changes: Mapping[str, float], machine: str) -> str:
    """Python that makes a machine of the catalogue with other numbers."""
    numbers = ", ".join(f"{path!r}: {value:.12g}" for path, value in changes.items())
    return f"strutwork.studies.Parametric.of({machine!r}).model({{{numbers}}})"


def parameter_words(found: xr.Dataset) -> str:
    """The parameters with their ranges or values."""
    settings = json.loads(found.attrs["settings"])["parameters"]
    said = []
    for column, one in zip(design_parameters(found), settings.values(), strict=True):
        if "values" in one:
            values = [value_words(column, v, found) for v in one["values"]]
            said.append(f"{title_of(column)} {' or '.join(values)}")
        else:
            low, high = (value_words(column, v, found) for v in one["range"])
            said.append(f"{title_of(column)} from {low} to {high}")
    return "; ".join(said)
