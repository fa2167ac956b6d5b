"""Springs to ground or between two nodes, and point masses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS


@dataclass(frozen=True)
class Spring:
    """A spring; to ground in global axes, otherwise in axes that move with its first node's body.

    Parameters
    ----------
    name : str
    nodes : (str,) or (str, str)
        One node: to ground. Two: on the motion of the second relative to the first.
    stiffness : mapping of direction to float
        N/m or N·m/rad.

    Raises
    ------
    ModelError
        An unknown direction, or a stiffness that is not positive.
    """

    name: str
    nodes: tuple[str] | tuple[str, str]
    stiffness: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.stiffness:
            raise ModelError(f"spring {self.name}", "has no stiffness.", "Name a direction.")
        if len(self.nodes) == 2 and self.nodes[0] == self.nodes[1]:
            raise ModelError(
                f"spring {self.name}",
                f'joins node "{self.nodes[0]}" to itself.',
                "Give it two nodes, or one for a spring to ground.",
            )
        for direction, value in self.stiffness.items():
            if direction not in DIRECTIONS:
                raise ModelError(
                    f"spring {self.name}",
                    f'unknown direction "{direction}".',
                    "Directions are " + ", ".join(DIRECTIONS) + ".",
                )
            if not (isfinite(value) and value > 0):
                raise ModelError(
                    f"spring {self.name}",
                    f"stiffness in {direction} is {value!r}.",
                    "Give a positive number, or omit the direction.",
                )

    @property
    def diagonal(self) -> NDArray[np.float64]:
        """Stiffness by direction, (6,)."""
        return np.array([float(self.stiffness.get(d, 0.0)) for d in DIRECTIONS])


@dataclass(frozen=True)
class PointMass:
    """A mass with inertia, carried by a node.

    Parameters
    ----------
    node : str
    mass : float
        kg.
    inertia : (3, 3) nested tuples
        About the centre of mass, global axes, kg·m².
    offset : (3,)
        From the node to the centre of mass, m.
    axes : (str, str, str) or None
        Nodes that carry the axes of inertia and offset: x from the first to the second, y on
        the third's side in their plane. None: global axes, which the body carries along
        where the placement says how it has turned.

    Raises
    ------
    ModelError
        A negative or non-finite mass, or an inertia that no body can have.
    """

    node: str
    mass: float
    inertia: tuple[tuple[float, ...], ...] = ((0.0,) * 3,) * 3
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    axes: tuple[str, str, str] | None = None

    def __post_init__(self) -> None:
        part = f"mass at node {self.node}"
        if not (isfinite(self.mass) and self.mass >= 0):
            raise ModelError(part, f"mass is {self.mass!r}.", "Give zero or a positive number.")
        inertia = np.asarray(self.inertia, dtype=float)
        if inertia.shape != (3, 3) or not np.all(np.isfinite(inertia)):
            raise ModelError(part, "inertia is not 3 x 3 finite numbers.", "Give three rows.")
        size = np.abs(inertia).max()
        if np.abs(inertia - inertia.T).max() > 1e-9 * size:
            raise ModelError(part, "inertia is not symmetric.", "Mirror entries must agree.")
        if np.linalg.eigvalsh(inertia).min() < -1e-9 * size:
            raise ModelError(part, "inertia has a negative principal moment.", "Check its signs.")
