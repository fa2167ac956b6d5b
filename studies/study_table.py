"""A study as a table: one row per machine, and how its answers follow its parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.studies.dataset_units import stated_unit, unit_at
from strutwork.studies.study_dataset import SAMPLE, STATUS

Array = NDArray[Any]


@dataclass(frozen=True)
class NumberColumn:
    """A column of numbers, one for each machine.

    Parameters
    ----------
    name : str
        Of the parameter, or of the variable with its labels.
    unit : str
        SI; "1" for none.
    values : (n,)
        In `unit`, any unit.
    variable : str
        In the dataset.
    label : str
        Along its dimensions, as "z"; empty without any.
    """

    name: str
    unit: str
    values: Array
    variable: str = ""
    label: str = ""

    @property
    def head(self) -> str:
        """Name and unit."""
        return self.name if self.unit == "1" else f"{self.name} [{self.unit}]"

    @property
    def cells(self) -> list[Any]:
        """As a file writes them; empty where missing."""
        return ["" if np.isnan(v) else repr(float(v)) for v in self.values]


@dataclass(frozen=True)
class WordColumn:
    """A column of words, one for each machine.

    Parameters
    ----------
    head : str
    cells : list of str
    """

    head: str
    cells: list[str]


def sample_dims(dataset: xr.Dataset) -> tuple[str, ...]:
    """Dimensions along which the machines of a study lie.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of a study.
    """
    return tuple(str(d) for d in dataset["status"].dims)


def parameter_columns(dataset: xr.Dataset) -> tuple[NumberColumn, ...]:
    """The values of the parameters, one row for each machine.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of a study.
    """
    dims = sample_dims(dataset)
    if dims != (SAMPLE,):
        grids = np.meshgrid(*(dataset[d].to_numpy() for d in dims), indexing="ij")
        arrays = {d: g.ravel() for d, g in zip(dims, grids, strict=True)}
    else:
        arrays = {str(n): c.to_numpy() for n, c in dataset.coords.items() if "paths" in c.attrs}
    return tuple(
        NumberColumn(name, stated_unit(dataset[name]), values, name)
        for name, values in arrays.items()
    )


def answer_columns(
    dataset: xr.Dataset, *, reductions: Sequence[str] = ()
) -> tuple[NumberColumn, ...]:
    """The answers, one row for each machine; those of single poses are left out.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of a study.
    reductions : sequence of str
        Ends of the names of those that are wanted, as "worst"; all where empty.
    """
    dims = sample_dims(dataset)
    count = int(np.prod([dataset.sizes[d] for d in dims], dtype=int))
    found = []
    for variable, array in dataset.data_vars.items():
        name, inner = str(variable), [str(d) for d in array.dims if d not in dims]
        # what is said of all machines together is no answer of one
        if array.dtype.kind != "f" or "pose" in inner or not set(dims) <= set(array.dims):
            continue
        if reductions and not name.endswith(tuple(reductions)):
            continue
        values = array.transpose(*dims, *inner).to_numpy().reshape(count, -1)
        labels = [[str(v) for v in dataset[d].to_numpy()] for d in inner]
        for k, parts in enumerate(product(*labels)):
            unit = unit_at(dataset, name, parts[-1] if parts else "")
            label = " ".join(parts)
            found.append(NumberColumn(f"{name} {label}".strip(), unit, values[:, k], name, label))
    return tuple(found)


def study_columns(dataset: xr.Dataset) -> list[NumberColumn | WordColumn]:
    """Everything of a study that is one cell for each machine.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of a study.
    """
    codes = dataset["status"].to_numpy().ravel()
    texts = [str(t) for t in dataset["reason_text"].to_numpy()]
    why = [texts[int(i)] for i in dataset["reason"].to_numpy().ravel()]
    kept = [str(int(k)) for k in dataset["poses_kept"].to_numpy().ravel()]
    return [
        *parameter_columns(dataset),
        WordColumn("status", [STATUS[int(c)] for c in codes]),
        WordColumn("reason", why),
        WordColumn("poses_kept", kept),
        *answer_columns(dataset),
    ]


def rank_correlation(first: Array, second: Array) -> float:
    """Spearman's rank correlation, no unit; NaN where one of the two does not vary.

    Parameters
    ----------
    first, second : (n,)
        Any unit; pairs of which one is not finite are left out.
    """
    good = np.isfinite(first) & np.isfinite(second)
    a, b = _ranks(first[good]), _ranks(second[good])
    if len(a) < 3 or np.ptp(a) == 0.0 or np.ptp(b) == 0.0:
        return float("nan")
    return float(np.corrcoef(a, b)[0, 1])


def _ranks(values: Array) -> Array:
    """Ranks, equal values sharing the middle of theirs; equal within rounding."""
    if not len(values):
        return values
    size = np.abs(values).max()
    rounded = np.round(values / size, 9) if size > 0 else values
    _, inverse, counts = np.unique(rounded, return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    return np.asarray((last - (counts - 1) / 2.0)[inverse.ravel()])


def leading(columns: Sequence[NumberColumn], answer: Array) -> tuple[str, float]:
    """The parameter that an answer follows most, with its rank correlation; ("", NaN) for none.

    Parameters
    ----------
    columns : sequence of NumberColumn
        The parameters.
    answer : (n,)
        Any unit.
    """
    found = [(c.name, rank_correlation(c.values, answer)) for c in columns]
    known = [pair for pair in found if np.isfinite(pair[1])]
    return max(known, key=lambda pair: abs(pair[1])) if known else ("", float("nan"))
