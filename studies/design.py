"""A design: which parameters a machine should have, judged by several objectives."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.studies.chunks import Arrays
from strutwork.studies.description import versions
from strutwork.studies.design_judged import (
    CANNOT_BE,
    FEASIBLE,
    MISSES,
    NOT_FINITE,
    OUTSIDE,
    WORST,
    Judged,
)
from strutwork.studies.design_quantities import COST, QUANTITIES, REACH, Quantity, reached_of, taken
from strutwork.studies.design_smooth import require_smooth
from strutwork.studies.design_terms import Constraint, Cost, Objective, Search, require_poses
from strutwork.studies.parameter import Parameter, Varied, parameters_of, varied
from strutwork.studies.parametric import Parametric
from strutwork.studies.pose_sets import PoseSet
from strutwork.studies.question import Asked
from strutwork.studies.study_machines import MACHINE, REDUCTIONS, Kept
from strutwork.studies.variants import Variants

Array = NDArray[Any]


@dataclass(frozen=True)
class Design:
    """A machine, parameters with their ranges, objectives and constraints.

    Unless `reach` is an objective or has a limit, a machine that misses one of the poses is not
    feasible: the worst of the poses would be another set for each machine.

    Parameters
    ----------
    machine : Parametric
    parameters : tuple of Parameter
        Each with a range or with values.
    objectives : tuple of Objective
    constraints : tuple of Constraint
    search : Search
    workspace : TaskGrid, TaskList, PoseList or None
        Poses besides home; None: home alone.
    cost : Cost
    vibration : Asked
        Band and frequencies of what is asked of vibration.

    Raises
    ------
    ModelError
        No objective, one named twice, parameters that scatter or do not exist; the machine as
        stated lacks what is asked for; a search along gradients of what has none.
    """

    machine: Parametric
    parameters: tuple[Parameter, ...]
    objectives: tuple[Objective, ...]
    constraints: tuple[Constraint, ...] = ()
    search: Search = field(default_factory=Search)
    workspace: PoseSet | None = None
    cost: Cost = field(default_factory=Cost)
    vibration: Asked = field(default_factory=lambda: Asked("vibration"))

    def __post_init__(self) -> None:
        if not self.objectives:
            raise ModelError("objectives", "are none.", 'Name one, as "stiffness_z".')
        names = [o.quantity.name for o in self.objectives]
        for name in names:
            if names.count(name) > 1:
                raise ModelError(f"objective {name}", "is named twice.", "Name it once.")
        for parameter in self.parameters:
            if parameter.distribution:
                raise ModelError(
                    f"parameter {parameter.name or parameter.path}",
                    "scatters about a mean.",
                    "A design chooses its value: give a range or values.",
                )
        if any(q.name == COST for q in self.quantities) and self.cost == Cost():
            raise ModelError("cost", "is asked for and not stated.", "Give a table [cost].")
        require_poses(self.quantities, self.workspace)
        # their errors come now
        _ = self.rates, self.variants
        if any(c.kept for c in self.constraints):
            own = dict(zip((q.name for q in self.quantities), self.stated.values[0], strict=True))
            limits = tuple(c.known(float(own[c.quantity.name])) for c in self.constraints)
            object.__setattr__(self, "constraints", limits)
            # judged without these limits
            del self.__dict__["stated"]
        require_smooth(
            self.search,
            self.objectives,
            self.quantities,
            self.varied,
            self.machine.origin.model,
        )

    @classmethod
    def of(
        cls,
        machine: object,
        parameters: Mapping[str, object] | Sequence[Parameter],
        *objectives: str | Objective,
        constraints: Sequence[Constraint] = (),
        workspace: Mapping[str, Any] | PoseSet | None = None,
        cost: Cost | None = None,
        band: tuple[float, float] | None = None,
        **search: Any,
    ) -> Design:
        """A design from names and plain values.

        Parameters
        ----------
        machine : str, Path, Parametric or machine
            As `Parametric.of`.
        parameters : mapping of path to values, or sequence of Parameter
            Beside a path a list of values, or a pair (low, high) for a range; SI, or texts with
            units.
        *objectives : str or Objective
            Names of `strutwork.studies.design_quantities.QUANTITIES`.
        constraints : sequence of Constraint
        workspace : mapping of direction to (n,), TaskGrid, TaskList or PoseList, optional
            Values along each, m and rad or texts with units; the machine's own by default, {} for
            home alone.
        cost : Cost, optional
            Nothing by default.
        band : (float, float), optional
            Of a least dynamic stiffness, Hz; wide enough for the modes that matter by default.
        **search : int or str
            method, population, generations, starts and seed, as of `Search`.

        Raises
        ------
        ModelError
            As `Design`.
        """
        found = Parametric.of(machine)
        first = next(iter(found.paths))
        grid = Variants.of(found, [first], "mass", workspace=workspace).study.workspace
        return cls(
            found,
            parameters_of(parameters),
            tuple(o if isinstance(o, Objective) else Objective.of(o) for o in objectives),
            tuple(constraints),
            Search(**search),
            grid,
            cost or Cost(),
            Asked("vibration", band),
        )

    def __repr__(self) -> str:
        names = ", ".join(f"{o.goal} {o.quantity.name}" for o in self.objectives)
        return f"<Design of {self.machine.title!r}: {names}>"

    @cached_property
    def varied(self) -> tuple[Varied, ...]:
        """The parameters, checked, in SI."""
        return varied(self.machine, self.parameters)

    @cached_property
    def quantities(self) -> tuple[Quantity, ...]:
        """What is computed of each machine: of the objectives first, each once."""
        every = [o.quantity for o in self.objectives] + [c.quantity for c in self.constraints]
        return tuple({q.name: q for q in every}.values())

    @cached_property
    def rates(self) -> Array:
        """Cost per unit of each parameter, (k,), currency per SI unit."""
        return self.cost.rates(self.varied)

    @cached_property
    def variants(self) -> Variants:
        """What makes the machines and asks each."""
        return Variants.of(
            self.machine,
            _single(self.parameters),
            *self._asked,
            workspace={} if self.workspace is None else self.workspace,
            reductions=self._reductions,
        )

    @property
    def _asked(self) -> tuple[str | Asked, ...]:
        names = dict.fromkeys(q.question for q in self.quantities if q.question)
        if any(q.name == COST for q in self.quantities) and self.cost.per_kg:
            names["mass"] = None
        return tuple(self.vibration if n == "vibration" else n for n in names) or ("mass",)

    @property
    def _reductions(self) -> tuple[str, ...]:
        found = dict.fromkeys(q.reduction for q in self.quantities if q.reduction in REDUCTIONS)
        return tuple(found) or ("worst",)

    @cached_property
    def stated(self) -> Judged:
        """The machine as it is described, one row."""
        one = Parameter(next(iter(self.machine.paths)), values=(1.0,), relative=True)
        asked = Variants.of(
            self.machine,
            [one],
            *self._asked,
            workspace={} if self.workspace is None else self.workspace,
            reductions=self._reductions,
        )
        return self._judged(asked.values([[1.0]]), self.stated_values[None])

    @property
    def stated_values(self) -> Array:
        """The parameters as the machine states them, (k,), each in its unit, any unit."""
        return np.array([1.0 if p.relative else p.numbers[0].value for p in self.varied])

    def samples(self, shares: Array) -> Array:
        """Values of the parameters, (n, k), each in its unit, any unit.

        Parameters
        ----------
        shares : (n, k)
            Of each range, or of each list, between 0 and 1; no unit.
        """
        found = np.empty(shares.shape)
        for i, p in enumerate(self.varied):
            if p.values:
                # values of a list have equal parts of the way from 0 to 1
                at = np.minimum((shares[:, i] * len(p.values)).astype(int), len(p.values) - 1)
                found[:, i] = np.asarray(p.values)[at]
            else:
                found[:, i] = p.scaled(shares[:, i])
        return found

    def judge(self, samples: Array, workers: int | None = None) -> Judged:
        """Make n machines and find what each is worth.

        Parameters
        ----------
        samples : (n, k)
            Of the parameters, each in its unit, any unit.
        workers : int, optional
            Threads; default one per processor.

        Raises
        ------
        ModelError
            Samples of another shape, or not finite.
        """
        return self._judged(self.variants.values(samples, workers), samples)

    def _judged(self, found: Arrays, samples: Array) -> Judged:
        good = found["status"] == 0
        reached = self._reached(QUANTITIES[REACH], found)
        values = np.stack([self._value(q, found, samples) for q in self.quantities], axis=1)
        values[~good] = np.nan
        reasons = [str(found["reasons"][i]) for i in found["reason"]]
        status = np.where(good, FEASIBLE, CANNOT_BE)
        for row in np.flatnonzero(good):
            status[row], reasons[row] = self._verdict(values[row])
        if self.every_pose:
            missed = good & (reached < 1.0)
            status[missed] = MISSES
            for row in np.flatnonzero(missed):
                reasons[row] = "misses some of the poses"
        return Judged(values, status.astype(np.int8), reached, tuple(reasons))

    @property
    def every_pose(self) -> bool:
        """Whether every pose has to be reached, because no term speaks of it."""
        return not any(q.name.startswith(REACH) for q in self.quantities)

    def _reached(self, quantity: Quantity, found: Arrays) -> Array:
        return reached_of(quantity, found, self.workspace, self.machine.origin.model)

    def _value(self, quantity: Quantity, found: Arrays, samples: Array) -> Array:
        if quantity.name.startswith(REACH):
            return self._reached(quantity, found)
        if quantity.name == COST:
            mass = found["mass"] if self.cost.per_kg else 0.0
            return np.asarray(self.cost.fixed + self.cost.per_kg * mass + samples @ self.rates)
        for kept, labels in self._columns:
            # what is asked at home alone, or once of a machine, has no other reduction
            same = kept.reduction in (quantity.reduction, "home", MACHINE)
            if kept.column.name == quantity.column and same:
                return taken(quantity, kept.column, labels, found[kept.name])
        raise AssertionError(quantity.name)

    @cached_property
    def _columns(self) -> tuple[tuple[Kept, tuple[Any, ...]], ...]:
        """Arrays in what the machines answer, with the labels along them."""
        model = self.machine.origin.model
        labels: dict[str, tuple[Any, ...]] = {}
        for question in self.variants.questions:
            labels |= dict(question.of(model).coordinates)
        return tuple(
            (k, labels[k.column.dims[0]] if k.column.dims else ())
            for k in self.variants.study.machines.kept
        )

    def _verdict(self, values: Array) -> tuple[np.int8, str]:
        for quantity, value in zip(self.quantities, values.tolist(), strict=True):
            if not np.isfinite(value):
                return NOT_FINITE, f"{quantity.name.replace('_', ' ')} is not finite"
        at = {q.name: v for q, v in zip(self.quantities, values.tolist(), strict=True)}
        for constraint in self.constraints:
            why = constraint.why(at[constraint.quantity.name])
            if why:
                return OUTSIDE, why
        return FEASIBLE, ""

    def targets(self, judged: Judged) -> Array:
        """What is to be minimised of n machines, (n, m): objectives with their signs, any unit.

        Parameters
        ----------
        judged : Judged
        """
        names = [q.name for q in self.quantities]
        columns = [o.sign * judged.values[:, names.index(o.quantity.name)] for o in self.objectives]
        return np.stack(columns, axis=1)

    def violations(self, judged: Judged) -> Array:
        """By how much n machines miss each limit, (n, c), no unit; at most 0: kept.

        Parameters
        ----------
        judged : Judged
        """
        names = [q.name for q in self.quantities]
        lost = np.isin(judged.status, (CANNOT_BE, NOT_FINITE))
        columns = [np.where(lost, WORST, 0.0)]
        if self.every_pose:
            columns.append(1.0 - judged.reached)
        columns += [
            c.violation(judged.values[:, names.index(c.quantity.name)]) for c in self.constraints
        ]
        found = np.stack(columns, axis=1)
        return np.where(np.isfinite(found), found, WORST)

    def model(self, values: Array) -> Model:
        """A machine with other parameters.

        Parameters
        ----------
        values : (k,)
            Each in its unit, any unit.

        Raises
        ------
        ModelError
            It cannot be.
        """
        changes: dict[str, float | str] = {}
        for parameter, value in zip(self.varied, values.tolist(), strict=True):
            changes |= parameter.changes(value)
        return self.machine.model(changes)

    @cached_property
    def settings(self) -> dict[str, Any]:
        """What was asked, as plain values."""
        return {
            "machine": self.machine.source or self.machine.title,
            "parameters": {p.name: p.settings for p in self.varied},
            "objectives": [o.settings for o in self.objectives],
            "constraints": [c.settings for c in self.constraints],
            "cost": self.cost.settings,
            "workspace": self.variants.study.settings["workspace"],
            **self.search.settings,
        }

    @cached_property
    def key(self) -> str:
        """Hash of all that the machines depend on, however many generations; hexadecimal."""
        study = self.variants.study
        # where the model file lies changes nothing
        settings = {k: v for k, v in self.settings.items() if k != "machine"}
        content = [study.inputs, settings, study.code, versions()]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _single(parameters: Sequence[Parameter]) -> list[Parameter]:
    """Each with one of its values: a population is no grid over the ranges."""
    found = []
    for p in parameters:
        first = p.values[0] if p.values else p.low
        values = () if first is None else (first,)
        found.append(replace(p, values=values, low=None, high=None, log=False))
    return found
