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
from strutwork.msa.beam import Beam
from strutwork.msa.element import Element
from strutwork.msa.held import check_held
from strutwork.msa.part_numbers import PartNumbers
from strutwork.msa.placed_structure import PlacedStructure
from strutwork.msa.proportions import warn_of_proportions
from strutwork.msa.rigid_map import rigid_map, turned_back
from strutwork.msa.springs import PointMass, Spring

__all__ = ["PlacedStructure", "Structure", "rigid_map", "turned_back"]

Array = NDArray[Any]


@dataclass(frozen=True)
class Structure:
    """A linkage with its flexibility and mass.

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

    @cached_property
    def numbers(self) -> PartNumbers:
        """Of its parts, which no pose changes."""
        return PartNumbers.of(self)

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
    def workpiece_vertex(self) -> int:
        """Rigid cluster relative to which the tool moves, -1 for the ground.

        Raises
        ------
        ModelError
            It is the tool's own.
        """
        linkage = self.linkage
        if linkage.against is None or linkage.tool is None:
            return -1
        vertex = self.vertex_of_node
        tool, other = (
            int(vertex[linkage.node_index[name]]) for name in (linkage.tool, linkage.against)
        )
        if tool == other:
            raise ModelError(
                "tool.against",
                f'names "{linkage.against}", which is one rigid body with the tool '
                f'"{linkage.tool}": they never move relative to each other.',
                "Name a node of the body that holds the workpiece.",
            )
        return other

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

        Parameters
        ----------
        placement : Placement
            At poses (...), all of them reachable.

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
