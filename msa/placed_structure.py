"""A structure at a batch of poses: where its beams and clusters stand, and their stiffness."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Placement
from strutwork.msa.beam import beam_axes, default_up, local_stiffness, to_global
from strutwork.msa.rigid_map import rigid_map, turned_back
from strutwork.msa.springs import Spring
from strutwork.msa.stiffening import Stiffening
from strutwork.names import choices

if TYPE_CHECKING:
    from strutwork.msa.part_numbers import PartNumbers
    from strutwork.msa.structure import Structure

Array = NDArray[Any]


@dataclass(frozen=True)
class PlacedStructure:
    """A structure at a batch of poses; made by `Structure.at`.

    Parameters
    ----------
    structure : Structure
    placement : Placement
        Positions of the nodes and frames of the joints at every pose.
    stiffening : Stiffening or None
        What a preload adds when it vibrates (`strutwork.fea.preloaded`); statics is linear and does
        without.
    of_many : int
        Poses of the study of which these are a part; its solver is then the study's, however few
        these are.
    """

    structure: Structure
    placement: Placement
    stiffening: Stiffening | None = None
    of_many: int = 0

    def __repr__(self) -> str:
        return f"<PlacedStructure: {self.structure!r}, batch {self.batch}>"

    @property
    def numbers(self) -> PartNumbers:
        """Of the structure's parts; of each pose's own where these are several structures."""
        return self.structure.numbers

    @property
    def alone(self) -> PlacedStructure | None:
        """At the one pose, a batch of one, where all poses are the same; None elsewhere."""
        return None

    @property
    def batch(self) -> tuple[int, ...]:
        """Shape of the batch of poses."""
        return self.placement.batch

    def __getitem__(self, index: Any) -> PlacedStructure:
        added = None if self.stiffening is None else self.stiffening[index]
        return PlacedStructure(self.structure, self.placement[index], added)

    def among(self, poses: int) -> PlacedStructure:
        """The same as a part of a study.

        Parameters
        ----------
        poses : int
            Of the whole study.
        """
        return replace(self, of_many=poses)

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
        """Rotation of a node's body from where its parts are described, (3, 3) or (..., 3, 3).

        Parameters
        ----------
        node : str
            A node of the linkage.
        """
        linkage, turns = self.structure.linkage, self.placement.turns
        body = linkage.body_of_node[linkage.node_index[node]]
        return np.eye(3) if turns is None or body < 0 else np.asarray(turns[..., body, :, :])

    def spring_axes(self, spring: Spring) -> Array:
        """Axes of a spring, (6, 6) or (..., 6, 6): global to ground, else of its first body.

        Parameters
        ----------
        spring : Spring
        """
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
        """`beam_geometry`, (..., b) and (..., b, 3, 3), to more digits than a double has."""
        return self._geometry(*self._ends(self.placement.positions.astype(np.longdouble)))

    @cached_property
    def extended_arms(self) -> Array:
        """`arms` in extended precision, (..., n, 3), m."""
        return self._arms(self.positions.astype(np.longdouble))

    def _orientations(self, shape: tuple[int, ...]) -> Array:
        """What the beams say of their x-z planes, (..., b, 3); NaN where nothing."""
        up = np.full(shape, np.nan)
        for i, beam in enumerate(self.structure.beams):
            if isinstance(beam.orientation, str):
                up[..., i, :] = self.frame(beam.orientation, f"beam {beam.name}")[..., :, 2]
            elif beam.orientation is not None:
                up[..., i, :] = beam.orientation
        return up

    @cached_property
    def beam_upright(self) -> Array:
        """A vector in the local x-z plane of every beam, global axes, (..., b, 3), no unit."""
        _, axes = self.beam_geometry
        up, turns = self._orientations(axes.shape[:-1]), self.beam_turns
        if turns is None:
            return np.where(np.isnan(up), default_up(axes[..., 0, :]), up)
        turns = np.broadcast_to(turns, axes.shape)
        up = np.where(np.isnan(up), default_up(turned_back(turns, axes[..., 0, :])), up)
        joint = np.array([isinstance(b.orientation, str) for b in self.structure.beams])
        return np.where(joint[:, None], up, (turns @ up[..., None])[..., 0])

    def _geometry(self, start: Array, end: Array) -> tuple[Array, Array]:
        s = self.structure
        up = self._orientations(start.shape)
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
        """Axes of a joint as columns, (..., 3, 3).

        Parameters
        ----------
        joint : str
        part : str
            What names the joint, for the error.
        """
        index = self.structure.linkage.joint_index
        if joint not in index:
            known = choices("Joints", joint, index)
            raise ModelError(part, f'names the unknown joint "{joint}".', known)
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
        properties = np.moveaxis(self.numbers.stiffness, -1, 0)
        local = local_stiffness((length / pieces)[..., beam], properties[..., beam])
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
                    "Place its nodes at one point or along its direction, or use a joint.",
                )
