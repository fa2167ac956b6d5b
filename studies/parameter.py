"""What a study varies: numbers of a machine by their path, and the values they take."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.model_numbers import Number
from strutwork.names import visible
from strutwork.studies.distribution import Distribution, distribution, is_share
from strutwork.studies.independent import groups
from strutwork.studies.parametric import Parametric

Array = NDArray[Any]

#: A value as a study states it: SI, or text with its unit.
Value = float | str

#: Points of a grid along a range, where nothing else is said.
POINTS = 5


@dataclass(frozen=True)
class Parameter:
    """Numbers that change together in a study; values or a range.

    Parameters
    ----------
    path : str or sequence of str
        Of `Parametric.paths`; a star stands for any characters. All that match take one value.
    values : sequence of float or str
        SI, or text with its unit; empty where a range is given.
    low, high : float or str, optional
        Ends of a range, SI or text with its unit.
    points : int
        On a grid over a range.
    relative : bool
        The values are factors of what the machine states, as 1.1 for 10 % more.
    log : bool
        The range is divided by ratios, not by differences.
    name : str
        In the result; the first path by default.
    distribution : str
        Of `strutwork.studies.distribution.DISTRIBUTIONS`: the values scatter about the mean; a
        range then states the ends of a uniform or truncated one.
    mean, scatter : float or str, optional
        Of the distribution, SI or text with its unit; what the machine states by default. The
        scatter is the standard deviation, or half the width of a uniform one; "10 %" is a share of
        the mean.
    independent : bool
        What stands for the first star of the path varies by itself: each joint of
        `joints.ball*.stiffness.*`, its directions together.
    """

    path: str | Sequence[str]
    values: Sequence[Value] = ()
    low: Value | None = None
    high: Value | None = None
    points: int = POINTS
    relative: bool = False
    log: bool = False
    name: str = ""
    distribution: str = ""
    mean: Value | None = None
    scatter: Value | None = None
    independent: bool = False

    @classmethod
    def of(cls, path: str, what: object) -> Parameter:
        """A parameter from what stands beside its path: a pair is a range, a list are values.

        Parameters
        ----------
        path : str
        what : tuple of two, list or Parameter
            SI, or texts with their units.

        Raises
        ------
        ModelError
            Something else.
        """
        if isinstance(what, Parameter):
            return what
        if isinstance(what, tuple) and len(what) == 2:
            return cls(path, low=what[0], high=what[1])
        if isinstance(what, str | int | float):
            return cls(path, values=[what])
        if not isinstance(what, Iterable):
            raise ModelError(
                f"parameter {path}",
                f"is given a {type(what).__name__}.",
                "Give a list of values, or a pair (low, high).",
            )
        return cls(path, values=list(what))


@dataclass(frozen=True)
class Varied:
    """A parameter of one machine, its values in SI.

    Parameters
    ----------
    name, unit, meaning : str
        The unit is that of the values: none of a factor.
    numbers : tuple of Number
        What it changes.
    values : tuple of float
        In `unit`, any unit; empty for a range.
    low, high : float or None
        Ends of the range, any unit.
    points : int
    relative, log : bool
    distribution : Distribution or None
        Of its values, in `unit`.
    """

    name: str
    unit: str
    meaning: str
    numbers: tuple[Number, ...]
    values: tuple[float, ...]
    low: float | None
    high: float | None
    points: int
    relative: bool
    log: bool
    distribution: Distribution | None = None

    @property
    def grid(self) -> Array:
        """Its values, or points over its range, (n,), any unit."""
        if self.values:
            return np.array(self.values)
        return self.scaled(np.linspace(0.0, 1.0, self.points))

    def scaled(self, share: Array) -> Array:
        """Places of a range, (n,), any unit, from shares of it between 0 and 1.

        Of a distribution it is the value below which that share of all values lies.

        Parameters
        ----------
        share : (n,)
            No unit.
        """
        if self.distribution is not None:
            return self.distribution.at(share)
        low, high = self.low or 0.0, self.high or 0.0
        if self.log:
            return np.asarray(np.exp(np.log(low) + share * (np.log(high) - np.log(low))))
        # both ends come out exactly
        return np.asarray((1.0 - share) * low + share * high)

    def changes(self, value: float) -> dict[str, float]:
        """What one value makes of each number, SI.

        Parameters
        ----------
        value : float
            In `unit`, any unit.
        """
        return {n.path: n.value * value if self.relative else value for n in self.numbers}

    @property
    def settings(self) -> dict[str, Any]:
        """What it is, as plain values."""
        plain = {"paths": [n.path for n in self.numbers], "unit": self.unit}
        more = {"relative": True} if self.relative else {}
        if self.distribution is not None:
            return plain | {"distribution": self.distribution.settings} | more
        return {
            **plain,
            **({"values": list(self.values)} if self.values else {"range": [self.low, self.high]}),
            **({"points": self.points} if not self.values else {}),
            **more,
            **({"log": True} if self.log else {}),
        }


def varied(machine: Parametric, parameters: Sequence[Parameter]) -> tuple[Varied, ...]:
    """The parameters of a machine, checked.

    Parameters
    ----------
    machine : Parametric
    parameters : sequence of Parameter

    Raises
    ------
    ModelError
        No parameter; a path that names nothing or a number of another parameter; no values, or
        both values and a range; a range the wrong way round; a value out of its field's range.
    UnitError
        A value of another dimension.
    """
    if not parameters:
        raise ModelError("parameters", "are none.", "Name one at least, with values or a range.")
    found = tuple(one for p in parameters for one in _varied(machine, p))
    owner: dict[str, str] = {}
    for one in found:
        for number in one.numbers:
            if number.path in owner:
                raise ModelError(
                    f"parameter {one.name}",
                    f"changes {visible(number.path)}, as the parameter "
                    f"{visible(owner[number.path])} does.",
                    "Change each number by one parameter.",
                )
            owner[number.path] = one.name
    names = [one.name for one in found]
    for name in names:
        if names.count(name) > 1:
            raise ModelError(f"parameter {name}", "is named twice.", "Give each its own name.")
    return found


def _varied(machine: Parametric, parameter: Parameter) -> list[Varied]:
    paths = [parameter.path] if isinstance(parameter.path, str) else list(parameter.path)
    if not paths:
        raise ModelError("parameter", "names no path.", 'Give path = "sections.strut.diameter".')
    if parameter.independent:
        return [
            _one(
                parameter,
                re.sub("/", "|", f"{parameter.name} {match}" if parameter.name else name),
                {n.path: n for n in numbers},
            )
            for name, match, numbers in groups(machine, paths)
        ]
    numbers = {n.path: n for path in paths for n in machine.matching(path)}
    return [_one(parameter, parameter.name or re.sub("/", "|", paths[0]), numbers)]


def _one(parameter: Parameter, name: str, numbers: Mapping[str, Number]) -> Varied:
    part = f"parameter {name}"
    if parameter.distribution:
        return _distributed(parameter, name, tuple(numbers.values()))
    if parameter.mean is not None or parameter.scatter is not None:
        raise ModelError(
            part, "has a mean or scatter without a distribution.", 'Give distribution = "normal".'
        )
    kinds = {n.unit for n in numbers.values()}
    if len(kinds) > 1 and not parameter.relative:
        raise ModelError(
            part,
            f"changes numbers of different units, {' and '.join(sorted(kinds))}.",
            "Give factors with relative = true, or name numbers of one unit.",
        )
    ranged = parameter.low is not None or parameter.high is not None
    if ranged == bool(len(parameter.values)):
        raise ModelError(
            part,
            "has both values and a range." if ranged else "has neither values nor a range.",
            'Give values = [...], or range = ["LOW", "HIGH"].',
        )

    def read(value: Any) -> float:
        if isinstance(value, np.generic):
            value = value.item()
        return _read(part, tuple(numbers.values()), value, relative=parameter.relative)

    values = tuple(read(v) for v in parameter.values)
    low = high = None
    if ranged:
        if parameter.low is None or parameter.high is None:
            raise ModelError(part, "has a range with one end.", "Give low and high.")
        low, high = read(parameter.low), read(parameter.high)
        if not low < high:
            raise ModelError(
                part, f"has a range from {low:g} to {high:g}.", "Give the lower end first."
            )
        if parameter.log and low <= 0.0:
            raise ModelError(
                part, f"has a logarithmic range that begins at {low:g}.", "Begin above zero."
            )
        if parameter.points < 2:
            raise ModelError(part, f"has {parameter.points} points.", "Give two at least.")
    every = tuple(numbers.values())
    return Varied(
        name,
        "" if parameter.relative else every[0].unit,
        _meaning(every, relative=parameter.relative),
        every,
        values,
        low,
        high,
        parameter.points,
        parameter.relative,
        parameter.log,
    )


def _meaning(numbers: tuple[Number, ...], *, relative: bool) -> str:
    first = numbers[0]
    more = f", and {len(numbers) - 1} more" if len(numbers) > 1 else ""
    return f"factor of {first.path}{more}" if relative else f"{first.meaning}{more}"


def _distributed(parameter: Parameter, name: str, numbers: tuple[Number, ...]) -> Varied:
    """A parameter with a distribution: of the number, or of a factor where there are several."""
    part = f"parameter {name}"
    if parameter.values or parameter.log:
        what = "values" if parameter.values else "log = true"
        raise ModelError(part, f"has {what} beside a distribution.", "Leave one of them out.")
    several = len({(n.value, n.unit) for n in numbers}) > 1
    shares = is_share(parameter.scatter) and parameter.mean is None and parameter.low is None
    relative = parameter.relative or (several and shares)
    if several and not relative:
        raise ModelError(
            part,
            f"scatters {len(numbers)} numbers of different values together.",
            'Give scatter = "10 %" of each, relative = true, or independent = true.',
        )
    if (parameter.low is None) != (parameter.high is None):
        raise ModelError(part, "has a range with one end.", "Give low and high.")
    stated = (parameter.mean, parameter.scatter, parameter.low, parameter.high)
    law = distribution(part, parameter.distribution, numbers, stated, relative=relative)
    return Varied(
        name,
        "" if relative else numbers[0].unit,
        _meaning(numbers, relative=relative),
        numbers,
        (),
        None,
        None,
        parameter.points,
        relative,
        log=False,
        distribution=law,
    )


def _read(part: str, numbers: tuple[Number, ...], value: Value, *, relative: bool) -> float:
    if not relative:
        # each has a range of its own
        every = [number.read(value) for number in numbers]
        return every[0]
    if not isinstance(value, int | float) or isinstance(value, bool) or not np.isfinite(value):
        raise ModelError(
            part, f"has the factor {value!r}.", "Give a plain number, as 1.1 for 10 % more."
        )
    for number in numbers:
        number.read(number.value * value)
    return float(value)


def parameters_of(given: Mapping[str, object] | Sequence[Parameter]) -> tuple[Parameter, ...]:
    """Parameters as a study in Python states them.

    Parameters
    ----------
    given : mapping of path to values, or sequence of Parameter
        A list of values, a pair for a range.
    """
    if isinstance(given, Mapping):
        return tuple(Parameter.of(path, what) for path, what in given.items())
    return tuple(given)
