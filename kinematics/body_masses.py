"""Mass of the rigid bodies of a linkage at home."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class BodyMasses:
    """Mass, centre and inertia of every moving body at home; they turn with their bodies.

    Parameters
    ----------
    mass : (b,)
        kg.
    centre : (b, 3)
        Centre of mass, m; of a body without mass any point of it.
    inertia : (b, 3, 3)
        About the centre, global axes at home, kg·m².

    Raises
    ------
    ModelError
        Shapes that do not match, values that are not finite, a negative mass, or an inertia that
        is not symmetric or has a negative principal moment.
    """

    mass: Array
    centre: Array
    inertia: Array

    def __post_init__(self) -> None:
        count = len(self.mass)
        if self.centre.shape != (count, 3) or self.inertia.shape != (count, 3, 3):
            raise ModelError(
                "body masses",
                f"have shapes {self.mass.shape}, {self.centre.shape} and {self.inertia.shape}.",
                "Give masses (b,), centres (b, 3) and inertias (b, 3, 3).",
            )
        for b in range(count):
            inertia, size = self.inertia[b], float(np.abs(self.inertia[b]).max(initial=0.0))
            values = (self.mass[b], *self.centre[b], *inertia.ravel())
            if not np.all(np.isfinite(values)) or self.mass[b] < 0:
                raise ModelError(
                    f"body number {b + 1}",
                    "has a mass that is negative, or a value that is not finite.",
                    "Give finite numbers, kg, m and kg·m².",
                )
            # what is left of kilograms and metres that were added and subtracted
            slack = 1e-9 * size + 1e-12 * float(self.mass[b])
            if (
                np.abs(inertia - inertia.T).max() > slack
                or np.linalg.eigvalsh((inertia + inertia.T) / 2).min() < -slack
            ):
                raise ModelError(
                    f"body number {b + 1}",
                    "has an inertia that no body can have.",
                    "Give a symmetric matrix with positive principal moments.",
                )

    def __repr__(self) -> str:
        return f"<BodyMasses: {len(self.mass)} bodies, {float(self.mass.sum()):.4g} kg>"
