"""Rows that are independent at home: what Newton's method solves; all others must then agree."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.given import Given
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.mobility import RANK_TOLERANCE

Array = NDArray[Any]


class Asked(Protocol):
    """What a walk is given."""

    given: Given


def independent_rows(matrix: Array, held: int, walk: Asked) -> NDArray[np.intp]:
    """Indices of independent rows, ascending.

    The held directions of joints come first; of those that depend on each other, as in a
    machine with redundant constraints, enough are taken to span them. Of what is given, a row
    that depends on the held directions cannot move.

    Parameters
    ----------
    matrix : (r, n)
        In one unit, at home.
    held : int
        How many of its first rows are held directions of joints.
    walk : object with `given`

    Raises
    ------
    ModelError
        A task direction or joint coordinate that is given and cannot move at home.
    """
    _, triangle, order = scipy.linalg.qr(matrix[:held].T, mode="economic", pivoting=True)
    sizes = np.abs(np.diagonal(triangle))
    count = int(np.sum(sizes > RANK_TOLERANCE * sizes.max(initial=0.0)))
    kept = list(np.sort(order[:count]))
    basis, _ = np.linalg.qr(matrix[kept].T) if kept else (np.zeros((matrix.shape[1], 0)), None)
    asked = walk.given
    first_task = held + len(asked.joint)
    for row in range(held, len(matrix)):
        alone = matrix[row] - basis[:, :count] @ (basis[:, :count].T @ matrix[row])
        if np.linalg.norm(alone) <= 1e-7 * np.linalg.norm(matrix[row]):
            _refuse(row - held, row - first_task, asked)
            continue
        rest = matrix[row] - basis @ (basis.T @ matrix[row])
        rest -= basis @ (basis.T @ rest)
        if np.linalg.norm(rest) > 1e-7 * np.linalg.norm(matrix[row]):
            kept.append(row)
            basis = np.concatenate([basis, (rest / np.linalg.norm(rest))[:, None]], axis=1)
    return np.sort(np.asarray(kept, dtype=np.intp))


def _refuse(joint: int, task: int, asked: Given) -> None:
    """Refuse a direction that was named and cannot move; a pose may name all six."""
    if task >= 0:
        if asked.tool is None:
            raise ModelError(
                "task",
                f"the tool cannot move in {DIRECTIONS[asked.task[task]]} from home.",
                "Leave this direction out, or change the home.",
            )
        return
    raise ModelError(
        "motion",
        f"coordinate {DIRECTIONS[asked.direction[joint]]} of joint number "
        f"{int(asked.joint[joint]) + 1} cannot move from home: the other joints hold it.",
        "Give another coordinate.",
    )
