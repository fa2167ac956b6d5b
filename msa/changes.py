"""What a parameter changes in a structure: rates of its parts' numbers and places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa.assembly import System, system_of
from strutwork.msa.part_geometry import PartGeometry
from strutwork.msa.part_numbers import PartNumbers
from strutwork.msa.structure import PlacedStructure, Structure

Array = NDArray[Any]


@dataclass(frozen=True)
class Change:
    """A structure a step above and a step below the value of a parameter.

    The parts' numbers are smooth closed forms, so that central differences of them have nearly all
    digits; nothing is solved twice.

    Parameters
    ----------
    name : str
        Of the parameter.
    above, below : Structure
    width : float
        From below to above, in the parameter's unit.

    Raises
    ------
    ModelError
        Structures that are not made of the same parts.
    """

    name: str
    above: Structure
    below: Structure
    width: float

    def __post_init__(self) -> None:
        if _made_of(self.above) != _made_of(self.below):
            raise ModelError(
                f"parameter {self.name}",
                "changes which parts, nodes or free directions the structure has: it has no "
                "derivative.",
                "Name a dimension, a stiffness or a material's number.",
            )

    @cached_property
    def numbers(self) -> PartNumbers:
        """Rates of the parts' numbers, per unit of the parameter."""
        return PartNumbers.of(self.above).rate(PartNumbers.of(self.below), self.width)

    @cached_property
    def elements(self) -> tuple[int, ...]:
        """Elements that are other objects above than below."""
        pairs = zip(self.above.elements, self.below.elements, strict=True)
        return tuple(i for i, (one, other) in enumerate(pairs) if one is not other)


def _made_of(structure: Structure) -> tuple[Any, ...]:
    linkage = structure.linkage
    return (
        structure.mesh_nodes,
        tuple((b.name, b.nodes, b.elements, b.mass) for b in structure.beams),
        tuple((j.name, j.between) for j in linkage.joints),
        tuple(map(tuple, linkage.states().tolist())),
        tuple((s.name, s.nodes) for s in structure.springs),
        tuple(m.node for m in structure.masses),
        tuple((e.name, e.nodes) for e in structure.elements),
    )


@dataclass(frozen=True)
class PlacedChange:
    """A change at a batch of poses.

    Parameters
    ----------
    change : Change
    above, below : PlacedStructure or None
        Both at the poses, where the parameter moves parts; None where it moves none.
    """

    change: Change
    above: PlacedStructure | None = None
    below: PlacedStructure | None = None

    @property
    def name(self) -> str:
        """Of the parameter."""
        return self.change.name

    @cached_property
    def systems(self) -> tuple[System, System] | None:
        """Both as systems; None where no part moves."""
        if self.above is None or self.below is None:
            return None
        return system_of(self.above), system_of(self.below)

    @cached_property
    def geometry(self) -> PartGeometry | None:
        """Rates of the places, per unit of the parameter; None where no part moves."""
        if self.systems is None:
            return None
        above, below = self.systems
        return PartGeometry.of(above).rate(PartGeometry.of(below), self.change.width)


@dataclass(frozen=True)
class Touched:
    """Parts of one kind that parameters change: one entry for every pair of the two.

    Parameters
    ----------
    parameter, part : (k,)
        Indices of both.
    """

    parameter: NDArray[np.intp]
    part: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.part)

    def moved(self, base: Array, rates: Sequence[Array | None], step: float) -> Array:
        """Numbers of the parts, moved by an imaginary step along the parameters, (k, ...).

        Parameters
        ----------
        base : (b, ...)
            Of all parts of the kind, any unit.
        rates : sequence of (b, ...) or None
            Of each parameter, per its unit; None for one that changes none of them.
        step : float
            No unit.
        """
        result = base[self.part].astype(complex)
        for i, rate in enumerate(rates):
            if rate is not None:
                own = self.parameter == i
                result[own] += 1j * step * rate[self.part[own]]
        return result


def touched(rates: Sequence[Sequence[Array | None]], count: int) -> Touched:
    """Pairs of a parameter and a part that it changes.

    Parameters
    ----------
    rates : sequence of sequences of (b, ...) or None
        Of each parameter the rates of the parts' numbers, any unit.
    count : int
        Number of parts b.
    """
    parameter: list[int] = []
    part: list[int] = []
    for i, some in enumerate(rates):
        moves = np.zeros(count, dtype=bool)
        for rate in some:
            if rate is not None:
                moves |= np.any(rate.reshape(count, -1), axis=1) if count else moves
        which = np.flatnonzero(moves).tolist()
        part += which
        parameter += [i] * len(which)
    return Touched(np.array(parameter, dtype=np.intp), np.array(part, dtype=np.intp))
