"""Grids as a reader types them: `x=-100mm..100mm:5,rz=0deg..20deg:3`."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.reports.motion_table import targets_of_words

#: Points along a direction where none are said.
POINTS = 5
#: Most of them: further ones make no grid that anybody waits for.
MOST = 10_000_000


def grid_of_words(words: Iterable[str], part: str = "--over", points: int = POINTS) -> TaskGrid:
    """A grid of task coordinates.

    Parameters
    ----------
    words : iterable of str
        `DIR=LOW..HIGH` or `DIR=LOW..HIGH:POINTS`, several separated by commas; `DIR=VALUE` for
        one place.
    part : str
        Named in messages.
    points : int
        Where a word does not say.

    Raises
    ------
    ModelError
        A word of another shape, a direction that does not exist or is given twice, no extent,
        fewer than two points, too many poses.
    UnitError
        A value that is no length, or for a rotation no angle.
    """
    axes: dict[str, np.ndarray[tuple[int], np.dtype[np.float64]]] = {}
    for word in (w.strip() for text in words for w in text.split(",")):
        name, equals, span = word.partition("=")
        name = name.strip()
        if not equals or name not in DIRECTIONS:
            raise ModelError(
                part,
                f'"{word}" is not a range of a direction.',
                "Write it as in x=-100mm..100mm:5 or rz=0deg..20deg.",
            )
        if name in axes:
            raise ModelError(part, f"gives {name} twice.", "Give it once.")
        low, dots, rest = span.partition("..")
        high, colon, number = rest.partition(":")
        if not dots:
            axes[name] = np.array([_value(name, low, part)])
            continue
        count = points
        if colon:
            if not number.strip().isascii() or not number.strip().isdigit() or len(number) > 9:
                raise ModelError(part, f'"{word}" has no number of points.', "Write it as in :5.")
            count = int(number)
        if count < 2:
            raise ModelError(part, f'"{word}" has fewer than two points.', "Give two or more.")
        first, last = _value(name, low, part), _value(name, high, part)
        if not first < last:
            raise ModelError(part, f'"{word}" has no extent.', "Give the lower end first.")
        if count > MOST:
            raise ModelError(
                part,
                f'"{word}" has more than the {MOST:,} points that are allowed along a direction.',
                "Use fewer points.",
            )
        axes[name] = np.linspace(first, last, count)
    return TaskGrid({d: axes[d] for d in DIRECTIONS if d in axes})


def _value(name: str, text: str, part: str) -> float:
    return next(iter(targets_of_words([f"{name}={text}"], part).values()))
