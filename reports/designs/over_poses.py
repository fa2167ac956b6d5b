"""Least stiffness of two machines over poses, and how many of them each takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.errors import ClusterError, OutputError, StrutworkError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.names import visible
from strutwork.reports.designs.design import Answers, Design
from strutwork.reports.designs.quantities import of_question
from strutwork.reports.designs.row import Value
from strutwork.reports.designs.space import Space
from strutwork.reports.survey_words import least
from strutwork.studies.answers import Stiffness
from strutwork.studies.filters import PoseStatus
from strutwork.studies.progress import Teller
from strutwork.studies.survey import survey

Array = NDArray[Any]


@dataclass(frozen=True)
class OverPoses:
    """What both machines answer over poses.

    Parameters
    ----------
    a, b : dict of key to Value
    words : str
        Which poses count, a sentence; empty where there is nothing to say.
    """

    a: Answers
    b: Answers
    words: str


def over_poses(a: Design, b: Design, space: Space, progress: Teller | None = None) -> OverPoses:
    """Ask both machines over poses.

    Where they are asked at the same poses, those alone count for the least stiffness that both
    take: one that gets farther is not the softer for it.

    Parameters
    ----------
    a, b : Design
    space : Space
    progress : callable, optional
    """
    asked = [
        _survey(a, space.a, space.why_a, progress),
        _survey(b, space.b, space.why_b, progress),
    ]
    found = [one for one in asked if isinstance(one, xr.Dataset)]
    common: Array | None = None
    words = ""
    if space.shared and len(found) == 2:
        taken = [one["status"].to_numpy() == PoseStatus.GOOD for one in found]
        common = taken[0] & taken[1]
        words = (
            f"The least stiffness is that over the {int(common.sum())} of {common.size} poses that "
            "both reach."
        )
    first, second = (_answers(one, common) for one in asked)
    return OverPoses(first, second, words)


def _survey(
    design: Design, grid: TaskGrid | None, why: str, progress: Teller | None
) -> xr.Dataset | str:
    """A survey, or why there is none."""
    if grid is None:
        return why or "it has no poses"
    told = None if progress is None else progress(f"stiffness of {visible(design.name)}")
    try:
        return survey(design.model, grid, [Stiffness()], progress=told)
    except (ClusterError, OutputError):
        # no answer of the machine: nobody computed it, or it cannot be kept
        raise
    except StrutworkError as error:
        return visible(" ".join(str(error).split()))


def _answers(found: xr.Dataset | str, common: Array | None) -> Answers:
    keys = [q.key for q in (*of_question("worst"), *of_question("reach"))]
    if isinstance(found, str):
        return dict.fromkeys(keys, Value(why=found))
    poses, kept = int(found.attrs["poses"]), int(found.attrs["poses_kept"])
    answers: Answers = {
        "poses_taken": Value(100.0 * kept / poses, f"{kept} of {poses} poses"),
        "poses": Value(float(poses)),
    }
    for meaning in ("free", "blocked"):
        for d in DIRECTIONS:
            values = found[f"stiffness_{meaning}"].sel(direction=d).to_numpy()
            answers[f"worst_stiffness_{meaning}_{d}"] = _least(found, values, common)
    return answers


def _least(found: xr.Dataset, values: Array, common: Array | None) -> Value:
    if common is not None:
        values = np.where(common, values, np.nan)
    if np.isnan(values).all():
        return Value(why="no pose is reached by both")
    finite = np.where(np.isfinite(values), values, np.nan)
    if np.isnan(finite).all():
        return Value(float("inf"))
    low = least(found, finite)
    return Value(low.value, f"at {low.where}")
