"""A grid of task coordinates of the tool: what a workspace is looked at over."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees, prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.joint import DIRECTIONS

Array = NDArray[Any]

#: Poses of a grid whose coordinates are held at once.
LARGEST = 100_000_000
#: Poses that nothing on earth looks at: refused before they are counted further.
ENDLESS = 10**12


@dataclass(frozen=True)
class TaskGrid:
    """Grid of values along task coordinates.

    Parameters
    ----------
    axes : mapping of direction to (k,)
        x, y, z of the tool centre point, m; rx, ry, rz, components of the tool's rotation vector
        from home, rad. The last changes fastest. What is not named stays as it is at home.

    Raises
    ------
    ModelError
        An unknown direction, no value or one that is not finite, more than `ENDLESS` poses.
    """

    axes: Mapping[str, Array]

    def __post_init__(self) -> None:
        for name, values in self.axes.items():
            if name not in DIRECTIONS:
                raise ModelError(
                    "workspace",
                    f'names the unknown direction "{name}".',
                    "Directions are " + ", ".join(DIRECTIONS) + ".",
                )
            if not np.size(values) or not np.all(np.isfinite(values)):
                raise ModelError(
                    "workspace", f"has no finite values in {name}.", "Give a range, m or rad."
                )
        if not self.axes:
            raise ModelError("workspace", "names no direction.", "Name one of the task's.")
        count = prod(len(v) for v in self.axes.values())
        if count > ENDLESS:
            raise ModelError(
                "workspace",
                f"has {count:.3g} poses: {8e-12 * count * len(self.axes):.3g} TB of coordinates "
                f"alone, and {count / 1e3 / 3.2e7:.2g} years at a thousand poses per second.",
                "Use fewer points along a direction.",
            )

    def __len__(self) -> int:
        return prod(len(v) for v in self.axes.values())

    def __repr__(self) -> str:
        spans = []
        for name, values in self.axes.items():
            factor, unit = (degrees(1.0), "deg") if name.startswith("r") else (1e3, "mm")
            low, high = factor * float(values[0]), factor * float(values[-1])
            spans.append(f"{name} {low:.4g} to {high:.4g} {unit} in {len(values)}")
        return f"<TaskGrid: {', '.join(spans)}; {len(self)} poses>"

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each direction."""
        return tuple(len(v) for v in self.axes.values())

    def task(self) -> dict[str, Array]:
        """Coordinates of all poses, direction by direction, (n,) each.

        Raises
        ------
        ModelError
            More than `LARGEST` poses.
        """
        if len(self) > LARGEST:
            raise ModelError(
                "workspace",
                f"has {len(self):,} poses, more than the {LARGEST:,} that are allowed: "
                f"{8e-9 * len(self) * len(self.axes):.3g} GB of coordinates alone.",
                "Use fewer points along a direction.",
            )
        grids = np.meshgrid(*self.axes.values(), indexing="ij")
        return {name: g.ravel() for name, g in zip(self.axes, grids, strict=True)}
