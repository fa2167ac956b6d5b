"""Rows that are independent at home: what Newton's method solves; all others must then agree."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.given import Given
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.mobility import RANK_TOLERANCE

Array = NDArray[Any]

#: Share of a row that is left beside the others below which it depends on them.
DEPENDENT = 1e-7

#: Rows up to which their singular values cost less than loading SciPy for a pivoted QR.
FEW = 300


def independent_rows(
    matrix: Array, held: int, known: tuple[list[int], Array] | None = None
) -> tuple[NDArray[np.intp], bool]:
    """Indices of independent rows, (i,), ascending, and whether all that is given is among them.

    The held directions of joints come first; of those that depend on each other, as in a
    machine with redundant constraints, enough are taken to span them.

    Parameters
    ----------
    matrix : (r, n)
        In one unit, at home.
    held : int
        How many of its first rows are held directions of joints; then joint coordinates and
        directions of the tool that are given.
    known : (list of int, (n, i)), optional
        `spanned` of the first rows.
    """
    kept, basis = spanned(matrix[:held]) if known is None else known
    more, every = independent_beside(matrix[held:], basis)
    kept = [*kept, *(held + row for row in more)]
    return np.sort(np.asarray(kept, dtype=np.intp)), every


def independent_beside(matrix: Array, basis: Array) -> tuple[list[int], bool]:
    """Rows, one after another, that depend on none before them, and whether all are such.

    Parameters
    ----------
    matrix : (r, n)
        In one unit.
    basis : (n, i)
        Orthonormal columns that span what comes first.
    """
    kept = []
    for number, row in enumerate(matrix):
        rest = _beside(row, basis)
        if np.linalg.norm(rest) > DEPENDENT * np.linalg.norm(row):
            kept.append(number)
            basis = np.concatenate([basis, (rest / np.linalg.norm(rest))[:, None]], axis=1)
    return kept, len(kept) == len(matrix)


def spanning_rows(matrix: Array, kept: NDArray[np.intp], held: int) -> NDArray[np.intp]:
    """As many held rows as at home, chosen anew at each pose, and what was given as at home.

    Each next row is the one that stands farthest from those before (pivoted Gram-Schmidt).

    Parameters
    ----------
    matrix : (k, r, n)
        In one unit, at the poses.
    kept : (i,)
        The independent rows at home.
    held : int
        How many of the first rows are held directions of joints.

    Returns
    -------
    (k, i)
        Ascending.
    """
    rest = matrix[:, :held].copy()
    count = int(np.sum(kept < held))
    chosen = np.tile(kept, (len(matrix), 1))
    each = np.arange(len(matrix))
    for k in range(count):
        size = np.linalg.norm(rest, axis=-1)
        size[each[:, None], chosen[:, :k]] = -1.0
        best = size.argmax(axis=-1)
        chosen[:, k] = best
        unit = rest[each, best] / np.maximum(size[each, best], np.finfo(float).tiny)[:, None]
        rest -= (rest @ unit[..., None]) * unit[:, None]
    return np.sort(chosen, axis=-1)


def refuse_dependent(matrix: Array, held: int, asked: Given) -> None:
    """Refuse a direction that was named and that the joints hold at home; a pose may name all six.

    What only depends on others that are given stays: it must agree with them.

    Parameters
    ----------
    matrix : (r, n)
        Rows at home in one unit, as in `independent_rows`.
    held : int
        How many of its first rows are held directions of joints.
    asked : Given
        What the other rows are.

    Raises
    ------
    ModelError
        Names the direction.
    """
    _, basis = spanned(matrix[:held])
    for row in range(held, len(matrix)):
        rest = _beside(matrix[row], basis)
        if np.linalg.norm(rest) > DEPENDENT * np.linalg.norm(matrix[row]):
            continue
        number = row - held
        if number < len(asked.joint):
            raise ModelError(
                "motion",
                f"{asked.names[number]} cannot move from home: the other joints hold it.",
                "Give another coordinate.",
            )
        if asked.tool is None:
            direction = DIRECTIONS[asked.task[number - len(asked.joint)]]
            raise ModelError(
                "task",
                f"the tool cannot move in {direction} from home.",
                "Leave this direction out, or change the home.",
            )


def spanned(rows: Array) -> tuple[list[int], Array]:
    """Independent rows among those of the joints, and an orthonormal basis of their span, (n, i).

    Parameters
    ----------
    rows : (h, n)
        In one unit.
    """
    if not len(rows):
        return [], np.zeros((rows.shape[1], 0))
    if len(rows) <= FEW:
        _, values, right = np.linalg.svd(rows, full_matrices=False)
        # no pivot is less than the least singular value: none of these rows depends on others
        if len(values) == len(rows) and values[-1] > RANK_TOLERANCE * values[0]:
            return list(range(len(rows))), right.T
    # loading SciPy takes longer than all else that a machine without redundant rows needs
    from scipy.linalg import qr  # noqa: PLC0415

    directions, triangle, order = qr(rows.T, mode="economic", pivoting=True)
    sizes = np.abs(np.diagonal(triangle))
    count = int(np.sum(sizes > RANK_TOLERANCE * sizes.max(initial=0.0)))
    return list(np.sort(order[:count])), directions[:, :count]


def _beside(row: Array, basis: Array) -> Array:
    rest = row - basis @ (basis.T @ row)
    # once more, for what rounding left
    return np.asarray(rest - basis @ (basis.T @ rest))
