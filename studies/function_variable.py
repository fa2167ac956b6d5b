"""What a machine's function depends on: its variables, and the poses at which it is evaluated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.names import choices, visible
from strutwork.studies.dimension import TOGETHER, Dimension
from strutwork.studies.parameter import Parameter, Varied, varied
from strutwork.studies.parametric import Parametric
from strutwork.units import ANGLE, LENGTH, quantity

Array = NDArray[Any]

#: Poses at which a function is evaluated, as a person states them.
Poses = Mapping[str, Any] | TaskGrid | str | None


@dataclass(frozen=True)
class Variable:
    """A variable of a function: numbers of a machine that take one value together.

    Parameters
    ----------
    varied : Varied
        What it changes.
    start : float
        What the machine states, in the variable's unit, any unit; 1 for a factor.
    """

    varied: Varied
    start: float

    @property
    def name(self) -> str:
        """As the function's arguments name it."""
        return self.varied.name

    @property
    def unit(self) -> str:
        """SI; empty for a pure number."""
        return self.varied.unit

    @property
    def bounds(self) -> tuple[float, float]:
        """The range it was given, infinite where none was, any unit."""
        low, high = self.varied.low, self.varied.high
        return (
            -np.inf if low is None or high is None else low,
            np.inf if low is None or high is None else high,
        )

    def read(self, value: object) -> float:
        """A value, SI, checked by the fields of all its numbers.

        Parameters
        ----------
        value : float or str
            SI, or text with its unit.

        Raises
        ------
        ModelError, UnitError
            Another dimension, not finite, or out of the range of a field; names the path.
        """
        if isinstance(value, np.ndarray) and value.size == 1:
            value = value.reshape(()).item()
        elif isinstance(value, np.generic):
            value = value.item()
        if not self.varied.relative:
            # each has a range of its own
            every = [number.read(value) for number in self.varied.numbers]
            return every[0]
        if not isinstance(value, int | float) or isinstance(value, bool) or not np.isfinite(value):
            raise ModelError(
                visible(self.name),
                f"is given the factor {visible(repr(value))}.",
                "Give a plain number, as 1.1 for 10 % more.",
            )
        for number in self.varied.numbers:
            number.read(number.value * value)
        return float(value)

    def at(self, value: float) -> Step:
        """The dimension along which a gradient is taken.

        Parameters
        ----------
        value : float
            Where, in the variable's unit, any unit.
        """
        return Step(self.name, {self.name: value}, self.unit, self.varied.meaning, self.varied)


@dataclass(frozen=True)
class Step(Dimension):
    """A dimension whose numbers follow one variable, by equal values or by equal factors.

    Parameters
    ----------
    varied : Varied or None
        What the variable changes.
    """

    varied: Varied | None = None

    def moved(self, step: float) -> dict[str, float]:
        """Its numbers when the variable is moved by a step, SI.

        Parameters
        ----------
        step : float
            In the variable's unit.
        """
        assert self.varied is not None  # noqa: S101 - made by `Variable.at` alone
        return self.varied.changes(self.value + step)


def variables_of(
    machine: Parametric, given: Mapping[str, Any] | Iterable[str | Parameter]
) -> tuple[Variable, ...]:
    """The variables of a function.

    Parameters
    ----------
    machine : Parametric
    given : sequence of str or Parameter, or mapping of path to (low, high)
        Paths with a star for any characters, several joined by a plus.

    Raises
    ------
    ModelError
        None, a path that names no number, numbers that differ and are to take one value; as
        `strutwork.studies.parameter.varied`.
    """
    if isinstance(given, str):
        raise ModelError("parameters", f'are the text "{visible(given)}".', "Give a list of paths.")
    pairs = given.items() if isinstance(given, Mapping) else [(p, None) for p in given]
    asked = [_parameter(machine, what, bounds) for what, bounds in pairs]
    found = varied(machine, asked)
    return tuple(Variable(one, _start(one)) for one in found)


def _parameter(machine: Parametric, what: object, bounds: object) -> Parameter:
    if isinstance(what, str):
        paths = tuple(p.strip() for p in what.split(TOGETHER))
        made = Parameter(paths, name=what)
        if bounds is not None:
            if not isinstance(bounds, Sequence) or isinstance(bounds, str) or len(bounds) != 2:
                raise ModelError(
                    visible(what), "is given no range.", "Give a pair (low, high) beside the path."
                )
            return replace(made, low=bounds[0], high=bounds[1])
    elif isinstance(what, Parameter):
        made = what
    else:
        raise ModelError(
            "parameters", f"hold a {type(what).__name__}.", "Give paths, or Parameter objects."
        )
    if made.values or made.low is not None or made.high is not None:
        return made
    # without values of its own it begins where the machine is
    first = [made.path] if isinstance(made.path, str) else list(made.path)
    value = 1.0 if made.relative else machine.matching(first[0])[0].value
    return replace(made, values=(value,))


def _start(one: Varied) -> float:
    if one.relative:
        return 1.0
    stated = {number.value for number in one.numbers}
    if len(stated) > 1:
        low, high = min(stated), max(stated)
        raise ModelError(
            visible(one.name),
            f"names {len(one.numbers)} numbers that differ, from {low:g} to {high:g}, and would "
            "make them one.",
            "Name them one by one, or give Parameter(path, relative=True), which scales them.",
        )
    return next(iter(stated))


def task_of(model: Model, poses: Poses) -> dict[str, Array] | None:
    """Poses as a batch (p,) along each direction, m and rad; None for the machine as described.

    Parameters
    ----------
    model : Model
    poses : mapping of direction to value or values, TaskGrid, "workspace" or None
        As of `strutwork.studies.function.MachineFunction.of`.

    Raises
    ------
    ModelError
        No workspace, no pose, or none that the machine can take.
    UnitError
        A value of another dimension.
    """
    if poses is None:
        return None
    if isinstance(poses, str):
        return _of_workspace(model, poses)
    if isinstance(poses, TaskGrid):
        return poses.task()
    axes = {}
    for direction, values in poses.items():
        kind = ANGLE if direction.startswith("r") else LENGTH
        several = [values] if isinstance(values, str) or np.ndim(values) == 0 else list(values)
        read = [quantity(_plain(v), kind, f"poses.{direction}") for v in several]
        axes[direction] = np.array(read, dtype=float)
    if not axes or any(not v.size for v in axes.values()):
        raise ModelError("poses", "are none.", "Name one, as {'z': 0.7}, or leave them out.")
    return TaskGrid(axes).task()


def _of_workspace(model: Model, word: str) -> dict[str, Array]:
    if word != "workspace":
        raise ModelError("poses", f'are "{visible(word)}".', choices("Words", word, ["workspace"]))
    if model.workspace is None:
        raise ModelError(
            "workspace", "is not given.", "Add a table [workspace], or name the poses."
        )
    task = model.workspace.task()
    good = moved(model, task)[1].reachable
    if not good.any():
        raise ModelError("workspace", "has no pose that can be taken.", "Move the grid.")
    return {d: v[good] for d, v in task.items()}


def _plain(value: ArrayLike) -> Any:
    return value.item() if isinstance(value, np.generic) else value
