"""Moments, extremes and fine histograms of many variables, fed a chunk of samples at a time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass
class Tally:
    """What is kept of samples of v variables between zero and a span each.

    Parameters
    ----------
    span : (v,)
        Upper end of each variable, positive, any unit.
    cells : int
        Of the fine histogram.
    count : int
        Samples taken in so far.
    """

    span: Array
    cells: int
    count: int = 0
    counts: NDArray[np.int64] = field(init=False)
    mean: Array = field(init=False)
    squares: Array = field(init=False)
    smallest: Array = field(init=False)
    largest: Array = field(init=False)

    def __post_init__(self) -> None:
        size = len(self.span)
        self.counts = np.zeros((size, self.cells), dtype=np.int64)
        self.mean, self.squares = np.zeros(size), np.zeros(size)
        self.smallest, self.largest = np.full(size, np.inf), np.zeros(size)

    def add(self, values: Array) -> None:
        """Take in samples, none beyond the span but for rounding.

        Parameters
        ----------
        values : (v, n)
            In the units of the span, any unit.
        """
        new = values.shape[1]
        mean = values.mean(axis=1)
        apart = mean - self.mean
        total = self.count + new
        # the moments of two parts together (Chan, Golub and LeVeque 1983)
        self.squares += ((values - mean[:, None]) ** 2).sum(axis=1)
        self.squares += apart**2 * (self.count * new / total)
        self.mean += apart * (new / total)
        self.smallest = np.minimum(self.smallest, values.min(axis=1))
        self.largest = np.maximum(self.largest, values.max(axis=1))
        self.count = total
        cell = (values * (self.cells / self.span)[:, None]).astype(np.intp)
        np.minimum(cell, self.cells - 1, out=cell)
        cell += (np.arange(len(values)) * self.cells)[:, None]
        np.add.at(self.counts.ravel(), cell.ravel(), 1)

    def join(self, other: Tally) -> None:
        """Take in another tally of the same variables.

        Parameters
        ----------
        other : Tally
        """
        apart, total = other.mean - self.mean, self.count + other.count
        self.squares += other.squares + apart**2 * (self.count * other.count / total)
        self.mean += apart * (other.count / total)
        self.smallest = np.minimum(self.smallest, other.smallest)
        self.largest = np.maximum(self.largest, other.largest)
        self.counts += other.counts
        self.count = total

    @property
    def deviation(self) -> Array:
        """Standard deviation with n − 1, (v,)."""
        return np.asarray(np.sqrt(self.squares / max(self.count - 1, 1)))

    def quantile(self, shares: Array) -> Array:
        """Value that a share of the samples does not exceed, (v, s); straight within a cell.

        Parameters
        ----------
        shares : (s,)
            From 0 to 1, no unit.
        """
        ranks = np.clip(np.asarray(shares, dtype=float) * self.count, 1, self.count)
        cell, up_to = self._cells(ranks)
        here = np.take_along_axis(self.counts, cell, axis=1)
        return self._within(cell + (ranks - (up_to - here)) / here)

    def between(self, ranks: NDArray[np.intp], upper: bool) -> Array:
        """Bounds of the samples of given ranks, (v, r): the edges of their cells.

        Below the first rank zero, above the last one the span.

        Parameters
        ----------
        ranks : (r,)
            1 is the smallest sample.
        upper : bool
            The upper edges; else the lower ones.
        """
        cell, _ = self._cells(np.clip(ranks, 1, self.count))
        edges = self._within(cell + float(upper))
        edges[:, ranks < 1] = 0.0
        edges[:, ranks > self.count] = self.span[:, None]
        return edges

    def histogram(self, bins: int) -> NDArray[np.int64]:
        """Counts in bins of equal width from zero to the span, (v, bins).

        Parameters
        ----------
        bins : int
            Divides the fine cells.
        """
        return np.asarray(self.counts.reshape(len(self.span), bins, -1).sum(axis=-1))

    def _cells(self, ranks: Array) -> tuple[NDArray[np.intp], NDArray[np.int64]]:
        """Cell in which the sample of each rank lies, (v, r), and the count up to its end."""
        up_to = np.cumsum(self.counts, axis=1)
        cell = np.stack([(up_to >= rank).argmax(axis=1) for rank in ranks], axis=1)
        return cell, np.take_along_axis(up_to, cell, axis=1)

    def _within(self, cells: Array) -> Array:
        values = cells * (self.span / self.cells)[:, None]
        return np.clip(values, self.smallest[:, None], self.largest[:, None])
