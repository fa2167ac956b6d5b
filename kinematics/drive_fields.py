"""Drive coordinates and their gradients over a surface of two parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.jacobians import jacobians
from strutwork.kinematics.mechanism import Poses
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.task_surfaces import TaskSurface
from strutwork.kinematics.turns import rotation_matrix, rotation_vector, vector_rates

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Task rates that a tool cannot make count as such above this share of them.
UNMADE = 1e-6

#: Points that are placed at once.
PIECE = 4096


class DriveField(Protocol):
    """What the drives do over two parameters."""

    @property
    def drives(self) -> tuple[str, ...]:
        """Names of the drives."""

    def gradient(self, points: Array) -> Array:
        """Derivatives of the drives' coordinates at (m, 2), (m, n, 2).

        NaN at a point that the machine cannot take.

        Parameters
        ----------
        points : (m, 2)
            Values of the two parameters, m or rad.
        """

    def speed(self, points: Array, way: Array) -> Array:
        """Length of path that the tool makes per unit of a way (2,) of the parameters, (m,).

        Parameters
        ----------
        points : (m, 2)
            Values of the two parameters, m or rad.
        way : (2,)
            Change of the parameters, m or rad.
        """


@dataclass(frozen=True)
class FormulaField:
    """Drives by formulas of one's own.

    Parameters
    ----------
    drives : tuple of str
    formula : callable
        Gradient (m, n, 2) at points (m, 2).
    """

    drives: tuple[str, ...]
    formula: Callable[[Array], ArrayLike]

    def gradient(self, points: Array) -> Array:
        """Derivatives at (m, 2), (m, n, 2).

        Parameters
        ----------
        points : (m, 2)
            Values of the two parameters, in the units of the formula.
        """
        return np.asarray(self.formula(points), dtype=float)

    @staticmethod
    def speed(points: Array, way: Array) -> Array:
        """Length in the parameters themselves, (m,), in their units.

        Parameters
        ----------
        points : (m, 2)
            Only counted; values of the parameters in their units.
        way : (2,)
            Change of the parameters, in their units.
        """
        return np.full(len(points), np.linalg.norm(way))


@dataclass(frozen=True)
class MotionField:
    """Drives of a linkage whose tool is led over a surface.

    The gradients come from the constraint rows at each point: of the tool's twists that the
    linkage can make, the one that has the surface's rates, and the drives' rates with it.

    Parameters
    ----------
    motion : Motion
        With a tool and drives.
    surface : TaskSurface
        Task coordinates that it does not give stay as at home, where they can.
    closed_form : callable, optional
        Placement at poses of the tool; in place of the motion where the surface and what stays
        fix all six coordinates of the tool.

    Raises
    ------
    ModelError
        No tool or no drive; the tool cannot move as the surface asks (names the direction).
    """

    motion: Motion
    surface: TaskSurface
    closed_form: Callable[[Poses], Placement] | None = None

    def __post_init__(self) -> None:
        if not self.motion.linkage.driven:
            raise ModelError(
                "linkage",
                "has no driven direction.",
                "Reversals are those of drives: name at least one.",
            )
        _ = self._held

    @property
    def drives(self) -> tuple[str, ...]:
        """Joint and direction of each drive."""
        return tuple(f"{joint}:{direction}" for joint, direction in self.motion.linkage.driven)

    @cached_property
    def _held(self) -> dict[str, float]:
        return self.motion.rest(self.surface.named)

    def placements(self, points: Array) -> tuple[Placement, Array, Array]:
        """Where the linkage stands at points (m, 2).

        Parameters
        ----------
        points : (m, 2)
            Values of the surface's parameters, m or rad.

        Returns
        -------
        placement : Placement
            Poses out of reach are marked.
        turn : (m, 3)
            Rotation vector of the tool from home, rad.
        rates : (m, t, 2)
            Of the task coordinates that are given or held, those given first.
        """
        given, rates = self.surface.task(np.asarray(points, dtype=float))
        count = len(points)
        still = np.zeros((count, len(self._held), 2))
        rates = np.concatenate([rates, still], axis=1)
        task = given | {name: np.full(count, value) for name, value in self._held.items()}
        if self.closed_form is not None and len(task) == 6:
            place = np.stack([task[d] for d in ("x", "y", "z")], axis=-1)
            turn = np.stack([task[d] for d in ("rx", "ry", "rz")], axis=-1)
            rotation = rotation_matrix(turn) @ self.motion.rotation
            return self.closed_form(Poses(place, rotation)), turn, rates
        moved = self.motion.move(task=task)
        if moved.tool is None:  # pragma: no cover - `rest` has asked for it
            raise ModelError("linkage", "has no tool.", "Name the tool centre point's node.")
        turned = moved.tool.rotation @ np.swapaxes(self.motion.rotation, -1, -2)
        return moved.placement, rotation_vector(turned), rates

    @cached_property
    def _order(self) -> tuple[str, ...]:
        return (*self.surface.named, *self._held)

    def gradient(self, points: Array) -> Array:
        """Derivatives of the drives' coordinates at (m, 2), (m, n, 2), m or rad per unit.

        NaN where the machine cannot stand, or the tool's rates do not settle the drives'.

        Parameters
        ----------
        points : (m, 2)
            Values of the surface's parameters, m or rad.
        """
        pieces = [
            self._some(points[first : first + PIECE]) for first in range(0, len(points), PIECE)
        ]
        return np.concatenate(pieces) if pieces else np.zeros((0, len(self.drives), 2))

    def _some(self, points: Array) -> Array:
        placement, turn, rates = self.placements(points)
        found = np.full((len(points), len(self.drives), 2), np.nan)
        good = np.flatnonzero(placement.reachable)
        if not good.size:
            return found
        rows = jacobians(self.motion.linkage, placement[good])
        task = np.zeros((len(good), len(self._order), 6))
        spin = vector_rates(turn[good])
        for k, direction in enumerate(self._order):
            axis = "xyz".index(direction[-1])
            if direction.startswith("r"):
                task[:, k, 3:] = spin[:, axis]
            else:
                task[:, k, axis] = 1.0
        motions = np.eye(6) if rows.motions is None else rows.motions
        # turns count at the machine's size, so that what the tool cannot do shows as a rank
        turning = np.array([d.startswith("r") for d in self._order], dtype=float)
        size = rows.length[:, None, None] ** turning[:, None]
        twist = motions @ np.linalg.pinv(size * (task @ motions), rcond=1e-9) @ (size * rates[good])
        made = np.abs(size * (task @ twist - rates[good])).max(axis=(1, 2))
        asked = np.abs(size * rates[good]).max(axis=(1, 2))
        settled = ~rows.serial & (made <= UNMADE * asked)
        safe = np.where(np.isfinite(rows.inverse), rows.inverse, 0.0)
        found[good] = np.where(settled[:, None, None], safe @ twist, np.nan)
        return found

    def speed(self, points: Array, way: Array) -> Array:
        """Path of the tool centre point per unit of a way (2,) of the parameters, (m,), m.

        Where the way turns the tool only, rad of its rotation vector.

        Parameters
        ----------
        points : (m, 2)
            Values of the surface's parameters, m or rad.
        way : (2,)
            Change of the parameters, all m or all rad.

        Raises
        ------
        ModelError
            A way that mixes a length with an angle.
        """
        kinds = {p.startswith("r") for p, w in zip(self.surface.parameters, way, strict=True) if w}
        if len(kinds) > 1:
            raise ModelError(
                "path",
                f"mixes {self.surface.parameters[0]} and {self.surface.parameters[1]}, a length "
                "and an angle: it has no length.",
                "Feed along one of the two.",
            )
        _, rates = self.surface.task(points)
        first = 3 if kinds == {True} else 0
        names = self.surface.named
        pick = [k for k, n in enumerate(names) if n.startswith("r") == (first == 3)]
        return np.asarray(np.linalg.norm(rates[:, pick] @ way, axis=-1))
