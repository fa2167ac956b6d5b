"""Stiffness and constraint rows of a placed structure on its rigid clusters.

The unknowns are the six displacements of every rigid cluster at its reference node; rigid
bodies are thereby eliminated exactly.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import (
    DIRECTIONS,
    ConstraintRows,
    characteristic_lengths,
    constraint_rows,
)
from strutwork.msa.row_blocks import row_blocks
from strutwork.msa.structure import PlacedStructure, rigid_map
from strutwork.msa.topology import Topology
from strutwork.msa.triplets import sum_of_parts

if TYPE_CHECKING:
    import scipy.sparse as sp

Array = NDArray[Any]


@dataclass(frozen=True)
class Clusters:
    """Clusters of a structure, their stiffness and constraint rows, at a flat batch of p poses.

    Parameters
    ----------
    placed : PlacedStructure
        With one batch axis.
    topology : Topology
    """

    placed: PlacedStructure
    topology: Topology

    @cached_property
    def _joint_nodes(self) -> NDArray[np.intp]:
        index = self.placed.structure.linkage.node_index
        pairs = [[index[n] for n in j.between] for j in self.placed.structure.linkage.joints]
        return np.asarray(pairs, dtype=np.intp).reshape(-1, 2)

    def contributions(self, beams: bool = True) -> Iterator[tuple[str, NDArray[np.intp], Array]]:
        """Parts that store energy: name, mesh nodes (k,), stiffness (p, 6k, 6k).

        Parameters
        ----------
        beams : bool
            Whether beam elements are among them.
        """
        placed, structure = self.placed, self.placed.structure
        if structure.beams and beams:
            stiffness = placed.segment_stiffness
            for s, (beam, a, b) in enumerate(structure.segments):
                yield f"beam {structure.beams[beam].name}", np.array([a, b]), stiffness[:, s]
        index = structure.linkage.node_index
        for s, spring in enumerate(structure.springs):
            turn = placed.spring_axes(spring)
            k = turn * placed.numbers.springs[..., s, None, :] @ np.swapaxes(turn, -1, -2)
            nodes = np.array([index[n] for n in spring.nodes])
            if len(nodes) == 2:
                k = np.concatenate(
                    [np.concatenate([k, -k], -1), np.concatenate([-k, k], -1)], axis=-2
                )
            yield f"spring {spring.name}", nodes, np.broadcast_to(k, (self.poses, *k.shape[-2:]))
        for j in self.topology.elastic_joints:
            joint = structure.linkage.joints[j]
            k = self._joint_global(j, placed.numbers.joints[..., j, :, :])
            yield (
                f"joint {joint.name}",
                self._joint_nodes[j],
                np.concatenate([np.concatenate([k, -k], -1), np.concatenate([-k, k], -1)], axis=-2),
            )
        for element in structure.elements:
            nodes = np.array([structure.mesh_index[n] for n in element.nodes])
            yield f"element {element.name}", nodes, element.stiffness(placed)

    def _joint_global(self, joint: int, matrix: Array) -> Array:
        turn = self.joint_frames[:, joint]
        return np.asarray(turn @ matrix @ np.swapaxes(turn, -1, -2))

    @cached_property
    def joint_frames(self) -> Array:
        """Joint axes as six-by-six block rotations, (p, j, 6, 6)."""
        frames = self.placed.placement.frames
        result = np.zeros((*frames.shape[:2], 6, 6))
        result[..., :3, :3] = frames
        result[..., 3:, 3:] = frames
        return result

    @cached_property
    def turn_scale(self) -> Array:
        """One over the length that makes rotations comparable with translations, (p,), 1/m."""
        return np.asarray(1.0 / characteristic_lengths(self.placed.placement))

    @property
    def poses(self) -> int:
        """Number of poses p."""
        return self.placed.batch[0]

    def dofs(self, nodes: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
        """Unknowns of the clusters of mesh nodes, (6k,), and which of them move.

        Parameters
        ----------
        nodes : (k,)
            Rows of the mesh nodes.
        """
        vertex = self.placed.structure.vertex_of_node[nodes]
        dofs = (6 * vertex[:, None] + np.arange(6)).ravel()
        return dofs, np.repeat(vertex >= 0, 6)

    def carried(self, nodes: NDArray[np.intp], stiffness: Array) -> Array:
        """Stiffness at nodes (p, 6k, 6k) moved to the reference nodes of their clusters.

        Parameters
        ----------
        nodes : (k,)
            Rows of the mesh nodes.
        stiffness : (p, 6k, 6k)
            At the nodes, global axes; N/m, N, N·m/rad.
        """
        arms = self.placed.arms[:, nodes]
        if not np.any(arms):
            return stiffness
        k = len(nodes)
        maps = rigid_map(arms)
        blocks = stiffness.reshape(-1, k, 6, k, 6)
        moved = np.einsum("paji,pajbk,pbkl->paibl", maps, blocks, maps, optimize=True)
        return np.asarray(moved).reshape(-1, 6 * k, 6 * k)

    @cached_property
    def stiffness(self) -> Array:
        """Dense stiffness, (p, n, n)."""
        n = self.topology.size
        matrix = np.zeros((self.poses, n, n))
        for _, nodes, part in self.contributions():
            self.add_part(matrix, nodes, part)
        return matrix

    def add_part(self, matrix: Array, nodes: NDArray[np.intp], part: Array) -> None:
        """Add a part's matrix at mesh nodes (p, 6k, 6k) to a dense one on the unknowns.

        Parameters
        ----------
        matrix : (p, n, n)
            Added to in place; N/m, N, N·m/rad, or kg, kg·m, kg·m².
        nodes : (k,)
            Rows of the mesh nodes.
        part : (p, 6k, 6k)
            At the nodes, global axes, in the units of `matrix`.
        """
        dofs, moves = self.dofs(nodes)
        block = self.carried(nodes, part)[:, moves][:, :, moves]
        dofs = dofs[moves]
        if len(set(dofs)) == len(dofs):
            matrix[:, dofs[:, None], dofs] += block
            return
        # both ends in one cluster: add block by block
        for i in range(0, len(dofs), 6):
            for j in range(0, len(dofs), 6):
                matrix[:, dofs[i : i + 6, None], dofs[j : j + 6]] += block[:, i : i + 6, j : j + 6]

    @cached_property
    def sparse_stiffness(self) -> sp.csc_array:
        """Sparse stiffness of a batch of one, (n, n)."""
        return self.sparse_sum(self.contributions())

    def sparse_sum(self, parts: Iterable[tuple[str, NDArray[np.intp], Array]]) -> sp.csc_array:
        """Sum of parts' matrices at mesh nodes on the unknowns, sparse (n, n), for a batch of one.

        Parameters
        ----------
        parts : iterable of (name, nodes (k,), matrix (1, 6k, 6k))
            As `contributions` gives them: N/m, N, N·m/rad, or kg, kg·m, kg·m².
        """
        arms, vertex = self.placed.arms[0], self.placed.structure.vertex_of_node
        found = sum_of_parts((n, part[0], arms[n], vertex[n]) for _, n, part in parts)
        return found.matrix((self.topology.size, self.topology.size)).tocsc()

    @cached_property
    def row_owner(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Joint and direction of every constraint row, (r,) each."""
        joint, direction = np.nonzero(self.topology.locked)
        return joint, direction

    @cached_property
    def locked_rows(self) -> ConstraintRows:
        """The constraint rows at their nodes."""
        placed = self.placed
        return constraint_rows(placed.structure.linkage, placed.placement, self.topology.locked)

    @cached_property
    def row_blocks(self) -> tuple[NDArray[np.intp], Array]:
        """Constraint rows in blocks: cluster (r, k), −1 for ground, and values (p, r, k, 6).

        k is two, and four where a joint coordinate follows another.
        """
        return row_blocks(self.locked_rows, self.placed)

    @cached_property
    def rows(self) -> Array:
        """Constraint rows A on the unknowns, (p, r, n): A u = g."""
        vertex, values = self.row_blocks
        matrix = np.zeros((self.poses, len(vertex), self.topology.size))
        for r, pair in enumerate(vertex):
            for k, v in enumerate(pair):
                if v >= 0:
                    matrix[:, r, 6 * v : 6 * v + 6] += values[:, r, k]
        return matrix

    @cached_property
    def row_labels(self) -> tuple[str, ...]:
        """Name of each constraint row, `joint:direction`."""
        joints = self.placed.structure.linkage.joints
        return tuple(
            f"{joints[j].name}:{DIRECTIONS[d]}" for j, d in zip(*self.row_owner, strict=True)
        )

    def expand(self, unknowns: Array) -> Array:
        """Displacements of the mesh nodes (p, n, 6, m) from the unknowns (p, 6v, m).

        Extended precision is kept, here as in `gather`.

        Parameters
        ----------
        unknowns : (p, 6v, m)
            Displacements of the clusters, m and rad.
        """
        structure = self.placed.structure
        blocks = unknowns.reshape(self.poses, structure.vertex_count, 6, unknowns.shape[-1])
        # one row of zeros at the end, which the ground's index −1 finds
        ground = np.zeros((self.poses, 1, 6, unknowns.shape[-1]), dtype=unknowns.dtype)
        padded = np.concatenate([blocks, ground], axis=1)
        return np.asarray(self._carry(unknowns) @ padded[:, structure.vertex_of_node])

    def gather(self, nodal: Array) -> Array:
        """Loads on the unknowns (p, 6v, m) from loads at the mesh nodes (p, n, 6, m).

        Parameters
        ----------
        nodal : (p, n, 6, m)
            Wrenches at the mesh nodes, N and N·m.
        """
        structure = self.placed.structure
        moved = np.swapaxes(self._carry(nodal), -1, -2) @ nodal
        result = np.zeros((self.poses, structure.vertex_count + 1, *nodal.shape[2:]), nodal.dtype)
        at: Any = (slice(None), structure.vertex_of_node)
        np.add.at(result, at, moved)
        return result[:, :-1].reshape(self.poses, self.topology.size, nodal.shape[-1])

    def _carry(self, like: Array) -> Array:
        extended = like.dtype == np.longdouble
        return rigid_map(self.placed.extended_arms if extended else self.placed.arms)

    def tool_load(self) -> Array:
        """Six unit wrenches at the tool on the unknowns, (p, n, 6).

        Where the linkage names a workpiece, the opposite ones act on its node, carried there from
        the tool: the transpose is then the tool's displacement relative to the point of the
        workpiece at which it stands.

        Raises
        ------
        ModelError
            The linkage has no tool, or the workpiece moves with it.
        """
        structure = self.placed.structure
        if structure.linkage.tool is None:
            raise ModelError("structure", "has no tool.", "Name the tool centre point's node.")
        node = structure.mesh_index[structure.linkage.tool]
        vertex = structure.vertex_of_node[node]
        load = np.zeros((self.poses, self.topology.size, 6))
        if vertex >= 0:
            carried = rigid_map(self.placed.arms[:, node])
            load[:, 6 * vertex : 6 * vertex + 6] = np.swapaxes(carried, -1, -2)
        other = structure.workpiece_vertex
        if other >= 0:
            positions = self.placed.positions
            arm = positions[:, node] - positions[:, structure.reference_nodes[other]]
            load[:, 6 * other : 6 * other + 6] -= np.swapaxes(rigid_map(arm), -1, -2)
        return load
