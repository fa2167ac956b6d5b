"""Mass of the rigid bodies of a structure, from the same matrices that vibrate."""

from __future__ import annotations

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics.body_masses import BodyMasses
from strutwork.kinematics.rows import body_references
from strutwork.msa.assembly import system_of
from strutwork.msa.mass import mass_contributions
from strutwork.msa.structure import PlacedStructure, Structure, rigid_map


def body_masses(placed: PlacedStructure) -> BodyMasses:
    """Mass, centre and inertia of every moving body of a structure's linkage.

    The consistent mass of all parts, on rigid motions of their bodies.

    Parameters
    ----------
    placed : PlacedStructure
        At one pose, the home of a motion.

    Raises
    ------
    ModelError
        A material without density, or no moving body that has mass.
    """
    structure = placed.structure
    linkage = structure.linkage
    system = system_of(placed)
    references = body_references(linkage, placed.placement).reshape(-1, 3)
    positions = placed.positions.reshape(-1, 3)
    owner = linkage.body_of_node
    bodies = len(linkage.body_names)
    whole = np.zeros((bodies, 6, 6))
    inner = {
        f"{beam.name}/{k}": owner[linkage.node_index[beam.nodes[0]]]
        for beam in structure.beams
        for k in range(1, beam.elements)
    }
    owner = np.array([*owner, *(inner[n] for n in structure.mesh_nodes[len(linkage.nodes) :])])
    for _, nodes, part in mass_contributions(system):
        body = owner[nodes[0]]
        if body < 0:
            continue
        carry = np.concatenate([rigid_map(positions[n] - references[body]) for n in nodes])
        whole[body] += carry.T @ part[0] @ carry
    mass = whole[:, range(3), range(3)].mean(axis=1)
    if not np.any(mass > 0):
        raise ModelError(
            "structure",
            "has no moving body with mass.",
            "Give densities or point masses, or name a variant of the machine that has them.",
        )
    some = np.where(mass > 0, mass, 1.0)[:, None]
    arm = -np.stack([whole[:, 4, 2], whole[:, 5, 0], whole[:, 3, 1]], axis=-1) / some
    outer = arm[:, :, None] * arm[:, None, :]
    square = np.einsum("bi,bi->b", arm, arm)[:, None, None] * np.eye(3)
    inertia = whole[:, 3:, 3:] - mass[:, None, None] * (square - outer)
    return BodyMasses(mass, references + arm, (inertia + np.swapaxes(inertia, -1, -2)) / 2)


def stretched_parts(structure: Structure) -> tuple[str, ...]:
    """Beams, masses and elements that end where a joint slides along their body.

    In statics and vibration they end at the other side's node at every pose; as rigid bodies
    they keep the mass that they have at home.

    Parameters
    ----------
    structure : Structure
    """
    linkage = structure.linkage
    still = linkage.still_mask()
    slides = {
        joint.between[0]
        for joint, held in zip(linkage.joints, still, strict=True)
        if not held[:3].all() and linkage.body_of_node[linkage.node_index[joint.between[0]]] >= 0
    }
    parts = [
        *((f"beam {b.name}", b.nodes) for b in structure.beams),
        *((f"mass at {m.node}", (m.node,)) for m in structure.masses),
        *((f"element {e.name}", e.nodes) for e in structure.elements if hasattr(e, "mass")),
    ]
    return tuple(name for name, nodes in parts if slides & set(nodes))
