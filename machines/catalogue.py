"""The machines by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

from strutwork.errors import ModelError
from strutwork.kinematics import Mechanism
from strutwork.machines.alizade_3prps import Alizade3PRPS
from strutwork.machines.eclipse_3pprs import Eclipse3PPRS
from strutwork.machines.glozman_3prrs import Glozman3PRRS
from strutwork.machines.hexel_hexapod import HexelHexapod
from strutwork.machines.limits import Limit
from strutwork.machines.mit_ss1 import MitSS1
from strutwork.machines.proposed_3pprs import Proposed3PPRS
from strutwork.machines.prototype_3ppprs import Prototype3PPPRS
from strutwork.machines.published import Paper
from strutwork.machines.published_azulay import AZULAY_2014
from strutwork.machines.published_son import SON_2002
from strutwork.msa.structure import Structure


class Machine(Mechanism, Protocol):
    """A mechanism with what makes it flexible and with the ranges of its joints."""

    @property
    def structure(self) -> Structure:
        """The linkage with its flexible links."""

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges."""


@dataclass(frozen=True)
class CatalogueEntry:
    """A machine of the literature.

    Parameters
    ----------
    name : str
        As typed on the command line.
    title : str
    topology : str
        Joints of a leg from the ground up; the driven ones in brackets.
    paper : Paper
        Where its dimensions come from.
    factory : callable
        Makes the machine with the paper's dimensions; takes other dimensions by name.
    """

    name: str
    title: str
    topology: str
    paper: Paper
    factory: Callable[..., Machine]


_ENTRIES = (
    CatalogueEntry(
        "proposed-3pprs",
        "Proposed 3xPPRS",
        "[P circular] [P radial] R S",
        AZULAY_2014,
        Proposed3PPRS,
    ),
    CatalogueEntry(
        "eclipse-3pprs",
        "Eclipse, three legs and six drives",
        "[P circular] [P vertical] R S",
        AZULAY_2014,
        Eclipse3PPRS,
    ),
    CatalogueEntry(
        "alizade-3prps", "Alizade", "[P circular] R [P along the link] S", AZULAY_2014, Alizade3PRPS
    ),
    CatalogueEntry("glozman-3prrs", "Glozman", "[P circular] [R] R S", AZULAY_2014, Glozman3PRRS),
    CatalogueEntry(
        "prototype-3ppprs",
        "Prototype 3xPPPRS, redundant and reconfigurable",
        "[P curvilinear] [P tangential] [P radial] R S",
        AZULAY_2014,
        Prototype3PPPRS,
    ),
    CatalogueEntry("mit-ss1", "MIT-SS-1", "planar, [P vertical] R R", SON_2002, MitSS1),
    CatalogueEntry(
        "hexel-hexapod", "Hexel hexapod", "U [P along the leg] S", SON_2002, HexelHexapod
    ),
)

#: Every machine by its name.
CATALOGUE: Mapping[str, CatalogueEntry] = MappingProxyType({e.name: e for e in _ENTRIES})


def get(name: str) -> CatalogueEntry:
    """The catalogue's entry for a machine.

    Raises
    ------
    ModelError
        An unknown name; the message lists the names.
    """
    if name not in CATALOGUE:
        raise ModelError(
            f"machine {name}", "is not in the catalogue.", "Machines: " + ", ".join(CATALOGUE) + "."
        )
    return CATALOGUE[name]
