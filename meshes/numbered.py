"""Things with numbers of their own, as files have nodes and elements: from number to place."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Ints = NDArray[np.int64]


class Numbered:
    """Places by number.

    Parameters
    ----------
    numbers : (n,) int
        The number of each place. Of several equal ones the last counts.
    """

    def __init__(self, numbers: Ints | array[int]) -> None:
        self.numbers: Ints = np.asarray(numbers, dtype=np.int64)
        self._order = np.argsort(self.numbers, kind="stable")
        self._sorted = self.numbers[self._order]

    def __len__(self) -> int:
        return len(self.numbers)

    def twice(self) -> Ints:
        """Pairs of places that have the same number, (k, 2), earlier place first."""
        same = np.flatnonzero(self._sorted[1:] == self._sorted[:-1])
        return np.stack([self._order[same], self._order[same + 1]], axis=1)

    def find(self, wanted: Ints) -> tuple[Ints, NDArray[np.bool_]]:
        """Place of each wanted number, and whether there is one, of the same shape as `wanted`.

        Parameters
        ----------
        wanted : any shape, of int
            Numbers.
        """
        wanted = np.asarray(wanted, dtype=np.int64)
        if not len(self._sorted):
            return np.zeros(wanted.shape, dtype=np.int64), np.zeros(wanted.shape, dtype=bool)
        at = np.maximum(np.searchsorted(self._sorted, wanted, side="right") - 1, 0)
        return self._order[at], self._sorted[at] == wanted

    def between(self, first: int, last: int, step: int) -> Ints:
        """Places (k,) whose number is one of first, first + step, …, up to last.

        Parameters
        ----------
        first : int
            The first number.
        last : int
            None is greater.
        step : int
            From one number to the next, positive.
        """
        low, high = np.searchsorted(self._sorted, [first, last + 1])
        inside = slice(int(low), max(int(low), int(high)))
        own = (self._sorted[inside] - first) % step == 0
        return np.asarray(self._order[inside][own], dtype=np.int64)
