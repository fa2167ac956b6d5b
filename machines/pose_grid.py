"""Places of the tool at which a machine's map is made: x and one tilt."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True)
class PoseGrid:
    """Every position along x with every tilt.

    Parameters
    ----------
    positions : (n, 3)
        m.
    rotations : (q, 3, 3)
        Rotation matrices of the tool, one per tilt.
    tilts : (q,)
        rad.
    tilt : str
        The tilt's letter and axis, "b" about y or "a" about x.
    """

    positions: Array
    rotations: Array
    tilts: Array
    tilt: str

    def __repr__(self) -> str:
        x, t = self.positions[:, 0], self.tilts
        return (
            f"<PoseGrid: {len(x)} places, x {1e3 * x.min():g} to {1e3 * x.max():g} mm, {len(t)} "
            f"tilts {self.tilt}, {degrees(t.min()):g} to {degrees(t.max()):g} deg>"
        )

    def __len__(self) -> int:
        return len(self.positions) * len(self.rotations)

    @property
    def x(self) -> Array:
        """Places along x, (n,), m."""
        return np.asarray(self.positions[:, 0])


@runtime_checkable
class GridMachine(Protocol):
    """A machine that is studied over x and a tilt, not over a hemisphere."""

    def pose_grid(self, steps: int = 10) -> PoseGrid:
        """2 · steps + 1 places along x, as many tilts.

        Parameters
        ----------
        steps : int
            To each side of the middle.
        """
