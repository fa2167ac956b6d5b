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
    published_rows,
    variant,
)
from strutwork.papers.azulay_2014.comparison import machines as published_machines
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.papers.azulay_2014.link_lengths import LINK_LENGTHS, link_lengths
from strutwork.papers.azulay_2014.published import TABLE_2, TABLE_4
from strutwork.papers.published_rows import PublishedRow
from strutwork.studies import Filters, Summary, budget_map, stiffness_map, summary
from strutwork.studies.progress import Teller, silent

#: The joint models in the words of the report, the machine as it is first.
MODEL_NAMES: Mapping[Model, str] = MappingProxyType(
    {"spherical": "true spherical joints", "apparent": "as the paper's numbers suggest"}
)

#: The one machine whose link length the paper varies.
PROPOSED = "proposed-3pprs"

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
    length_maps : mapping of (row of Table 2, model) to Dataset
    rows : mapping of (table key, model) to tuple of PublishedRow
    """

    name: str
    entry: CatalogueEntry
    machines: Mapping[Model, ThreeLegs]
    maps: Mapping[Model, xr.Dataset]
    summaries: Mapping[Model, Summary]
    free: Mapping[Model, Summary]
    budgets: Mapping[Model, xr.Dataset]
    lengths: Mapping[tuple[str, Model], Summary]
    length_maps: Mapping[tuple[str, Model], xr.Dataset]
    rows: Mapping[tuple[str, Model], tuple[PublishedRow, ...]]

    def __repr__(self) -> str:
        return f"<MachineStudy of {self.name}: {len(self.maps)} models>"


def study_machine(name: str, progress: Teller | None = None) -> MachineStudy:
    """Compute everything a machine's report shows.

    Raises
    ------
    ModelError
        An unknown machine.
    """
    entry = get(name)
    machines = {model: variant(name, model) for model in MODEL_NAMES}
    maps, length_maps = {}, {}
    for model, machine in machines.items():
        tell = progress(f"{name}, {MODEL_NAMES[model]}") if progress else silent
        maps[model] = stiffness_map(machine, filters=FILTERS, progress=tell)
        if name != PROPOSED:
            continue
        for length in LINK_LENGTHS:
            row = f"{name} L={length * 1e3:.0f} mm"
            tell = progress(f"{row}, {MODEL_NAMES[model]}") if progress else silent
            same = length == getattr(machine, "link_length", None)
            length_maps[row, model] = (
                maps[model]
                if same
                else link_lengths(machine, (length,), FILTERS, progress=tell)[length]
            )
    summaries = {model: summary(dataset) for model, dataset in maps.items()}
    lengths = {key: summary(dataset) for key, dataset in length_maps.items()}
    rows = {}
    for model in MODEL_NAMES:
        found = {name: summaries[model]} | {r: s for (r, m), s in lengths.items() if m == model}
        for table in (TABLE_2, TABLE_4):
            shared = published_rows(table, found, model)
            if shared:
                rows[table.key, model] = shared
    return MachineStudy(
        name,
        entry,
        machines,
        maps,
        summaries,
        {model: summary(dataset, "free") for model, dataset in maps.items()},
        {model: budget_map(machines[model], maps[model]) for model in MODEL_NAMES},
        lengths,
        length_maps,
        rows,
    )


@dataclass(frozen=True)
class Comparison:
    """The four machines of the paper side by side.

    Parameters
    ----------
    azulay : AzulayComparison
    machines : mapping of (name, model) to ThreeLegs
    budgets : mapping of (name, model) to Dataset
    """

    azulay: AzulayComparison
    machines: Mapping[tuple[str, Model], ThreeLegs]
    budgets: Mapping[tuple[str, Model], xr.Dataset]

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
    return Comparison(azulay, machines, budgets)
