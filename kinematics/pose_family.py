"""Poses by a few parameters, and what tool and drives can do at them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import characteristic_length
from strutwork.kinematics.tool_drive_space import Freedoms, ToolDriveSpace, tool_drive_space

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Told how many of how many poses are done.
Progress = Callable[[int, int], None]

#: Poses that are placed at once.
PIECE = 512


@dataclass(frozen=True)
class TaskSection:
    """A line or a plane of poses in task coordinates.

    Parameters
    ----------
    motion : Motion
    names : tuple of directions
        Task coordinates that the parameters are, k of them.
    held : mapping of direction to float
        Other coordinates of the tool with their values, m and rad.
    """

    motion: Motion
    names: tuple[str, ...]
    held: Mapping[str, float]

    @classmethod
    def of(
        cls, motion: Motion, names: tuple[str, ...], at: Mapping[str, float] | None = None
    ) -> TaskSection:
        """The section through `at`; what is not named stays as at home, where it can.

        Parameters
        ----------
        motion : Motion
            With a tool.
        names : tuple of directions
            Task coordinates that the parameters are.
        at : mapping of direction to float, optional
            Other coordinates of the tool with their values, m and rad.

        Raises
        ------
        ModelError
            A coordinate named twice or unknown, or one in which the tool cannot move.
        """
        given = dict(at or {})
        for name in (*names, *given):
            if name not in DIRECTIONS:
                raise ModelError(
                    "section",
                    f'names the unknown direction "{name}".',
                    "Directions are " + ", ".join(DIRECTIONS) + ".",
                )
        twice = [n for n in (*names, *given) if [*names, *given].count(n) > 1]
        if twice:
            raise ModelError("section", f"names {twice[0]} twice.", "Name a direction once.")
        return cls(motion, names, given | motion.rest((*names, *given)))

    @property
    def directions(self) -> tuple[int, ...]:
        """All coordinates that are given, in the order of `DIRECTIONS`."""
        return tuple(k for k, d in enumerate(DIRECTIONS) if d in self.names or d in self.held)

    def values(self, parameters: Array) -> dict[str, Array]:
        """Task coordinates at parameters (p, k), (p,) each.

        Parameters
        ----------
        parameters : (p, k)
            m and rad, in the order of `names`.
        """
        found = {name: parameters[:, k] for k, name in enumerate(self.names)}
        found |= {name: np.full(len(parameters), v) for name, v in self.held.items()}
        return found

    def place(self, parameters: Array) -> Placement:
        """Placements at parameters (p, k).

        Parameters
        ----------
        parameters : (p, k)
            m and rad, in the order of `names`.
        """
        return self.motion.move(task=self.values(parameters)).placement


@dataclass(frozen=True)
class PoseFamily:
    """Poses of a linkage by k parameters.

    Parameters
    ----------
    linkage : Linkage
    place : callable
        Placement at parameters (p, k); poses out of reach are marked.
    names : tuple of str
        Of the parameters.
    length : float
        L, m: how much translation counts as much as one radian.
    known : Freedoms or None
        Ranks at poses that are not singular; None until poses have been looked at.
    section : TaskSection or None
        Where parameters are task coordinates of a motion: the end of reach is then found along
        the motion itself.
    """

    linkage: Linkage
    place: Callable[[Array], Placement]
    names: tuple[str, ...]
    length: float
    known: Freedoms | None = None
    section: TaskSection | None = None

    @classmethod
    def along(
        cls,
        section: TaskSection,
        length: float | None = None,
        place: Callable[[Array], Placement] | None = None,
    ) -> PoseFamily:
        """The poses of a section of task coordinates.

        Parameters
        ----------
        section : TaskSection
        length : float, optional
            m; default the machine's `characteristic_length` at home.
        place : callable, optional
            In place of the section's own, as where joint ranges count too.
        """
        motion = section.motion
        chosen = characteristic_length(motion.home) if length is None else length
        return cls(motion.linkage, place or section.place, section.names, chosen, section=section)

    def __repr__(self) -> str:
        return f"<PoseFamily: {', '.join(self.names)}; L = {1e3 * self.length:.4g} mm>"

    def look(self, parameters: Array, progress: Progress | None = None) -> Looked:
        """Place poses and determine their spaces.

        Parameters
        ----------
        parameters : (p, k)
            m and rad, in the order of `names`.
        progress : callable, optional
            Called with the number of poses done and that of all.

        Raises
        ------
        ModelError
            As `tool_drive_space`; and no pose is reached while ranks are not known.
        """
        placements: list[Placement] = []
        reach = np.zeros(len(parameters), dtype=bool)
        reasons = np.zeros(len(parameters), dtype=np.intp)
        words = [""]
        for first in range(0, len(parameters), PIECE):
            placed = self.place(parameters[first : first + PIECE])
            piece = slice(first, first + len(placed.reachable))
            reach[piece] = placed.reachable
            words += [w for w in placed.reasons if w not in words]
            number = np.array([0, *(words.index(w) for w in placed.reasons)])
            reasons[piece] = number[np.asarray(placed.status)]
            placements.append(placed[placed.reachable])
            if progress is not None:
                progress(min(first + PIECE, len(parameters)), len(parameters))
        if not reach.any() and self.known is None:
            raise ModelError(
                "section",
                f"no pose of the {len(parameters)} can be reached: {words[-1]}.",
                "Move it into the machine's reach.",
            )
        found = joined(placements) if placements else self.place(parameters)
        space = tool_drive_space(self.linkage, found, self.length, self.known)
        return Looked(parameters, reach, found, space, reasons, tuple(words))


@dataclass(frozen=True)
class Looked:
    """Poses that were looked at.

    Parameters
    ----------
    parameters : (p, k)
        m or rad.
    reach : (p,) of bool
    placement : Placement
        Of those that are reached only, in order.
    space : ToolDriveSpace
        The same.
    reason : (p,) of int
        Index into `reasons`, whose first is empty: why a pose is not reached.
    reasons : tuple of str
    """

    parameters: Array
    reach: Mask
    placement: Placement
    space: ToolDriveSpace
    reason: NDArray[np.intp]
    reasons: tuple[str, ...]

    @cached_property
    def index(self) -> NDArray[np.intp]:
        """Where each pose stands among those that are reached; −1 for the others, (p,)."""
        return np.where(self.reach, np.cumsum(self.reach) - 1, -1)

    def spread(self, values: Array) -> Array:
        """Values at the poses that are reached as values at all, NaN elsewhere, (p,).

        Parameters
        ----------
        values : (r,)
            One for each of the r poses that are reached, any unit.
        """
        result = np.full(len(self.reach), np.nan)
        result[self.reach] = values
        return result


def joined(placements: list[Placement]) -> Placement:
    """Placements of one batch axis one after the other.

    Parameters
    ----------
    placements : list of Placement
        Of one linkage, all poses good; at least one.
    """
    first = placements[0]

    def chained(arrays: list[Array | None]) -> Array | None:
        kept = [a for a in arrays if a is not None]
        return np.concatenate(kept) if len(kept) == len(arrays) else None

    positions, frames, values = (
        np.concatenate([getattr(p, name) for p in placements])
        for name in ("positions", "frames", "values")
    )
    return replace(
        first,
        positions=positions,
        frames=frames,
        values=values,
        status=np.zeros(len(positions), dtype=np.int8),
        reasons=(),
        turns=chained([p.turns for p in placements]),
    )
