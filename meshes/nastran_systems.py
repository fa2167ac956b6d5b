"""Coordinate systems of Nastran grid points: CORD1R, CORD1C, CORD1S, CORD2R, CORD2C, CORD2S."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.meshes.deck_lines import DeckLines
from strutwork.meshes.nastran_cards import Card, real, whole
from strutwork.meshes.numbered import Numbered

Array = NDArray[Any]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Given:
    """A system as its card gives it: by three points in another system, or by three grids.

    Parameters
    ----------
    shape : "R", "C" or "S"
        Rectangular, cylindrical or spherical.
    where : str
        Its line, for messages.
    reference : int
        System in which the points are; 0 is the basic one.
    points : (3, 3) or None
        Origin, a point on z and one in the x-z plane, one per row, in the file's own unit.
    grids : tuple of int
        The three grids, instead of points.
    """

    shape: str
    where: str
    reference: int = 0
    points: Array | None = None
    grids: tuple[int, ...] = ()


@dataclass
class Systems:
    """All systems of a file, and the grid points that some of them go through.

    Parameters
    ----------
    lines : DeckLines
        For messages.
    given : dict of int to Given
        Systems by their numbers, as their cards give them.
    """

    lines: DeckLines
    given: dict[int, Given] = field(default_factory=dict)
    _made: dict[int, tuple[Array, Array]] = field(default_factory=dict)

    def add(self, card: Card) -> None:
        """Take a card; ValueError where its numbers are none.

        Parameters
        ----------
        card : Card
            One of CORD1R to CORD2S.
        """
        shape = card.name[-1]
        fields = [*card.fields, *[""] * 16]
        if card.name[4] == "2":
            points = np.array([real(f) for f in fields[2:11]]).reshape(3, 3)
            self._put(whole(fields[0]), Given(shape, card.where, whole(fields[1]), points))
            return
        for first in (0, 4):
            if fields[first]:
                grids = tuple(whole(f) for f in fields[first + 1 : first + 4])
                self._put(whole(fields[first]), Given(shape, card.where, grids=grids))

    def _put(self, number: int, given: Given) -> None:
        before = self.given.setdefault(number, given)
        if before is not given and not (
            before.shape == given.shape
            and before.reference == given.reference
            and before.grids == given.grids
            and np.array_equal(before.points, given.points)  # type: ignore[arg-type]
        ):
            raise self.lines.error(
                f"gives the coordinate system {number} again", "Renumber it.", given.where
            )

    def to_global(self, numbers: Numbered, systems: Ints, places: Array) -> Array:
        """Global places of grid points, (n, 3).

        Parameters
        ----------
        numbers : Numbered
            Of the grid points.
        systems : (n,) of int
            In which each is given; 0 for the global one.
        places : (n, 3)
            As given there: in the unit of the file, angles in degrees.
        """
        found = np.array(places, dtype=float)
        done = systems == 0
        for system in np.unique(systems).tolist():
            if system:
                self._of(system, f"grid point {numbers.numbers[systems == system][0]}")
                self._place(system, numbers, systems, places, found, done, ())
        return found

    def _place(
        self,
        system: int,
        numbers: Numbered,
        systems: Ints,
        places: Array,
        found: Array,
        done: NDArray[np.bool_],
        open_: tuple[int, ...],
    ) -> None:
        """Set the global places of all points of a system."""
        own = systems == system
        if done[own].all():
            return
        shape = self._of(system, "").shape
        origin, axes = self._frame(system, numbers, systems, places, found, done, open_)
        found[own] = origin + _rectangular(shape, places[own]) @ axes.T
        done |= own

    def _of(self, number: int, where: str) -> Given:
        if number not in self.given:
            raise self.lines.error(
                f"names the coordinate system {number}, which the file does not give",
                "Add its CORD card, or export the mesh in the basic system.",
                where,
            )
        return self.given[number]

    def _frame(
        self,
        number: int,
        numbers: Numbered,
        systems: Ints,
        places: Array,
        found: Array,
        done: NDArray[np.bool_],
        open_: tuple[int, ...],
    ) -> tuple[Array, Array]:
        """Origin and axes (columns) of a system."""
        if number == 0:
            return np.zeros(3), np.eye(3)
        if number in self._made:
            return self._made[number]
        given = self._of(number, "")
        if number in open_:
            raise self.lines.error(
                f"defines the coordinate system {number} by itself", "Check its card.", given.where
            )
        args = (numbers, systems, places, found, done, (*open_, number))
        if given.points is None:
            at, known = numbers.find(np.array(given.grids))
            if not known.all():
                raise self.lines.error(
                    f"names the grid point {given.grids[int(np.argmin(known))]}, which the file "
                    "does not give",
                    "Check its number.",
                    given.where,
                )
            for system in np.unique(systems[at]).tolist():
                if system:
                    self._place(system, *args)
            points = found[at]
        else:
            reference = given.reference
            shape = self._of(reference, given.where).shape if reference else "R"
            origin, axes = self._frame(given.reference, *args)
            points = origin + _rectangular(shape, given.points) @ axes.T
        z = points[1] - points[0]
        y = np.cross(z, points[2] - points[0])
        x = np.cross(y, z)
        lengths = [float(np.linalg.norm(v)) for v in (x, y, z)]
        if min(lengths) <= 1e-12 * float(np.abs(points).max()) ** 2:
            raise self.lines.error(
                f"gives the coordinate system {number} by points on one line",
                "Check its points.",
                given.where,
            )
        axes = np.stack([v / n for v, n in zip((x, y, z), lengths, strict=True)], axis=1)
        self._made[number] = points[0], axes
        return self._made[number]


def _rectangular(shape: str, places: Array) -> Array:
    """Places given as radius, angle, height or radius, polar angle, azimuth, in degrees."""
    if shape == "R":
        return places
    if shape == "C":
        radius, angle = places[:, 0], np.radians(places[:, 1])
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), places[:, 2]], axis=1)
    radius, polar, azimuth = places[:, 0], np.radians(places[:, 1]), np.radians(places[:, 2])
    across = radius * np.sin(polar)
    return np.stack(
        [across * np.cos(azimuth), across * np.sin(azimuth), radius * np.cos(polar)], axis=1
    )
