"""Solids: a mesh with a material for each region and an order of the field."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.connectivity import check_connectivity
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.quality import check_quality
from strutwork.msa.materials import Material

Array = NDArray[Any]
#: Cells with straight edges, and those whose middle nodes bend them.
LINEAR = ("hexahedron", "tetra")
QUADRATIC = ("hexahedron20", "hexahedron27", "tetra10")


@dataclass(frozen=True, repr=False)
class Solid:
    """A three-dimensional linear elastic solid.

    Parameters
    ----------
    mesh : Mesh
        Of one kind of cell. Where it is quadratic, the middle nodes carry the displacements and
        bend the cells: curved faces keep their place, and the solid its volume.
    materials : mapping of str to Material
        The material of each region of the mesh.
    order : int
        1 or 2: linear or quadratic displacements in each cell. Linear cells are too stiff in
        bending and near incompressibility; quadratic ones are the default, and the order of
        quadratic cells.
    name : str
        For messages; by default the mesh's.

    Raises
    ------
    ModelError
        Cells that cannot be used, inverted cells (with their count and the worst place),
        parts without a common node (with the names of their regions), points without a cell,
        regions without a material, a Poisson's ratio of 0.5.
    """

    mesh: Mesh
    materials: Mapping[str, Material]
    order: int = 2
    name: str = field(default="")

    def __post_init__(self) -> None:
        object.__setattr__(self, "materials", MappingProxyType(dict(self.materials)))
        object.__setattr__(self, "name", self.name or self.mesh.name)
        if self.order not in {1, 2}:
            raise ModelError(self._part, f"its order is {self.order!r}.", "Choose 1 or 2.")
        self._check_cells()
        self._check_materials()
        check_connectivity(self.mesh)
        check_quality(self.mesh)

    def __repr__(self) -> str:
        return (
            f"Solid({self.name}: {self.mesh.cell_count} {self.kind} of order {self.order}, "
            f"materials {', '.join(f'{r}: {m.name}' for r, m in self.materials.items())})"
        )

    @property
    def kind(self) -> str:
        """The kind of its cells: one of `LINEAR` or `QUADRATIC`."""
        return self.mesh.blocks[0].kind

    @property
    def keeps_curves(self) -> bool:
        """Whether its cells are quadratic, so that their edges and faces may be curved."""
        return self.kind in QUADRATIC

    @property
    def cells(self) -> NDArray[np.int64]:
        """Nodes of all cells in the order of VTK, blocks one after another, (m, k)."""
        return np.concatenate([b.nodes for b in self.mesh.blocks])

    @property
    def cell_regions(self) -> NDArray[np.int64]:
        """Index of each cell's region in `mesh.regions`, (m,)."""
        return np.concatenate([b.region for b in self.mesh.blocks])

    @property
    def used_regions(self) -> tuple[str, ...]:
        """Names of the regions that have cells."""
        return tuple(self.mesh.regions[i] for i in np.unique(self.cell_regions))

    @property
    def has_density(self) -> bool:
        """Whether every region's material has a density."""
        return all(self.materials[r].density is not None for r in self.used_regions)

    @property
    def _part(self) -> str:
        return f"solid {self.name}"

    def _check_cells(self) -> None:
        kinds = list(dict.fromkeys(b.kind for b in self.mesh.blocks))
        for kind in kinds:
            if kind not in LINEAR + QUADRATIC:
                raise ModelError(
                    self._part,
                    f"its mesh has cells of type {kind!r}.",
                    f"Use {' or '.join(LINEAR + QUADRATIC)}.",
                )
            if kind in QUADRATIC and self.order == 1:
                raise ModelError(
                    self._part,
                    f"its mesh has cells of type {kind!r}, and its order is 1.",
                    "Choose order=2, or keep only their corners with "
                    "`strutwork.meshes.order.linear`, which makes curved edges straight and "
                    "removes volume.",
                )
        if len(kinds) > 1:
            raise ModelError(
                self._part,
                f"its mesh mixes {' and '.join(kinds)}.",
                "Mesh it with one kind of cell.",
            )

    def _check_materials(self) -> None:
        known = ", ".join(repr(r) for r in self.mesh.regions)
        for region in self.used_regions:
            if region not in self.materials:
                raise ModelError(
                    self._part,
                    f"region {region!r} has no material.",
                    f"Name one for each of the regions {known}.",
                )
        for region, material in self.materials.items():
            if region not in self.mesh.regions:
                raise ModelError(
                    self._part, f"has no region {region!r}.", f"Its regions are {known}."
                )
            if not material.poissons_ratio < 0.5 - 1e-9:
                raise ModelError(
                    f"{self._part}, region {region!r}",
                    f"the material {material.name} has a Poisson's ratio of "
                    f"{material.poissons_ratio:.6g}, so it is incompressible.",
                    "Give a Poisson's ratio below 0.5; with 0.49 use order=2.",
                )
