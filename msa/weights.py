"""The weight of every part as a load of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.msa.assembly import System
from strutwork.msa.loads import LoadCase
from strutwork.msa.point_mass import mass_weights

Array = NDArray[Any]


def part_weights(system: System, gravity: ArrayLike) -> tuple[tuple[str, ...], Array]:
    """Weights of beams, solids, rigid bodies and masses.

    Parameters
    ----------
    system : System
        At p poses.
    gravity : (3,)
        Acceleration, global axes, m/s².

    Returns
    -------
    parts : tuple of m str
    loads : (p, n, 6, m)
        At the mesh nodes, global axes, N and N·m; they add to `System.nodal_loads` of gravity.

    Raises
    ------
    ModelError
        A beam whose material has no density.
    """
    structure, pull = system.placed.structure, np.asarray(gravity, dtype=float)
    shape = (system.poses, len(structure.mesh_nodes), 6)
    found: dict[str, Array] = {}
    case = LoadCase("gravity", gravity=(float(pull[0]), float(pull[1]), float(pull[2])))
    every = system.per_length_loads(case)
    for i, beam in enumerate(structure.beams):
        loads, alone = np.zeros(shape), np.zeros((len(structure.beams), 2, 3))
        if every is not None:
            alone[i] = every[i]
        system.add_segment_loads(loads, system.segment_loads(alone))
        found[beam.name] = loads
    for element in structure.elements:
        if hasattr(element, "mass"):
            nodes = [structure.mesh_index[n] for n in element.nodes]
            fall = np.tile(np.append(pull, np.zeros(3)), len(nodes))
            loads = np.zeros(shape)
            loads[:, nodes] += (element.mass(system.placed) @ fall).reshape(-1, len(nodes), 6)
            found[element.name] = loads
    owner, index = structure.linkage.body_of_node, structure.linkage.node_index
    bodies = [
        body
        for body in structure.linkage.bodies
        if int(owner[index[body.nodes[0]]]) not in structure.flexible_bodies
    ]
    rigid = {n: body.name for body in (*bodies, *structure.rigid) for n in body.nodes}
    for node, weight in mass_weights(system.placed, pull):
        loads = found.setdefault(rigid.get(node, f"mass at {node}"), np.zeros(shape))
        loads[:, structure.mesh_index[node]] += weight
    if not found:
        return (), np.zeros((*shape, 0))
    return tuple(found), np.stack(list(found.values()), axis=-1)
