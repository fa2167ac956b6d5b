"""Designs (a), (b), (c) of Fig. 39 of Son 2002 as data: which rails share a datum surface.

The figure's dimensions are not published. This is a reading of it of it and of section 6.6: every
datum surface is located within one zone of its own, and every rail lies on its datum within a
smaller one. What a common datum does to all of its rails together, it does not do to one of them
against the other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Poses
from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.mit_ss1 import MitSS1
from strutwork.msa.structure import PlacedStructure, Structure
from strutwork.overconstraint import Tolerance
from strutwork.papers.son_2002.tolerances import RAIL_HEIGHT

#: Zone in which a datum surface lies against the others, m. Our choice: milled and bolted faces.
DATUM_ZONE = 50e-6

#: Length of the rails along z, m. Our choice.
RAIL_LENGTH = 0.400

#: Width of a datum surface beside its rails, m. Our choice.
MARGIN = 0.100


@dataclass(frozen=True)
class Design:
    """Rails by the datum surface on which they lie.

    Parameters
    ----------
    letter : str
        In Fig. 39.
    title : str
    datums : tuple of tuples of int
        Rails of each datum surface.
    """

    letter: str
    title: str
    datums: tuple[tuple[int, ...], ...]


#: The three designs. Which two rails share a datum in (b) is assumed: those of the equal struts.
DESIGNS: Mapping[str, Design] = MappingProxyType(
    {
        d.letter: d
        for d in (
            Design("a", "each rail on a datum of its own", ((1,), (2,), (3,))),
            Design("b", "rails 1 and 2 on one datum, rail 3 on another", ((1, 2), (3,))),
            Design("c", "all rails on one ground surface", ((1, 2, 3),)),
        )
    }
)


def datum(rails: tuple[int, ...]) -> str:
    """Node of the ground in the middle of the datum surface of some rails."""
    return "datum " + " ".join(map(str, rails))


def placed_design(
    design: Design, machine: MitSS1 | None = None, poses: Poses | None = None
) -> PlacedStructure:
    """The machine with a ground node in the middle of each datum surface.

    Parameters
    ----------
    design : Design
    machine : MitSS1, optional
    poses : Poses, optional
        Default: home.

    Raises
    ------
    UnreachableError
        A pose that the machine cannot take.
    """
    machine = machine or MitSS1()
    placement = machine.place(machine.home() if poses is None else poses).require_reachable()
    linkage, structure = machine.linkage, machine.structure
    names = tuple(datum(rails) for rails in design.datums)
    bodies = tuple(
        Body(GROUND, (*b.nodes, *names)) if b.name == GROUND else b for b in linkage.bodies
    )
    home = machine.place(machine.home()).positions
    index = linkage.node_index
    middles = np.array(
        [home[[index[parts.rail(i)] for i in rails]].mean(axis=0) for rails in design.datums]
    )
    grown = replace(linkage, nodes=(*linkage.nodes, *names), bodies=bodies)
    positions = np.concatenate(
        [placement.positions, np.broadcast_to(middles, (*placement.batch, *middles.shape))],
        axis=-2,
    )
    return Structure(grown, beams=structure.beams, rigid=structure.rigid).at(
        replace(placement, positions=positions)
    )


def design_tolerances(
    design: Design,
    machine: MitSS1 | None = None,
    *,
    zone: float = DATUM_ZONE,
    rail_zone: float = RAIL_HEIGHT,
    distribution: str = "uniform",
) -> tuple[Tolerance, ...]:
    """Location of each datum surface, and of each rail on its own.

    A location is a height along y and two tilts, such that the surface's corners stay within
    the zone.

    Parameters
    ----------
    design : Design
    machine : MitSS1, optional
        Whose rails stand where the datum surfaces reach.
    zone, rail_zone : float
        Widths of the zones, m.
    distribution : str

    Raises
    ------
    ModelError
        A design in which a rail has no datum, or two.
    """
    machine = machine or MitSS1()
    if sorted(i for rails in design.datums for i in rails) != list(parts.STRUTS):
        raise ModelError(
            f"design {design.letter}",
            f"has the datums {design.datums}.",
            "Give each of the rails 1, 2 and 3 one datum.",
        )
    found = []
    for rails in design.datums:
        along = machine.rails[[i - 1 for i in rails]]
        found.append(
            _location(datum(rails), rails, datum(rails), zone, float(np.ptp(along)), distribution)
        )
    found += [
        _location(f"rail {i}", (i,), parts.rail(i), rail_zone, 0.0, distribution)
        for i in parts.STRUTS
    ]
    return tuple(found)


def _location(
    name: str, rails: tuple[int, ...], node: str, zone: float, reach: float, distribution: str
) -> Tolerance:
    return Tolerance(
        name,
        "location",
        tuple(parts.guide(i) for i in rails),
        size=zone,
        datum=node,
        axis=(0.0, 1.0, 0.0),
        along=(0.0, 0.0, 1.0),
        length=RAIL_LENGTH,
        width=reach + MARGIN,
        distribution=distribution,
    )
