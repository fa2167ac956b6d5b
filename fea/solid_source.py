"""What a superelement was made of, kept so that it can be assembled again: it can be pickled."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea.interface import Interface
from strutwork.fea.solid import Solid
from strutwork.meshes.mesh import CellBlock, Mesh, Patch
from strutwork.msa.materials import Material

Array = NDArray[Any]


@dataclass(frozen=True, eq=False, repr=False)
class SolidSource:
    """A solid and its interfaces.

    Parameters
    ----------
    name : str
    points : (n, 3)
        Of the mesh, m.
    blocks : tuple of CellBlock
    regions : tuple of str
    patches : tuple of (str, Patch)
    materials : tuple of (str, Material)
        By region.
    order : int
        1 or 2.
    interfaces : tuple of Interface
    """

    name: str
    points: Array
    blocks: tuple[CellBlock, ...]
    regions: tuple[str, ...]
    patches: tuple[tuple[str, Patch], ...]
    materials: tuple[tuple[str, Material], ...]
    order: int
    interfaces: tuple[Interface, ...]

    def __repr__(self) -> str:
        return f"<SolidSource {self.name}: {len(self.points)} points>"

    def solid(self) -> Solid:
        """The solid."""
        mesh = Mesh(
            self.points, self.blocks, self.regions, patches=dict(self.patches), name=self.name
        )
        return Solid(mesh, dict(self.materials), self.order, self.name)

    def scaled(self, factor: float) -> SolidSource:
        """The same solid `factor` times as large.

        Parameters
        ----------
        factor : float
            No unit, positive.
        """
        interfaces = tuple(
            i if i.position is None else replace(i, position=_times(factor, i.position))
            for i in self.interfaces
        )
        return replace(self, points=factor * np.asarray(self.points), interfaces=interfaces)


def _times(factor: float, point: tuple[float, float, float]) -> tuple[float, float, float]:
    return (factor * point[0], factor * point[1], factor * point[2])


def solid_source(solid: Solid, interfaces: tuple[Interface, ...]) -> SolidSource:
    """Keep what a solid is made of.

    Parameters
    ----------
    solid : Solid
    interfaces : tuple of Interface
    """
    mesh = solid.mesh
    return SolidSource(
        solid.name,
        mesh.points,
        mesh.blocks,
        mesh.regions,
        tuple(mesh.patches.items()),
        tuple(solid.materials.items()),
        solid.order,
        interfaces,
    )
