"""The search along gradients: SLSQP of SciPy (Kraft 1988), from one machine to the best near it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, StrutworkError
from strutwork.studies.design import Design
from strutwork.studies.design_gradient import Gradients
from strutwork.studies.design_quantities import Quantity
from strutwork.studies.design_smooth import AT_HOME, smooth_names
from strutwork.studies.design_terms import Objective

Array = NDArray[np.float64]

#: Change of the objective, as a share, below which it has converged; steps at most.
ACCURACY, STEPS = 1e-10, 100
#: Share by which limits are kept beyond what is asked: rounding breaks none.
MARGIN = 1e-7
#: Targets of a machine that cannot be, beside the last one that could: steps become shorter.
AWAY = 10.0


@dataclass(frozen=True)
class Limit:
    """A limit of a quantity.

    Parameters
    ----------
    quantity : str
    value : float
        Any unit.
    at_least : bool
        Whether the quantity is at least so large, or at most.
    """

    quantity: str
    value: float
    at_least: bool


@dataclass
class Descent:
    """Minimises one objective of a design within limits.

    A quantity that is the least over poses has a limit at each pose, which is smooth where their
    least is not; as an objective it is an unknown of its own that no pose falls below.

    Parameters
    ----------
    design : Design
    objective : Objective
    limits : tuple of Limit
    start : (k,)
        Shares of the ranges of all parameters, no unit; those with a list of values stay.
    visited : list of (k,)
        Shares of every machine that was evaluated, in order.
    """

    design: Design
    objective: Objective
    limits: tuple[Limit, ...]
    start: Array
    visited: list[Array] = field(default_factory=list)

    def __post_init__(self) -> None:
        varied = self.design.varied
        self._along = tuple(i for i, p in enumerate(varied) if not p.values)
        self._gradients = Gradients(self.design, self._along)
        by_name = {q.name: q for q in self.design.quantities}
        goal = by_name[self.objective.quantity.name]
        # the largest least of several poses: the unknown t
        self._several = self.objective.goal == "maximise" and not _single(goal, self.design)
        self._values: tuple[bytes, dict[str, Array]] | None = None
        self._rates: tuple[bytes, dict[str, Array]] | None = None
        self._last: tuple[float, Array] | None = None

    def run(self) -> str:
        """Search; how it ended, in words.

        Raises
        ------
        StrutworkError
            The machine at the start cannot be, or a parameter has no derivative.
        """
        # half a second, for a search alone
        from scipy.optimize import minimize  # noqa: PLC0415

        first = self.start[list(self._along)]
        stated = self._value(first)
        # what has no derivative anywhere is refused now
        self._rate(first)
        own = stated[self.objective.quantity.name]
        self._scale = float(np.abs(own).min()) or 1.0
        x = first
        if self._several:
            x = np.append(first, own.min() / self._scale)
        bounds: list[tuple[float | None, float | None]] = [(0.0, 1.0)] * len(first)
        bounds += [(None, None)] * self._several
        kept = {"type": "ineq", "fun": self._slack, "jac": self._slack_rates}
        try:
            found = minimize(
                self._target,
                x,
                jac=self._target_rates,
                method="SLSQP",
                bounds=bounds,
                constraints=[kept] if self.limits or self._several else [],
                options={"ftol": ACCURACY, "maxiter": STEPS},
            )
        except StrutworkError as error:
            # it stands at a machine that has no gradient
            return f"{error.part}: {error.problem}"
        return str(found.message)

    def _shares(self, x: Array) -> Array:
        shares = self.start.copy()
        shares[list(self._along)] = np.clip(x[: len(self._along)], 0.0, 1.0)
        return shares

    def _value(self, x: Array) -> dict[str, Array]:
        """Values of the quantities.

        Raises
        ------
        StrutworkError
            The machine cannot be.
        """
        shares = self._shares(x)
        key = shares.tobytes()
        if self._values is None or self._values[0] != key:
            self._values = None
            self.visited.append(shares)
            self._values = key, self._gradients.values(self.design.samples(shares[None])[0])
        return self._values[1]

    def _rate(self, x: Array) -> dict[str, Array]:
        """Gradients of the quantities along shares of the ranges."""
        shares = self._shares(x)
        key = shares.tobytes()
        if self._rates is None or self._rates[0] != key:
            found = self._gradients.rates(self.design.samples(shares[None])[0])
            widths = self._widths(shares)[:, None]
            self._rates = key, {name: widths * rate for name, rate in found.items()}
        return self._rates[1]

    def _widths(self, shares: Array) -> Array:
        """What a share of each range is worth, (g,), any unit."""
        sample = self.design.samples(shares[None])[0]
        widths = []
        for i in self._along:
            p = self.design.varied[i]
            low, high = p.low or 0.0, p.high or 0.0
            widths.append(sample[i] * np.log(high / low) if p.log else high - low)
        return np.array(widths)

    def _target(self, x: Array) -> float:
        try:
            values = self._value(x)
        except StrutworkError:
            if self._last is None:
                raise
            return self._last[0] + AWAY * (1.0 + abs(self._last[0]))
        target = -float(x[-1]) if self._several else self._plain(values)
        self._last = target, self._slacks(x, values)
        return target

    def _plain(self, values: Mapping[str, Array]) -> float:
        own = values[self.objective.quantity.name]
        return self.objective.sign * float(own.min()) / self._scale

    def _target_rates(self, x: Array) -> Array:
        if self._several:
            return np.append(np.zeros(len(self._along)), -1.0)
        name = self.objective.quantity.name
        at = int(np.argmin(self._value(x)[name]))
        return np.asarray(self.objective.sign * self._rate(x)[name][:, at] / self._scale)

    def _slack(self, x: Array) -> Array:
        try:
            return self._slacks(x, self._value(x))
        except StrutworkError:
            if self._last is None:
                raise
            return self._last[1] - AWAY

    def _slacks(self, x: Array, values: Mapping[str, Array]) -> Array:
        found = []
        for limit in self.limits:
            size = abs(limit.value) or 1.0
            own = values[limit.quantity]
            if limit.at_least:
                found.append((own - limit.value) / size - MARGIN)
            else:
                found.append((limit.value - own.min(keepdims=True)) / size - MARGIN)
        if self._several:
            found.append(values[self.objective.quantity.name] / self._scale - x[-1])
        return np.concatenate(found) if found else np.zeros(0)

    def _slack_rates(self, x: Array) -> Array:
        values, rates = self._value(x), self._rate(x)
        found = []
        for limit in self.limits:
            size = abs(limit.value) or 1.0
            own = rates[limit.quantity]
            if limit.at_least:
                found.append(own.T / size)
            else:
                at = int(np.argmin(values[limit.quantity]))
                found.append(-own[:, at][None] / size)
        if self._several:
            found.append(rates[self.objective.quantity.name].T / self._scale)
        whole = np.concatenate(found)
        if self._several:
            last = np.zeros((len(whole), 1))
            last[len(whole) - len(found[-1]) :] = -1.0
            whole = np.hstack([whole, last])
        return np.asarray(whole)


def _single(quantity: Quantity, design: Design) -> bool:
    """Whether it is one number whatever the poses."""
    if quantity.name in AT_HOME or quantity.reduction == "mean":
        return True
    return design.workspace is None and len(smooth_names(quantity)) == 1


def descent(design: Design, start: Array) -> Descent:
    """The search for the best of the one objective of a design.

    Parameters
    ----------
    design : Design
    start : (k,)
        Shares of the ranges, no unit.
    """
    return Descent(design, design.objectives[0], _limits(design), start)


def finish(design: Design, start: Array, values: Array) -> Descent:
    """The search from a machine of the front for one that is better in the first objective alone.

    Parameters
    ----------
    design : Design
    start : (k,)
        Shares of the ranges, no unit.
    values : (q,)
        Of its quantities, any unit: in the other objectives the machine is to stay as good.
    """
    names = [q.name for q in design.quantities]
    others = tuple(
        Limit(o.quantity.name, float(values[names.index(o.quantity.name)]), o.goal == "maximise")
        for o in design.objectives[1:]
    )
    return Descent(design, design.objectives[0], (*_limits(design), *others), start)


def _limits(design: Design) -> tuple[Limit, ...]:
    found = []
    for c in design.constraints:
        if c.at_least is not None:
            found.append(Limit(c.quantity.name, c.at_least, at_least=True))
        if c.at_most is not None:
            found.append(Limit(c.quantity.name, c.at_most, at_least=False))
    return tuple(found)


def starts(design: Design) -> Array:
    """Where a search along gradients begins, (n, k), shares of the ranges, no unit.

    The machine as described comes first, at the nearest end of a range that it is outside; the
    others are a Latin hypercube.

    Parameters
    ----------
    design : Design
    """
    from scipy.stats import qmc  # noqa: PLC0415

    stated = []
    for p, value in zip(design.varied, design.stated_values.tolist(), strict=True):
        low, high = p.low or 0.0, p.high or 0.0
        place = np.clip(value, low, high)
        share = np.log(place / low) / np.log(high / low) if p.log else (place - low) / (high - low)
        stated.append(float(share))
    spread = qmc.LatinHypercube(len(stated), seed=design.search.seed).random(
        max(design.search.starts - 1, 1)
    )
    return np.concatenate([[stated], spread])[: design.search.starts]


def steps_of(search: Descent, first: bool) -> tuple[Array, str]:
    """Every machine on the way of a search, (n, k), shares of the ranges, and how it ended.

    Parameters
    ----------
    search : Descent
    first : bool
        Whether an error of its start ends everything.

    Raises
    ------
    StrutworkError
        The machine at the first start cannot be.
    """
    try:
        words = search.run()
    except StrutworkError as error:
        if first or not search.visited:
            raise ModelError(
                "search",
                f"cannot begin: {error.part}: {error.problem}",
                'Change the ranges, or choose method = "evolution".',
            ) from error
        words = f"{error.part}: {error.problem}"
    _, order = np.unique(np.array(search.visited), axis=0, return_index=True)
    return np.array(search.visited)[np.sort(order)], words
