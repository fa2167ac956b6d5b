"""Assembly: stiffness, constraint rows and loads of a placed structure on its clusters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, State
from strutwork.msa.beam import fixed_end_loads
from strutwork.msa.clusters import Clusters
from strutwork.msa.loads import LoadCase
from strutwork.msa.point_mass import mass_weights
from strutwork.msa.structure import PlacedStructure, rigid_map
from strutwork.msa.topology import Topology
from strutwork.names import choices

Array = NDArray[Any]


@dataclass(frozen=True)
class System(Clusters):
    """The clusters of a structure at a flat batch of p poses, with their loads.

    Parameters
    ----------
    placed : PlacedStructure
        With one batch axis.
    topology : Topology
    """

    @property
    def lone(self) -> System | None:
        """The same at the one pose, where all poses are the same; None elsewhere.

        What the placement alone decides is computed of it, once.
        """
        alone = self.placed.alone
        if alone is None:
            return None
        kept = alone.__dict__
        if "_system" not in kept:
            kept["_system"] = system_of(alone)
        found: System = kept["_system"]
        return found

    def nodal_loads(self, cases: Sequence[LoadCase]) -> Array:
        """Loads at the mesh nodes, (p, n, 6, m), line loads and gravity by fixed-end forces.

        Parameters
        ----------
        cases : sequence of m LoadCase

        Raises
        ------
        ModelError
            An unknown node or beam, or gravity without densities.
        """
        structure = self.placed.structure
        loads = np.zeros((self.poses, len(structure.mesh_nodes), 6, len(cases)))
        for m, case in enumerate(cases):
            for node, wrench in case.wrenches:
                if node not in structure.linkage.node_index:
                    raise ModelError(
                        f"load case {case.name}",
                        f'names the unknown node "{node}".',
                        "Define the node.",
                    )
                loads[:, structure.mesh_index[node], :, m] += wrench
            pull = np.asarray(case.gravity)
            for node, weight in mass_weights(self.placed, pull) if case.gravity is not None else ():
                loads[:, structure.mesh_index[node], :, m] += weight
            for element in structure.elements if case.gravity is not None else ():
                if hasattr(element, "mass"):
                    # a rigid translation of its nodes is one of the whole element
                    nodes = [structure.mesh_index[n] for n in element.nodes]
                    fall = np.tile(np.append(np.asarray(case.gravity), np.zeros(3)), len(nodes))
                    weight = (element.mass(self.placed) @ fall).reshape(-1, len(nodes), 6)
                    loads[..., m][:, nodes] += weight
            per_length = self.per_length_loads(case)
            if per_length is not None:
                self.add_segment_loads(loads[..., m], self.segment_loads(per_length))
        return loads

    def per_length_loads(self, case: LoadCase) -> Array | None:
        """Load per length at both ends of every beam, global axes, (..., b, 2, 3), N/m; or None.

        With an axis of poses where each is another structure.

        Parameters
        ----------
        case : LoadCase
            Its line loads, and its gravity on the beams' own mass.
        """
        structure = self.placed.structure
        if not structure.beams or not (case.line_loads or case.gravity is not None):
            return None
        index = {beam.name: i for i, beam in enumerate(structure.beams)}
        per_metre = self.placed.numbers.inertia[..., 0]
        result = np.zeros((*per_metre.shape, 2, 3))
        for line in case.line_loads:
            if line.beam not in index:
                raise ModelError(
                    f"load case {case.name}",
                    f'names the unknown beam "{line.beam}".',
                    "Define the beam.",
                )
            result[..., index[line.beam], :, :] += (line.first, line.second)
        if case.gravity is not None:
            for beam in structure.beams:
                if beam.material.density is None:
                    raise ModelError(
                        f"material {beam.material.name}",
                        f'has no density, and beam "{beam.name}" needs it for gravity.',
                        "Give the material a density.",
                    )
            result += per_metre[..., None, None] * np.asarray(case.gravity)
        return result

    def line_loads(self, case: LoadCase) -> Array | None:
        """Equivalent end loads of every beam element in local axes, (p, s, 12), N and N·m.

        None without any.

        Parameters
        ----------
        case : LoadCase
        """
        per_length = self.per_length_loads(case)
        return None if per_length is None else self.segment_loads(per_length)

    def segment_loads(self, per_length: Array) -> Array:
        """Consistent loads of every beam element in local axes, (p, s, 12), N and N·m.

        Parameters
        ----------
        per_length : (..., b, 2, 3)
            At both ends of every beam, global axes, N/m.
        """
        structure = self.placed.structure
        length, axes = self.placed.beam_geometry
        beam = structure.segments[:, 0]
        per_length = np.broadcast_to(per_length, (self.poses, *per_length.shape[-3:]))
        pieces = np.array([b.elements for b in structure.beams], dtype=float)
        order = np.concatenate([np.arange(b.elements) for b in structure.beams])
        at = [order / pieces[beam], (order + 1) / pieces[beam]]
        near = per_length[:, beam, 0]
        change = per_length[:, beam, 1] - near
        ends = [np.einsum("psij,psj->psi", axes[:, beam], near + x[:, None] * change) for x in at]
        properties = np.moveaxis(self.placed.numbers.stiffness, -1, 0)[..., beam]
        return fixed_end_loads((length / pieces)[:, beam], properties, ends[0], ends[1])

    def add_segment_loads(self, loads: Array, local: Array) -> None:
        """Add loads of beam elements to those at the mesh nodes.

        Parameters
        ----------
        loads : (p, n, 6)
            Added to in place, global axes, N and N·m.
        local : (p, s, 12)
            At both ends of every beam element, local axes, N and N·m.
        """
        structure = self.placed.structure
        _, axes = self.placed.beam_geometry
        beam = structure.segments[:, 0]
        blocks = local.reshape(*local.shape[:2], 4, 3)
        turned = np.einsum("psij,pski->pskj", axes[:, beam], blocks).reshape(local.shape)
        offsets = self.placed.segment_offsets
        for k in (0, 1):
            part = turned[..., 6 * k : 6 * k + 6]
            at_node = (np.swapaxes(rigid_map(offsets[..., k, :]), -1, -2) @ part[..., None])[..., 0]
            for s, node in enumerate(structure.segments[:, 1 + k]):
                loads[:, node] += at_node[:, s]

    def gaps(self, cases: Sequence[LoadCase]) -> tuple[Array, Array]:
        """Misfits: on the constraint rows (p, r, m), and of elastic directions (j, 6, m).

        Parameters
        ----------
        cases : sequence of m LoadCase
            Their gaps, m and rad.

        Raises
        ------
        ModelError
            An unknown joint, or a misfit in a free direction.
        """
        linkage = self.placed.structure.linkage
        states = linkage.states()
        every = np.zeros((len(linkage.joints), 6, len(cases)))
        for m, case in enumerate(cases):
            for (name, direction), value in case.gaps.items():
                if name not in linkage.joint_index:
                    raise ModelError(
                        f"load case {case.name}",
                        f'names the unknown joint "{name}".',
                        choices("Joints", name, linkage.joint_index),
                    )
                j = linkage.joint_index[name]
                resists = [DIRECTIONS[d] for d in np.flatnonzero(states[j] != State.FREE)]
                if direction not in resists:
                    raise ModelError(
                        f"joint {name}",
                        f"has a misfit in {direction}, which is free or not a direction.",
                        "Name a locked or elastic direction: " + ", ".join(resists) + ".",
                    )
                every[j, DIRECTIONS.index(direction), m] += value
        owners, directions = self.row_owner
        on_rows = every[owners, directions]
        elastic = np.where((states == State.ELASTIC)[..., None], every, 0.0)
        return np.broadcast_to(on_rows, (self.poses, *on_rows.shape)), elastic

    def elastic_gap_loads(self, gaps: Array) -> Array:
        """Loads at the mesh nodes from misfits of elastic directions, (p, n, 6, m), N and N·m.

        Parameters
        ----------
        gaps : (j, 6, m)
            Of every joint in its axes, m and rad.
        """
        structure = self.placed.structure
        loads = np.zeros((self.poses, len(structure.mesh_nodes), 6, gaps.shape[-1]))
        for j in self.topology.elastic_joints:
            if not np.any(gaps[j]):
                continue
            force = self.joint_frames[:, j] @ (self.placed.numbers.joints[..., j, :, :] @ gaps[j])
            first, second = self._joint_nodes[j]
            loads[:, first] -= force
            loads[:, second] += force
        return loads


def system_of(placed: PlacedStructure) -> System:
    """The system of a placed structure, its batch made flat.

    Parameters
    ----------
    placed : PlacedStructure
        At a batch of any shape.
    """
    if len(placed.batch) != 1:
        flat = placed.placement.flat()
        added = None if placed.stiffening is None else placed.stiffening.flat(*flat.batch)
        placed = PlacedStructure(placed.structure, flat, added)
    return System(placed, Topology(placed.structure))
