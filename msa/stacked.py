"""Structures of one topology at one placement as a batch: each is a pose of its own.

An optimiser asks a hundred machines that differ in sections, materials, stiffnesses and masses for
the same number. What their placement decides (rank of the rows, independent coordinates, motions
that are free) is computed once; what their numbers decide is computed as one stack of matrices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from strutwork.kinematics import Placement
from strutwork.msa.part_numbers import PartNumbers
from strutwork.msa.placed_structure import PlacedStructure
from strutwork.msa.structure import Structure
from strutwork.msa.variant_of import origin_of

_KEPT = "_singles"

#: Placements of which a structure keeps what they decide, the latest ones.
PLACEMENTS = 2


@dataclass(frozen=True)
class PlacedStack(PlacedStructure):
    """Several structures at one placement, a pose for each; made by `stacked`.

    `structure` is that whose topology they share. Statics of load cases, preload, modes and mass
    take the numbers of each from `numbers`; the compiled kernel, budgets and sensitivities do not.

    Parameters
    ----------
    structure, placement, stiffening
        As `PlacedStructure`, with one batch axis.
    own : PartNumbers
        With an axis of the structures in front.
    single : PlacedStructure
        At the one placement, a batch of one.
    """

    own: PartNumbers = field(kw_only=True)
    single: PlacedStructure = field(kw_only=True)

    @property
    def numbers(self) -> PartNumbers:
        """Of each structure's parts."""
        return self.own

    @property
    def alone(self) -> PlacedStructure:
        """The structure whose topology they share, at their placement."""
        return self.single

    def __getitem__(self, index: Any) -> PlacedStack:
        added = None if self.stiffening is None else self.stiffening[index]
        return PlacedStack(
            self.structure,
            self.placement[index],
            added,
            own=self.own[index],
            single=self.single,
        )


def can_stack(structure: Structure) -> bool:
    """Whether a structure differs from the one whose topology it shares in numbers alone.

    Beams that stand off their nodes otherwise, or turn otherwise about themselves, are placed
    otherwise.

    Parameters
    ----------
    structure : Structure
    """
    origin = origin_of(structure)
    return origin is not None and all(
        one is other or (one.offsets == other.offsets and one.orientation == other.orientation)
        for one, other in zip(structure.beams, origin.beams, strict=True)
    )


def stacked(structures: Sequence[Structure], placement: Placement) -> PlacedStack:
    """Structures of one origin at one placement as one batch.

    Parameters
    ----------
    structures : sequence of p Structure
        All of one origin (`strutwork.msa.variant_of.origin_of`), each of which `can_stack`.
    placement : Placement
        No batch axes.
    """
    origin = origin_of(structures[0]) or structures[0]
    # a frozen dataclass keeps derived data in its __dict__, as functools.cached_property does
    kept = origin.__dict__.get(_KEPT, ())
    single = next((one for place, one in kept if place is placement), None)
    if single is None:
        single = PlacedStructure(origin, placement[None])
        origin.__dict__[_KEPT] = ((placement, single), *kept)[:PLACEMENTS]
    every = placement[None][np.zeros(len(structures), dtype=np.intp)]
    numbers = PartNumbers.stacked([s.numbers for s in structures])
    return PlacedStack(origin, every, own=numbers, single=single)
