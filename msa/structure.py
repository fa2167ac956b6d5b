"""Structures: a linkage whose bodies may be flexible."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Linkage, Placement, check_coincidence
from strutwork.msa.beam import Beam, beam_axes, local_stiffness, to_global
from strutwork.msa.element import Element
from strutwork.msa.held import check_held
from strutwork.msa.proportions import warn_of_proportions
from strutwork.msa.rigid_map import rigid_map, turned_back
from strutwork.msa.springs import PointMass, Spring
from strutwork.msa.stiffening import Stiffening

__all__ = ["PlacedStructure", "Structure", "rigid_map", "turned_back"]

Array = NDArray[Any]


@dataclass(frozen=True)
class Structure:
    """A linkage with what makes it flexible and heavy.

    A body of the linkage is rigid unless a beam or element lies in it; a flexible body may
    hold rigid groups.

    Parameters
    ----------
    linkage : Linkage
    beams : tuple of Beam
    springs : tuple of Spring
    rigid : tuple of Body
        Rigid groups inside flexible bodies.
    masses : tuple of PointMass
    elements : tuple of Element
        Elements of other kinds.

    Raises
    ------
    ModelError
        An unknown node, a name used twice, or a body that its beams do not hold together.
    """

    linkage: Linkage
    beams: tuple[Beam, ...] = ()
    springs: tuple[Spring, ...] = ()
    rigid: tuple[Body, ...] = ()
    masses: tuple[PointMass, ...] = ()
    elements: tuple[Element, ...] = field(default=())

    def __post_init__(self) -> None:
        known = self.linkage.node_index
        parts = [
            *((f"beam {b.name}", b.nodes) for b in self.beams),
            *((f"spring {s.name}", s.nodes) for s in self.springs),
            *((f"body {r.name}", r.nodes) for r in self.rigid),
            *((f"mass at node {m.node}", (m.node,)) for m in self.masses),
            *((f"element {e.name}", e.nodes) for e in self.elements),
        ]
        for part, nodes in parts:
            for node in nodes:
                if node not in known:
                    raise ModelError(part, f'names the unknown node "{node}".', "Define the node.")
        owner = self.linkage.body_of_node
        for part, nodes in parts:
            if part.startswith(("beam", "body", "element")):
                bodies = {int(owner[known[node]]) for node in nodes}
                if len(bodies) > 1:
                    raise ModelError(
                        part,
                        "its nodes belong to different bodies of the linkage.",
                        "Put the nodes in one body, or join the bodies by a joint.",
                    )
        seen: set[str] = set()
        for name in [*(b.name for b in self.beams), *(s.name for s in self.springs)]:
            if name in seen:
                raise ModelError(
                    f"part {name}", "is defined twice.", "Give beams and springs unique names."
                )
            seen.add(name)
        check_held(self)

    def __repr__(self) -> str:
        return (
            f"<Structure: {len(self.linkage.nodes)} nodes, {len(self.beams)} beams, "
            f"{len(self.linkage.joints)} joints, {6 * self.vertex_count} dof before joints>"
        )

    @property
    def flexible_parts(self) -> list[tuple[str, ...]]:
        """Nodes of every beam and element."""
        return [*(b.nodes for b in self.beams), *(e.nodes for e in self.elements)]

    @cached_property
    def flexible_bodies(self) -> frozenset[int]:
        """Indices of bodies that hold a beam or an element; -1 stands for ground."""
        owner, index = self.linkage.body_of_node, self.linkage.node_index
        return frozenset(int(owner[index[nodes[0]]]) for nodes in self.flexible_parts)

    @cached_property
    def mesh_nodes(self) -> tuple[str, ...]:
        """Nodes of the linkage, then those inside divided beams (beam/1, beam/2 and so on)."""
        inner = (f"{b.name}/{i}" for b in self.beams for i in range(1, b.elements))
        return (*self.linkage.nodes, *inner)

    @cached_property
    def mesh_index(self) -> dict[str, int]:
        """Row of each mesh node."""
        return {name: i for i, name in enumerate(self.mesh_nodes)}

    @cached_property
    def segments(self) -> NDArray[np.intp]:
        """Beam, first and second mesh node of every beam element, (s, 3)."""
        rows: list[list[int]] = []
        for i, beam in enumerate(self.beams):
            chain = [
                beam.nodes[0],
                *(f"{beam.name}/{k}" for k in range(1, beam.elements)),
                beam.nodes[1],
            ]
            index = [self.mesh_index[n] for n in chain]
            rows.extend([i, a, b] for a, b in pairwise(index))
        return np.asarray(rows, dtype=np.intp).reshape(-1, 3)

    @cached_property
    def vertex_of_node(self) -> NDArray[np.intp]:
        """Rigid cluster of every mesh node, -1 for ground, (n,).

        Nodes of one cluster share six degrees of freedom: the exact elimination of rigid
        bodies.
        """
        linkage = self.linkage
        owner = linkage.body_of_node
        grounded = [b for b in linkage.bodies if b.name == GROUND]
        label: dict[int, int] = {}
        count = 0
        groups: list[list[int]] = [
            [linkage.node_index[n] for n in body.nodes] for body in self.rigid
        ]
        groups += [
            [int(i) for i in np.flatnonzero(owner == b)]
            for b in range(len(linkage.body_names))
            if b not in self.flexible_bodies
        ]
        for body in grounded:
            for node in body.nodes:
                label[linkage.node_index[node]] = -1
        for group in groups:
            if any(label.get(i) == -1 for i in group):
                label.update(dict.fromkeys(group, -1))
                continue
            if any(i in label for i in group):
                names = ", ".join(linkage.nodes[i] for i in group if i in label)
                raise ModelError(
                    f"node {names}", "is in two rigid bodies.", "Merge the bodies into one."
                )
            label.update(dict.fromkeys(group, count))
            count += 1
        for i in range(len(self.mesh_nodes)):
            if i not in label:
                label[i] = count
                count += 1
        return np.asarray([label[i] for i in range(len(self.mesh_nodes))], dtype=np.intp)

    @cached_property
    def vertex_count(self) -> int:
        """Number of moving rigid clusters."""
        return int(self.vertex_of_node.max(initial=-1)) + 1

    @cached_property
    def reference_nodes(self) -> NDArray[np.intp]:
        """Mesh node that stands for each cluster: the tool in its own, else the first, (v,)."""
        vertex = self.vertex_of_node
        first = np.array(
            [np.flatnonzero(vertex == v)[0] for v in range(self.vertex_count)], dtype=np.intp
        )
        if self.linkage.tool is not None:
            tool = self.linkage.node_index[self.linkage.tool]
            if vertex[tool] >= 0:
                first[vertex[tool]] = tool
        return first

    def at(self, placement: Placement) -> PlacedStructure:
        """The structure at a batch of poses.

        Raises
        ------
        ModelError
            Joint nodes that do not coincide; a beam of zero length, an orientation along its
            beam, a spring that resists rigid rotation (in a batch these come when the poses are
            solved, and mark the poses at fault).
        UnreachableError
            A pose that cannot be taken.

        Warns
        -----
        ProportionWarning
            Beams and sections whose dimensions do not fit one another; once.
        """
        placement.require_reachable()
        check_coincidence(self.linkage, placement)
        placed = PlacedStructure(self, placement)
        if np.prod(placement.batch, dtype=int) == 1:
            placed.check()
        warn_of_proportions(placed)
        return placed


@dataclass(frozen=True)
class PlacedStructure:
    """A structure at a batch of poses; made by `Structure.at`.

    `stiffening` is what a preload adds when it vibrates (`strutwork.fea.preloaded`); statics is
    linear and does without.
    """

    structure: Structure
    placement: Placement
    stiffening: Stiffening | None = None

    def __repr__(self) -> str:
        return f"<PlacedStructure: {self.structure!r}, batch {self.batch}>"

    @property
    def batch(self) -> tuple[int, ...]:
        """Shape of the batch of poses."""
        return self.placement.batch

    def __getitem__(self, index: Any) -> PlacedStructure:
        added = None if self.stiffening is None else self.stiffening[index]
        return PlacedStructure(self.structure, self.placement[index], added)

    @cached_property
    def beam_ends(self) -> tuple[Array, Array]:
        """Ends of the whole beams, offsets included, (..., b, 3) each, m."""
        return self._ends(self.placement.positions)

    def _ends(self, positions: Array) -> tuple[Array, Array]:
        s = self.structure
        index = s.linkage.node_index
        ends = []
        for k in (0, 1):
            rows = [index[b.nodes[k]] for b in s.beams]
            ends.append(positions[..., rows, :] + self.beam_offsets[..., k, :])
        return ends[0], ends[1]

    @cached_property
    def beam_offsets(self) -> Array:
        """From the nodes of the whole beams to their ends, (b, 2, 3) or (..., b, 2, 3), m."""
        beams = self.structure.beams
        shift = np.array([b.offsets for b in beams]).reshape(-1, 2, 3)
        turns = self.beam_turns
        if turns is not None and np.any(shift):
            shift = np.asarray(shift @ np.swapaxes(turns, -1, -2))
        return shift

    @cached_property
    def beam_turns(self) -> Array | None:
        """Rotation of each beam's body, (..., b, 3, 3); None where no body has turned."""
        beams = self.structure.beams
        if self.placement.turns is None or not beams:
            return None
        return np.stack([self.turn_of(b.nodes[0]) for b in beams], axis=-3)

    def turn_of(self, node: str) -> Array:
        """Rotation of a node's body from where its parts are described, (3, 3) or (..., 3, 3)."""
        linkage, turns = self.structure.linkage, self.placement.turns
        body = linkage.body_of_node[linkage.node_index[node]]
        return np.eye(3) if turns is None or body < 0 else np.asarray(turns[..., body, :, :])

    def spring_axes(self, spring: Spring) -> Array:
        """Axes of a spring, (6, 6) or (..., 6, 6): global to ground, else of its first body."""
        turn = np.eye(3) if len(spring.nodes) == 1 else self.turn_of(spring.nodes[0])
        axes = np.zeros((*turn.shape[:-2], 6, 6))
        axes[..., :3, :3] = axes[..., 3:, 3:] = turn
        return axes

    @cached_property
    def beam_geometry(self) -> tuple[Array, Array]:
        """Length (..., b) in m and local axes as rows (..., b, 3, 3) of the whole beams."""
        return self._geometry(*self.beam_ends)

    @cached_property
    def extended_geometry(self) -> tuple[Array, Array]:
        """`beam_geometry` in extended precision: axes orthogonal to more digits than a double."""
        return self._geometry(*self._ends(self.placement.positions.astype(np.longdouble)))

    @cached_property
    def extended_arms(self) -> Array:
        """`arms` in extended precision."""
        return self._arms(self.positions.astype(np.longdouble))

    def _geometry(self, start: Array, end: Array) -> tuple[Array, Array]:
        s = self.structure
        up = np.full(start.shape, np.nan)
        for i, beam in enumerate(s.beams):
            if isinstance(beam.orientation, str):
                up[..., i, :] = self.frame(beam.orientation, f"beam {beam.name}")[..., :, 2]
            elif beam.orientation is not None:
                up[..., i, :] = beam.orientation
        names, turns = [b.name for b in s.beams], self.beam_turns
        if turns is None:
            return beam_axes(start, end, up, names)
        # in its body's axes, in which vectors and the default are what the beam says
        turns = np.broadcast_to(turns, (*start.shape[:-1], 3, 3))
        named = [i for i, beam in enumerate(s.beams) if isinstance(beam.orientation, str)]
        up[..., named, :] = turned_back(turns[..., named, :, :], up[..., named, :])
        length, axes = beam_axes(turned_back(turns, start), turned_back(turns, end), up, names)
        return length, np.asarray(axes @ np.swapaxes(turns, -1, -2))

    def frame(self, joint: str, part: str = "structure") -> Array:
        """Axes of a joint as columns, (..., 3, 3)."""
        index = self.structure.linkage.joint_index
        if joint not in index:
            raise ModelError(part, f'names the unknown joint "{joint}".', "Name a joint.")
        return self.placement.frames[..., index[joint], :, :]

    @cached_property
    def positions(self) -> Array:
        """Positions of the mesh nodes, (..., n, 3), m."""
        inner = []
        start, end = self.beam_ends
        for i, beam in enumerate(self.structure.beams):
            for k in range(1, beam.elements):
                share = k / beam.elements
                inner.append((1 - share) * start[..., i, :] + share * end[..., i, :])
        if not inner:
            return self.placement.positions
        return np.concatenate([self.placement.positions, np.stack(inner, axis=-2)], axis=-2)

    @cached_property
    def arms(self) -> Array:
        """From each cluster's reference node to its nodes, (..., n, 3), m; zero for ground."""
        return self._arms(self.positions)

    def _arms(self, positions: Array) -> Array:
        s = self.structure
        vertex = s.vertex_of_node
        reference, moves = np.arange(len(vertex)), vertex >= 0
        reference[moves] = s.reference_nodes[vertex[moves]]
        return np.asarray(positions - positions[..., reference, :])

    @cached_property
    def segment_stiffness(self) -> Array:
        """Stiffness of every beam element at its two mesh nodes, global axes, (..., s, 12, 12)."""
        s = self.structure
        length, axes = self.beam_geometry
        beam = s.segments[:, 0]
        pieces = np.array([b.elements for b in s.beams], dtype=float)
        properties = np.array([b.properties for b in s.beams]).reshape(-1, 6).T
        local = local_stiffness((length / pieces)[..., beam], properties[:, beam])
        stiffness = to_global(axes[..., beam, :, :], local)
        offsets = self.segment_offsets
        if not np.any(offsets):
            return stiffness
        carry = np.zeros((*offsets.shape[:-2], 12, 12))
        for k in (0, 1):
            carry[..., 6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = rigid_map(offsets[..., k, :])
        return np.asarray(np.swapaxes(carry, -1, -2) @ stiffness @ carry)

    @cached_property
    def segment_offsets(self) -> Array:
        """From the mesh nodes of each beam element to its ends, (s, 2, 3) or (..., s, 2, 3), m."""
        s, offsets = self.structure, self.beam_offsets
        result = np.zeros((*offsets.shape[:-3], len(s.segments), 2, 3))
        last = -1
        for i, beam in enumerate(s.beams):
            first, last = last + 1, last + beam.elements
            result[..., first, 0, :] = offsets[..., i, 0, :]
            result[..., last, 1, :] = offsets[..., i, 1, :]
        return result

    def check(self) -> None:
        """Evaluate the geometry once so that its errors come early."""
        if self.structure.beams:
            _ = self.beam_geometry
        index = self.structure.linkage.node_index
        for spring in self.structure.springs:
            if len(spring.nodes) == 1:
                continue
            first, second = (index[n] for n in spring.nodes)
            arm = self.placement.positions[..., second, :] - self.placement.positions[..., first, :]
            # work of the spring in a rigid rotation about each axis
            arm = turned_back(self.spring_axes(spring)[..., :3, :3], arm)
            resisted = spring.diagonal[:3, None] * rigid_map(arm)[..., :3, 3:]
            if np.abs(resisted).max(initial=0.0) > 1e-9 * spring.diagonal.max():
                raise ModelError(
                    f"spring {spring.name}",
                    f"its nodes are {np.linalg.norm(arm, axis=-1).max():.3g} m apart across its "
                    "direction: it would resist a rigid rotation of both.",
                    "Put its nodes at one place or along its direction, or use a joint.",
                )
