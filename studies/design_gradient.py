"""The quantities of a design with their gradients, from the adjoint of the machine's own rows."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.kinematics import Placement, Poses
from strutwork.machines.model import Model
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free, compliance_and_outcome
from strutwork.studies.design import Design
from strutwork.studies.design_quantities import COST, MEAN, Quantity
from strutwork.studies.design_smooth import AT_HOME, smooth_names
from strutwork.studies.dynamic import ONE_PERCENT
from strutwork.studies.function_variable import Variable
from strutwork.studies.gradient_quantities import Asked as Answer
from strutwork.studies.gradient_quantities import Vibrating, read_quantity, sensitivities
from strutwork.studies.model_damping import model_damping
from strutwork.studies.pose_sets import PoseList
from strutwork.studies.question import Asked
from strutwork.studies.tangents import PlacedTangents, Tangents

Array = NDArray[np.float64]

#: Poses that are solved at once.
STACK = 64

#: Stiffness at the tool from its compliance, by the kinds of `gradient_quantities`.
_STIFFNESS = {"stiffness": axis_stiffness_free, "blocked_stiffness": axis_stiffness_blocked}

#: Places a machine and its changes at some poses.
Placed = Callable[[Tangents], PlacedTangents]


@dataclass(frozen=True)
class Gradients:
    """Values of the quantities of a design, and their gradients along some parameters.

    Parameters
    ----------
    design : Design
        Whose quantities have gradients, as `strutwork.studies.design_smooth.require_smooth` checks.
    along : tuple of int
        Numbers of the parameters that move, g of them.
    """

    design: Design
    along: tuple[int, ...]

    def values(self, sample: Array) -> dict[str, Array]:
        """Each quantity of one machine, at every pose of which it is the least, (p,), any unit.

        Of a mean, and of what no pose changes, it has one number.

        Parameters
        ----------
        sample : (k,)
            Of the parameters, each in its unit, any unit.

        Raises
        ------
        StrutworkError
            The machine cannot be, misses a pose, or has no finite answer.
        """
        model = self._model({}, sample)
        return self._asked(Tangents(model, (), (), (), (), {}), sample)[0]

    def rates(self, sample: Array) -> dict[str, Array]:
        """Gradients of the same, (g, p), per unit of each parameter, any unit.

        Parameters
        ----------
        sample : (k,)
            Of the parameters, each in its unit, any unit.

        Raises
        ------
        StrutworkError
            As `values`; a parameter without derivative, with the reason.
        """
        steps = [Variable(self.design.varied[i], 0.0).at(float(sample[i])) for i in self.along]
        tangents = Tangents.of(lambda some: self._model(some, sample), steps)
        for name, why in tangents.refused.items():
            raise ModelError(f"parameter {name}", "has no derivative.", why)
        return self._asked(tangents, sample)[1]

    def _model(self, some: Mapping[str, float], sample: Array) -> Model:
        changes: dict[str, float | str] = {}
        for parameter, value in zip(self.design.varied, sample.tolist(), strict=True):
            changes |= parameter.changes(value)
        return self.design.machine.model({**changes, **some})

    def _asked(
        self, tangents: Tangents, sample: Array
    ) -> tuple[dict[str, Array], dict[str, Array]]:
        values: dict[str, Array] = {}
        rates: dict[str, Array] = {}
        homely = [q for q in self.design.quantities if q.name in AT_HOME]
        other = [q for q in self.design.quantities if q.name not in AT_HOME]
        for quantities, places in ((homely, [_at_home]), (other, self._places)):
            if not quantities:
                continue
            names = tuple(dict.fromkeys(n for q in quantities for n in smooth_names(q)))
            asked = [read_quantity(tangents.model, name) for name in names]
            vibrating = self._vibrating(tangents.model)
            found = [_solved(tangents.model, p(tangents), asked, vibrating) for p in places]
            value = np.concatenate([f[0] for f in found], axis=1)
            rate = np.concatenate([f[1] for f in found], axis=2)
            if not np.isfinite(value).all() or not np.isfinite(rate).all():
                raise NumericalError(
                    "design", "has a quantity or gradient that is not finite.", "Change its ranges."
                )
            for q in quantities:
                rows = [names.index(n) for n in smooth_names(q)]
                taken, slopes = _reduced(q, value[rows], rate[rows])
                if q.name == COST:
                    taken, slopes = self._cost(taken, slopes, sample)
                values[q.name], rates[q.name] = taken, slopes
        return values, rates

    def _cost(self, mass: Array, slopes: Array, sample: Array) -> tuple[Array, Array]:
        cost, rates = self.design.cost, self.design.rates
        value = cost.fixed + cost.per_kg * mass + float(sample @ rates)
        own = rates[list(self.along)] if len(slopes) else rates[:0]
        return value, cost.per_kg * slopes + own[:, None]

    def _vibrating(self, model: Model) -> Vibrating:
        if self._band is None:
            return Vibrating()
        return Vibrating(model_damping(model) or ONE_PERCENT, self._band)

    @cached_property
    def _band(self) -> tuple[float, float] | None:
        asked = [q for q in self.design.variants.questions if isinstance(q, Asked)]
        return next((q.band for q in asked if q.name == "vibration"), None)

    @cached_property
    def _places(self) -> Sequence[Placed]:
        """What places machines at the poses, some of them at a time."""
        workspace = self.design.workspace
        if workspace is None:
            return [_at_home]
        parts = [slice(i, i + STACK) for i in range(0, len(workspace), STACK)]
        if isinstance(workspace, PoseList):
            return [_in_list(_part(workspace, part)) for part in parts]
        task = workspace.task()
        return [_on_way({d: v[part] for d, v in task.items()}) for part in parts]


def _solved(
    model: Model, found: PlacedTangents, asked: Sequence[Answer], vibrating: Vibrating
) -> tuple[Array, Array]:
    """Values (q, p) and gradients (q, g, p)."""
    if found.changes or any(a.kind not in _STIFFNESS for a in asked):
        return sensitivities(model, found, asked, vibrating)[:2]
    # without gradients the elimination is several times faster
    compliance, outcome = compliance_and_outcome(found.placed)
    if not outcome.solved.all():
        raise NumericalError(
            "design", "has a pose without an answer.", "Change its ranges or its poses."
        )
    values = np.array([_STIFFNESS[a.kind](compliance)[:, a.direction] for a in asked])
    return values, np.zeros((len(asked), 0, values.shape[1]))


def _at_home(tangents: Tangents) -> PlacedTangents:
    return tangents.at(None)


def _on_way(task: Mapping[str, Array]) -> Placed:
    return lambda tangents: tangents.at(task)


def _in_list(poses: PoseList) -> Placed:
    def placement(model: Model) -> Placement:
        return poses.placement(model)

    return lambda tangents: tangents.at(placement_of=placement)


def _part(poses: PoseList, part: slice) -> PoseList:
    some = Poses(poses.poses.position[part], poses.poses.rotation[part])
    return PoseList(poses.name, some, poses.joint_kinds)


def _reduced(quantity: Quantity, values: Array, rates: Array) -> tuple[Array, Array]:
    """Values (r, p) and rates (r, g, p) as one row (n,) and (g, n), the mean as one number."""
    value, rate = values.ravel(), np.swapaxes(rates, 0, 1).reshape(rates.shape[1], values.size)
    if quantity.reduction == MEAN:
        return value.mean(keepdims=True), rate.mean(axis=1, keepdims=True)
    return value, rate
