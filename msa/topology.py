"""Topology of a structure: what its assembly needs and no coordinate changes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import State
from strutwork.msa.forest import Forest, spanning_forest
from strutwork.msa.structure import Structure


@dataclass(frozen=True)
class Topology:
    """What a structure's assembly needs and no coordinate changes.

    Parameters
    ----------
    structure : Structure
    """

    structure: Structure

    @cached_property
    def forest(self) -> Forest:
        """Spanning forest of the joints."""
        return spanning_forest(self.structure)

    @cached_property
    def size(self) -> int:
        """Number of unknowns before joints."""
        return 6 * self.structure.vertex_count

    @cached_property
    def locked(self) -> NDArray[np.bool_]:
        """Joint directions that are constraint rows, (j, 6)."""
        return np.asarray(self.structure.linkage.states() == State.LOCKED)

    @cached_property
    def elastic_joints(self) -> tuple[int, ...]:
        """Joints with at least one elastic direction."""
        states = self.structure.linkage.states()
        return tuple(int(j) for j in np.flatnonzero((states == State.ELASTIC).any(axis=1)))
