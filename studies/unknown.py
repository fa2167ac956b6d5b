"""A number of a machine that a calibration finds, with its bounds and what is known before."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import exp, log, sqrt
from typing import Any

from strutwork.errors import ModelError
from strutwork.studies import calibration_problem
from strutwork.studies.dimension import Dimension
from strutwork.studies.parameter import Parameter, Varied, varied
from strutwork.studies.parametric import Parametric

#: Bounds of a positive number where the file states none: so many times the guess either way.
FACTOR = 10.0


@dataclass(frozen=True)
class Moving(Dimension):
    """A number along which a machine is differentiated: a value, or a factor of several.

    Parameters
    ----------
    stated : mapping of path to float
        What the machine states, any unit; empty where the value itself moves.
    """

    stated: Mapping[str, float] = field(default_factory=dict)

    def moved(self, step: float) -> dict[str, float]:
        """Its numbers moved by a step, SI.

        Parameters
        ----------
        step : float
            In the parameter's unit.
        """
        if not self.stated:
            return super().moved(step)
        return {path: value * (self.value + step) for path, value in self.stated.items()}


@dataclass(frozen=True)
class Unknown:
    """A number that is to be found.

    Parameters
    ----------
    parameter : strutwork.studies.calibration_problem.Parameter
        Name, guess, bounds and scale.
    varied : Varied
        What it changes in the machine.
    prior : float or None
        Standard deviation of what is known before about the scaled number, no unit.
    """

    parameter: calibration_problem.Parameter
    varied: Varied
    prior: float | None = None

    @classmethod
    def of(
        cls,
        machine: Parametric,
        path: Any,
        guess: Any = None,
        bounds: tuple[Any, Any] | None = None,
        *,
        prior: float | None = None,
        relative: bool = False,
        scale: str | None = None,
        name: str = "",
    ) -> Unknown:
        """An unknown of a machine.

        Parameters
        ----------
        machine : Parametric
        path : str or sequence of str
            All that match take one value.
        guess : float or str, optional
            SI or text with its unit; default what the machine states, or the factor 1.
        bounds : pair of float or str, optional
            Default a tenth and ten times the guess.
        prior : float, optional
            Standard deviation of the guess as a share of it, no unit.
        relative : bool
            Whether the unknown is a factor of what the machine states.
        scale : "log" or "linear", optional
            Default by factors where both bounds are positive.
        name : str
            Default the first path.

        Raises
        ------
        ModelError
            No such path, bounds that do not enclose the guess, bounds that are missing, a
            logarithm of what is not positive.
        UnitError
            A value of another dimension.
        """
        numbers = [
            n for p in ([path] if isinstance(path, str) else path) for n in machine.matching(p)
        ]
        stated = [n.value for n in numbers]
        label = name or (path if isinstance(path, str) else path[0])
        if guess is None:
            guess = 1.0 if relative else sum(stated) / len(stated)
        if bounds is None:
            only = varied(machine, [Parameter(path, [guess], relative=relative, name=name)])[0]
            guess = only.values[0]
            if guess <= 0:
                raise ModelError(
                    f"parameter {label}",
                    f"has the guess {guess:g} and no range.",
                    'Give range = ["LOW", "HIGH"].',
                )
            bounds = (guess / FACTOR, guess * FACTOR)
        one = varied(machine, [Parameter(path, (), *bounds, relative=relative, name=name)])[0]
        if isinstance(guess, str):
            given = Parameter(path, [guess], relative=relative, name=name)
            guess = varied(machine, [given])[0].values[0]
        low, high = float(one.low or 0.0), float(one.high or 0.0)
        kind: Any = scale or ("log" if low > 0 else "linear")
        parameter = calibration_problem.Parameter(one.name, float(guess), low, high, one.unit, kind)
        if prior is not None and kind == "linear":
            prior = parameter.scaled(abs(float(guess)) * prior)
            if prior == 0:
                raise ModelError(
                    f"parameter {one.name}",
                    "has a prior that is a share of the guess 0.",
                    "Leave the prior out; the range bounds the value.",
                )
        return cls(parameter, one, prior)

    @property
    def name(self) -> str:
        """Of the parameter."""
        return self.parameter.name

    @property
    def vague(self) -> float:
        """The prior's standard deviation, or that of a value that lies anywhere between the bounds.

        Of the scaled number, no unit.
        """
        if self.prior is not None:
            return self.prior
        p = self.parameter
        return (p.scaled(p.high) - p.scaled(p.low)) / sqrt(12.0)

    def rate(self, value: float) -> float:
        """Change of the value per change of the scaled number, in its unit.

        Parameters
        ----------
        value : float
            In the parameter's own unit.
        """
        p = self.parameter
        return value if p.scale == "log" else p.high - p.low

    def moving(self, value: float) -> Moving:
        """The direction in which the machine is differentiated.

        Parameters
        ----------
        value : float
            In the parameter's own unit.
        """
        stated = {n.path: n.value for n in self.varied.numbers} if self.varied.relative else {}
        numbers = {self.name: value} if stated else self.varied.changes(value)
        return Moving(self.name, numbers, self.varied.unit, self.varied.meaning, stated)

    def interval(self, value: float, deviation: float, wide: float) -> tuple[float, float]:
        """The value less and plus so many deviations of the scaled number, in its unit.

        Parameters
        ----------
        value : float
            In the parameter's own unit.
        deviation : float
            Of the scaled number, no unit.
        wide : float
            How many deviations, no unit.
        """
        p = self.parameter
        if p.scale == "log":
            # what is not known has no end that a double could state
            reach = min(wide * deviation, 700.0 - abs(log(value)))
            return value * exp(-reach), value * exp(reach)
        reach = wide * deviation * (p.high - p.low)
        return value - reach, value + reach


def check_unknowns(unknowns: tuple[Unknown, ...]) -> None:
    """Refuse unknowns that share a number or a name.

    Parameters
    ----------
    unknowns : tuple of Unknown

    Raises
    ------
    ModelError
        None at all; two of a name, or two that change one number.
    """
    if not unknowns:
        raise ModelError("parameters", "are none.", "Add [[parameters]] with a path.")
    owner: dict[str, str] = {}
    names: list[str] = []
    for one in unknowns:
        if one.name in names:
            raise ModelError(f"parameter {one.name}", "is named twice.", "Give each its own name.")
        names.append(one.name)
        for number in one.varied.numbers:
            if number.path in owner:
                raise ModelError(
                    f"parameter {one.name}",
                    f"changes {number.path}, as the parameter {owner[number.path]} does.",
                    "Change each number by one parameter.",
                )
            owner[number.path] = one.name
