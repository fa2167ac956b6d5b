"""Patches of a solid's surface tied to nodes with six degrees of freedom.

An *average* interface (RBE3) reads the node's motion off the patch as the least-squares rigid
motion of its points, weighted by area; forces on the node spread over the patch and stiffen
nothing. A *rigid* one (RBE2) makes the patch move with the node as one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]
Vector = tuple[float, float, float]

#: Share of a patch's size below which its points count as one line.
COLLINEAR = 1e-6


@dataclass(frozen=True)
class Interface:
    """Where beams, joints, springs and bearings meet a solid.

    Parameters
    ----------
    name : str
        Of the node that it makes.
    patch : str
        A named patch of the mesh.
    position : (3,) or None
        Of the node in the mesh's frame, m. Default: the patch's middle.
    kind : "average" or "rigid"
    """

    name: str
    patch: str
    position: Vector | None = None
    kind: Literal["average", "rigid"] = "average"


@dataclass(frozen=True)
class TiedPatch:
    """An interface on a mesh.

    Parameters
    ----------
    interface : Interface
    nodes : (m,)
        Mesh nodes of the patch.
    position : (3,)
        m.
    average : (6, 3 m)
        Motion of the node from displacements of the patch, no unit and rad/m; its transpose spreads
        forces.
    rigid : (3 m, 6)
        Displacements of the patch that moves with the node, no unit and m/rad.
    """

    interface: Interface
    nodes: NDArray[np.intp]
    position: Array
    average: Array
    rigid: Array

    def __repr__(self) -> str:
        return f"<TiedPatch: {self.interface.name}, {len(self.nodes)} mesh nodes>"


def tie(interface: Interface, points: Array, nodes: NDArray[np.intp], weights: Array) -> TiedPatch:
    """Tie a patch to a node.

    Parameters
    ----------
    interface : Interface
    points : (n, 3)
        Of the whole mesh, m.
    nodes : (m,)
        Of the patch.
    weights : (m,)
        Area that each node stands for, m².

    Returns
    -------
    TiedPatch

    Raises
    ------
    ModelError
        A patch without nodes or area, or on one line, which gives no rotation about the line.
    """
    part = f"interface {interface.name}"
    # corners of quadratic triangles stand for no area: round-off may put them below zero
    weights = np.maximum(weights, 0.0)
    total = float(np.sum(weights)) if len(nodes) else 0.0
    if len(nodes) == 0 or total <= 0:
        raise ModelError(
            part,
            f'its patch "{interface.patch}" is empty.',
            "Choose a patch that contains faces of the mesh.",
        )
    share = np.asarray(weights) / total
    at = points[nodes]
    middle = share @ at
    spread = np.sqrt(share)[:, None] * (at - middle)
    sizes = np.linalg.svd(spread, compute_uv=False)
    if len(sizes) < 2 or sizes[1] <= COLLINEAR * max(sizes[0], 1e-300):
        raise ModelError(
            part,
            f'the {len(nodes)} nodes of its patch "{interface.patch}" lie on one line, which '
            "leaves a rotation undefined.",
            "Use a patch with an area, at least one face.",
        )
    position = middle if interface.position is None else np.asarray(interface.position, dtype=float)
    rigid = rigid_map(at - position)[:, :3]
    # rotations in units of displacement at the patch's size keep the 6 x 6 well conditioned
    size = np.array([1.0] * 3 + [1.0 / sizes[0]] * 3)
    scaled = rigid * size
    weighted = share[:, None, None] * scaled
    gram = np.einsum("nij,nik->jk", weighted, scaled)
    average = size[:, None] * np.linalg.solve(gram, weighted.reshape(-1, 6).T)
    return TiedPatch(
        interface, np.asarray(nodes, dtype=np.intp), position, average, rigid.reshape(-1, 6)
    )
