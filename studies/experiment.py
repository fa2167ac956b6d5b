"""A machine, the numbers to be found in it, and what was measured of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.model_poses import moved
from strutwork.studies.measurement import Measurement, Standing, residuals
from strutwork.studies.parametric import Parametric
from strutwork.studies.tangents import Tangents
from strutwork.studies.unknown import Unknown, check_unknowns

Array = NDArray[Any]

#: Step of central differences in a scaled number: cube root of what an eigenproblem leaves.
STEP = 1e-4

#: Pose of the tool as it can be a key.
_Task = tuple[tuple[str, float], ...]


@dataclass
class Differences:
    """Unknowns whose derivatives were taken by differences, by measurement.

    Parameters
    ----------
    taken : dict of (measurement, unknown) to None
    """

    taken: dict[tuple[str, str], None] = field(default_factory=dict)


@dataclass(frozen=True)
class Experiment:
    """What a calibration works on.

    Parameters
    ----------
    machine : Parametric
    unknowns : tuple of g Unknown
    measurements : tuple of Measurement
    source : str
        File that described it; empty for none.
    differences : Differences
        Filled as derivatives are taken.

    Raises
    ------
    ModelError
        As `check_unknowns`.
    """

    machine: Parametric
    unknowns: tuple[Unknown, ...]
    measurements: tuple[Measurement, ...] = ()
    source: str = ""
    differences: Differences = field(default_factory=Differences, compare=False, repr=False)

    def __post_init__(self) -> None:
        check_unknowns(self.unknowns)

    def __repr__(self) -> str:
        return (
            f"<Experiment on {self.machine.title!r}: {len(self.unknowns)} unknowns, "
            f"{self.count} measured numbers>"
        )

    @property
    def count(self) -> int:
        """How many numbers were measured."""
        return sum(len(m.values) for m in self.measurements)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the unknowns."""
        return tuple(u.name for u in self.unknowns)

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest scaled numbers, (g,) each, no unit."""
        every = [
            (u.parameter.scaled(u.parameter.low), u.parameter.scaled(u.parameter.high))
            for u in self.unknowns
        ]
        low, high = np.array(every).T
        return low, high

    @property
    def guess(self) -> Array:
        """First guess, (g,), scaled, no unit."""
        return np.array([u.parameter.scaled(u.parameter.start) for u in self.unknowns])

    def values(self, point: Array) -> Array:
        """Values of scaled numbers, (g,), each in its own unit.

        Parameters
        ----------
        point : (g,)
            Scaled numbers, no unit.
        """
        return np.array([u.parameter.value(x) for u, x in zip(self.unknowns, point, strict=True)])

    def numbers(self, values: Array) -> dict[str, float]:
        """Every number of the machine that is changed, SI.

        Parameters
        ----------
        values : (g,)
            Each in its own unit.
        """
        found: dict[str, float] = {}
        for unknown, value in zip(self.unknowns, values, strict=True):
            found |= unknown.varied.changes(float(value))
        return found

    def tangents(self, values: Array, *, changes: bool) -> Tangents:
        """The machine with values, and what the unknowns change in it.

        Parameters
        ----------
        values : (g,)
            Each in its own unit.
        changes : bool
            Whether derivatives are wanted.
        """
        stated = self.numbers(values)
        if not changes:
            return Tangents(self.machine.model(stated), (), (), (), (), {})
        directions = [u.moving(float(v)) for u, v in zip(self.unknowns, values, strict=True)]
        return Tangents.of(lambda some: self.machine.model({**stated, **some}), directions)

    def standing(self, values: Array) -> list[Standing]:
        """The machine at the pose of each measurement, without derivatives.

        Parameters
        ----------
        values : (g,)
            Each in its own unit.

        Raises
        ------
        UnreachableError
            A pose that the machine cannot take.
        """
        tangents = self.tangents(values, changes=False)
        at: dict[_Task, Standing] = {}
        for m in self.measurements:
            key = tuple(m.task.items())
            if key not in at:
                at[key] = _standing(tangents, m.task)
        return [at[tuple(m.task.items())] for m in self.measurements]

    def computed(self, values: Array) -> list[Array]:
        """What the model gives for each measurement, (t,) each, in its unit.

        Parameters
        ----------
        values : (g,)
            Each in its own unit.
        """
        return [
            m.computed(at) for m, at in zip(self.measurements, self.standing(values), strict=True)
        ]

    def residuals(self, point: Array) -> Array:
        """(computed − measured) / scatter of all measurements, (t,), no unit.

        Parameters
        ----------
        point : (g,)
            Scaled numbers, no unit.
        """
        found = self.computed(self.values(point))
        each = [residuals(m, c) for m, c in zip(self.measurements, found, strict=True)]
        return np.concatenate(each) if each else np.zeros(0)

    def jacobian(self, point: Array) -> Array:
        """Derivatives of the residuals by the scaled numbers, (t, g), no unit.

        Analytical where they exist, else central differences, noted in `differences`.

        Parameters
        ----------
        point : (g,)
            Scaled numbers, no unit.
        """
        values = self.values(point)
        tangents = self.tangents(values, changes=True)
        rows, missing = [], []
        for m in self.measurements:
            block = self._block(m, tangents, values)
            rows.append(block)
            missing.append(np.isnan(block).any(axis=0))
        if not rows:
            return np.zeros((0, len(self.unknowns)))
        found = np.concatenate(rows)
        for k in np.flatnonzero(np.any(missing, axis=0)).tolist():
            ahead, behind = self._beside(point, k, 1.0), self._beside(point, k, -1.0)
            slope = (self.residuals(ahead) - self.residuals(behind)) / (ahead[k] - behind[k])
            found[:, k] = np.where(np.isnan(found[:, k]), slope, found[:, k])
        return found

    def _beside(self, point: Array, k: int, sign: float) -> Array:
        low, high = self.bounds
        found = point.copy()
        found[k] = min(max(found[k] + sign * STEP, low[k]), high[k])
        return found

    def _block(self, m: Measurement, tangents: Tangents, values: Array) -> Array:
        """Analytical derivatives of one measurement, (t, g); NaN where there are none."""
        block = np.full((len(m.values), len(self.unknowns)), np.nan)
        found = tangents.at({d: np.array([v]) for d, v in m.task.items()} or None)
        at = Standing(tangents.model, found.placed, found.changes)
        column = {name: k for k, name in enumerate(self.names)}
        still = [
            (p.name, c)
            for p, c, lost in zip(tangents.parameters, found.changes, found.missing, strict=True)
            if not lost.any() and not self._blind(m, p.name)
        ]
        rates = m.rates(Standing(at.model, at.placed, tuple(c for _, c in still)))
        if rates is None and any(c.geometry is None for _, c in still):
            # what moves no part may have a derivative where others have none
            still = [(n, c) for n, c in still if c.geometry is None]
            rates = m.rates(Standing(at.model, at.placed, tuple(c for _, c in still)))
        if rates is not None:
            for (name, _), rate in zip(still, rates, strict=True):
                k = column[name]
                block[:, k] = rate * self.unknowns[k].rate(float(values[k])) / m.scatter
        for k in np.flatnonzero(np.isnan(block).any(axis=0)).tolist():
            self.differences.taken[m.name, self.names[k]] = None
        return block

    def _blind(self, m: Measurement, name: str) -> bool:
        unknown = self.unknowns[self.names.index(name)]
        return any(m.blind(number.path) for number in unknown.varied.numbers)


def _standing(tangents: Tangents, task: Mapping[str, float]) -> Standing:
    found = tangents.at({d: np.array([v]) for d, v in task.items()} or None)
    return Standing(tangents.model, found.placed, found.changes)


def reachable(experiment: Experiment, task: Mapping[str, Array]) -> NDArray[np.bool_]:
    """Which poses of a batch the machine can take at its first guess, (p,).

    Parameters
    ----------
    experiment : Experiment
    task : mapping of direction to (p,)
        m and rad.
    """
    model = experiment.machine.model(experiment.numbers(experiment.values(experiment.guess)))
    return np.asarray(moved(model, task)[1].reachable)
