"""Loads of parts that expand: what a part would do if it were free, held by its neighbours.

A part whose temperature changes has a shape in which it is free of stress; its stiffness times
that free motion is the load (Przemieniecki 1968, section 7.1). A rigid body that expands moves
its nodes against one another, which is a known displacement of all that they hold.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa.assembly import System
from strutwork.names import choices

Array = NDArray[Any]


@dataclass(frozen=True)
class Expansion:
    """Free expansion of one part.

    Parameters
    ----------
    part : str
        A beam, an element or a rigid body.
    strain : float
        α ΔT, no unit.
    curvature : (float, float)
        α times the gradients of the temperature along local y and z of a beam, 1/m.
    load : (6 k,) or None
        Of an element at its nodes, axes of its body where it is described, N and N·m; in place of
        what its strain does.

    Raises
    ------
    ModelError
        A value that is not finite.
    """

    part: str
    strain: float = 0.0
    curvature: tuple[float, float] = (0.0, 0.0)
    load: Array | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        load = () if self.load is None else np.asarray(self.load).tolist()
        if not all(isfinite(v) for v in (self.strain, *self.curvature, *load)):
            raise ModelError(
                f"expansion of {self.part}", "is not finite.", "Give finite temperatures."
            )


@dataclass(frozen=True)
class ThermalLoads:
    """The right-hand sides of m expansions at p poses.

    Parameters
    ----------
    loads : (p, n, 6, m)
        At the mesh nodes, global axes, N and N·m.
    gaps : (p, r, m)
        Misfits on the constraint rows, m and rad.
    moved : (p, n, 6, m)
        By what the nodes of rigid bodies are displaced within their bodies, m and rad; adds to
        what the loads and gaps cause.
    """

    loads: Array
    gaps: Array
    moved: Array

    def __repr__(self) -> str:
        return f"<ThermalLoads: {self.loads.shape[-1]} expansions, {len(self.loads)} poses>"


def expandable(system: System) -> dict[str, str]:
    """Parts that can expand, by name: "beam", "element" or "body".

    Parameters
    ----------
    system : System
    """
    structure = system.placed.structure
    linkage = structure.linkage
    owner, index = linkage.body_of_node, linkage.node_index
    # a body that holds a beam or an element is not rigid, and the ground does not move
    rigid = [
        body.name
        for body in linkage.bodies
        if owner[index[body.nodes[0]]] >= 0
        and int(owner[index[body.nodes[0]]]) not in structure.flexible_bodies
    ]
    return (
        dict.fromkeys((*rigid, *(b.name for b in structure.rigid)), "body")
        | {e.name: "element" for e in structure.elements}
        | {b.name: "beam" for b in structure.beams}
    )


def thermal_loads(system: System, expansions: Sequence[Expansion]) -> ThermalLoads:
    """Loads, misfits and displacements of expanding parts, a column for each.

    Exact for beams, whose free shape is an arc. An element has the load that is given. Without
    one it expands from its first node, its interfaces with it and their rotations unchanged, as
    a homogeneous solid of one temperature whose nodes stand at the centres of their patches.

    Parameters
    ----------
    system : System
        At p poses.
    expansions : sequence of m Expansion

    Raises
    ------
    ModelError
        An unknown part, a curvature of what is no beam, or a load of what is no element.
    """
    structure = system.placed.structure
    known = expandable(system)
    nodes, count = len(structure.mesh_nodes), len(expansions)
    loads = np.zeros((system.poses, nodes, 6, count))
    gaps = np.zeros((system.poses, len(system.row_labels), count))
    moved = np.zeros_like(loads)
    for m, expansion in enumerate(expansions):
        kind = known.get(expansion.part)
        if kind is None:
            raise ModelError(
                "expansion",
                f'names the unknown part "{expansion.part}".',
                choices("Parts", expansion.part, known),
            )
        if kind != "beam" and any(expansion.curvature):
            raise ModelError(
                f"expansion of {expansion.part}",
                "has a gradient across a beam, and it is no beam.",
                "Give gradients to beams and solids, or mesh the part.",
            )
        if kind != "element" and expansion.load is not None:
            raise ModelError(
                f"expansion of {expansion.part}",
                "has a load, and it is no element.",
                "Give its strain.",
            )
        if kind == "beam":
            system.add_segment_loads(loads[..., m], _beam(system, expansion))
        elif kind == "element":
            loads[..., m] += _element(system, expansion)
        else:
            moved[..., m] = _body(system, expansion)
            loads[..., m] += _held_loads(system, moved[..., m])
            gaps[..., m] = _held_gaps(system, moved[..., m])
    return ThermalLoads(loads, gaps, moved)


def _beam(system: System, expansion: Expansion) -> Array:
    """Loads of a beam's elements in local axes, (p, s, 12)."""
    structure = system.placed.structure
    beam = structure.segments[:, 0]
    names = [b.name for b in structure.beams]
    here = beam == names.index(expansion.part)
    ea, _, eiy, eiz = np.array([b.properties for b in structure.beams]).T[:4, beam]
    loads = np.zeros((system.poses, len(beam), 12))
    force = ea * expansion.strain * here
    loads[..., 0], loads[..., 6] = -force, force
    # strain α g y is −y v″, and rotations are v′ about z and −w′ about y
    along_y, along_z = expansion.curvature
    moment = -eiz * along_y * here
    loads[..., 5], loads[..., 11] = -moment, moment
    moment = eiy * along_z * here
    loads[..., 4], loads[..., 10] = -moment, moment
    return loads


