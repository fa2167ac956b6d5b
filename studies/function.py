"""A machine as a function of its numbers, with gradients, for optimisers and other programs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.names import choices, visible
from strutwork.studies.function_variable import Poses, Variable, task_of, variables_of
from strutwork.studies.gradient_quantities import Asked, Vibrating, read_quantity, sensitivities
from strutwork.studies.model_damping import model_damping
from strutwork.studies.parameter import Parameter
from strutwork.studies.parametric import Parametric
from strutwork.studies.tangents import Tangents

Array = NDArray[Any]

#: What becomes of several poses.
REDUCTIONS = ("worst", "mean", "poses")

#: Poses that are solved at once.
STACK = 64

#: Arguments of a function: numbers by name, or all of them in order.
Point = Mapping[str, float | str] | ArrayLike | None


@dataclass(frozen=True, repr=False)
class MachineFunction:
    """Answers of a machine as a function of its numbers; made by `MachineFunction.of`.

    It can be pickled. The last result is kept, so that asking for the answers one by one at the
    same point computes them once.

    Parameters
    ----------
    machine : Parametric
    variables : tuple of k Variable
    asked : tuple of q Asked
    task : mapping of direction to (p,), or None
        m and rad.
    reduction : str
        "worst", "mean" or "poses".
    band : (float, float)
        Of a least dynamic stiffness, Hz.

    Examples
    --------
    >>> f = MachineFunction.of(
    ...     "examples/machines/6-ups.toml", ["sections.ram.diameter"], ["stiffness_z", "mass"]
    ... )
    >>> {name: round(value, 1) for name, value in f({"sections.ram.diameter": "50 mm"}).items()}
    {'stiffness_z': 460831614.5, 'mass': 187.4}
    >>> f.gradient([0.05])["mass"]["sections.ram.diameter"] > 0.0
    True
    """

    machine: Parametric
    variables: tuple[Variable, ...]
    asked: tuple[Asked, ...]
    task: Mapping[str, Array] | None = None
    reduction: str = "worst"
    band: tuple[float, float] = (1.0, 1000.0)
    _kept: dict[str, tuple[bytes, Any]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @classmethod
    def of(
        cls,
        machine: object,
        parameters: Mapping[str, Any] | Iterable[str | Parameter],
        answers: Sequence[str],
        poses: Poses = None,
        *,
        reduction: str = "worst",
        band: tuple[float, float] = (1.0, 1000.0),
    ) -> MachineFunction:
        """A function from names and plain values, evaluated once where the machine is.

        Parameters
        ----------
        machine : str, Path, Parametric or machine
            As `strutwork.studies.parametric.Parametric.of`.
        parameters : sequence of str or Parameter, or mapping of path to (low, high)
            Paths of `Parametric.paths`, in the order of the arguments; with a star or a plus
            several numbers that take one value. `Parameter(path, relative=True)` is a factor. A
            pair beside a path is its range, which `bounds` hands to an optimiser.
        answers : sequence of str
            As `strutwork.studies.gradient_quantities.FORMS`.
        poses : mapping of direction to value or values, TaskGrid or "workspace", optional
            m and rad, or texts with units; several values form a grid. "workspace" is the
            machine's own, without the poses that it cannot take. The machine as it is described
            where there are none.
        reduction : str
            What becomes of several poses: "worst" (the least; of a displacement or force the one
            of the largest size), "mean", or "poses" for arrays.
        band : (float, float)
            Of a least dynamic stiffness, Hz.

        Raises
        ------
        ModelError
            A parameter or answer that does not exist (the message names the nearest), numbers that
            differ and would become one, no pose, an unknown reduction; the machine lacks what an
            answer needs.
        UnreachableError, MechanismError, NumericalError
            A pose that the machine cannot take, or without an answer.
        """
        found = Parametric.of(machine)
        if isinstance(answers, str) or not answers:
            raise ModelError("answers", "are no list.", 'Give one, as ["stiffness_z", "mass"].')
        if reduction not in REDUCTIONS:
            raise ModelError(
                "reduction",
                f'is "{visible(reduction)}", which is unknown.',
                choices("Reductions", reduction, REDUCTIONS),
            )
        model = found.origin.model
        twice = [a for a in answers if list(answers).count(a) > 1]
        if twice:
            raise ModelError("answers", f"name {visible(twice[0])} twice.", "Name each once.")
        made = cls(
            found,
            variables_of(found, parameters),
            tuple(read_quantity(model, name) for name in answers),
            task_of(model, poses),
            reduction,
            band,
        )
        made()
        return made

    def __repr__(self) -> str:
        names = ", ".join(v.name for v in self.variables)
        return (
            f"<MachineFunction of {self.machine.title!r}: {names} -> {', '.join(self.answers)}; "
            f"{self.poses} poses>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        # its results are computed anew elsewhere
        given = (self.machine, self.variables, self.asked, self.task, self.reduction, self.band)
        return MachineFunction, given

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the arguments, in their order."""
        return tuple(v.name for v in self.variables)

    @property
    def answers(self) -> tuple[str, ...]:
        """Names of the results, in their order."""
        return tuple(a.name for a in self.asked)

    @property
    def units(self) -> dict[str, str]:
        """SI units of arguments and results; "1" for none."""
        parts: tuple[Variable | Asked, ...] = (*self.variables, *self.asked)
        return {part.name: part.unit or "1" for part in parts}

    @property
    def start(self) -> Array:
        """The machine's own numbers, (k,), SI, each in its unit."""
        return np.array([v.start for v in self.variables])

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Lowest and highest value of each argument, SI; infinite where no range was given."""
        return [v.bounds for v in self.variables]

    @property
    def poses(self) -> int:
        """How many poses are evaluated."""
        return 1 if self.task is None else len(next(iter(self.task.values())))

    def point(self, x: Point = None) -> Array:
        """Arguments as an array (k,), SI.

        Parameters
        ----------
        x : mapping of name to float or str, or (k,), optional
            SI, or texts with units; those that a mapping does not name are the machine's own.

        Raises
        ------
        ModelError, UnitError
            An unknown name, another length, a value that its field does not allow.
        """
        if x is None:
            return self.start
        if isinstance(x, Mapping):
            for name in x:
                if name not in self.parameters:
                    raise ModelError(
                        visible(str(name)),
                        "is no argument of the function.",
                        choices("Arguments", str(name), self.parameters),
                    )
            return np.array([v.read(x.get(v.name, v.start)) for v in self.variables])
        try:
            values = np.asarray(x, dtype=float)
        except (TypeError, ValueError):
            values = np.empty(0)
        if values.shape != (len(self.variables),):
            raise ModelError(
                "arguments",
                f"are no array of {len(self.variables)} numbers.",
                f"Give them in the order {', '.join(map(visible, self.parameters))}, or by name.",
            )
        return np.array([v.read(n) for v, n in zip(self.variables, values, strict=True)])

    def model(self, x: Point = None) -> Model:
        """The machine at a point.

        Parameters
        ----------
        x : mapping of name to float or str, or (k,), optional
            As `point`, SI.

        Raises
        ------
        ModelError
            It cannot be built: sizes that do not fit one another, joints that do not close.
        """
        return self._model_of(self._changes(self.point(x)))

    def __call__(self, x: Point = None) -> dict[str, Any]:
        """Answers at a point, SI: numbers, or (p,) arrays with the reduction "poses".

        Parameters
        ----------
        x : mapping of name to float or str, or (k,), optional
            As `point`, SI.

        Raises
        ------
        ModelError
            As `model` and `point`.
        UnreachableError, MechanismError, NumericalError
            A pose that the machine cannot take there, or without an answer.
        """
        values = self._every(self.point(x))
        return {a.name: self._reduced(a, values[k]) for k, a in enumerate(self.asked)}

    def jacobian(self, x: Point = None) -> dict[str, Array]:
        """Gradients at a point as arrays (k,), or (p, k) with the reduction "poses".

        Of the worst of several poses it is the gradient at that pose, which jumps where another
        becomes the worst.

        Parameters
        ----------
        x : mapping of name to float or str, or (k,), optional
            As `point`, SI.

        Raises
        ------
        ModelError
            An argument without derivative; the message states why. Else as a call.
        UnreachableError, MechanismError, NumericalError
            As a call.
        """
        at = self.point(x)
        kept = self._kept.get("jacobian")
        if kept is not None and kept[0] == at.tobytes():
            return {name: rates.copy() for name, rates in kept[1].items()}
        values = self._every(at)
        base = self._changes(at)
        tangents = Tangents.of(
            lambda some: self._model_of({**base, **some}),
            [v.at(float(n)) for v, n in zip(self.variables, at, strict=True)],
        )
        for name, why in tangents.refused.items():
            raise ModelError(visible(name), "has no derivative.", why)
        found = self._rates(tangents, values)
        self._kept["jacobian"] = at.tobytes(), found
        return {name: rates.copy() for name, rates in found.items()}

    def gradient(self, x: Point = None) -> dict[str, dict[str, Any]]:
        """Gradients at a point by the names of answer and argument.

        Parameters
        ----------
        x : mapping of name to float or str, or (k,), optional
            As `point`, SI.

        Raises
        ------
        StrutworkError
            As `jacobian`.
        """
        poses = self.reduction == "poses"
        return {
            name: {
                p: rates[..., i] if poses else float(rates[i])
                for i, p in enumerate(self.parameters)
            }
            for name, rates in self.jacobian(x).items()
        }

    def _changes(self, at: Array) -> dict[str, float]:
        changes: dict[str, float] = {}
        for variable, value in zip(self.variables, at.tolist(), strict=True):
            changes |= variable.varied.changes(value)
        return changes

    def _model_of(self, changes: Mapping[str, float]) -> Model:
        return self.machine.model(dict(changes))

    def _vibrating(self, model: Model) -> Vibrating:
        if all(a.kind != "least_dynamic_stiffness" for a in self.asked):
            return Vibrating(None, self.band)
        return Vibrating(model_damping(model), self.band)

    def _stacks(self, picked: Array | None = None) -> list[dict[str, Array] | None]:
        """The poses, or the picked ones of them, some at a time."""
        if self.task is None:
            return [None]
        index = np.arange(self.poses) if picked is None else picked
        parts = [index[i : i + STACK] for i in range(0, len(index), STACK)]
        return [{d: v[part] for d, v in self.task.items()} for part in parts]

    def _every(self, at: Array) -> Array:
        """Values of all answers at all poses, (q, p)."""
        kept = self._kept.get("values")
        if kept is not None and kept[0] == at.tobytes():
            return np.asarray(kept[1])
        model = self._model_of(self._changes(at))
        plain = Tangents(model, (), (), (), (), {})
        vibrating = self._vibrating(model)
        values = np.concatenate(
            [
                sensitivities(model, plain.at(task), self.asked, vibrating)[0]
                for task in self._stacks()
            ],
            axis=1,
        )
        self._kept["values"] = at.tobytes(), values
        return values

    def _rates(self, tangents: Tangents, values: Array) -> dict[str, Array]:
        """Gradients of the reduced answers; at the worst poses alone where these count."""
        worst = [self._worst(a, values[k]) for k, a in enumerate(self.asked)]
        picked = np.unique(worst) if self.reduction == "worst" else np.arange(self.poses)
        vibrating = self._vibrating(tangents.model)
        rates = np.concatenate(
            [
                sensitivities(tangents.model, tangents.at(task), self.asked, vibrating)[1]
                for task in self._stacks(picked)
            ],
            axis=2,
        )
        found = {}
        for k, one in enumerate(self.asked):
            match self.reduction:
                case "worst":
                    rate = rates[k][:, np.searchsorted(picked, worst[k])]
                case "mean":
                    rate = rates[k].mean(axis=-1)
                case _:
                    rate = rates[k].T
            found[one.name] = np.array(rate)
        return found

    def _reduced(self, one: Asked, values: Array) -> Any:
        match self.reduction:
            case "worst":
                return float(values[self._worst(one, values)])
            case "mean":
                return float(values.mean())
            case _:
                return values.copy()

    @staticmethod
    def _worst(one: Asked, values: Array) -> int:
        ranked = -np.abs(values) if one.static is not None else values
        return int(np.argmin(np.where(np.isfinite(ranked), ranked, np.inf)))
