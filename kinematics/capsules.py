"""Links as capsules, segments with a radius: how far apart bodies are that no joint joins."""

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
from strutwork.kinematics.placement import Placement

Array = NDArray[Any]

#: Squared lengths below this share of the largest are points, and sines below its root parallel.
FLAT = 1e-24


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
    """Capsules of a linkage, and the pairs of them that may collide.

    Two capsules are a pair where they lie on different bodies that neither a joint joins nor a
    body between them, without a capsule and with two joints, such as the cross of a universal
    joint.

    Parameters
    ----------
    linkage : Linkage
    capsules : tuple of Capsule

    Raises
    ------
    ModelError
        A capsule names an unknown node, or nodes of two bodies.
    """

    linkage: Linkage
    capsules: tuple[Capsule, ...]

    def __post_init__(self) -> None:
        index, owner = self.linkage.node_index, self.linkage.body_of_node
        for capsule in self.capsules:
            for node in capsule.nodes:
                if node not in index:
                    raise ModelError(
                        capsule.name, f'names the unknown node "{node}".', "Define the node."
                    )
            if len({int(owner[index[node]]) for node in capsule.nodes}) > 1:
                raise ModelError(
                    capsule.name,
                    "has its ends on two bodies.",
                    "Give each body capsules of its own.",
                )

    def __repr__(self) -> str:
        return f"<Interference: {len(self.capsules)} capsules, {len(self.pairs)} pairs>"

    @cached_property
    def _nodes(self) -> NDArray[np.intp]:
        index = self.linkage.node_index
        rows = [[index[n] for n in c.nodes] for c in self.capsules]
        return np.asarray(rows, dtype=np.intp).reshape(-1, 2)

    @cached_property
    def pairs(self) -> NDArray[np.intp]:
        """Indices of two capsules each, (q, 2)."""
        body = self.linkage.body_of_node[self._nodes[:, 0]]
        joined = _joined(self.linkage, set(body.tolist()))
        first, second = np.triu_indices(len(self.capsules), 1)
        free = [
            body[i] != body[k] and frozenset((int(body[i]), int(body[k]))) not in joined
            for i, k in zip(first, second, strict=True)
        ]
        return np.asarray(np.stack([first, second], axis=-1)[np.asarray(free, dtype=bool)])

    @cached_property
    def reach(self) -> Array:
        """Sum of the radii of each pair, m, (q,)."""
        radius = np.array([c.radius for c in self.capsules])
        return np.asarray(radius[self.pairs].sum(axis=-1))

    def words(self, pair: int) -> str:
        """The two parts of a pair."""
        first, second = (self.capsules[i].name for i in self.pairs[pair])
        return f"{first} and {second}"

    def gaps(self, placement: Placement) -> Array:
        """Distance between the surfaces of each pair, m, negative where they overlap, (..., q)."""
        ends = placement.positions[..., self._nodes, :]
        found = np.empty((*placement.batch, len(self.pairs)))
        # pair by pair: all pairs of a large batch at once would not fit
        for q, (i, k) in enumerate(self.pairs):
            found[..., q] = segment_distances(ends[..., i, :, :], ends[..., k, :, :])
        return found - self.reach

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
        gaps = self.gaps(home)
        if gaps.size and gaps.min() < 0.0:
            worst = int(gaps.argmin())
            raise ModelError(
                self.words(worst),
                f"interfere at home: they overlap by {-1e3 * gaps[worst]:.3g} mm.",
                "Give a smaller radius, correct the nodes, or join the bodies by a joint.",
            )
        return self


def segment_distances(first: Array, second: Array) -> Array:
    """Distances between segments.

    The squared distance is a convex function of the two places: it is least inside both, or at
    the end of one of them (Ericson 2005, Real-Time Collision Detection, section 5.1.9).

    Parameters
    ----------
    first, second : (..., 2, 3)
        Ends, m.

    Returns
    -------
    distance : (...)
        m.
    """
    a, b = first[..., 0, :], second[..., 0, :]
    u, v = first[..., 1, :] - a, second[..., 1, :] - b
    found = np.minimum(
        np.minimum(_to_point(a, b, v), _to_point(a + u, b, v)),
        np.minimum(_to_point(b, a, u), _to_point(b + v, a, u)),
    )
    uu, vv, uv = (u * u).sum(axis=-1), (v * v).sum(axis=-1), (u * v).sum(axis=-1)
    across = uu * vv - uv**2
    skew = across > FLAT**0.5 * uu * vv
    safe = np.where(skew, across, 1.0)
    apart = a - b
    au, av = (apart * u).sum(axis=-1), (apart * v).sum(axis=-1)
    s, t = (uv * av - vv * au) / safe, (uu * av - uv * au) / safe
    inside = skew & (s > 0.0) & (s < 1.0) & (t > 0.0) & (t < 1.0)
    between = np.linalg.norm(apart + s[..., None] * u - t[..., None] * v, axis=-1)
    return np.asarray(np.where(inside, np.minimum(between, found), found))


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


def _to_point(point: Array, start: Array, along: Array) -> Array:
    """Distance of points from segments, (...)."""
    squared = (along * along).sum(axis=-1)
    share = ((point - start) * along).sum(axis=-1) / np.where(squared > 0.0, squared, 1.0)
    share = np.clip(share, 0.0, 1.0)
    return np.asarray(np.linalg.norm(point - start - share[..., None] * along, axis=-1))


def _joined(linkage: Linkage, solid: set[int]) -> set[frozenset[int]]:
    """Pairs of bodies that a joint joins, or a body without a capsule that has two joints."""
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
