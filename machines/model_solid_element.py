"""A solid of a model file as an element: a superelement where the file places it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa import Material, PlacedStructure
from strutwork.msa.structure import rigid_map

if TYPE_CHECKING:
    from strutwork.fea.solid_source import SolidSource
    from strutwork.fea.superelement import Superelement

Array = NDArray[Any]

#: Neighbouring triangles that turn by more make an edge of the outline, as a cosine.
EDGE = 0.8


@dataclass(frozen=True, eq=False, repr=False)
class SolidElement:
    """A reduced solid at the one placement that a model file gives it.

    Parameters
    ----------
    reduced : Superelement
        In the mesh's frame.
    rotation : (3, 3)
        Axes of the mesh's frame as columns.
    translation : (3,)
        Its origin, m.
    tied : tuple of str
        The nodes of the file; the others are monitors.
    materials : tuple of str
    loss_factor : float or None
        Structural loss factor of the material, no unit.
    surface : (p,) int
        Field nodes on the outer surface.
    points : (p, 3)
        Where they are, global axes, m.
    triangles : (t, 3) int
        The outer surface, of `points`, counter-clockwise from outside.
    made_of : tuple of Material
        Those of `materials`, in their order.
    cells : int
        Of the mesh.
    order : int
        Of its shape functions, 1 or 2; 0 where nobody says.
    source : SolidSource or None
        What `reduced` was made of.
    """

    reduced: Superelement
    rotation: Array
    translation: Array
    tied: tuple[str, ...]
    materials: tuple[str, ...]
    loss_factor: float | None
    surface: NDArray[np.int64]
    points: Array
    triangles: NDArray[np.int64]
    made_of: tuple[Material, ...] = ()
    cells: int = 0
    order: int = 0
    source: SolidSource | None = None

    def __repr__(self) -> str:
        return f"<SolidElement {self.name}: {len(self.tied)} interfaces, {self.reduced!r}>"

    @property
    def name(self) -> str:
        """Of the solid."""
        return self.reduced.name

    @property
    def nodes(self) -> tuple[str, ...]:
        """Interface nodes, then monitors NAME/1, NAME/2 and so on."""
        return self.reduced.nodes

    @property
    def monitors(self) -> tuple[str, ...]:
        """Nodes that stand for what the solid does inside."""
        return tuple(n for n in self.nodes if n not in self.tied)

    @property
    def cutoff(self) -> float:
        """Highest retained frequency with the interfaces held, Hz."""
        return self.reduced.cutoff

    @property
    def accurate_to(self) -> float:
        """Frequency below which answers hold to 1e-4, Hz, as of the superelement."""
        return self.reduced.accurate_to

    @property
    def mesh_size(self) -> float:
        """Median length of the edges on the mesh's surface, m."""
        corners = self.points[self.triangles]
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
        return float(np.median(edges))

    @cached_property
    def weighed(self) -> tuple[float, Array]:
        """Mass, kg, and its centre (3,), global axes, m."""
        carry = rigid_map(self.positions).reshape(-1, 6)
        whole = carry.T @ self._mass @ carry
        mass = float(whole[0, 0])
        return mass, np.array([-whole[4, 2], -whole[5, 0], -whole[3, 1]]) / mass

    @property
    def positions(self) -> Array:
        """Of the nodes, (k, 3), global axes, m."""
        return np.asarray(self.reduced.positions @ self.rotation.T + self.translation)

    def scaled(self, factor: float) -> SolidElement:
        """The same solid of the same material in another size, from the same origin.

        Parameters
        ----------
        factor : float
            No unit, positive.
        """
        return replace(
            self,
            reduced=self.reduced.scaled(factor),
            translation=factor * self.translation,
            points=factor * self.points,
            source=None if self.source is None else self.source.scaled(factor),
        )

    def stiffness(self, at: PlacedStructure) -> Array:
        """Stiffness in global axes, (..., 6k, 6k), N/m, N, N·m/rad.

        Parameters
        ----------
        at : PlacedStructure
            The structure in which it stands.
        """
        return self._turned(self._stiffness, at)

    def mass(self, at: PlacedStructure) -> Array:
        """Mass in global axes, (..., 6k, 6k), kg, kg·m, kg·m².

        Parameters
        ----------
        at : PlacedStructure
            The structure in which it stands.
        """
        return self._turned(self._mass, at)

    def points_at(self, placed: PlacedStructure) -> Array:
        """`points` where the solid's body stands in a placement, (p, 3), m.

        Parameters
        ----------
        placed : PlacedStructure
            At one pose.
        """
        first = placed.structure.mesh_index[self.nodes[0]]
        turn = np.asarray(placed.turn_of(self.nodes[0]))
        arms = self.points - self.positions[0]
        return np.asarray(placed.positions[first] + arms @ turn.T)

    def motion(self, nodes: Array, placed: PlacedStructure) -> Array:
        """Displacements of the surface's points, global axes.

        Parameters
        ----------
        nodes : (..., k, 6)
            Displacements and rotations of `self.nodes`, global axes, m and rad.
        placed : PlacedStructure
            One pose.

        Returns
        -------
        displacements : (..., p, 3)
            m.
        """
        axes = np.asarray(placed.turn_of(self.nodes[0])) @ self.rotation
        local = (np.asarray(nodes).reshape(*nodes.shape[:-2], -1, 3) @ axes).reshape(
            *nodes.shape[:-2], -1
        )
        return np.asarray(np.einsum("pcn,...n->...pc", self._surface_shapes, local) @ axes.T)

    @cached_property
    def outline(self) -> NDArray[np.int64]:
        """Pairs of `points` between which the surface has an edge, (e, 2); all where it has none.

        A closed surface has every edge twice.
        """
        corners = self.points[self.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        pairs = np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=-1)
        edges = np.sort(pairs.reshape(-1, 2), axis=1)
        owner = np.repeat(np.arange(len(self.triangles)), 3)
        order = np.lexsort(edges.T)
        first, second = order[::2], order[1::2]
        turned = np.einsum("ij,ij->i", normals[owner[first]], normals[owner[second]]) < EDGE
        return np.asarray(edges[first[turned]] if turned.any() else edges[first])

    @cached_property
    def _turn(self) -> Array:
        return np.kron(np.eye(2 * len(self.nodes)), self.rotation)

    @cached_property
    def _stiffness(self) -> Array:
        return np.asarray(self._turn @ self.reduced.local_stiffness @ self._turn.T)

    @cached_property
    def _mass(self) -> Array:
        return np.asarray(self._turn @ self.reduced.local_mass @ self._turn.T)

    @cached_property
    def _surface_shapes(self) -> Array:
        shapes = self.reduced.shapes
        return np.asarray(shapes.reshape(-1, 3, shapes.shape[1])[self.surface])

    def _turned(self, matrix: Array, at: PlacedStructure) -> Array:
        turn = at.turn_of(self.nodes[0])
        if at.placement.turns is not None:
            blocks = matrix.reshape(2 * len(self.nodes), 3, 2 * len(self.nodes), 3)
            turned = np.einsum("...ik,akbl,...jl->...aibj", turn, blocks, turn, optimize=True)
            matrix = turned.reshape(*turn.shape[:-2], *matrix.shape)
        return np.broadcast_to(matrix, (*at.batch, *matrix.shape[-2:]))
