"""Geometric stiffness of what joins and of what moves as one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import cross_matrix
from strutwork.msa.assembly import System
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]

Part = tuple[str, NDArray[np.intp], Array]


def turning_stiffness(moment: Array) -> Array:
    """Stiffness against turning of a body under forces that keep their direction.

    The second-order displacement of a point at r from the pivot is ½ θ × (θ × r), so forces f
    do the work −½ θᵀ (tr S − S) θ with S = Σ f rᵀ, of which the symmetric part counts.

    Parameters
    ----------
    moment : (..., 3, 3)
        S of the forces on the body, N·m.

    Returns
    -------
    stiffness : (..., 3, 3)
    """
    trace = np.trace(moment, axis1=-2, axis2=-1)[..., None, None]
    return np.asarray(trace * np.eye(3) - (moment + np.swapaxes(moment, -1, -2)) / 2.0)


def cluster_parts(system: System, moments: Array) -> Iterator[Part]:
    """Rigid bodies under forces off their reference nodes.

    Parameters
    ----------
    system : System
        At p poses, with v clusters.
    moments : (p, v, 3, 3)
        S of all forces on each cluster about its reference node, N·m.
    """
    structure = system.placed.structure
    names = structure.mesh_nodes
    for v, node in enumerate(structure.reference_nodes):
        part = np.zeros((system.poses, 6, 6))
        part[:, 3:, 3:] = turning_stiffness(moments[:, v])
        if np.any(part):
            yield f"node {names[node]}", np.array([node]), part


def joint_parts(system: System, forces: Array) -> Iterator[Part]:
    """Joints, whose axes turn with their first side.

    What a locked or elastic direction carries works on the second-order part of the relative
    motion, −θ₁ × d of its displacement d and −½ θ₁ × θ₂ of its turn.

    Parameters
    ----------
    system : System
    forces : (p, j, 6)
        On the second node in joint axes, N and N·m.
    """
    linkage = system.placed.structure.linkage
    index = linkage.node_index
    turned = (system.joint_frames @ forces[..., None])[..., 0]
    for j, joint in enumerate(linkage.joints):
        nodes = np.array([index[n] for n in joint.between])
        f, m = cross_matrix(turned[:, j, :3]), cross_matrix(turned[:, j, 3:])
        # f·(θ₁ × d) = θ₁ᵀ (−f̃) d, with f̃ d = f × d
        part = np.zeros((system.poses, 12, 12))
        part[:, 3:6, 6:9], part[:, 3:6, 0:3] = -f, f
        part[:, 3:6, 9:12] = -m / 2.0
        if np.any(part):
            yield f"joint {joint.name}", nodes, part + np.swapaxes(part, -1, -2)


def spring_parts(system: System, displacements: Array) -> Iterator[Part]:
    """Springs between two nodes: what pulls along its length holds across it.

    Parameters
    ----------
    system : System
    displacements : (p, n, 6)
        Of the mesh nodes, m and rad.
    """
    structure = system.placed.structure
    for s, spring in enumerate(structure.springs):
        if len(spring.nodes) == 1:
            continue
        nodes = np.array([structure.mesh_index[n] for n in spring.nodes])
        first, second = nodes
        k = system.placed.numbers.springs[..., s, :]
        axes = system.placed.spring_axes(spring)
        moved = displacements[:, second] - displacements[:, first]
        pull = np.einsum("...ij,...j,...kj,...k->...i", axes, k, axes, moved)
        span = system.placed.positions[:, second] - system.placed.positions[:, first]
        length = np.linalg.norm(span, axis=-1)[:, None]
        apart = length > 0
        along = span / np.where(apart, length, 1.0)
        force = (pull[:, :3] * along).sum(axis=-1, keepdims=True)
        across = np.eye(3) - along[:, :, None] * along[:, None, :]
        # nodes at one place have no length to turn
        tension = np.where(apart, force / np.where(apart, length, 1.0), 0.0)[..., None]
        block = tension * across
        half = np.zeros((system.poses, 12, 12))
        half[:, 3:6, 9:12] = cross_matrix(pull[:, 3:]) / 2.0
        part = half + np.swapaxes(half, -1, -2)
        for a, b, sign in ((0, 0, 1), (6, 6, 1), (0, 6, -1), (6, 0, -1)):
            part[:, a : a + 3, b : b + 3] += sign * block
        if np.any(part):
            yield f"spring {spring.name}", nodes, part


def element_parts(system: System, displacements: Array) -> Iterator[Part]:
    """Elements of other kinds stiffen as though rigid: by the mean turn of their nodes.

    Parameters
    ----------
    system : System
    displacements : (p, n, 6)
        Of the mesh nodes, m and rad.
    """
    placed, structure = system.placed, system.placed.structure
    for element in structure.elements:
        nodes = np.array([structure.mesh_index[n] for n in element.nodes])
        k = len(nodes)
        u = displacements[:, nodes].reshape(system.poses, 6 * k, 1)
        pull = (element.stiffness(placed) @ u).reshape(system.poses, k, 6)[..., :3]
        arms = placed.positions[:, nodes]
        arms = arms - arms.mean(axis=1, keepdims=True)
        # the rigid motion nearest to the nodes' motions, rotations at the element's own size
        size = np.linalg.norm(arms, axis=-1).max(axis=-1)[:, None, None]
        weight = (
            np.tile([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], k)[None, :, None]
            + np.where(size > 0, size, 1.0)
            * np.tile([0.0, 0.0, 0.0, 1.0, 1.0, 1.0], k)[None, :, None]
            * 1e-3
        )
        rigid = rigid_map(arms).reshape(system.poses, 6 * k, 6)
        mean_turn = (np.linalg.pinv(weight * rigid) * np.swapaxes(weight, -1, -2))[:, 3:]
        moment = np.swapaxes(pull, -1, -2) @ arms
        # forces of the nodes on the element pull it as loads pull a body
        part = np.swapaxes(mean_turn, -1, -2) @ turning_stiffness(moment) @ mean_turn
        if np.any(part):
            yield f"element {element.name}", nodes, part
