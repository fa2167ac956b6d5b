"""Dimensions of beams that are out of all proportion: mostly millimetres taken for metres."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from strutwork.errors import ProportionWarning
from strutwork.msa.sections import Section

if TYPE_CHECKING:
    from strutwork.msa.structure import PlacedStructure

#: A section deeper than so many sizes of the whole structure belongs to none. Against its own beam
#: it may be deeper: a stub in a machine has no length to speak of.
DEEPEST = 5.0
#: A beam longer than so many depths of its section is no beam; wires reach two thousand.
LONGEST = 5000.0
#: No machine is as large as this, m.
LARGEST = 1000.0
_LISTED = 3


def warn_of_proportions(placed: PlacedStructure) -> None:
    """Warn of beams and sections that do not fit one another, once for a structure.

    Judged at the first pose by the depth of a section beside the size of the structure and the
    length of its beam; only the size of the whole is absolute.

    Parameters
    ----------
    placed : PlacedStructure

    Warns
    -----
    ProportionWarning
        Names the beams with their sections.
    """
    structure = placed.structure
    # a frozen dataclass keeps what it has derived in its __dict__, as cached_property does
    if structure.__dict__.get("_proportions_seen") or not placed.placement.reachable.size:
        return
    structure.__dict__["_proportions_seen"] = True
    first = placed[(0,) * len(placed.batch)] if placed.batch else placed
    found = []
    points = first.placement.positions.real
    size = float(np.ptp(points, axis=0).max(initial=0.0)) if len(points) else 0.0
    if size > LARGEST:
        found.append(f"its nodes are up to {size:.4g} m apart")
    if structure.beams:
        start, end = first.beam_ends
        lengths = np.linalg.norm(np.real(end - start), axis=-1)
        size = max(size, float(lengths.max()))
        for beam, length in zip(structure.beams, lengths, strict=True):
            depth = _depth(beam.section)
            if depth > DEEPEST * size or length > LONGEST * depth:
                found.append(
                    f'beam {beam.name} is {length:.4g} m long, and its section "'
                    f'{beam.section.name}" {depth:.4g} m deep'
                )
    if found:
        more = f"; and {len(found) - _LISTED} more" if len(found) > _LISTED else ""
        warnings.warn(
            f"dimensions are out of proportion: {'; '.join(found[:_LISTED])}{more}. Lengths are "
            "in metres: write 0.019 for 19 mm.",
            ProportionWarning,
            stacklevel=3,
        )


def _depth(section: Section) -> float:
    """Largest outer size, m; of a section given by its properties, that of a rectangle like it."""
    if section.outline:
        return float(max(section.outline))
    largest = max(section.second_moment_y, section.second_moment_z)
    return float(np.sqrt(12.0 * largest / section.area))
