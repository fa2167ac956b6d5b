"""What a calibration varies and what it is to meet, and the residuals between."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite, log
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]

#: What a model takes and gives: numbers by name.
Model = Callable[[Mapping[str, float]], Mapping[str, float]]


@dataclass(frozen=True)
class Parameter:
    """A number to be determined.

    Parameters
    ----------
    name : str
    start, low, high : float
        In its unit.
    unit : str
    scale : "log" or "linear"
        "log": varied by factors, for numbers that are positive by nature.

    Raises
    ------
    ModelError
        Bounds that do not enclose the start, or a logarithm of what is not positive.
    """

    name: str
    start: float
    low: float
    high: float
    unit: str = ""
    scale: Literal["log", "linear"] = "log"

    def __post_init__(self) -> None:
        part = f"parameter {self.name}"
        if not all(isfinite(v) for v in (self.start, self.low, self.high)):
            raise ModelError(part, "has a bound that is not finite.", "Give finite numbers.")
        if not (self.low < self.high and self.low <= self.start <= self.high):
            raise ModelError(
                part,
                f"starts at {self.start:g}, and its range is {self.low:g} to {self.high:g}.",
                "Give the lower end first, and a first guess within the range.",
            )
        if self.scale == "log" and self.low <= 0:
            raise ModelError(
                part, f"its lower bound is {self.low:g}.", 'Give a positive one, or scale="linear".'
            )

    def scaled(self, value: float) -> float:
        """The number that is varied, no unit.

        Parameters
        ----------
        value : float
            In the parameter's own unit.
        """
        return log(value) if self.scale == "log" else value / (self.high - self.low)

    def value(self, scaled: float) -> float:
        """The inverse of `scaled`, kept within the bounds against rounding.

        Parameters
        ----------
        scaled : float
            No unit.
        """
        number = np.exp(scaled) if self.scale == "log" else scaled * (self.high - self.low)
        return float(min(max(number, self.low), self.high))


@dataclass(frozen=True)
class Target:
    """A number to be met.

    Parameters
    ----------
    name : str
        As the model names it.
    value : float
        In its unit.
    uncertainty : float
        Standard deviation, in the value's unit: the weight is its inverse.
    unit : str

    Raises
    ------
    ModelError
        An uncertainty that is not positive.
    """

    name: str
    value: float
    uncertainty: float
    unit: str = ""

    def __post_init__(self) -> None:
        if not (isfinite(self.value) and isfinite(self.uncertainty) and self.uncertainty > 0):
            raise ModelError(
                f"target {self.name}",
                f"is {self.value!r} with the uncertainty {self.uncertainty!r}.",
                "Give finite numbers and a positive uncertainty.",
            )


class Problem:
    """The residuals of a model over scaled parameters.

    Parameters
    ----------
    model : callable
    parameters : tuple of Parameter
    targets : tuple of Target
    step : float
        Of the differences, in scaled parameters, no unit.

    Attributes
    ----------
    bounds : (p,), (p,)
        Lowest and highest scaled parameters.
    evaluations : int
        Of the model so far.
    """

    def __init__(
        self,
        model: Model,
        parameters: tuple[Parameter, ...],
        targets: tuple[Target, ...],
        step: float,
    ) -> None:
        self.model, self.parameters, self.targets, self.step = model, parameters, targets, step
        self.bounds = (
            np.array([p.scaled(p.low) for p in parameters]),
            np.array([p.scaled(p.high) for p in parameters]),
        )
        self.evaluations = 0
        self._last: tuple[bytes, Array] = (b"", np.zeros(0))

    def values(self, point: Array) -> dict[str, float]:
        """Parameters by name; not a number stays so.

        Parameters
        ----------
        point : (p,)
            Scaled parameters, no unit.
        """
        return {
            p.name: p.value(x) if isfinite(x) else x
            for p, x in zip(self.parameters, point, strict=True)
        }

    def computed(self, point: Array) -> Array:
        """The model's targets, (t,), each in its own unit.

        Parameters
        ----------
        point : (p,)
            Scaled parameters, no unit.
        """
        self.evaluations += 1
        given = self.model(self.values(point))
        missing = [t.name for t in self.targets if t.name not in given]
        if missing:
            raise ModelError(
                f"target {missing[0]}",
                f"is not among the results of the model: {', '.join(given)}.",
                "Name it as the model does.",
            )
        result = np.array([given[t.name] for t in self.targets], dtype=float)
        if not np.isfinite(result).all():
            raise NumericalError("model", "gave a number that is not finite.", "Narrow the bounds.")
        return result

    def residuals(self, point: Array) -> Array:
        """(computed − target) / uncertainty, (t,).

        Parameters
        ----------
        point : (p,)
            Scaled parameters, no unit.
        """
        wanted = np.array([t.value for t in self.targets])
        found = (self.computed(point) - wanted) / [t.uncertainty for t in self.targets]
        self._last = (point.tobytes(), found)
        return np.asarray(found)

    def slopes(self, point: Array) -> Array:
        """Forward differences of the residuals, (t, p), backward at an upper bound: one run each.

        Parameters
        ----------
        point : (p,)
            Scaled parameters, no unit.
        """
        key, base = self._last
        if key != point.tobytes():
            base = self.residuals(point)
        columns = []
        for i in range(len(point)):
            moved = point.copy()
            moved[i] += self.step if point[i] + self.step <= self.bounds[1][i] else -self.step
            columns.append((self.residuals(moved) - base) / (moved[i] - point[i]))
        return np.stack(columns, axis=1)

    def jacobian(self, point: Array) -> Array:
        """Central differences of the residuals, (t, p); one-sided at a bound.

        Parameters
        ----------
        point : (p,)
            Scaled parameters, no unit.
        """
        low, high = self.bounds
        columns = []
        for i in range(len(point)):
            ahead, behind = point.copy(), point.copy()
            ahead[i] = min(point[i] + self.step, high[i])
            behind[i] = max(point[i] - self.step, low[i])
            change = self.residuals(ahead) - self.residuals(behind)
            columns.append(change / (ahead[i] - behind[i]))
        return np.stack(columns, axis=1)
