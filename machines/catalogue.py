"""The machines by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import radians
from types import MappingProxyType
from typing import Protocol

from strutwork.errors import ModelError
from strutwork.kinematics import Mechanism
from strutwork.machines.alizade_3prps import Alizade3PRPS
from strutwork.machines.azulay_dynamic import models_for_statics_and_vibration
from strutwork.machines.biglide import Biglide
from strutwork.machines.biglide_third_leg import models_by_legs
from strutwork.machines.eclipse_3pprs import Eclipse3PPRS
from strutwork.machines.eclipse_machine import EclipseMachine
from strutwork.machines.eclipse_prototype import EclipsePrototype, models_by_drives
from strutwork.machines.glozman_3prrs import Glozman3PRRS
from strutwork.machines.gough_platform import GoughPlatform
from strutwork.machines.hexel_hexapod import HexelHexapod
from strutwork.machines.limits import Limit
from strutwork.machines.linear_delta import LinearDelta
from strutwork.machines.literature import (
    AZULAY_2014,
    CHABLAT_2003,
    CORBEL_2008,
    KIM_2001,
    SON_2002,
    Paper,
)
from strutwork.machines.mit_ss1 import MitSS1
from strutwork.machines.moving_bridge import MovingBridge
from strutwork.machines.proposed_3pprs import Proposed3PPRS, models_with_two_tubes
from strutwork.machines.prototype_3ppprs import Prototype3PPPRS
from strutwork.machines.serial_five_axis import SerialFiveAxis, models_by_head
from strutwork.machines.variant import Variant
from strutwork.msa.structure import Structure


class Machine(Mechanism, Protocol):
    """A mechanism with its flexibility and the ranges of its joints."""

    @property
    def structure(self) -> Structure:
        """The linkage with its flexible links."""

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges."""


@dataclass(frozen=True)
class CatalogueEntry:
    """A machine from the literature.

    Its report, tolerances and scale are references to `papers`, see
    `strutwork.machines.paper_reference.resolve`.

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
    report : str
        What writes its report: given its name and a callable for the progress, returns title,
        subtitle and chapters.
    tolerances : str
        What makes its `strutwork.studies.TolerancedMachine`; empty where nobody has stated
        tolerances.
    scale : str
        What `strutwork scale` runs; empty where no study of its size exists.
    around_home : mapping of direction to (float, int)
        What its maps and report look over, where nothing else is asked: so far to either side of
        home, m or rad, in so many points. Our choice, not its paper's.
    process : str
        The cut whose stability its report states, of `strutwork.machines.process_file`; empty for
        none. Assumed, not its paper's.
    errors : str
        Causes of errors from which its report has an error sheet, of `strutwork.machines.data`;
        empty for none. Assumed, not its paper's.
    models : tuple of Variant
        Its models, the first that of `factory`; empty of one that has no other.
    """

    name: str
    title: str
    topology: str
    paper: Paper
    factory: Callable[..., Machine]
    report: str
    tolerances: str = ""
    scale: str = ""
    around_home: Mapping[str, tuple[float, int]] = field(default_factory=dict)
    process: str = ""
    errors: str = ""
    models: tuple[Variant, ...] = ()


#: What compares a machine with the four of one paper.
_COMPARED = "strutwork.papers.azulay_2014.machine_page:machine_chapters"

#: Upright poses about home: within the ring on which these machines are singular.
_UPRIGHT: Mapping[str, tuple[float, int]] = {"x": (0.02, 5), "y": (0.02, 5), "z": (0.01, 3)}

#: What compares the two machines of one document with it.
_CORBEL = "strutwork.papers.corbel_2008.pages:machine_chapters"

#: Their cube of 300 mm.
_CUBE: Mapping[str, tuple[float, int]] = {"x": (0.15, 7), "y": (0.15, 7), "z": (0.15, 3)}

_CHABLAT = "strutwork.papers.chablat_2003.pages:machine_chapters"

