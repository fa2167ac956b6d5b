"""Models of one machine by name: `eclipse-3pprs:calibrated`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from strutwork.errors import ModelError
from strutwork.machines.azulay_dynamic import DYNAMIC_SETS
from strutwork.machines.catalogue import CATALOGUE, CatalogueEntry, Machine, get
from strutwork.machines.variant import Variant

#: Between a machine's name and its variant's.
MARK = ":"


@dataclass(frozen=True)
class NamedMachine:
    """A machine with the name that selected it.

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
    def report(self) -> str:
        """What writes its document's chapters: its own, or its entry's of the first model.

        Empty for another model, which has what every machine has.
        """
        first = self.variant.name == next(iter(variants(self.entry.name)))
        return self.variant.report or (self.entry.report if first else "")

    @property
    def around_home(self) -> Mapping[str, tuple[float, int]]:
        """What its maps and report look over."""
        own = self.variant.around_home
        return self.entry.around_home if own is None else own


def variants(name: str) -> Mapping[str, Variant]:
    """The models of a machine of the catalogue by their names, its own first.

    Parameters
    ----------
    name : str
        In the catalogue.

    Raises
    ------
    ModelError
        An unknown machine.
    """
    entry = get(name)
    models = entry.models or (Variant("own", "its only model", entry.factory),)
    return MappingProxyType({model.name: model for model in models})


def is_machine(text: str) -> bool:
    """Whether a name denotes a machine of the catalogue, with or without a variant.

    Parameters
    ----------
    text : str
    """
    return text.partition(MARK)[0] in CATALOGUE


def named_machine(text: str) -> NamedMachine:
    """The machine that `NAME` or `NAME:VARIANT` denotes; by default the first variant.

    Parameters
    ----------
    text : str

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

    Parameters
    ----------
    found : NamedMachine

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
        "is a model for statics: its platform has no mass, so its vibration cannot be computed.",
        "Name a model that can: " + ", ".join(heavy) + ".",
    )


def heavy_variants(found: NamedMachine) -> tuple[str, ...]:
    """Names of the models to ask how a machine vibrates; none where it can be asked itself.

    Parameters
    ----------
    found : NamedMachine
    """
    if found.machine.structure.masses or found.variant.name == "own":
        return ()
    name = found.entry.name
    return tuple(f"{name}{MARK}{v}" for v in variants(name) if v in DYNAMIC_SETS)
