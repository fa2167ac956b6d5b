"""Equilibrium part by part: the forces of a structure from its nodes' displacements.

No assembled matrix stands between: a beam's end forces come from its own stiffness, which in
extended precision keeps the digits that a sum of stiff and soft parts in doubles has lost.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import ConstraintRows
from strutwork.msa.assembly import System
from strutwork.msa.beam import local_stiffness
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]


def beam_end_forces(system: System, displacements: Array) -> tuple[Array, Array]:
    """Displacements and forces of every beam element's ends in local axes, (p, s, 12, m) each.

    Parameters
    ----------
    system : System
    displacements : (p, n, 6, m)
        Of the mesh nodes, m and rad; in extended precision the forces are too.
    """
    structure = system.placed.structure
    segments = structure.segments
    length, axes = _geometry(system, displacements)
    pieces = np.array([b.elements for b in structure.beams], dtype=displacements.dtype)
    properties = np.moveaxis(system.placed.numbers.stiffness, -1, 0)[..., segments[:, 0]]
    stiffness = local_stiffness((length / pieces)[:, segments[:, 0]], properties)
    offsets = system.placed.segment_offsets.astype(displacements.dtype)
    at_ends = displacements[:, segments[:, 1:]]
    if np.any(offsets):
        at_ends = rigid_map(offsets) @ at_ends
    m = displacements.shape[-1]
    blocks = at_ends.reshape(*at_ends.shape[:2], 4, 3, m)
    turned = np.einsum("psij,pskjm->pskim", axes[:, segments[:, 0]], blocks)
    local = turned.reshape(system.poses, len(segments), 12, m)
    return local, np.asarray(stiffness @ local)


def unbalanced(
    system: System, unknowns: Array, multipliers: Array, load: Array, gaps: Array
) -> tuple[Array, Array, Array]:
    """What is left of the equilibrium and of the gaps: F − K u − Aᵀλ and g − A u.

    Parameters
    ----------
    system : System
    unknowns : (p, n, m)
        m and rad; extended precision is kept.
    multipliers : (p, r, m)
        Of the constraint rows, N and N·m.
    load : (p, n, m)
        F on the unknowns, N and N·m.
    gaps : (p, r, m)
        g, the misfits of the constraint rows, m and rad.

    Returns
    -------
    force : (p, n, m)
    gap : (p, r, m)
    carried : (p, m)
        Largest force on a node by one part; moments over the characteristic length.
    """
    structure = system.placed.structure
    kind, m = unknowns.dtype, unknowns.shape[-1]
    nodal = system.expand(unknowns)
    force = np.zeros_like(nodal)
    lever = np.ones((system.poses, 6, 1))
    lever[:, 3:] = system.turn_scale[:, None, None]
    carried = np.zeros((system.poses, m), dtype=kind)

    def add(nodes: NDArray[np.intp], part: Array) -> None:
        nonlocal carried
        at: Any = (slice(None), nodes)
        np.add.at(force, at, part)
        size = np.abs(part * lever[:, None]).max(axis=(1, 2), initial=0.0)
        carried = np.maximum(carried, size)

    if structure.beams:
        _, local = beam_end_forces(system, nodal)
        _, axes = _geometry(system, nodal)
        segments = structure.segments
        blocks = local.reshape(*local.shape[:2], 4, 3, m)
        turned = np.einsum("psij,pskim->pskjm", axes[:, segments[:, 0]], blocks)
        ends = turned.reshape(*local.shape[:2], 2, 6, m)
        offsets = system.placed.segment_offsets.astype(kind)
        if np.any(offsets):
            ends = np.swapaxes(rigid_map(offsets), -1, -2) @ ends
        for k in (0, 1):
            add(segments[:, 1 + k], ends[:, :, k])
    for name, nodes, stiffness in system.contributions(beams=False):
        del name
        moved = nodal[:, nodes].reshape(system.poses, 6 * len(nodes), m)
        add(nodes, (stiffness @ moved).reshape(system.poses, len(nodes), 6, m))

    def along(rows: ConstraintRows, forces: Array) -> Array:
        """Add what rows carry; the way that they have gone."""
        nodes = rows.nodes
        held = rows.axes[..., None] * forces[:, :, None]
        inside = structure.vertex_of_node[nodes[:, 0]] == structure.vertex_of_node[nodes[:, 1]]
        held[:, inside] = 0.0
        add(nodes[:, 1], held)
        add(nodes[:, 0], -held)
        apart = nodal[:, nodes[:, 1]] - nodal[:, nodes[:, 0]]
        return np.where(inside[:, None], 0.0, np.einsum("pri,prim->prm", rows.axes, apart))

    gap = gaps - along(system.locked_rows, multipliers)
    tied = system.locked_rows.tied
    if tied is not None:
        ratio = tied.ratio[:, None]
        gap[:, tied.rows] += ratio * along(tied.others, -ratio * multipliers[:, tied.rows])
    return load - system.gather(force), gap, carried


def _geometry(system: System, like: Array) -> tuple[Array, Array]:
    placed = system.placed
    return placed.extended_geometry if like.dtype == np.longdouble else placed.beam_geometry
