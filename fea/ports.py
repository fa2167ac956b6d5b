"""Ports: where and in which direction a structure is excited or observed."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.reduction import Reduced
from strutwork.kinematics import DIRECTIONS, Linkage
from strutwork.msa.rigid_map import rigid_map

Array = NDArray[Any]

#: Motions below this share of what rounding works on count as none.
STILL = 1e-9


@dataclass(frozen=True)
class Port:
    """A direction at a node, or between two nodes.

    Parameters
    ----------
    node : str
    direction : str or (6,) tuple
        A direction name, or a vector of translation and rotation parts in global axes, no unit.
    against : str or None
        A second node: motion relative to it, and an equal and opposite load on it.
    carried : bool
        The second node's body carries the point of the first, as a workpiece the point at which the
        tool stands: its rotation counts, and the opposite load acts there.

    Raises
    ------
    ModelError
        An unknown direction, or a vector of length zero.
    """

    node: str
    direction: str | tuple[float, ...]
    against: str | None = None
    carried: bool = False

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
    def parse(cls, text: str, nodes: Collection[str] = ()) -> Port:
        """Port from `NODE:direction` or `NODE-NODE:direction`, the second relative to the first.

        Parameters
        ----------
        text : str
        nodes : collection of str
            Names of the structure's nodes: they tell a hyphen in a name from one between two.

        Raises
        ------
        ModelError
            Text of another shape, or a hyphen that splits it into known nodes in two ways.
        """
        named, _, direction = text.rpartition(":")
        if not named or not direction:
            raise ModelError(f'port "{text}"', "is not a node with a direction.", "Write NODE:x.")
        if named in nodes or "-" not in named:
            return cls(named, direction)
        cuts = [i for i, letter in enumerate(named) if letter == "-"]
        pairs = [(named[:i], named[i + 1 :]) for i in cuts]
        if nodes:
            pairs = [p for p in pairs if p[0] in nodes and p[1] in nodes]
        pairs = [p for p in pairs if all(p)]
        if len(pairs) != 1:
            raise ModelError(
                f'port "{text}"',
                "does not state which node moves relative to which.",
                "Write NODE-NODE:x with two nodes of the structure.",
            )
        first, second = pairs[0]
        return cls(second, direction, against=first)

    @property
    def vector(self) -> Array:
        """Direction as a six-vector, (6,)."""
        if isinstance(self.direction, str):
            return np.asarray(np.eye(6)[DIRECTIONS.index(self.direction)])
        return np.asarray(self.direction, dtype=float)

    def __str__(self) -> str:
        direction = self.direction if isinstance(self.direction, str) else list(self.direction)
        return f"{self.node}{f' against {self.against}' if self.against else ''}:{direction}"

    def on(self, reduced: Reduced) -> Array:
        """Motion at the port per unit coordinate, (p, c).

        Parameters
        ----------
        reduced : Reduced
            At p poses.

        Raises
        ------
        ModelError
            An unknown node, or a port that cannot move.
        """
        at = reduced.at_node(self.node)
        if self.against is not None:
            at = at - self._other(reduced)
        motion = np.einsum("i,pic->pc", self.vector, at)
        # a loop's coordinates are found numerically: a held direction keeps their rounding
        size = np.abs(reduced.basis).max(axis=(1, 2)) * np.linalg.norm(self.vector)
        still = np.abs(motion).max(axis=1) <= STILL * size
        if np.any(still):
            where = f" at pose {int(still.argmax())}" if reduced.system.poses > 1 else ""
            raise ModelError(
                f"port {self}",
                f"does not move{where}: its node is held in that direction.",
                "Choose another node or direction.",
            )
        return np.asarray(motion)

    def _other(self, reduced: Reduced) -> Array:
        """Motion of the second node, or of the point that its body carries, (p, 6, c)."""
        found = reduced.at_node(str(self.against))
        if not self.carried:
            return found
        placed = reduced.system.placed
        index = placed.structure.mesh_index
        arm = placed.positions[:, index[self.node]] - placed.positions[:, index[str(self.against)]]
        return np.asarray(rigid_map(arm) @ found)


def tool_port(linkage: Linkage, direction: str, node: str | None = None) -> Port:
    """Port of the tool, relative to the workpiece where the linkage names one.

    Parameters
    ----------
    linkage : Linkage
        With a tool.
    direction : str
        A direction name.
    node : str, optional
        The tool by default; another node is taken as it is.

    Raises
    ------
    ModelError
        No tool, or an unknown direction.
    """
    if linkage.tool is None:
        raise ModelError("linkage", "has no tool.", "Name the tool centre point's node.")
    if node is not None and node != linkage.tool:
        return Port(node, direction)
    return Port(linkage.tool, direction, linkage.against, carried=linkage.against is not None)


def tool_ports(linkage: Linkage, node: str | None = None) -> tuple[Port, ...]:
    """The three translations of `tool_port`.

    Parameters
    ----------
    linkage : Linkage
        With a tool.
    node : str, optional
        The tool by default.

    Raises
    ------
    ModelError
        As `tool_port`.
    """
    return tuple(tool_port(linkage, axis, node) for axis in DIRECTIONS[:3])


def port_motions(reduced: Reduced, ports: Sequence[Port], rigid: Array) -> tuple[Array, Array]:
    """Motion at the ports per coordinate (p, q, c), and in the rigid-body modes (p, q, k).

    A port that no rigid motion moves gets zeros without rounding: a strut that spins
    does not make the tool float.

    Parameters
    ----------
    reduced : Reduced
        At p poses.
    ports : sequence of q Port
    rigid : (p, c, k)
        Rigid-body modes in coordinates, mass-normalised, 1/√kg.
    """
    at = np.stack([port.on(reduced) for port in ports], axis=1)
    if not rigid.shape[-1]:
        return at, at @ rigid
    moved = np.abs(at @ reduced.rigid).max(axis=-1)
    size = np.abs(at).max(axis=-1) * np.abs(reduced.rigid).max(axis=(1, 2))[:, None]
    return at, np.asarray(np.where((moved > STILL * size)[..., None], at @ rigid, 0.0))
