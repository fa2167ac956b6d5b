"""Coordinate systems of universal files (2420, 18) and the directions of a node in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.uff_sets import DataSet, Records

Array = NDArray[Any]

CARTESIAN, CYLINDRICAL, SPHERICAL = 0, 1, 2

#: Systems that need no definition: the part's own.
GLOBAL = (0, 1)

#: Axes are written with six digits or more.
_SQUARE = 1e-3


@dataclass(frozen=True)
class Axes:
    """A coordinate system.

    Parameters
    ----------
    kind : int
        0 Cartesian, 1 cylindrical (radius, angle, z), 2 spherical.
    rows : (3, 3)
        Its axes in global directions, one row per axis: unit vectors.
    origin : (3,)
        m.
    """

    kind: int
    rows: Array
    origin: Array

    def at(self, place: Array | None, part: str) -> Array:
        """Directions of this system at a place, (3, 3), one row per direction.

        Parameters
        ----------
        place : (3,) or None
            Global, m; None where it is not known.
        part : str
            For messages.

        Raises
        ------
        ModelError
            A spherical system, or a cylindrical one where the place is not known.
        """
        if self.kind == CARTESIAN:
            return self.rows
        if self.kind != CYLINDRICAL:
            raise ModelError(
                part,
                "has motion in a spherical coordinate system, which is not read.",
                "Export the results in Cartesian systems.",
            )
        if place is None:
            raise ModelError(
                part,
                "has motion in a cylindrical coordinate system at a node without a position.",
                "Export the nodes too (data set 2411).",
            )
        x, y, _ = self.rows @ (place - self.origin)
        radius = float(np.hypot(x, y))
        # on the axis itself the angle is zero
        c, s = (x / radius, y / radius) if radius > 0 else (1.0, 0.0)
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ self.rows


def systems_2420(source: DataSet, length: float) -> dict[int, Axes]:
    """Systems of data set 2420 by number.

    Parameters
    ----------
    source : DataSet
    length : float
        The file's units of length in one metre, no unit.
    """
    records = Records(source)
    records.skip(2)
    found: dict[int, Axes] = {}
    while records:
        label, kind = records.next().whole([10, 10, 10, 10], 2)[:2]
        records.skip(1)
        rows = np.array([records.numbers(3, 25) for _ in range(4)])
        found[label] = _made(source.part, label, kind, rows[:3], rows[3] / length)
    return found


def systems_18(source: DataSet, length: float) -> dict[int, Axes]:
    """Systems of data set 18 by number: an origin, a point on x, a point in the xz plane.

    Parameters
    ----------
    source : DataSet
    length : float
        The file's units of length in one metre, no unit.
    """
    records = Records(source)
    found: dict[int, Axes] = {}
    while records:
        label, kind, reference = records.next().whole([10] * 5, 3)[:3]
        records.skip(1)
        points = np.array(records.numbers(9, 13)).reshape(3, 3)
        part = f"{source.part}, coordinate system {label}"
        if reference not in GLOBAL and reference not in found:
            raise ModelError(
                part, f"refers to the system {reference}, which is not there.", "Export it too."
            )
        base = found.get(reference)
        if base is not None and base.kind != CARTESIAN:
            raise ModelError(
                part, "refers to a system that is not Cartesian.", "Export it in global axes."
            )
        if not np.all(np.isfinite(points)):
            raise _not_square(part)
        with np.errstate(all="ignore"):
            x = points[1] - points[0]
            y = np.cross(points[2] - points[0], x)
            rows = np.array([x, y, np.cross(x, y)])
            rows = rows / np.linalg.norm(rows, axis=1, keepdims=True)
        origin = points[0] / length
        if base is not None:
            rows, origin = rows @ base.rows, base.origin + origin @ base.rows
        found[label] = _made(source.part, label, kind, rows, origin)
    return found


def _made(part: str, label: int, kind: int, rows: Array, origin: Array) -> Axes:
    part = f"{part}, coordinate system {label}"
    if kind not in (CARTESIAN, CYLINDRICAL, SPHERICAL):
        raise ModelError(part, f"is of the unknown type {kind}.", "Types are 0, 1 and 2.")
    finite = bool(np.all(np.isfinite(rows)) and np.all(np.isfinite(origin)))
    if (
        not finite
        or np.abs(rows).max() > 2
        or not np.allclose(rows @ rows.T, np.eye(3), atol=_SQUARE)
    ):
        raise _not_square(part)
    # the nearest rotation: axes of six digits are not exactly square
    left, _, right = np.linalg.svd(rows)
    return Axes(kind, left @ right, origin)


def _not_square(part: str) -> ModelError:
    return ModelError(
        part,
        "has axes that are not three perpendicular unit vectors.",
        "Correct its matrix, or export in global axes.",
    )


def axes_of(number: int, systems: Mapping[int, Axes], part: str) -> Axes | None:
    """The system of a number; None for the global one.

    Parameters
    ----------
    number : int
    systems : mapping of int to Axes
        Those that the file holds.
    part : str
        For messages.

    Raises
    ------
    ModelError
        The file does not hold it.
    """
    if number in systems:
        return systems[number]
    if number in GLOBAL:
        return None
    raise ModelError(
        part,
        f"refers to the coordinate system {number}, which the file does not contain.",
        "Export the coordinate systems too (data set 2420), or the results in global axes.",
    )
