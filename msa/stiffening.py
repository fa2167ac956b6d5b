"""What a load that stays adds to the stiffness of a placed structure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True)
class Stiffening:
    """Geometric stiffness of a preload, part by part.

    Parameters
    ----------
    case : str
        Load case that causes it, for messages.
    parts : tuple of (name, nodes, matrix)
        Mesh nodes (k,) and the geometric stiffness at them in global axes, (..., 6k, 6k), N/m, N,
        N·m/rad, the batch of the placed structure first.
    """

    case: str
    parts: tuple[tuple[str, NDArray[np.intp], Array], ...]

    def __repr__(self) -> str:
        return f'<Stiffening by case "{self.case}": {len(self.parts)} parts, N/m>'

    def __getitem__(self, index: Any) -> Stiffening:
        return Stiffening(self.case, tuple((n, at, m[index]) for n, at, m in self.parts))

    def flat(self, count: int) -> Stiffening:
        """The same with one batch axis of `count` poses.

        Parameters
        ----------
        count : int
            Poses of the one batch axis.
        """
        return Stiffening(
            self.case,
            tuple((n, at, m.reshape(count, *m.shape[-2:])) for n, at, m in self.parts),
        )

    def contributions(self) -> Iterator[tuple[str, NDArray[np.intp], Array]]:
        """The parts: name, mesh nodes (k,), geometric stiffness (p, 6k, 6k)."""
        yield from self.parts
