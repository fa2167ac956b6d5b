"""Coordinate systems of an Abaqus deck: *SYSTEM, cylindrical nodes, instances put in place."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[Any]


@dataclass(frozen=True)
class System:
    """A rectangular system.

    Parameters
    ----------
    origin : (3,)
        In the file's own unit.
    axes : (3, 3)
        Its axes as columns, orthonormal.
    """

    origin: Array = field(default_factory=lambda: np.zeros(3))
    axes: Array = field(default_factory=lambda: np.eye(3))

    @classmethod
    def through(cls, rows: Sequence[Sequence[float]]) -> System:
        """The system of *SYSTEM: origin and a point of the x axis, then one of the xy plane.

        Without rows it is the global one; without the third point z stays global.

        Parameters
        ----------
        rows : sequence of sequence of float
            Coordinates in the unit of the file, as *SYSTEM gives them on its lines.

        Raises
        ------
        ValueError
            Points on one line.
        """
        given = [v for row in rows for v in row]
        if not given:
            return cls()
        points = np.zeros(9)
        points[: min(len(given), 9)] = given[:9]
        origin, on_x, in_plane = points.reshape(3, 3)
        x = on_x - origin
        z = np.cross(x, in_plane - origin) if len(given) > 6 else np.array([0.0, 0.0, 1.0])
        y = np.cross(z, x)
        lengths = [float(np.linalg.norm(v)) for v in (x, y, z)]
        if min(lengths) == 0.0 or (len(given) <= 3):
            raise ValueError("whose points are on one line")
        if len(given) <= 6 and abs(x[2]) > 1e-9 * lengths[0]:
            raise ValueError("whose x axis leaves the xy plane, and no third point")
        return cls(origin, np.stack([v / n for v, n in zip((x, y, z), lengths, strict=True)], 1))

    @property
    def is_global(self) -> bool:
        """Whether it changes nothing."""
        return not self.origin.any() and bool((self.axes == np.eye(3)).all())

    def to_global(self, values: array[float], cylindrical: bool) -> array[float]:
        """Coordinates of a system as global ones, (3 n).

        Parameters
        ----------
        values : (3 n,) array of float
            x, y and z of each node, or radius, angle and height, in the unit of the file and
            degrees.
        cylindrical : bool
            Whether they are the latter.
        """
        places = np.array(values, dtype=float).reshape(-1, 3)
        if cylindrical:
            radius, angle = places[:, 0], np.radians(places[:, 1])
            places = np.stack([radius * np.cos(angle), radius * np.sin(angle), places[:, 2]], 1)
        return array("d", (self.origin + places @ self.axes.T).tobytes())


def placed(points: Array, rows: Sequence[Sequence[float]]) -> Array:
    """Points of an instance, (n, 3): translated, then turned about the axis through two points.

    Parameters
    ----------
    points : (n, 3)
        In any unit, that of the file.
    rows : sequence of sequence of float
        The translation, then both points, same unit, and the angle in degrees; either may be
        missing.

    Raises
    ------
    ValueError
        Rows of other lengths, an axis without length.
    """
    if len(rows) > 2 or (rows and len(rows[0]) > 3) or (len(rows) == 2 and len(rows[1]) != 7):
        raise ValueError("is placed by lines that are not a translation and rotation")
    move = np.zeros(3)
    if rows:
        move[: len(rows[0])] = rows[0]
    moved = points + move
    if len(rows) < 2:
        return moved
    first, second, angle = np.array(rows[1][:3]), np.array(rows[1][3:6]), rows[1][6]
    axis = second - first
    length = float(np.linalg.norm(axis))
    if length == 0.0:
        raise ValueError("rotates about an axis without length")
    turn = Rotation.from_rotvec(np.radians(angle) * axis / length)
    return np.asarray(first + turn.apply(moved - first))
