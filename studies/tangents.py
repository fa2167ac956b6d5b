"""What parameters change in a machine, made once for all poses, and at a batch of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, StrutworkError
from strutwork.kinematics import DIRECTIONS, Placement, characteristic_length
from strutwork.kinematics.motion import Moved
from strutwork.machines.model import Model
from strutwork.machines.model_poses import brought, moved, targets
from strutwork.msa import PlacedStructure
from strutwork.msa.changes import Change, PlacedChange
from strutwork.studies.dimension import Dimension

Array = NDArray[Any]

#: Step of a central difference as a share of a number: the cube root of a double's last digit.
STEP = 6e-6

#: Makes the machine of numbers by path, SI.
ModelOf = Callable[[Mapping[str, float]], Model]


@dataclass(frozen=True)
class Tangents:
    """Directions in which parameters change a machine; no pose is in them.

    Parameters
    ----------
    model : Model
    parameters : tuple of Dimension
        Those that can be changed.
    changes : tuple of Change
        Of each parameter.
    above, below : tuple of Model
        A step to either side, without ranges of joints: a pose at the end of one is a pose.
    refused : mapping of parameter name to str
        Why others cannot be changed.
    """

    model: Model
    parameters: tuple[Dimension, ...]
    changes: tuple[Change, ...]
    above: tuple[Model, ...]
    below: tuple[Model, ...]
    refused: Mapping[str, str]

    @classmethod
    def of(cls, model_of: ModelOf, parameters: Sequence[Dimension]) -> Tangents:
        """Make the machine a step above and a step below each parameter.

        Parameters
        ----------
        model_of : callable
            The machine of numbers by path, as `Parametric.model`.
        parameters : sequence of Dimension

        Raises
        ------
        StrutworkError
            The machine itself cannot be made.
        """
        model = model_of({})
        length = characteristic_length(model.placement)
        kept, changes, above, below = [], [], [], []
        refused: dict[str, str] = {}
        for parameter in parameters:
            size = max(abs(v) for v in parameter.numbers.values())
            step = STEP * (size or (length if parameter.unit == "m" else 1.0))
            try:
                high, low = (model_of(parameter.moved(s)) for s in (step, -step))
                one = next(iter(parameter.numbers.values()))
                # the step that the last digits leave
                width = (one + step) - (one - step)
                change = Change(parameter.name, high.structure, low.structure, width)
                _require_same_solids(model, high, low)
            except StrutworkError as error:
                refused[parameter.name] = f"{error.problem} {error.remedy}".strip()
                continue
            kept.append(parameter)
            changes.append(change)
            above.append(replace(high, limits=()))
            below.append(replace(low, limits=()))
        return cls(model, tuple(kept), tuple(changes), tuple(above), tuple(below), refused)

    def at(
        self,
        task: Mapping[str, ArrayLike] | None = None,
        placement_of: Callable[[Model], Placement] | None = None,
    ) -> PlacedTangents:
        """The machine and its changes at a batch of poses, the tool held where the task says.

        Parameters
        ----------
        task : mapping of direction to (p,), optional
            Of the tool, m and rad; what is not named stays as at home, where it can. None: the
            machine as it is described.
        placement_of : callable, optional
            Places a machine, p poses, in place of a task.

        Raises
        ------
        ModelError
            As `strutwork.machines.model_poses.moved`.
        UnreachableError
            A pose that the machine cannot take.
        """
        asked: dict[str, Array] = {}
        held: list[str] = []
        found, tool = None, None
        if placement_of is not None:
            base = placement_of(self.model).require_reachable()
        elif not task:
            base = self.model.placement.flat()
        else:
            asked = {d: np.atleast_1d(np.asarray(v, dtype=float)) for d, v in task.items()}
            found, base = moved(self.model, asked)
            base, tool = base.require_reachable(), found.tool
            held = [d for d in targets(self.model, asked, {}) if d not in asked]
        placed = self.model.structure.at(base)
        changes, missing = [], []
        for change, high, low in zip(self.changes, self.above, self.below, strict=True):
            lost = np.zeros(placed.batch, dtype=bool)
            if self._still(high) and self._still(low):
                changes.append(PlacedChange(change))
                missing.append(lost)
                continue
            sides = []
            for model in (high, low):
                if placement_of is not None:
                    placement = placement_of(model)
                elif not task:
                    placement = model.placement.flat()
                elif model.closed_form is not None and tool is not None:
                    placement = model.closed_form(tool)
                else:
                    placement = _brought(model, asked, held, found)
                lost |= ~placement.reachable
                sides.append(placement)
            if _same(*sides) and _described(high) == _described(low):
                changes.append(PlacedChange(change))
            else:
                pair = [
                    PlacedStructure(m.structure, _where_known(s, base, lost))
                    for m, s in zip((high, low), sides, strict=True)
                ]
                changes.append(PlacedChange(change, *pair))
            missing.append(lost)
        count = placed.batch[0]
        return PlacedTangents(
            placed, tuple(changes), np.array(missing, dtype=bool).reshape(-1, count), self
        )

    def _still(self, model: Model) -> bool:
        """Whether a changed machine surely stands as the machine itself at every pose."""
        return (
            model.closed_form is None
            and model.placement is self.model.placement
            and _described(model) == _described(self.model)
        )


@dataclass(frozen=True)
class PlacedTangents:
    """A machine at p poses, and what parameters change there.

    Parameters
    ----------
    placed : PlacedStructure
        One batch axis of p poses.
    changes : tuple of g PlacedChange
    missing : (g, p) of bool
        Where a changed machine cannot take the pose: there is no derivative.
    tangents : Tangents
        What was placed; its models are at home.
    """

    placed: PlacedStructure
    changes: tuple[PlacedChange, ...]
    missing: NDArray[np.bool_]
    tangents: Tangents


def _require_same_solids(model: Model, *changed: Model) -> None:
    """Refuse what meshes and reduces a solid anew: its monitors may then stand elsewhere.

    Raises
    ------
    ModelError
        A solid is another object than in the machine itself.
    """
    for other in changed:
        for one, two in zip(model.solids, other.solids, strict=True):
            if one is not two:
                raise ModelError(
                    f"solid {one.name}",
                    "is meshed and reduced anew, which changes it by more than a small step.",
                    "Compare two models, or name a number that leaves the solids as they are.",
                )


def _brought(
    model: Model, asked: Mapping[str, Array], held: Sequence[str], beside: Moved | None
) -> Placement:
    """A changed machine at the poses; what the machine itself holds, it holds as at its home."""
    home = dict(zip(DIRECTIONS, model.motion.task_of(model.motion.home_pose), strict=True))
    return brought(model, {**asked, **{d: home[d] for d in held}}, {}, beside).placement


def _described(model: Model) -> tuple[Any, ...]:
    """What moves parts beside the placement: offsets, orientations, ratios of coordinates."""
    structure = model.structure
    beams = tuple((b.offsets, b.orientation) for b in structure.beams)
    return beams, tuple(tie.ratio for tie in structure.linkage.ties)


def _same(one: Placement, other: Placement) -> bool:
    turned = one.turns is None or other.turns is None or np.array_equal(one.turns, other.turns)
    return (
        turned
        and np.array_equal(one.positions, other.positions)
        and np.array_equal(one.frames, other.frames)
    )


def _where_known(placement: Placement, base: Placement, lost: NDArray[np.bool_]) -> Placement:
    """A placement with that of the machine itself in the place of poses it does not reach."""
    if not lost.any():
        return placement
    turns = placement.turns
    if turns is not None and base.turns is not None:
        turns = np.where(lost[:, None, None, None], base.turns, turns)
    return replace(
        placement,
        positions=np.where(lost[:, None, None], base.positions, placement.positions),
        frames=np.where(lost[:, None, None, None], base.frames, placement.frames),
        values=np.where(lost[:, None], base.values, placement.values),
        status=np.zeros(len(lost), dtype=np.int16),
        turns=turns,
    )
