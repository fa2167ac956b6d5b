"""The machines of a design as tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from strutwork.studies.dataset_units import stated_unit
from strutwork.studies.design_dataset import MACHINE
from strutwork.studies.design_judged import STATUS
from strutwork.studies.study_table import NumberColumn


def design_parameters(found: xr.Dataset) -> tuple[NumberColumn, ...]:
    """The parameters, one row for each machine.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    """
    return tuple(_column(found, str(name)) for name in found["parameter"].to_numpy())


def design_quantities(found: xr.Dataset) -> tuple[NumberColumn, ...]:
    """The quantities, those of the objectives first, one row for each machine.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    """
    names = [str(n) for n, v in found.data_vars.items() if "stated" in v.attrs]
    return tuple(_column(found, n) for n in names if "paths" not in found[n].attrs)


def design_objectives(found: xr.Dataset) -> tuple[tuple[NumberColumn, str], ...]:
    """The objectives with their goals, one row for each machine.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    """
    every = design_quantities(found)
    return tuple(
        (c, str(found[c.name].attrs["goal"])) for c in every if "goal" in found[c.name].attrs
    )


def reasons_of(found: xr.Dataset) -> dict[str, int]:
    """Why machines are not feasible, with how many each; the most frequent first.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    """
    texts = [str(t) for t in found["reason_text"].to_numpy()]
    counts = np.bincount(found["reason"].to_numpy(), minlength=len(texts)).tolist()
    some = {t: n for t, n in zip(texts, counts, strict=True) if t and n}
    return dict(sorted(some.items(), key=lambda item: -item[1]))


def design_rows(found: xr.Dataset) -> tuple[list[str], list[list[Any]]]:
    """Heads and rows of all machines, those of the front first, in order.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    """
    columns = [*design_parameters(found), *design_quantities(found)]
    cells = [c.cells for c in columns]
    texts = [str(t) for t in found["reason_text"].to_numpy()]
    front = found["front"].to_numpy().tolist()
    others = sorted(set(range(found.sizes[MACHINE])) - set(front))
    status, reason = found["status"].to_numpy(), found["reason"].to_numpy()
    generation = found["generation"].to_numpy()
    rows = [
        [
            place if place <= len(front) else "",
            *(c[i] for c in cells),
            STATUS[int(status[i])],
            texts[int(reason[i])],
            int(generation[i]),
        ]
        for place, i in enumerate([*front, *others], 1)
    ]
    return ["front", *(c.head for c in columns), "status", "reason", "generation"], rows


def _column(found: xr.Dataset, name: str) -> NumberColumn:
    return NumberColumn(name, stated_unit(found[name]), found[name].to_numpy(), name)
