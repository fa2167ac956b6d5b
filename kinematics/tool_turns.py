"""How far the tool has turned at a batch of poses, from where its linkage stood before."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement

Array = NDArray[Any]

#: Places that spread by less than this share of their largest spread lie on a line.
LINE = 1e-6


@dataclass(frozen=True)
class ToolTurns:
    """Where the body of a tool stood, by which its turns are counted.

    Parameters
    ----------
    body : int
        Index into `Linkage.body_names`.
    nodes : tuple of int
        Of the body, indices into `Linkage.nodes`.
    places : (k, 3)
        Of the nodes, m.
    turn : (3, 3)
        Rotation matrix that the placement counted for the body.
    """

    body: int
    nodes: tuple[int, ...]
    places: Array
    turn: Array

    @classmethod
    def of(cls, linkage: Linkage, placement: Placement) -> ToolTurns:
        """Counted from a placement.

        Parameters
        ----------
        linkage : Linkage
        placement : Placement
            One pose, no batch axes.

        Raises
        ------
        ModelError
            The linkage has no tool.
        """
        body = linkage.tool_body
        nodes = tuple(int(i) for i in np.flatnonzero(linkage.body_of_node == body))
        turn = np.eye(3) if placement.turns is None or body < 0 else placement.turns[body]
        return cls(body, nodes, np.asarray(placement.positions)[list(nodes)], np.asarray(turn))

    def at(self, placement: Placement) -> Array:
        """Rotation matrices of the tool, (p, 3, 3), from where it stood.

        Parameters
        ----------
        placement : Placement
            One batch axis (p,).
        """
        if self.body < 0:
            return np.broadcast_to(np.eye(3), (*placement.batch, 3, 3))
        if placement.turns is not None:
            return np.asarray(placement.turns[..., self.body, :, :] @ self.turn.T)
        return _fitted(self.places, placement.positions[..., list(self.nodes), :])


def _fitted(before: Array, after: Array) -> Array:
    """Rotations (p, 3, 3) that carry places (k, 3) to others (p, k, 3) best (Kabsch 1976)."""
    arms, moved = before - before.mean(axis=0), after - after.mean(axis=-2, keepdims=True)
    spread = np.linalg.svd(arms, compute_uv=False)
    if len(spread) < 2 or spread[1] <= LINE * max(float(spread[0]), 1e-300):
        return _least(arms, moved)
    u, _, vt = np.linalg.svd(np.einsum("pki,kj->pij", moved, arms))
    sign = np.sign(np.linalg.det(u @ vt))
    u[..., -1] *= sign[..., None]
    return np.asarray(u @ vt)


def _least(arms: Array, moved: Array) -> Array:
    """The least rotations that carry a line to others; none of a single place."""
    found = np.broadcast_to(np.eye(3), (len(moved), 3, 3)).copy()
    if not np.any(arms):
        return found
    far = int(np.linalg.norm(arms, axis=1).argmax())
    a = arms[far] / np.linalg.norm(arms[far])
    b = moved[:, far] / np.linalg.norm(moved[:, far], axis=1, keepdims=True)
    middle = a + b
    # twice the middle's dyad, less one, turns a to b by half a turn; so does a's to itself
    half = 2.0 * np.einsum("pi,pj->pij", middle, middle)
    half = half / np.einsum("pi,pi->p", middle, middle)[:, None, None] - np.eye(3)
    return np.asarray(half @ (2.0 * np.outer(a, a) - np.eye(3)))
