"""Largest squares within bounds of the velocity amplification (section 3.3)."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from strutwork.kinematics import Poses
from strutwork.kinematics.inscribed_shape import InscribedShape, plane_turn
from strutwork.kinematics.largest_shape import LargestShape, largest_shape
from strutwork.kinematics.margin_grid import margin_grid
from strutwork.machines.biglide import Biglide
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.papers.chablat_2003.published import HIGH, LOW, PLANE, SQUARES
from strutwork.papers.published_rows import PublishedRow
from strutwork.studies.margin_bounds import AmplificationBound
from strutwork.studies.workspace_margin import MachineMargin

Array = NDArray[Any]

#: The grid reaches a little less far on one side: none of its points is a centre that is sought.
ENDS, POINTS = (-1.1, 1.067), 11

#: Angles of the square's sides to the rails, deg; the document has the first and the last.
ANGLES = (45.0, 30.0, 15.0, 0.0)


@cache
def machine() -> Model:
    """The biglide with the document's dimensions."""
    return load(PLANE)


@cache
def _bound() -> AmplificationBound:
    return AmplificationBound(machine(), LOW, HIGH)


def amplification(x: ArrayLike, y: ArrayLike) -> Array:
    """Least and largest velocity amplification at places of the tool, m; NaN where none is.

    Returns
    -------
    amplification : (..., 2)
        1/λ of the document, from the rows of the machine's joints.
    """
    poses = Biglide.poses(x, y)
    flat = Poses(poses.position.reshape(-1, 3), poses.rotation.reshape(-1, 3, 3))
    place = machine().closed_form
    assert place is not None  # noqa: S101 - a machine of the catalogue has one
    placement = place(flat)
    found = np.full((len(flat.position), 2), np.nan)
    good = placement.reachable
    found[good] = _bound().of(placement[good])
    return found.reshape(*poses.position.shape[:-1], 2)


@cache
def largest_square(angle: float) -> LargestShape:
    """The largest square about S over which all amplifications keep the document's bounds.

    Parameters
    ----------
    angle : float
        Of its sides to the rails, deg.
    """
    axis = np.linspace(*ENDS, POINTS)
    step = np.full(2, axis[1] - axis[0])
    margin = MachineMargin(machine(), ("x", "y"), step, bounds=(_bound(),))
    shape = InscribedShape("box", np.ones(2), plane_turn(np.radians(angle)))
    grid = margin_grid(("x", "y"), [axis, axis], margin)
    return largest_shape(grid, margin, shape, centre=[0.0, 0.0], accuracy=1e-8)


@cache
def square_area(angle: float) -> float:
    """Area of the largest square about S, m²: where its border first meets a bound.

    As `largest_square` without its search between the border's points, in a fiftieth of its time;
    the bounds are met in corners, which are among the points.

    Parameters
    ----------
    angle : float
        Of its sides to the rails, deg.
    """
    border = InscribedShape("box", np.ones(2), plane_turn(np.radians(angle))).border(9)

    def slack(half: float) -> float:
        found = amplification(*(half * border).T)
        return float(np.minimum(HIGH / found[:, 1], found[:, 0] / LOW).min() - 1.0)

    return float((2.0 * brentq(slack, 0.1, 0.68, xtol=1e-13)) ** 2)


def square_corners(angle: float) -> Array:
    """Corners of the largest square about S, the first once more at the end, (5, 2), m.

    Parameters
    ----------
    angle : float
        Of its sides to the rails, deg.
    """
    reach = float(np.sqrt(square_area(angle) / 2.0))
    turn = np.radians(angle + 45.0 + 90.0 * np.arange(5))
    return np.asarray(reach * np.stack([np.cos(turn), np.sin(turn)], axis=-1))


def square_rows() -> tuple[PublishedRow, ...]:
    """The two areas beside the computed values."""
    note = (
        "the printed values are about half of the computed ones, to 1 and 2 %; their ratio is "
        "1.435, computed 1.425. No interpretation of the bounds, of the legs' length or of the "
        "shape gives the half, and nothing is rescaled"
    )
    found = (square_area(45.0), square_area(0.0))
    return tuple(
        PublishedRow(v.row, v.quantity, v.unit, v.value, ours, "not reproducible", note)
        for v, ours in zip(SQUARES, found, strict=True)
    )
