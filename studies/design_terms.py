"""What a design aims at: objectives, limits, cost, and how long is searched."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.names import choices
from strutwork.studies.design_quantities import OF_JOINTS, REACH, Goal, Quantity, quantity_of
from strutwork.studies.parameter import Value, Varied
from strutwork.studies.pose_sets import PoseSet
from strutwork.units import quantity

Array = NDArray[Any]

#: In place of a limit: what the machine as described has.
STATED = "stated"

#: Machines and generations of a search at most: larger ones are typing errors.
MOST_MACHINES = 10_000_000
#: Starts of a search along gradients at most.
MOST_STARTS = 1000

#: How is searched: NSGA-II, SLSQP with gradients from several starts, or the first and then the
#: second from each machine of the front.
EVOLUTION, GRADIENT, BOTH = METHODS = ("evolution", "gradient", "both")


@dataclass(frozen=True)
class Objective:
    """A quantity to make as small or as large as possible.

    Parameters
    ----------
    quantity : Quantity
    goal : "minimise" or "maximise"
    """

    quantity: Quantity
    goal: Goal

    @classmethod
    def of(cls, name: str, goal: Goal | None = None) -> Objective:
        """An objective by the name of its quantity.

        Parameters
        ----------
        name : str
            Of `strutwork.studies.design_quantities.QUANTITIES`.
        goal : "minimise" or "maximise", optional
            What is better of the quantity by default.

        Raises
        ------
        ModelError
            No such quantity.
        """
        found = quantity_of(name, "objectives")
        return cls(found, goal or found.goal)

    @property
    def sign(self) -> float:
        """1 of what is minimised, -1 of what is maximised."""
        return 1.0 if self.goal == "minimise" else -1.0

    @property
    def settings(self) -> dict[str, Any]:
        """What it is, as plain values."""
        return {"quantity": self.quantity.name, "goal": self.goal}


@dataclass(frozen=True)
class Constraint:
    """Limits of a quantity.

    Parameters
    ----------
    quantity : Quantity
    at_least, at_most : float or None
        In the SI unit of the quantity, any unit.
    kept : tuple of str
        Of "at_least" and "at_most", those that are the value of the machine as described; a design
        puts the number in their place.
    """

    quantity: Quantity
    at_least: float | None = None
    at_most: float | None = None
    kept: tuple[str, ...] = ()

    @classmethod
    def of(
        cls, name: str, at_least: Value | None = None, at_most: Value | None = None
    ) -> Constraint:
        """A constraint by the name of its quantity.

        Parameters
        ----------
        name : str
            Of `strutwork.studies.design_quantities.QUANTITIES`.
        at_least, at_most : float or str, optional
            SI, or text with its unit; "stated" for what the machine as described has.

        Raises
        ------
        ModelError
            No such quantity, no limit, limits that exclude each other.
        UnitError
            A limit of another dimension.
        """
        found = quantity_of(name, "constraints")
        part = f"constraint {name}"
        if at_least is None and at_most is None:
            raise ModelError(part, "has no limit.", "Give at_least, at_most or both.")
        limits = {"at_least": at_least, "at_most": at_most}
        kept = tuple(key for key, v in limits.items() if v == STATED)
        low, high = (
            None if v is None or key in kept else quantity(v, found.dimension, f"{part}.{key}")
            for key, v in limits.items()
        )
        if low is not None and high is not None and low > high:
            raise ModelError(
                part,
                f"has at_least = {low:g} above at_most = {high:g}.",
                "Exchange the two.",
            )
        return cls(found, low, high, kept)

    def known(self, stated: float) -> Constraint:
        """The same with numbers for what is kept of the machine as described.

        Parameters
        ----------
        stated : float
            What this machine has, in the unit of the quantity, any unit.

        Raises
        ------
        ModelError
            It has no value.
        """
        if not self.kept:
            return self
        if not np.isfinite(stated):
            raise ModelError(
                f"constraint {self.quantity.name}",
                "keeps what the machine as described has, and this has no value.",
                "Give a number.",
            )
        low = stated if "at_least" in self.kept else self.at_least
        high = stated if "at_most" in self.kept else self.at_most
        return Constraint(self.quantity, low, high)

    @property
    def settings(self) -> dict[str, Any]:
        """What it is, as plain values."""
        limits = {"at_least": self.at_least, "at_most": self.at_most}
        return {
            "quantity": self.quantity.name,
            **{k: v for k, v in limits.items() if v is not None},
        }

    def violation(self, values: Array) -> Array:
        """By how much n values miss their limits, (n,), as shares of these; at most 0: kept.

        Parameters
        ----------
        values : (n,)
            In the unit of the quantity, any unit.
        """
        found = np.full(len(values), -np.inf)
        for limit, sign in ((self.at_least, 1.0), (self.at_most, -1.0)):
            if limit is not None:
                found = np.maximum(found, sign * (limit - values) / (abs(limit) or 1.0))
        return found

    def why(self, value: float) -> str:
        """What is wrong with a value, in words; empty where it is within the limits.

        Parameters
        ----------
        value : float
            In the unit of the quantity, any unit.
        """
        name = self.quantity.name.replace("_", " ")
        if self.at_least is not None and value < self.at_least:
            return f"{name} is below its limit"
        if self.at_most is not None and value > self.at_most:
            return f"{name} is above its limit"
        return ""


def require_poses(quantities: Iterable[Quantity], poses: PoseSet | None) -> None:
    """Refuse what needs poses where there are none, and a range where they form no grid.

    Parameters
    ----------
    quantities : iterable of Quantity
    poses : TaskGrid, TaskList, PoseList or None
        None: home alone.

    Raises
    ------
    ModelError
        A quantity of a joint, and no poses; the range of a direction that no grid has.
    """
    for one in quantities:
        if one.name.startswith(f"{REACH}_"):
            axes = poses.axes if isinstance(poses, TaskGrid) else {}
            if len(axes.get(one.label, ())) < 2:
                raise ModelError(
                    f"quantity {one.name}",
                    f"needs a grid of poses with several values of {one.label}.",
                    f"Give [workspace] a range of {one.label} in several points.",
                )
        if one.reduction in OF_JOINTS and poses is None:
            raise ModelError(
                f"quantity {one.name}",
                "is asked for at home alone, where no joint moves.",
                "Name poses: a table [workspace], or workspace = {...} in Python.",
            )


@dataclass(frozen=True)
class CostOf:
    """What one parameter costs.

    Parameters
    ----------
    name : str
        Of the parameter.
    amount : float
        In the currency, any unit.
    per : float or str
        For so much of the parameter: SI or text with its unit, of a factor a plain number.
    """

    name: str
    amount: float
    per: Value = 1.0


@dataclass(frozen=True)
class Cost:
    """Cost as a linear function of mass and parameters.

    Parameters
    ----------
    fixed : float
        In the currency, any unit.
    per_kg : float
        Currency per kg of the mass.
    parts : tuple of CostOf
    currency : str
    """

    fixed: float = 0.0
    per_kg: float = 0.0
    parts: tuple[CostOf, ...] = ()
    currency: str = ""

    def rates(self, varied: Sequence[Varied]) -> Array:
        """Cost per unit of each of k parameters, (k,), currency per SI unit.

        Parameters
        ----------
        varied : sequence of k Varied

        Raises
        ------
        ModelError
            A part that names no parameter, or is per nothing.
        UnitError
            `per` of another dimension.
        """
        names = [p.name for p in varied]
        found = np.zeros(len(names))
        for part in self.parts:
            where = f"cost of {part.name}"
            if part.name not in names:
                raise ModelError(where, "names no parameter.", f"Parameters: {', '.join(names)}.")
            one = varied[names.index(part.name)]
            per = part.per if one.relative else one.numbers[0].read(part.per)
            if not isinstance(per, int | float) or isinstance(per, bool) or not per > 0.0:
                raise ModelError(where, f"is per {per!r}.", "Give a number above zero.")
            found[names.index(part.name)] += part.amount / per
        return found

    @property
    def settings(self) -> dict[str, Any]:
        """What it is, as plain values."""
        return {
            "fixed": self.fixed,
            "per_kg": self.per_kg,
            "parameters": [[p.name, p.amount, p.per] for p in self.parts],
            "currency": self.currency,
        }


@dataclass(frozen=True)
class Search:
    """How, and how long, is searched.

    Parameters
    ----------
    population : int
        Machines of each generation.
    generations : int
    seed : int
        The same seed gives the same machines.
    method : str
        Of `METHODS`.
    starts : int
        Of the method "gradient": the machine as described, and points spread over the ranges.

    Raises
    ------
    ModelError
        Fewer than four machines or one generation, or more than can be meant; no start; an unknown
        method.
    """

    population: int = 48
    generations: int = 40
    seed: int = 0
    method: str = EVOLUTION
    starts: int = 3

    @property
    def rounds(self) -> int:
        """In how many steps machines are judged: generations, starts, and one that finishes."""
        if self.method == GRADIENT:
            return self.starts
        return self.generations + (self.method == BOTH)

    @property
    def machines(self) -> int:
        """Machines that are judged in all, but for those on the way along gradients."""
        return self.starts if self.method == GRADIENT else self.population * self.generations

    @property
    def words(self) -> str:
        """The method in words."""
        if self.method == GRADIENT:
            return f"SLSQP with adjoint gradients from {self.starts} start{'s' * (self.starts > 1)}"
        more = ", then SLSQP with adjoint gradients from each machine of the front"
        return f"NSGA-II{more if self.method == BOTH else ''}"

    @property
    def settings(self) -> dict[str, Any]:
        """What decides which machines are judged, as plain values, but for how many rounds."""
        if self.method == GRADIENT:
            return {"method": self.method, "starts": self.starts, "seed": self.seed}
        evolution = {"population": self.population, "seed": self.seed}
        if self.method == EVOLUTION:
            return evolution
        # the last round finishes what the others leave
        return {"method": self.method, "generations": self.generations, **evolution}

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise ModelError(
                "search",
                f'names the method "{self.method}", which is unknown.',
                choices("Methods", self.method, METHODS),
            )
        if not 1 <= self.starts <= MOST_STARTS:
            raise ModelError(
                "search", f"has {self.starts} starts.", f"Give one at least, {MOST_STARTS} at most."
            )
        if self.population < 4 or self.generations < 1:
            raise ModelError(
                "search",
                f"has {self.population} machines in {self.generations} generations.",
                "Give a population of four at least, and one generation.",
            )
        if self.population * self.generations > MOST_MACHINES:
            raise ModelError(
                "search",
                f"asks for {self.population * self.generations} machines.",
                f"Ask for {MOST_MACHINES} at most.",
            )
