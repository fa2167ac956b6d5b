"""What the bearings of a structure do under a load case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from strutwork.machines.bearing_entry import BearingEntry
    from strutwork.msa import PlacedStructure, StaticSolution

Array = NDArray[Any]


@dataclass(frozen=True)
class BearingState:
    """A bearing under a load case.

    Parameters
    ----------
    joint : str
    entry : BearingEntry
    displacement : (6,)
        Of the second side against the first, joint axes, m and rad.
    load : (6,)
        That holds it, beyond the preload, N and N·m.
    secant : (6, 6)
        Symmetric stiffness that bears the load at the displacement, N/m, N and N·m.
    tangent : (6, 6)
        Stiffness against further loads, N/m, N and N·m.
    loaded : float
        Share of the balls or rollers that bear, no unit.
    """

    joint: str
    entry: BearingEntry
    displacement: Array
    load: Array
    secant: Array
    tangent: Array
    loaded: float

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI."""
        return {
            "entry": self.entry.name,
            "displacement": self.displacement.tolist(),
            "load": self.load.tolist(),
            "secant": self.secant.tolist(),
            "tangent": self.tangent.tolist(),
            "loaded": self.loaded,
        }


@dataclass(frozen=True)
class Equilibrium:
    """A load case at equilibrium.

    Parameters
    ----------
    solution : StaticSolution
        Of the one case, with the secants; its strain energy is that of the contacts.
    states : tuple of BearingState
        Of the bearings with contacts.
    steps : int
        Solutions that it took.
    secant, tangent : PlacedStructure
        The structure with these stiffnesses.
    """

    solution: StaticSolution
    states: tuple[BearingState, ...]
    steps: int
    secant: PlacedStructure
    tangent: PlacedStructure


def joined(found: Sequence[Equilibrium]) -> StaticSolution:
    """The solutions of several cases as one.

    Parameters
    ----------
    found : sequence of Equilibrium
        At least one.
    """
    parts = [one.solution for one in found]

    def last(name: str) -> Array:
        return np.concatenate([getattr(part, name) for part in parts], axis=-1)

    return replace(
        parts[0],
        cases=tuple(name for part in parts for name in part.cases),
        residual=np.max([part.residual for part in parts], axis=0),
        displacements=last("displacements"),
        joint_forces=last("joint_forces"),
        beam_forces=last("beam_forces"),
        strain_energy=last("strain_energy"),
    )
