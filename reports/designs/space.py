"""Poses over which two machines are compared: those that their workspaces share, from home on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import StrutworkError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.names import listed
from strutwork.reports.survey_words import grid_text
from strutwork.studies.comparison import HALF, POINTS, common_task

Array = NDArray[Any]

#: Coordinates that differ by less, m and rad, are the same.
SAME = 1e-9


@dataclass(frozen=True)
class Space:
    """What both machines are looked at over.

    Parameters
    ----------
    a, b : TaskGrid or None
        Poses of either, as its own coordinates have them; None where it has none.
    shared : bool
        Whether they are the same poses, counted from the home of each.
    words : str
        Which they are and why, a sentence.
    why_a, why_b : str
        Why one has no poses.
    asked : bool
        Whether they were asked for, and are not those that the machines state.
    """

    a: TaskGrid | None
    b: TaskGrid | None
    shared: bool
    words: str
    why_a: str = ""
    why_b: str = ""
    asked: bool = False


def space_of(a: Model, b: Model, around: TaskGrid | None = None) -> Space:
    """The poses over which two machines are compared.

    Parameters
    ----------
    a, b : Model
        At home.
    around : TaskGrid, optional
        Poses counted from the home of each, in place of those that their workspaces share.

    Returns
    -------
    Space
        What the stated workspaces share where they go in the same directions, counted from home;
        else each machine's own.
    """
    missing = ["" if m.tool is not None else "it has no tool: add [tool] with tcp" for m in (a, b)]
    if any(missing):
        return Space(
            None, None, False, "A machine without a tool has no poses.", missing[0], missing[1]
        )
    if around is not None:
        return replace(_shared(a, b, around, "those requested"), asked=True)
    spaces = [_from_home(m) for m in (a, b)]
    if spaces[0] is None and spaces[1] is None:
        return _cubes(a, b)
    for own, other in (spaces, spaces[::-1]):
        if own is None:
            assert other is not None  # noqa: S101 - both absent was before
            which = "B" if own is spaces[0] else "A"
            return _shared(
                a, b, other, f"those of the workspace of {which}, since the other states none"
            )
    first, second = spaces
    assert first is not None and second is not None  # noqa: S101, PT018
    shared = _overlap(first, second)
    if shared is not None:
        return _shared(a, b, shared, "those that both workspaces contain")
    return Space(
        a.workspace,
        b.workspace,
        False,
        f"The workspaces have the directions {_along(first)} in A and {_along(second)} in B: each "
        "machine is studied over its own, and the two worst poses belong to different tasks.",
    )


def _from_home(model: Model) -> TaskGrid | None:
    """The stated workspace, counted from home; its directions of one value only where they move."""
    if model.workspace is None:
        return None
    home = _home(model)
    moved = {d: np.asarray(v) - home[d] for d, v in model.workspace.axes.items()}
    kept = {d: v for d, v in moved.items() if len(v) > 1 or abs(v[0]) > SAME}
    return TaskGrid(kept or moved)


def _home(model: Model) -> dict[str, float]:
    six = model.motion.task_of(model.motion.home_pose)
    return dict(zip(DIRECTIONS, np.asarray(six, dtype=float).ravel().tolist(), strict=True))


def _overlap(first: TaskGrid, second: TaskGrid) -> TaskGrid | None:
    """What two grids about home share; None where they go in other directions or are apart."""
    if set(first.axes) != set(second.axes):
        return None
    axes: dict[str, Array] = {}
    for direction, one in first.axes.items():
        other = second.axes[direction]
        if len(one) == len(other) and np.allclose(one, other, rtol=0.0, atol=SAME):
            axes[direction] = one
            continue
        low, high = max(one[0], other[0]), min(one[-1], other[-1])
        if not low < high or min(len(one), len(other)) < 2:
            return None
        axes[direction] = np.linspace(low, high, max(len(one), len(other)))
    return TaskGrid(axes)


def _shared(a: Model, b: Model, about: TaskGrid, which: str) -> Space:
    words = f"Poses are {which}, counted from the home of each machine; {grid_text(about)}."
    return Space(_at(a, about), _at(b, about), True, words)


def _at(model: Model, about: TaskGrid) -> TaskGrid:
    home = _home(model)
    return TaskGrid({d: home[d] + v for d, v in about.axes.items()})


def _cubes(a: Model, b: Model) -> Space:
    """Neither says where it works: a small cube about home."""
    grids: list[TaskGrid | None] = []
    why = []
    for model in (a, b):
        try:
            grids.append(common_task(model))
            why.append("")
        except StrutworkError as error:
            grids.append(None)
            why.append(" ".join(str(error).split()))
    same = all(grids) and set(grids[0].axes) == set(grids[1].axes)  # type: ignore[union-attr]
    words = (
        f"Neither states a workspace: poses are {2e3 * HALF:g} mm about the home of each, at "
        f"{POINTS} points along each of its translations."
    )
    return Space(grids[0], grids[1], same, words, why[0], why[1])


def _along(grid: TaskGrid) -> str:
    return listed(list(grid.axes))
