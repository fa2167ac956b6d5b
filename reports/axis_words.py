"""Axes and directions of joints in words, beside the machine's own frame."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.numbers import MINUS, significant

#: An axis along one of the machine's own is named by it.
ALONG = 1.0 - 1e-9


def axis_words(axis: NDArray[Any]) -> str:
    """An axis in the machine's frame, by name where it is one of its own.

    >>> axis_words(np.array([0.0, -1.0, 0.0])) == f"{MINUS}y"
    True
    >>> axis_words(np.array([0.6, 0.0, 0.8]))
    '0.6, 0, 0.8'
    """
    most = int(np.argmax(np.abs(axis)))
    if abs(axis[most]) >= ALONG:
        return f"{'' if axis[most] > 0 else MINUS}{'xyz'[most]}"
    texts = [significant(v) for v in np.round(axis, 3).tolist()]
    return ", ".join(t.rstrip("0").rstrip(".") if "." in t else t for t in texts)


def direction_words(direction: str, frame: NDArray[Any]) -> str:
    """A direction of a joint in its own axes and in the machine's.

    Parameters
    ----------
    direction : str
        As in `strutwork.kinematics.DIRECTIONS`.
    frame : (3, 3)
        Axes of the joint as columns.

    >>> direction_words("z", np.eye(3)), direction_words("ry", np.eye(3)[:, [1, 2, 0]])
    ('along its z (global z)', 'about its y (global z)')
    """
    axis = direction[-1]
    word = "about" if direction.startswith("r") else "along"
    return f"{word} its {axis} (global {axis_words(frame[:, 'xyz'.index(axis)])})"
