"""Models of one machine by name: `eclipse-3pprs:calibrated`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import radians
from types import MappingProxyType
from typing import cast, get_args

from strutwork.errors import ModelError
from strutwork.machines.azulay_dynamic import DYNAMIC_SETS, DynamicSet, dynamic_machine
from strutwork.machines.biglide import Biglide
from strutwork.machines.biglide_third_leg import BiglideThirdLeg
from strutwork.machines.catalogue import CATALOGUE, CatalogueEntry, Machine, get
from strutwork.machines.eclipse_prototype import EclipsePrototype
from strutwork.machines.serial_five_axis import SerialFiveAxis
from strutwork.machines.three_legs import ThreeLegs

#: Between a machine's name and its variant's.
MARK = ":"

#: Drives of the machines whose hinges may be driven as well.
_EXTRA_DRIVES: Mapping[str, str] = MappingProxyType(
    {
        "6": "carriages and columns are driven",
        "7a": "the hinge of leg 1 is driven as well",
        "7b": "the hinge of leg 2 is driven as well",
        "8": "the hinges of legs 1 and 2 are driven as well",
    }
)

#: Heads of the serial machine.
_HEADS: Mapping[str, str] = MappingProxyType(
    {
        "ac": "rotary axes C, then A: the vertical type, singular with the tool upright",
        "ab": "rotary axes A, then B: the horizontal type, singular at b = ±90°",
    }
)


@dataclass(frozen=True)
class Variant:
    """One model of a machine.

    Parameters
    ----------
    name : str
    description : str
        What sets it apart from the others.
    factory : callable
        Makes the machine.
    around_home : mapping of direction to (float, int), optional
        As its entry's, where it moves in other directions.
    report : str
        As its entry's, where this model has a report of its own; empty where it is shown beside
        the others.
    """

    name: str
    description: str
    factory: Callable[[], Machine]
    around_home: Mapping[str, tuple[float, int]] | None = None
    report: str = ""


@dataclass(frozen=True)
class NamedMachine:
    """A machine as it was named.

    Parameters
    ----------
    entry : CatalogueEntry
    variant : Variant
    machine : Machine
    """

    entry: CatalogueEntry
    variant: Variant
    machine: Machine

    @property
    def name(self) -> str:
        """As it is typed, with the variant where there are several."""
        several = len(variants(self.entry.name)) > 1
        return f"{self.entry.name}{MARK}{self.variant.name}" if several else self.entry.name

    @property
    def stem(self) -> str:
        """For names of files."""
        return self.name.replace(MARK, "-")

    @property
    def title(self) -> str:
        """What it is, in words."""
        several = len(variants(self.entry.name)) > 1
        return (
            f"{self.entry.title}; {self.variant.name}: {self.variant.description}"
            if several
            else self.entry.title
        )

    @property
    def around_home(self) -> Mapping[str, tuple[float, int]]:
        """What its maps and report look over."""
        own = self.variant.around_home
        return self.entry.around_home if own is None else own


def variants(name: str) -> Mapping[str, Variant]:
    """The models of a machine of the catalogue by their names, its own first.

    Raises
    ------
    ModelError
        An unknown machine.
    """
    entry = get(name)
    made = entry.factory()
    if isinstance(made, EclipsePrototype):
        return MappingProxyType(
            {
                which: Variant(which, words, partial(entry.factory, drives=which))
                for which, words in _EXTRA_DRIVES.items()
            }
        )
    if isinstance(made, Biglide):
        return _biglides(entry)
    if isinstance(made, SerialFiveAxis):
        return MappingProxyType(
            {
                which: Variant(which, words, partial(entry.factory, axes=which))
                for which, words in _HEADS.items()
            }
        )
    if not isinstance(made, ThreeLegs):
        return MappingProxyType({"own": Variant("own", "its only model", entry.factory)})
    legs: ThreeLegs = made
    found = [
        Variant("static", "true spherical joints, drives with their stiffness", entry.factory),
        Variant(
            "apparent",
            "links clamped in the platform, carriages that do not turn: as the paper's static "
            "tables suggest",
            lambda: cast(Machine, legs.apparent()),
        ),
    ]
    found += [
        Variant(which, DYNAMIC_SETS[which], _dynamic(name, which)) for which in get_args(DynamicSet)
    ]
    return MappingProxyType({v.name: v for v in found})


def _biglides(entry: CatalogueEntry) -> Mapping[str, Variant]:
    turning = {"x": (0.4, 5), "y": (0.4, 5), "ry": (radians(60.0), 5)}
    found = (
        Variant("plane", "two drives, the tool does not turn", entry.factory),
        Variant(
            "third-leg",
            "a third drive across the plane turns the tool",
            BiglideThirdLeg,
            MappingProxyType(turning),
            entry.report,
        ),
    )
    return MappingProxyType({v.name: v for v in found})


def _dynamic(name: str, which: DynamicSet) -> Callable[[], Machine]:
    return lambda: cast(Machine, dynamic_machine(name, which))


def is_machine(text: str) -> bool:
    """Whether a name stands for a machine of the catalogue, with or without a variant."""
    return text.partition(MARK)[0] in CATALOGUE


def named_machine(text: str) -> NamedMachine:
    """The machine that `NAME` or `NAME:VARIANT` stands for; without a variant the first.

    Raises
    ------
    ModelError
        An unknown machine or variant; the message lists them.
    """
    name, mark, which = text.partition(MARK)
    entry = get(name)
    known = variants(name)
    if mark and which not in known:
        raise ModelError(
            f"machine {name}",
            f'has no variant "{which}".',
            "Variants: " + ", ".join(f"{name}{MARK}{v}" for v in known) + ".",
        )
    variant = known[which] if mark else next(iter(known.values()))
    return NamedMachine(entry, variant, variant.factory())


def require_mass(found: NamedMachine) -> NamedMachine:
    """Return the machine itself if its structure can vibrate.

    Raises
    ------
    ModelError
        Its platform has no mass; names the variants that have.
    """
    heavy = heavy_variants(found)
    if not heavy:
        return found
    raise ModelError(
        f"machine {found.name}",
        "is a model for statics: its platform has no mass, so it cannot be asked how it vibrates.",
        "Name a model that can: " + ", ".join(heavy) + ".",
    )


def heavy_variants(found: NamedMachine) -> tuple[str, ...]:
    """Names of the models to ask how a machine vibrates; none where it can be asked itself."""
    if found.machine.structure.masses or found.variant.name == "own":
        return ()
    name = found.entry.name
    return tuple(f"{name}{MARK}{v}" for v in variants(name) if v in DYNAMIC_SETS)
