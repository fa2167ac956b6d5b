"""What a report needs to know about a machine of the literature: its studies with both models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import xarray as xr

from strutwork.machines import CatalogueEntry, ThreeLegs, get
from strutwork.papers.azulay_2014.comparison import (
    AzulayComparison,
    Model,
    compare_azulay,
    variant,
)
from strutwork.papers.azulay_2014.comparison import machines as published_machines
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.papers.azulay_2014.regions import Barred, barred
from strutwork.papers.published_rows import PublishedRow
from strutwork.studies import Filters, Summary, budget_map, summary
from strutwork.studies.progress import Teller

#: The joint models in the words of the report, the machine as it is first.
MODEL_NAMES: Mapping[Model, str] = MappingProxyType(
    {"spherical": "true spherical joints", "apparent": "as the paper's numbers suggest"}
)

FILTERS: Filters = AS_IN_AZULAY


@dataclass(frozen=True)
class MachineStudy:
    """A machine's stiffness over the hemisphere, with both joint models.

    Parameters
    ----------
    name : str
        In the catalogue.
    entry : CatalogueEntry
    machines : mapping of model to ThreeLegs
    maps : mapping of model to Dataset
    summaries : mapping of model to Summary
        Other directions blocked.
    free : mapping of model to Summary
        Other directions free to follow.
    budgets : mapping of model to Dataset
    lengths : mapping of (row of Table 2, model) to Summary
        Empty but for the proposed machine.
    rows : mapping of (table key, model) to tuple of PublishedRow
    barred : mapping of model to Barred
        What the singular ring and the machine's own joint ranges leave.
    """

    name: str
    entry: CatalogueEntry
    machines: Mapping[Model, ThreeLegs]
    maps: Mapping[Model, xr.Dataset]
    summaries: Mapping[Model, Summary]
    free: Mapping[Model, Summary]
    budgets: Mapping[Model, xr.Dataset]
    lengths: Mapping[tuple[str, Model], Summary]
    rows: Mapping[tuple[str, Model], tuple[PublishedRow, ...]]
    barred: Mapping[Model, Barred]

    def __repr__(self) -> str:
        return f"<MachineStudy of {self.name}: {len(self.maps)} models>"


def study_machine(name: str, progress: Teller | None = None) -> MachineStudy:
    """Compute everything a machine's report shows.

    Raises
    ------
    ModelError
        An unknown machine.
    """
    machines = {model: variant(name, model) for model in MODEL_NAMES}
    found = compare_azulay(FILTERS, names=(name,), progress=progress)
    maps = {model: found.maps[name, model] for model in MODEL_NAMES}
    return MachineStudy(
        name,
        get(name),
        machines,
        maps,
        {model: found.summaries[name, model] for model in MODEL_NAMES},
        {model: summary(dataset, "free") for model, dataset in maps.items()},
        {model: budget_map(machines[model], maps[model]) for model in MODEL_NAMES},
        {key: one for key, one in found.summaries.items() if key[0] != name},
        found.rows,
        {model: barred(machines[model], maps[model]) for model in MODEL_NAMES},
    )


@dataclass(frozen=True)
class Comparison:
    """The four machines of the paper side by side.

    Parameters
    ----------
    azulay : AzulayComparison
    machines : mapping of (name, model) to ThreeLegs
    budgets : mapping of (name, model) to Dataset
    barred : mapping of (name, model) to Barred
    """

    azulay: AzulayComparison
    machines: Mapping[tuple[str, Model], ThreeLegs]
    budgets: Mapping[tuple[str, Model], xr.Dataset]
    barred: Mapping[tuple[str, Model], Barred]

    def __repr__(self) -> str:
        return f"<Comparison of {', '.join(self.names)}>"

    @property
    def names(self) -> tuple[str, ...]:
        """The machines in the catalogue's order."""
        return tuple(dict.fromkeys(name for name, _ in self.machines))

    def rows(self, table: str) -> dict[Model, tuple[PublishedRow, ...]]:
        """Rows of a published table by joint model."""
        return {model: self.azulay.rows[table, model] for model in MODEL_NAMES}


def study_comparison(progress: Teller | None = None) -> Comparison:
    """Compute everything the comparison of the four machines shows."""
    azulay = compare_azulay(FILTERS, progress=progress)
    machines = {
        (name, model): variant(name, model)
        for name in published_machines()
        for model in MODEL_NAMES
    }
    budgets = {key: budget_map(machine, azulay.maps[key]) for key, machine in machines.items()}
    parted = {key: barred(machine, azulay.maps[key]) for key, machine in machines.items()}
    return Comparison(azulay, machines, budgets, parted)
