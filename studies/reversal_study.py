"""Reversals of a machine's drives over a surface."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics.clear_paths import ClearPath
from strutwork.kinematics.drive_fields import MotionField
from strutwork.kinematics.reversals import Reversals, reversals
from strutwork.kinematics.task_surfaces import TaskSurface
from strutwork.machines.limits import check_limits
from strutwork.machines.model import Model
from strutwork.memory import available_memory
from strutwork.studies.progress import Progress

Array = NDArray[Any]

#: Directions that are tried for the longest path where no feed is given.
HEADINGS = 12

#: Lines along each of them.
LINES = 11

#: Points by which the time of a grid is foreseen.
SAMPLE = 64

#: Longest study that is begun, s.
LONGEST = 3600.0

#: Evaluations of a study for each point of its grid: paths, lines, searches.
WORK = 20.0


@dataclass(frozen=True)
class ReversalStudy:
    """What the drives of a machine do over a surface.

    Parameters
    ----------
    found : Reversals
        With the grid, the gradients, and `singular`.
    feed : (2,) or None
        Direction of the parameters along which the tool is fed, m or rad.
    lines : mapping of drive to list of (c, 2)
        Parameters at which the feed makes it turn back, m or rad; empty without a feed.
    longest : ClearPath or None
        Without a reversal: along the feed, or along the best of `HEADINGS` directions.
    plates : int
        As many as the grid tells apart.
    reach : float or None
        Share of the reachable grid points to which a path without a reversal leads from the
        one in the middle; None where that is out of reach.
    outside : int
        Grid points outside a joint's range.
    """

    found: Reversals
    feed: Array | None
    lines: dict[str, list[Array]]
    longest: ClearPath | None
    plates: int
    reach: float | None
    outside: int


def reversal_study(
    model: Model,
    surface: TaskSurface,
    axes: tuple[Array, Array],
    feed: str | None = None,
    progress: Progress | None = None,
) -> ReversalStudy:
    """Study the drives of a machine over a surface.

    Parameters
    ----------
    model : Model
    surface : TaskSurface
    axes : two of (k,)
        Grid along the surface's parameters, ascending, three points or more.
    feed : str, optional
        One of the surface's parameters.
    progress : callable, optional
        Called with how many steps are done, and of how many.

    Returns
    -------
    ReversalStudy

    Raises
    ------
    ModelError
        No drive, a surface that the tool cannot follow, an unknown feed, or a grid that would
        take too long or too much memory.
    UnreachableError
        No point of the surface can be reached.
    """
    names = surface.parameters
    if feed is not None and feed not in names:
        raise ModelError("feed", f'"{feed}" is neither {names[0]} nor {names[1]}.', "Name one.")

    def tell(done: int) -> None:
        if progress is not None:
            progress(done, 5)

    field = MotionField(model.motion, surface, model.closed_form)
    _require_feasible(field, axes)
    try:
        found = reversals(field, *axes)
    except UnreachableError as error:
        centre = np.array([[(axis[0] + axis[-1]) / 2 for axis in axes]])
        why = (
            field.placements(centre)[0].reason(0)
            or "the tool's motion does not determine that of the drives"
        )
        raise UnreachableError(
            error.part, f"{error.problem.rstrip('.')}; in its middle: {why}.", error.remedy
        ) from error
    # a range that the placements do not give ends the study before its long part
    placed = check_limits(model.limits, field.placements(found.patch.points)[0])
    outside = np.count_nonzero(~placed.reachable.reshape(found.reachable.shape) & found.reachable)
    tell(1)
    _ = found.singular
    tell(2)
    way = None if feed is None else np.eye(2)[names.index(feed)]
    lines = {} if way is None else found.lines(way)
    tell(3)
    longest = found.longest(_headings(names), LINES) if way is None else found.longest(way[None])
    tell(4)
    middle = (len(axes[0]) // 2, len(axes[1]) // 2)
    seen = found.reach(middle)
    reachable = np.count_nonzero(found.reachable)
    tell(5)
    return ReversalStudy(
        found,
        way,
        lines,
        longest,
        int(found.plates.max()),
        float(seen.sum() / reachable) if found.reachable[middle] else None,
        int(outside),
    )


def _headings(names: tuple[str, str]) -> Array:
    if names[0].startswith("r") != names[1].startswith("r"):
        # a length and an angle have no direction between them
        return np.eye(2)
    angle = np.pi * np.arange(HEADINGS) / HEADINGS
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _require_feasible(field: MotionField, axes: tuple[Array, Array]) -> None:
    """Refuse what would take too long or too much memory, foreseen from a few points."""
    count = len(axes[0]) * len(axes[1])
    drives = len(field.drives)
    need = 8.0 * count * (6 * drives + 2 * drives**2)
    if count <= 10_000 and need <= 0.5 * available_memory():
        return
    share = np.linspace(0.0, 1.0, SAMPLE)
    points = np.stack([a[0] + share * (a[-1] - a[0]) for a in axes], axis=-1)
    field.gradient(points[:2])
    start = perf_counter()
    field.gradient(points)
    seconds = (perf_counter() - start) / SAMPLE * count * WORK
    if need <= 0.5 * available_memory() and seconds <= LONGEST:
        return
    raise ModelError(
        "grid",
        f"of {count:,} points would take about {need / 1e9:.2g} GB and {seconds / 3600:.2g} hours.",
        "Take fewer points.",
    )