def _element(system: System, expansion: Expansion) -> Array:
    structure = system.placed.structure
    element = next(e for e in structure.elements if e.name == expansion.part)
    index = np.array([structure.mesh_index[n] for n in element.nodes])
    loads = np.zeros((system.poses, len(structure.mesh_nodes), 6))
    if expansion.load is not None:
        at_home = np.asarray(expansion.load, dtype=float).reshape(-1, 2, 3)
        turned = np.einsum("...ij,naj->...nai", system.placed.turn_of(element.nodes[0]), at_home)
        loads[:, index] = turned.reshape(*turned.shape[:-2], 6)
        return loads
    tied = np.array([n in getattr(element, "tied", element.nodes) for n in element.nodes])
    places = system.placed.positions[:, index]
    free = np.zeros((system.poses, len(index), 6))
    free[..., :3] = expansion.strain * (places - places[:, :1]) * tied[:, None]
    force = element.stiffness(system.placed) @ free.reshape(system.poses, -1, 1)
    loads[:, index] = force.reshape(system.poses, len(index), 6)
    return loads


def _body(system: System, expansion: Expansion) -> Array:
    """By what the body's nodes move within it, (p, n, 6), from its first node."""
    structure = system.placed.structure
    bodies = {b.name: b.nodes for b in (*structure.linkage.bodies, *structure.rigid)}
    index = np.array([structure.mesh_index[n] for n in bodies[expansion.part]])
    places = system.placed.positions[:, index]
    moved = np.zeros((system.poses, len(structure.mesh_nodes), 6))
    moved[:, index, :3] = expansion.strain * (places - places[:, :1])
    return moved


def _held_loads(system: System, moved: Array) -> Array:
    """Loads of elastic parts whose nodes are displaced, (p, n, 6)."""
    loads = np.zeros_like(moved)
    for _, nodes, stiffness in system.contributions():
        at = moved[:, nodes].reshape(system.poses, -1, 1)
        if np.any(at):
            loads[:, nodes] -= (stiffness @ at).reshape(system.poses, len(nodes), 6)
    return loads


def _held_gaps(system: System, moved: Array) -> Array:
    """Misfits of locked joint directions whose nodes are displaced, (p, r)."""
    linkage = system.placed.structure.linkage
    pairs = np.array([[linkage.node_index[n] for n in j.between] for j in linkage.joints])
    joint, direction = system.row_owner
    if not len(joint):
        return np.zeros((system.poses, 0))
    apart = moved[:, pairs[joint, 1]] - moved[:, pairs[joint, 0]]
    frames = np.swapaxes(system.joint_frames, -1, -2)[:, joint]
    local = np.einsum("prij,prj->pri", frames, apart)
    return np.asarray(-np.take_along_axis(local, direction[None, :, None], axis=-1)[..., 0])
