"""Numbers of a structure's parts that no pose changes: what a parameter acts on first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS

if TYPE_CHECKING:
    from strutwork.msa.structure import Structure

Array = NDArray[Any]


@dataclass(frozen=True)
class PartNumbers:
    """Closed forms of a structure's sections, materials, joints, springs and masses.

    Of several structures, each array has an axis of these in front.

    Parameters
    ----------
    stiffness : (b, 6)
        `Beam.properties`: N, N·m² and m².
    inertia : (b, 4)
        ρA, ρ(Iy + Iz), ρIy, ρIz, kg/m and kg·m; zero of a material without density.
    loss : (b,)
        Loss factors of the beams' materials, no unit.
    joints : (j, 6, 6)
        Stiffness in joint axes, N/m, N, N·m/rad.
    dashpots : (j, 6)
        N·s/m and N·m·s/rad.
    ratios : (t,)
        Of the coordinates that follow others, in m and rad.
    springs : (k, 6)
        N/m and N·m/rad.
    masses : (m, 13)
        Mass, inertia row by row, offset: kg, kg·m², m.
    """

    stiffness: Array
    inertia: Array
    loss: Array
    joints: Array
    dashpots: Array
    ratios: Array
    springs: Array
    masses: Array

    @classmethod
    def of(cls, structure: Structure) -> PartNumbers:
        """Those of a structure.

        Parameters
        ----------
        structure : Structure
        """
        beams, linkage = structure.beams, structure.linkage
        inertia = []
        for beam in beams:
            s, density = beam.section, beam.material.density or 0.0
            turning = density if beam.mass == "consistent" else 0.0
            y, z = turning * s.second_moment_y, turning * s.second_moment_z
            inertia.append([density * s.area, y + z, y, z])
        masses = [[m.mass, *np.ravel(m.inertia), *m.offset] for m in structure.masses]
        return cls(
            np.array([b.properties for b in beams]).reshape(-1, 6),
            np.array(inertia).reshape(-1, 4),
            np.array([b.material.loss_factor or 0.0 for b in beams]),
            np.array([j.stiffness_matrix for j in linkage.joints]).reshape(-1, 6, 6),
            np.array(
                [[float(j.damping.get(d, 0.0)) for d in DIRECTIONS] for j in linkage.joints]
            ).reshape(-1, 6),
            np.array([tie.ratio for tie in linkage.ties]),
            np.array([s.diagonal for s in structure.springs]).reshape(-1, 6),
            np.array(masses, dtype=float).reshape(-1, 13),
        )

    @classmethod
    def stacked(cls, several: Sequence[PartNumbers]) -> PartNumbers:
        """Those of several structures of one topology, in their order.

        Parameters
        ----------
        several : sequence of PartNumbers
        """
        return cls(*(np.stack([getattr(n, f.name) for n in several]) for f in fields(cls)))

    def __getitem__(self, index: Any) -> PartNumbers:
        return PartNumbers(*(getattr(self, f.name)[index] for f in fields(self)))

    def rate(self, before: PartNumbers, width: float) -> PartNumbers:
        """Change per unit of a parameter since `before`, which stands `width` below.

        Parameters
        ----------
        before : PartNumbers
            Of the same structure.
        width : float
            In the parameter's unit.
        """
        return PartNumbers(
            *((getattr(self, f.name) - getattr(before, f.name)) / width for f in fields(self))
        )


def same_numbers(one: PartNumbers, other: PartNumbers) -> bool:
    """Whether two structures have the same numbers.

    Parameters
    ----------
    one, other : PartNumbers
    """
    return all(np.array_equal(getattr(one, f.name), getattr(other, f.name)) for f in fields(one))
