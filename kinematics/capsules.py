"""Links as capsules, segments with a radius, or meshes: how far apart bodies are unjoined."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.linkage import GROUND, Linkage
from strutwork.kinematics.mesh_gaps import MeshGaps, PlacedPart
from strutwork.kinematics.mesh_shapes import MeshShape
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.segments import segment_distances
from strutwork.kinematics.sliding import fixed_nodes

Array = NDArray[Any]


@dataclass(frozen=True)
class Capsule:
    """Points within a radius of the segment between two nodes of one body.

    Parameters
    ----------
    name : str
        Of the part, for messages.
    nodes : (str, str)
    radius : float
        m.

    Raises
    ------
    ModelError
        A radius that is not positive and finite.
    """

    name: str
    nodes: tuple[str, str]
    radius: float

    def __post_init__(self) -> None:
        if not 0.0 < self.radius < np.inf:
            raise ModelError(
                self.name, f"has the radius {self.radius!r} m.", "Give a positive finite number."
            )


@dataclass(frozen=True)
class Interference:
    """Parts of a linkage, capsules and meshes, and the pairs of them that may collide.

    Two parts are a pair where they lie on different bodies that neither a joint joins nor a
    body between them, without a part and with two joints, such as the cross of a universal
    joint.

    Parameters
    ----------
    linkage : Linkage
    capsules : tuple of Capsule
    shapes : tuple of MeshShape
        After the capsules in the numbers of `pairs`.

    Raises
    ------
    ModelError
        A part names an unknown node, or nodes of two bodies; meshes without their library.
    """

    linkage: Linkage
    capsules: tuple[Capsule, ...]
    shapes: tuple[MeshShape, ...] = ()

    def __post_init__(self) -> None:
        index, owner = self.linkage.node_index, self.linkage.body_of_node
        for part, nodes in zip(self._parts, self._ends, strict=True):
            for node in nodes:
                if node not in index:
                    raise ModelError(
                        part.name, f'names the unknown node "{node}".', "Define the node."
                    )
            if len({int(owner[index[node]]) for node in nodes}) > 1:
                raise ModelError(
                    part.name,
                    "has its ends on two bodies.",
                    "Give each body capsules of its own.",
                )
        fixed = fixed_nodes(self.linkage) if self.shapes else np.zeros(0, dtype=bool)
        for shape in self.shapes:
            if owner[index[shape.node]] >= 0 and not fixed[index[shape.node]]:
                raise ModelError(
                    shape.name,
                    f'its mesh is held by the node "{shape.node}", which slides along the body.',
                    "Give another node of the body.",
                )
        if self.shapes:
            _ = self._meshes

    def __repr__(self) -> str:
        meshes = f", {len(self.shapes)} meshes" if self.shapes else ""
        return f"<Interference: {len(self.capsules)} capsules{meshes}, {len(self.pairs)} pairs>"

    @property
    def _parts(self) -> tuple[Capsule | MeshShape, ...]:
        return (*self.capsules, *self.shapes)

    @property
    def _ends(self) -> list[tuple[str, str]]:
        return [*(c.nodes for c in self.capsules), *((s.node, s.node) for s in self.shapes)]

    @cached_property
    def _meshes(self) -> MeshGaps:
        return MeshGaps()

    @cached_property
    def _nodes(self) -> NDArray[np.intp]:
        index = self.linkage.node_index
        rows = [[index[n] for n in nodes] for nodes in self._ends]
        return np.asarray(rows, dtype=np.intp).reshape(-1, 2)

    @cached_property
    def _bodies(self) -> NDArray[np.intp]:
        return np.asarray(self.linkage.body_of_node[self._nodes[:, 0]], dtype=np.intp)

    @cached_property
    def pairs(self) -> NDArray[np.intp]:
        """Indices of two parts each, (q, 2)."""
        body = self._bodies
        joined = _joined(self.linkage, set(body.tolist()))
        first, second = np.triu_indices(len(body), 1)
        free = [
            body[i] != body[k] and frozenset((int(body[i]), int(body[k]))) not in joined
            for i, k in zip(first, second, strict=True)
        ]
        return np.asarray(np.stack([first, second], axis=-1)[np.asarray(free, dtype=bool)])

    @cached_property
    def reach(self) -> Array:
        """What the gap of each pair is measured by, m, (q,).

        The sum of the radii; of a mesh half its least extent.
        """
        radius = np.array([c.radius for c in self.capsules] + [s.half for s in self.shapes])
        return np.asarray(radius[self.pairs].sum(axis=-1))

    def words(self, pair: int) -> str:
        """The two parts of a pair.

        Parameters
        ----------
        pair : int
            Row of `pairs`.
        """
        first, second = (self._parts[i].name for i in self.pairs[pair])
        return f"{first} and {second}"

    def gaps(self, placement: Placement, within: float | None = None) -> Array:
        """Distance between the surfaces of each pair, m, negative where they overlap, (..., q).

        Of meshes the depth is a least one: that of the deepest pair of triangles that cross; of
        a part inside a mesh, its distance from the surface and its own least extent; of a
        capsule whose axis meets a mesh, its radius.

        Parameters
        ----------
        placement : Placement
        within : float, optional
            Of a mesh: gaps from this on, m, are only known to be at least that large. Default:
            those that exceed the pair's `reach`.

        Raises
        ------
        ModelError
            Poses of a mesh whose placement does not say how bodies have turned.
        """
        if not self.shapes:
            return self._capsule_gaps(placement)
        if (
            placement.turns is None
            and placement.batch
            and (self._bodies[len(self.capsules) :] >= 0).any()
        ):
            raise ModelError(
                self.shapes[0].name,
                "has a mesh, and the placement does not give the rotation of its body.",
                "Place the machine by its motion (`Motion.move`).",
            )
        flat = placement.flat()
        found = np.empty((len(flat.positions), len(self.pairs)))
        parts = [self._placed(flat, k) for k in range(len(self._parts))]
        for q, (i, k) in enumerate(self.pairs):
            most = float(self.reach[q]) if within is None else within
            if parts[i].shape is None and parts[k].shape is None:
                ends = parts[i].ends, parts[k].ends
                found[:, q] = segment_distances(*ends) - self.reach[q]
            else:
                found[:, q] = self._meshes.gaps(parts[i], parts[k], most)
        return found.reshape(*placement.batch, len(self.pairs))

    def _capsule_gaps(self, placement: Placement) -> Array:
        ends = placement.positions[..., self._nodes, :]
        found = np.empty((*placement.batch, len(self.pairs)))
        # pair by pair: all pairs of a large batch at once would not fit
        for q, (i, k) in enumerate(self.pairs):
            found[..., q] = segment_distances(ends[..., i, :, :], ends[..., k, :, :])
        return found - self.reach

    def _placed(self, placement: Placement, part: int) -> PlacedPart:
        if part < len(self.capsules):
            ends = placement.positions[:, self._nodes[part], :]
            return PlacedPart(ends, self.capsules[part].radius)
        shape = self.shapes[part - len(self.capsules)]
        body = int(self._bodies[part])
        # nodes of the ground may slide with what they carry
        origin = np.broadcast_to(shape.place, (len(placement.positions), 3))
        if body >= 0:
            origin = placement.positions[:, self._nodes[part, 0]]
        rotation = np.broadcast_to(np.eye(3), (len(origin), 3, 3))
        if body >= 0 and placement.turns is not None:
            rotation = placement.turns[:, body]
        ends, radius = shape.around
        return PlacedPart(
            origin[:, None] + ends @ np.swapaxes(rotation, -1, -2), radius, shape, origin, rotation
        )

    def check(self, home: Placement) -> Interference:
        """Return itself where nothing overlaps at home.

        Parameters
        ----------
        home : Placement
            One pose.

        Raises
        ------
        ModelError
            Names the two parts that overlap most, and by how much.
        """
        gaps = self.gaps(home, 0.0)
        if gaps.size and gaps.min() < 0.0:
            worst = int(gaps.argmin())
            least = "" if self.pairs[worst].max() < len(self.capsules) else "at least "
            raise ModelError(
                self.words(worst),
                f"interfere at home: they overlap by {least}{-1e3 * gaps[worst]:.3g} mm.",
                "Give a smaller radius or shape, correct the nodes, or join the bodies by a joint.",
            )
        return self


def outlines(linkage: Linkage, radius: float, bodies: Iterable[str] | None = None) -> list[Capsule]:
    """Capsules along the nodes of bodies: from one to the next, and back from the last of many.

    Parameters
    ----------
    linkage : Linkage
    radius : float
        m.
    bodies : iterable of str, optional
        All moving bodies by default.
    """
    owner = linkage.body_of_node
    found = []
    for b, name in enumerate(linkage.body_names):
        if bodies is not None and name not in bodies:
            continue
        nodes = [linkage.nodes[i] for i in np.flatnonzero(owner == b)]
        sides = list(pairwise(nodes))
        if len(nodes) > 2:
            sides.append((nodes[-1], nodes[0]))
        found += [Capsule(_part(name, sides, k), side, radius) for k, side in enumerate(sides)]
    return found


def _part(name: str, sides: Sequence[tuple[str, str]], k: int) -> str:
    return name if len(sides) == 1 else f"{name} ({' to '.join(sides[k])})"


def _joined(linkage: Linkage, solid: set[int]) -> set[frozenset[int]]:
    """Pairs of bodies that a joint joins, or a body without a part that has two joints."""
    owner, index = linkage.body_of_node, linkage.node_index
    near: dict[int, list[int]] = {}
    pairs: set[frozenset[int]] = set()
    for joint in linkage.joints:
        a, b = (int(owner[index[node]]) for node in joint.between)
        near.setdefault(a, []).append(b)
        near.setdefault(b, []).append(a)
        pairs.add(frozenset((a, b)))
    names = (*linkage.body_names, GROUND)
    for between, ends in near.items():
        if len(ends) == 2 and between not in solid and names[between] != GROUND:
            pairs.add(frozenset(ends))
    return pairs
