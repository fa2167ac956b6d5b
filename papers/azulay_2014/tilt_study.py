"""Tilts, joint ranges and singular poses of the four machines, and tilts as Fig. 3 varies them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from types import MappingProxyType

import numpy as np

from strutwork.machines import Proposed3PPRS
from strutwork.papers.azulay_2014.comparison import machines, variant
from strutwork.papers.azulay_2014.link_lengths import LINK_LENGTHS
from strutwork.papers.azulay_2014.singular_types import SingularTilts, singular_tilts
from strutwork.papers.azulay_2014.tilts import TiltPlane, Tilts, tilt_plane, tilts

#: Radii of the hemisphere, m: Fig. 3 varies it, its axis is not legible.
RADII = np.array([1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0]) * 1e-3


@dataclass(frozen=True)
class TiltStudy:
    """What stands beside Table 3's tilt angles and Figs 3 and 4.

    Parameters
    ----------
    planes : mapping of machine to TiltPlane
    singular : mapping of machine to SingularTilts
        Both on the 4 mm hemisphere.
    by_radius : mapping of link length, m, to tuple of Tilts
        Of the proposed machine, along `RADII`.
    """

    planes: Mapping[str, TiltPlane]
    singular: Mapping[str, SingularTilts]
    by_radius: Mapping[float, tuple[Tilts, ...]]

    def __repr__(self) -> str:
        return f"<TiltStudy of {', '.join(self.planes)}>"


@cache
def tilt_study() -> TiltStudy:
    """All of it, with true spherical joints; found once."""
    some = {name: variant(name, "spherical") for name in machines()}
    proposed = Proposed3PPRS()
    by_radius = {
        length: tuple(tilts(replace(proposed, link_length=length), float(r)) for r in RADII)
        for length in LINK_LENGTHS
    }
    return TiltStudy(
        MappingProxyType({name: tilt_plane(machine) for name, machine in some.items()}),
        MappingProxyType({name: singular_tilts(machine) for name, machine in some.items()}),
        MappingProxyType(by_radius),
    )
