"""Any field of temperature in a solid: steady conduction, and its load on a reduced solid.

The load is ∫ Bᵀ D α ΔT dV on the nodes of the mesh, brought to the interfaces by the shapes of
the superelement as any other load. A rigid patch expands with the part of the temperature that is
linear around it: what is left is what it holds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.elastic_terms import Assembler, assembler
from strutwork.fea.factorize import factorize
from strutwork.fea.free_expansion import free_displacements
from strutwork.fea.interface import Interface, TiedPatch, tie
from strutwork.fea.solid import Solid
from strutwork.fea.superelement import Superelement
from strutwork.meshes.mesh import Mesh, Patch
from strutwork.meshes.surface_integrals import nodal_area_products, nodal_areas

Array = NDArray[Any]


@dataclass(frozen=True)
class HeatedSurface:
    """Part of the surface of a solid through which heat flows; the rest is insulated.

    Parameters
    ----------
    patch : str
        Of the mesh.
    change : float or None
        Temperature of the surface, K above that of the unloaded solid.
    film : float or None
        Coefficient of heat transfer to the surroundings, W/(m² K).
    surroundings : float
        Their temperature, K above that of the unloaded solid.
    flux : float
        Into the solid, W/m².
    power : float
        Into the solid, spread evenly, W.

    Raises
    ------
    ModelError
        A number that is not finite, a film coefficient that is not positive, or a temperature
        beside a film or a flow.
    """

    patch: str
    change: float | None = None
    film: float | None = None
    surroundings: float = 0.0
    flux: float = 0.0
    power: float = 0.0

    def __post_init__(self) -> None:
        part = f"heated surface {self.patch}"
        numbers = (self.change or 0.0, self.film or 0.0, self.surroundings, self.flux, self.power)
        if not all(isfinite(v) for v in numbers):
            raise ModelError(part, "has a number that is not finite.", "Give finite numbers.")
        if self.film is not None and not self.film > 0:
            raise ModelError(
                part, f"has the film coefficient {self.film:g}.", "Give a positive one, or none."
            )
        if self.change is not None and (self.film is not None or self.flux or self.power):
            raise ModelError(
                part,
                "has a temperature and a flow of heat, of which the other follows.",
                "Give change alone, or film, flux or power.",
            )


@dataclass(frozen=True, eq=False, repr=False)
class HeatedSolid:
    """A solid assembled for temperatures.

    Parameters
    ----------
    solid : Solid
    interfaces : tuple of Interface
    """

    solid: Solid
    interfaces: tuple[Interface, ...]

    def __repr__(self) -> str:
        return f"<HeatedSolid {self.solid.name}: {len(self.points)} nodes>"

    @cached_property
    def _assembler(self) -> Assembler:
        return assembler(self.solid)

    @cached_property
    def mesh(self) -> Mesh:
        """Of the field, with its patches."""
        return self._assembler.field_mesh()

    @property
    def points(self) -> Array:
        """Nodes of the field, in the mesh's frame, m, (n, 3)."""
        return self.mesh.points

    @cached_property
    def _stiffness(self) -> sp.csc_array:
        return self._assembler.stiffness()

    @cached_property
    def _patches(self) -> tuple[TiedPatch, ...]:
        mesh = self.mesh
        return tuple(
            tie(i, mesh.points, *nodal_areas(mesh, mesh.patch(i.patch))) for i in self.interfaces
        )

    def steady(
        self, conductivities: Mapping[str, float], surfaces: Sequence[HeatedSurface]
    ) -> Array:
        """Temperatures of steady conduction, K above that of the unloaded solid, (n,).

        Parameters
        ----------
        conductivities : mapping of region to float
            W/(m K), positive.
        surfaces : sequence of HeatedSurface
            Where they overlap, a temperature prevails over a flow, and flows add.

        Raises
        ------
        ModelError
            An unknown patch, two temperatures of one node, or no surface that fixes the level.
        """
        part = f"solid {self.solid.name}"
        if all(s.change is None and s.film is None for s in surfaces):
            raise ModelError(
                part,
                "is heated, and nothing fixes its temperature.",
                "Give at least one of its surfaces a temperature (change) or a film coefficient.",
            )
        n = len(self.points)
        matrix = sp.csc_array(self._assembler.conduction(conductivities))
        right, held = np.zeros(n), np.full(n, np.nan)
        for surface in surfaces:
            patch = self.mesh.patch(surface.patch)
            nodes, areas = nodal_areas(self.mesh, patch)
            if surface.change is not None:
                before = held[nodes]
                if np.any(np.abs(before - surface.change) > 0):
                    raise ModelError(
                        f"{part}, surface {surface.patch}",
                        "shares nodes with a surface of another temperature.",
                        "Leave a gap of a cell between them.",
                    )
                held[nodes] = surface.change
                continue
            flow = surface.flux + surface.power / areas.sum()
            flow += (surface.film or 0.0) * surface.surroundings
            right[nodes] += flow * areas
            if surface.film is not None:
                matrix = matrix + _film(self.mesh, patch, surface.film, n)
        free = np.isnan(held)
        found = np.where(free, 0.0, held)
        if free.any():
            right -= matrix @ found
            inner = sp.csc_array(sp.csr_array(matrix)[free][:, free])
            found[free] = factorize(inner).solve(right[free][:, None])[:, 0]
        return found

    def load(
        self, reduced: Superelement, changes: Array, coefficients: Mapping[str, float]
    ) -> Array:
        """Load on the nodes of the reduced solid, mesh's frame, N and N·m, (6 k,).

        Parameters
        ----------
        reduced : Superelement
            Of the solid and the interfaces.
        changes : (n,)
            Change of temperature at the nodes of the field, K.
        coefficients : mapping of region to float
            Of expansion, 1/K.
        """
        loads = self._assembler.expansion(changes, coefficients)
        given = self._patch_expansion(changes, coefficients)
        if np.any(given):
            loads = loads - self._stiffness @ given
        return np.asarray(reduced.shapes.T @ loads)

    def _patch_expansion(self, changes: Array, coefficients: Mapping[str, float]) -> Array:
        """Displacements of rigid patches against their nodes by their own expansion, (3 n,)."""
        given = np.zeros((len(self.points), 3))
        cells = np.concatenate([b.nodes for b in self.mesh.blocks])
        alpha = np.array([coefficients.get(r, 0.0) for r in self.solid.mesh.regions])
        for patch in self._patches:
            if patch.interface.kind != "rigid":
                continue
            near = np.flatnonzero(np.isin(cells, patch.nodes).any(axis=1))
            nodes = cells[near]
            strains = alpha[self.solid.cell_regions[near]][:, None] * changes[nodes]
            arms = self.points[nodes] - patch.position
            terms = np.concatenate([np.ones((nodes.size, 1)), arms.reshape(-1, 3)], axis=1)
            strain, *gradient = np.linalg.lstsq(terms, strains.ravel(), rcond=None)[0]
            given[patch.nodes] = free_displacements(
                self.points[patch.nodes], float(strain), gradient, patch.position
            )
        return given.ravel()


def _film(mesh: Mesh, patch: Patch, film: float, size: int) -> sp.csc_array:
    pairs, areas = nodal_area_products(mesh, patch)
    return sp.csc_array(sp.coo_array((film * areas, (pairs[:, 0], pairs[:, 1])), (size, size)))