_ENTRIES = (
    CatalogueEntry(
        "proposed-3pprs",
        "Proposed 3xPPRS",
        "[P circular] [P radial] R S",
        AZULAY_2014,
        Proposed3PPRS,
        _COMPARED,
        around_home=_UPRIGHT,
        models=(
            *models_for_statics_and_vibration("proposed-3pprs", Proposed3PPRS),
            *models_with_two_tubes(),
        ),
    ),
    CatalogueEntry(
        "eclipse-3pprs",
        "Eclipse, three legs and six drives",
        "[P circular] [P vertical] R S",
        AZULAY_2014,
        Eclipse3PPRS,
        _COMPARED,
        around_home=_UPRIGHT,
        process="process-end-mill",
        errors="errors-eclipse",
        models=models_for_statics_and_vibration("eclipse-3pprs", Eclipse3PPRS),
    ),
    CatalogueEntry(
        "alizade-3prps",
        "Alizade",
        "[P circular] R [P along the link] S",
        AZULAY_2014,
        Alizade3PRPS,
        _COMPARED,
        around_home=_UPRIGHT,
        models=models_for_statics_and_vibration("alizade-3prps", Alizade3PRPS),
    ),
    CatalogueEntry(
        "glozman-3prrs",
        "Glozman",
        "[P circular] [R] R S",
        AZULAY_2014,
        Glozman3PRRS,
        _COMPARED,
        around_home=_UPRIGHT,
        models=models_for_statics_and_vibration("glozman-3prrs", Glozman3PRRS),
    ),
    CatalogueEntry(
        "prototype-3ppprs",
        "Prototype 3xPPPRS, redundant and reconfigurable",
        "[P curvilinear] [P tangential] [P radial] R S",
        AZULAY_2014,
        Prototype3PPPRS,
        "strutwork.papers.azulay_2014.prototype_page:prototype_chapters",
        around_home=_UPRIGHT,
        models=models_for_statics_and_vibration("prototype-3ppprs", Prototype3PPPRS),
    ),
    CatalogueEntry(
        "mit-ss1",
        "MIT-SS-1",
        "planar, [P vertical] R R",
        SON_2002,
        MitSS1,
        "strutwork.papers.son_2002.mit_ss1_page:mit_ss1_chapters",
        "strutwork.papers.son_2002.toleranced:mit_ss1",
        "strutwork.papers.son_2002.scale_command:run",
        {"x": (0.1, 9), "ry": (radians(20.0), 9)},
        "process-end-mill",
        "errors-mit-ss1",
    ),
    CatalogueEntry(
        "hexel-hexapod",
        "Hexel hexapod",
        "U [P along the leg] S",
        SON_2002,
        HexelHexapod,
        "strutwork.papers.son_2002.hexapod_page:hexapod_chapters",
        around_home={"x": (0.15, 7), "y": (0.15, 7), "z": (0.1, 3)},
    ),
    CatalogueEntry(
        "moving-bridge",
        "Moving bridge with the planar machine of the MIT-SS-1, four axes",
        "[P] of the bridge, below it planar, [P vertical] R R",
        SON_2002,
        MovingBridge,
        "strutwork.papers.son_2002.serial_page:bridge_chapters",
        around_home={"x": (0.1, 9), "y": (0.5, 3), "ry": (radians(20.0), 9)},
    ),
    CatalogueEntry(
        "serial-five-axis",
        "Serial five-axis machine",
        "[P] [P] [P] and a head [R] [R], with its spindle [R]",
        SON_2002,
        SerialFiveAxis,
        "strutwork.papers.son_2002.serial_page:serial_chapters",
        around_home={"x": (0.1, 5), "y": (0.1, 5), "rx": (radians(20.0), 5)},
        models=models_by_head(),
    ),
    CatalogueEntry(
        "eclipse-prototype",
        "Eclipse prototype, one leg from below",
        "[P circular] [P vertical] R S, hinges driven or not",
        KIM_2001,
        EclipsePrototype,
        "strutwork.papers.kim_2001.pages:machine_chapters",
        around_home=_UPRIGHT,
        process="process-end-mill",
        errors="errors-eclipse",
        models=models_by_drives(EclipsePrototype),
    ),
    CatalogueEntry(
        "eclipse-machine",
        "Eclipse machine, all columns up",
        "[P circular] [P vertical] R S, hinges driven or not",
        KIM_2001,
        EclipseMachine,
        "strutwork.papers.kim_2001.pages:machine_chapters",
        around_home={"x": (0.1, 5), "y": (0.1, 5), "z": (0.05, 3)},
        process="process-face-mill",
        errors="errors-eclipse-large",
        models=models_by_drives(EclipseMachine),
    ),
    CatalogueEntry(
        "linear-delta",
        "Linear Delta",
        "[P along the rail] (U S)₂",
        CORBEL_2008,
        LinearDelta,
        _CORBEL,
        around_home=_CUBE,
    ),
    CatalogueEntry(
        "gough-platform",
        "Gough measuring platform",
        "U [P along the leg, measured] S",
        CORBEL_2008,
        GoughPlatform,
        _CORBEL,
        around_home=_CUBE,
    ),
    CatalogueEntry(
        "biglide",
        "Biglide, two legs in a plane",
        "planar, [P] parallelogram",
        CHABLAT_2003,
        Biglide,
        _CHABLAT,
        around_home={"x": (0.5, 11), "y": (0.5, 11)},
        models=models_by_legs(_CHABLAT),
    ),
)

#: Every machine by its name.
CATALOGUE: Mapping[str, CatalogueEntry] = MappingProxyType({e.name: e for e in _ENTRIES})


def get(name: str) -> CatalogueEntry:
    """The catalogue's entry for a machine.

    Parameters
    ----------
    name : str

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
