"""Ports: where and in which direction a structure is excited or observed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.reduction import Reduced
from kinematics import DIRECTIONS
from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class Port:
    """A direction at a node, or between two nodes.

    Parameters
    ----------
    node : str
    direction : str or (6,) tuple
        A direction name, or a vector of translation and rotation parts in global axes.
    against : str or None
        A second node: motion relative to it, and an equal and opposite load on it.

    Raises
    ------
    ModelError
        An unknown direction, or a vector of length zero.
    """

    node: str
    direction: str | tuple[float, ...]
    against: str | None = None

    def __post_init__(self) -> None:
        if isinstance(self.direction, str):
            if self.direction not in DIRECTIONS:
                raise ModelError(
                    f"port {self.node}:{self.direction}",
                    "has an unknown direction.",
                    "Directions are " + ", ".join(DIRECTIONS) + ".",
                )
        elif len(self.direction) != 6 or not np.any(self.direction):
            raise ModelError(
                f"port at {self.node}", "has no direction.", "Give six numbers, not all zero."
            )

    @classmethod
    def parse(cls, text: str) -> Port:
        """Port from `NODE:direction` or `NODE-NODE:direction`, the second relative to the first.

        Raises
        ------
        ModelError
            Text of another shape.
        """
        nodes, _, direction = text.rpartition(":")
        if not nodes:
            raise ModelError(f'port "{text}"', "has no direction.", "Write it as NODE:x.")
        return cls(nodes, direction)

    @property
    def vector(self) -> Array:
        """Direction as a six-vector."""
        if isinstance(self.direction, str):
            return np.eye(6)[DIRECTIONS.index(self.direction)]
        return np.asarray(self.direction, dtype=float)

    def __str__(self) -> str:
        direction = self.direction if isinstance(self.direction, str) else list(self.direction)
        return f"{self.node}{f' against {self.against}' if self.against else ''}:{direction}"

    def on(self, reduced: Reduced) -> Array:
        """Motion at the port per unit coordinate, (p, c).

        Raises
        ------
        ModelError
            An unknown node, or a port that cannot move.
        """
        motion = np.einsum("i,pic->pc", self.vector, reduced.at_node(self.node))
        if self.against is not None:
            motion = motion - np.einsum("i,pic->pc", self.vector, reduced.at_node(self.against))
        if not np.any(motion):
            raise ModelError(
                f"port {self}",
                "does not move: its node is held in that direction.",
                "Choose another node or direction.",
            )
        return np.asarray(motion)
