"""Time and memory of a survey, foreseen from a few of its poses before it begins."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.memory import available_memory
from strutwork.stages import stage

Array = NDArray[Any]

#: Longest survey that is begun, s.
LONGEST = 6 * 3600.0
#: Share of the available memory that its results may take.
SHARE = 0.5
#: Poses by which it is foreseen; a grid of fewer than `SMALL` is simply begun.
TRIAL, SMALL = 32, 2048
#: Times that a number is held: among the arrays, in the dataset, and in the text of the file.
HELD = 4.0


@dataclass(frozen=True)
class Foreseen:
    """What a survey will take.

    Parameters
    ----------
    poses : int
    seconds : float
        s.
    memory : float
        Of its results, bytes.
    """

    poses: int
    seconds: float
    memory: float

    def require(
        self,
        part: str,
        remedy: str,
        longest: float | None = LONGEST,
        largest: int | None = None,
    ) -> None:
        """Refuse what takes too long or too much memory.

        Parameters
        ----------
        part : str
            Named in the message.
        remedy : str
        longest : float or None
            s; None where time has no bound.
        largest : int or None
            Poses.

        Raises
        ------
        ModelError
            Says how long, how much, and the bounds.
        """
        most = SHARE * max(available_memory(), 0.0)
        if (
            self.memory <= most
            and (longest is None or self.seconds <= longest)
            and (largest is None or self.poses <= largest)
        ):
            return
        bounds = [] if largest is None else [f"{largest:,} poses"]
        bounds += [] if longest is None else [f"{longest / 3600.0:g} hours"]
        bounds.append(f"{most / 1e9:.3g} GB")
        raise ModelError(
            part,
            f"has {self.poses:,} poses, which would take about {_duration(self.seconds)} and "
            f"{self.memory / 1e9:.2g} GB; at most {', '.join(bounds)} are allowed.",
            remedy,
        )


def foresee(
    asked: Callable[[dict[str, Array]], Mapping[str, Array]],
    grid: TaskGrid,
    workers: int | None = None,
) -> Foreseen:
    """Measure some poses of a grid, after one that compiles and prepares.

    Parameters
    ----------
    asked : callable
        Arrays (p, ...) of poses, whose task coordinates it is given, (p,) each.
    grid : TaskGrid
    workers : int, optional
        Threads that share the work; default one per processor.
    """
    count = len(grid)
    which = np.unique(np.linspace(0, count - 1, min(TRIAL, count)).round().astype(np.int64))
    places = np.unravel_index(which, grid.shape)
    task = {d: v[i] for (d, v), i in zip(grid.axes.items(), places, strict=True)}
    with stage("measures how long a pose takes"):
        asked({d: v[:1] for d, v in task.items()})
        begun = time.perf_counter()
        found = asked(task)
        a_pose = (time.perf_counter() - begun) / len(which)
    numbers = len(task) + sum(
        float(np.prod(v.shape[1:])) for v in found.values() if v.shape[:1] == which.shape
    )
    threads = min(workers or os.cpu_count() or 1, max(1, count // TRIAL))
    return Foreseen(count, a_pose * count / threads, 8.0 * HELD * numbers * count)


def _duration(seconds: float) -> str:
    if seconds < 120.0:
        return f"{seconds:.2g} s"
    if seconds < 7200.0:
        return f"{seconds / 60.0:.2g} minutes"
    return f"{seconds / 3600.0:,.0f} hours"
