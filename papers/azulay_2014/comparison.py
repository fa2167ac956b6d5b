"""The four machines of Azulay et al. 2014 side by side, with the published tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Literal

import xarray as xr

from strutwork.errors import ModelError
from strutwork.machines import Machine, Proposed3PPRS, ThreeLegs, get
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.papers.azulay_2014.link_lengths import LINK_LENGTHS
from strutwork.papers.azulay_2014.notes import note_of, status_of
from strutwork.papers.azulay_2014.published import TABLE_2, TABLE_4
from strutwork.papers.published_rows import PublishedRow
from strutwork.papers.published_table import PublishedTable
from strutwork.studies.filters import Filters
from strutwork.studies.progress import Progress, silent
from strutwork.studies.statistics import Summary, summary
from strutwork.studies.stiffness_map import stiffness_map

Model = Literal["spherical", "apparent"]

#: The one machine whose link length the paper varies.
PROPOSED = "proposed-3pprs"

#: The joint models, the machine as it is first.
MODELS: Mapping[Model, str] = MappingProxyType(
    {
        "spherical": "true spherical joints",
        "apparent": "links clamped in the platform, as the paper's numbers suggest",
    }
)

DIRECTIONS = ("x", "y", "z")


@dataclass(frozen=True)
class AzulayComparison:
    """Stiffness maps of the four machines and of three link lengths, beside the paper's tables.

    Parameters
    ----------
    maps : mapping of (row, model) to Dataset
        Rows as in the published tables.
    summaries : mapping of (row, model) to Summary
    rows : mapping of (table key, model) to tuple of PublishedRow
    """

    maps: Mapping[tuple[str, Model], xr.Dataset]
    summaries: Mapping[tuple[str, Model], Summary]
    rows: Mapping[tuple[str, Model], tuple[PublishedRow, ...]]

    def __repr__(self) -> str:
        kept = {key: s.points_kept for key, s in self.summaries.items()}
        return f"<AzulayComparison: {len(kept)} maps, stiffness in N/m>"

    def table(self, key: str) -> tuple[PublishedRow, ...]:
        """Both models' rows of a table, for its file; the model stands in the row's name."""
        return tuple(
            replace(row, row=f"{row.row}, {MODELS[model]}")
            for (table, model), rows in self.rows.items()
            if table == key
            for row in rows
        )

    def ranking(self, direction: str, model: Model) -> tuple[str, ...]:
        """The four machines by mean stiffness along a direction, the stiffest first."""
        return tuple(
            sorted(
                machines(),
                key=lambda row: -self.summaries[row, model].axis(direction).statistics.mean,
            )
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and strings: summaries, rankings and rows, without the maps."""
        present = tuple(dict.fromkeys(model for _, model in self.summaries))
        return {
            "summaries": [
                {"row": row, "model": model, **s.to_dict()}
                for (row, model), s in self.summaries.items()
            ],
            "rankings": {
                model: {d: list(self.ranking(d, model)) for d in DIRECTIONS} for model in present
            },
            "published_rankings": {d: list(published_ranking(d)) for d in DIRECTIONS},
            "tables": {
                f"{table}, {model}": [r.to_dict() for r in rows]
                for (table, model), rows in self.rows.items()
            },
        }


def machines() -> tuple[str, ...]:
    """Names of the machines that the paper compares."""
    return tuple(dict.fromkeys(value.row for value in TABLE_4))


def published_ranking(direction: str) -> tuple[str, ...]:
    """The four machines by the means of Table 4, the stiffest first."""
    quantity = f"K{direction * 2} mean"
    return tuple(sorted(machines(), key=lambda row: -TABLE_4.value(row, quantity)))


def variant(name: str, model: Model) -> ThreeLegs:
    """A machine of the paper with one of the joint models.

    Raises
    ------
    ModelError
        An unknown machine or model.
    """
    machine = get(name).factory()
    if not isinstance(machine, ThreeLegs) or model not in MODELS:
        raise ModelError(
            f"{name}, {model}",
            "is not a machine of the paper with one of the joint models.",
            "Machines: " + ", ".join(machines()) + "; models: " + ", ".join(MODELS) + ".",
        )
    return with_model(machine, model)


def with_model(machine: ThreeLegs, model: Model) -> ThreeLegs:
    """The machine as it is, or what the paper's numbers suggest of it."""
    return machine.apparent() if model == "apparent" else machine


def compare_azulay(
    filters: Filters = AS_IN_AZULAY,
    *,
    names: Sequence[str] | None = None,
    workers: int | None = None,
    progress: Callable[[str], Progress] | None = None,
) -> AzulayComparison:
    """Compute the paper's static comparison with both joint models.

    Parameters
    ----------
    filters : Filters
        The same for every machine.
    names : sequence of str, optional
        Some of the machines; default all that the paper compares.
    workers : int, optional
        Threads; default one a processor.
    progress : callable, optional
        Given the name of a part of the work, returns what is told how far it is.

    Returns
    -------
    AzulayComparison
    """
    chosen = machines() if names is None else names
    plan: list[tuple[str, Model, Machine]] = []
    for model in MODELS:
        plan += [(name, model, variant(name, model)) for name in chosen]
        if PROPOSED not in chosen:
            continue
        proposed = Proposed3PPRS()
        plan += [
            (
                f"{PROPOSED} L={length * 1e3:.0f} mm",
                model,
                with_model(replace(proposed, link_length=length), model),
            )
            for length in LINK_LENGTHS
        ]
    distinct: dict[Machine, xr.Dataset] = {}
    maps: dict[tuple[str, Model], xr.Dataset] = {}
    for row, model, machine in plan:
        # Table 2's machine of 216 mm is Table 4's: computed once
        if machine not in distinct:
            tell = progress(f"{row}, {MODELS[model]}") if progress else silent
            distinct[machine] = stiffness_map(
                machine, filters=filters, workers=workers, progress=tell
            )
        maps[row, model] = distinct[machine]
    summaries = {key: summary(dataset) for key, dataset in maps.items()}
    rows = {
        (table.key, model): published_rows(
            table, {row: s for (row, m), s in summaries.items() if m == model}, model
        )
        for table in (TABLE_2, TABLE_4)
        for model in MODELS
    }
    return AzulayComparison(
        MappingProxyType(maps), MappingProxyType(summaries), MappingProxyType(rows)
    )


def published_rows(
    table: PublishedTable, summaries: Mapping[str, Summary], model: Model
) -> tuple[PublishedRow, ...]:
    """Rows of Table 2 or 4 with our numbers from maps of one model.

    Parameters
    ----------
    table : PublishedTable
    summaries : mapping of row to Summary
        Rows of the table that are missing here are left out.
    model : "spherical" or "apparent"

    Returns
    -------
    tuple of PublishedRow
    """
    rows = []
    for entry in table:
        if entry.row not in summaries:
            continue
        axis, measure = entry.quantity[1], entry.quantity.split()[1]
        found = summaries[entry.row].axis(axis).statistics
        # the table is in N/um; its variances in the square of it
        computed = found.mean / 1e6 if measure == "mean" else found.variance / 1e12
        rows.append(
            PublishedRow(
                entry.row,
                entry.quantity,
                entry.unit,
                entry.value,
                computed,
                status_of(entry),
                note_of(entry, model),
            )
        )
    return tuple(rows)
