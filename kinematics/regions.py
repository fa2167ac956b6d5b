"""Pieces of a workspace on its grid: which hang together, and what they enclose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Regions:
    """Components of the good points of a grid, largest first, and their holes.

    Parameters
    ----------
    label : (grid) of int
        0 where a point is not good, else the number of its component.
    sizes : (c,) of int
        Points of each component.
    holes : int
        Pieces of what is not good that good points enclose within the grid.
    """

    label: NDArray[np.intp]
    sizes: NDArray[np.intp]
    holes: int

    def __repr__(self) -> str:
        return f"<Regions: {len(self.sizes)} components, {self.holes} holes>"

    def of(self, place: Array) -> int:
        """Number of the component at a place in cells of the grid, (d,); 0 for none.

        A place in a cell whose good corners are of several components is of the nearest one.

        Parameters
        ----------
        place : (d,)
            In cells from the grid's first point, no unit.
        """
        shape = np.array(self.label.shape)
        if np.any(place < -1e-9) or np.any(place > shape - 1 + 1e-9):
            return 0
        low = np.clip(np.floor(place).astype(int), 0, shape - 2)
        corners = low + np.stack(np.meshgrid(*[[0, 1]] * len(shape), indexing="ij"), -1).reshape(
            -1, len(shape)
        )
        order = np.argsort(np.abs(corners - place).sum(axis=1), kind="stable")
        found = self.label[tuple(corners[order].T)]
        good = np.flatnonzero(found)
        return int(found[good[0]]) if good.size else 0


def regions(good: Mask) -> Regions:
    """Components and holes of the good points of a grid.

    Points hang together along edges of the grid. What is not good does so across corners too,
    so that a wall one point thick is no hole's end.

    Parameters
    ----------
    good : (grid) of bool
    """
    # imported late: no other part of a small command needs it
    from scipy import ndimage  # noqa: PLC0415

    label, count = ndimage.label(good)
    sizes = np.bincount(label.ravel(), minlength=count + 1)[1:]
    order = np.argsort(-sizes, kind="stable")
    rank = np.zeros(count + 1, dtype=np.intp)
    rank[1 + order] = 1 + np.arange(count)
    # a rim of what is not good joins all that is open to the outside
    rim = np.pad(~good, 1, constant_values=True)
    _, pieces = ndimage.label(rim, structure=np.ones((3,) * good.ndim))
    # along a line good points part the outside in two
    outside = 2 if good.ndim == 1 and count else 1
    return Regions(rank[label], sizes[order], pieces - outside)
