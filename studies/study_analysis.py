"""What a study says of all its machines together: Sobol indices, and how its answers scatter."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.studies.run import Chunk
from strutwork.studies.scatter import LEVEL, QUANTILES, scatter
from strutwork.studies.sobol_blocks import rows_of
from strutwork.studies.sobol_indices import RESAMPLES, dropped_words, indices
from strutwork.studies.study_table import NumberColumn, answer_columns
from strutwork.studies.variables import named

if TYPE_CHECKING:
    from strutwork.studies.study import Study

Array = NDArray[Any]

#: Dimensions of what is said of all machines.
ANSWER, PARAMETER, OTHER, BOUND, QUANTILE = (
    "answer",
    "parameter",
    "other_parameter",
    "bound",
    "quantile",
)
#: Which begin their names with these.
SOBOL, SCATTER = "sobol_", "scatter_"


def analysed(study: Study, dataset: xr.Dataset) -> xr.Dataset:
    """The result of a study with what its sample is for.

    Of blocks the Sobol indices `sobol_first`, `sobol_total` and, if asked for, `sobol_second`, each
    with its `_confidence`: half the width of the interval at 95 %. Where parameters have
    distributions, or points are random, `scatter_mean`, `scatter_standard_deviation` and
    `scatter_quantile` with their intervals, and `scatter_at_mean`: the answer of the machine whose
    scattering numbers are at their means.

    Parameters
    ----------
    study : Study
    dataset : xarray.Dataset
        Its result.

    Raises
    ------
    ModelError
        SALib is needed and is not installed.
    """
    drawn = study.drawn.kind
    distributed = any(p.distribution is not None for p in study.varied)
    if drawn != "saltelli" and not distributed and drawn != "random":
        return dataset
    columns = answer_columns(dataset)
    found = dataset.assign_coords(
        {
            ANSWER: [c.name for c in columns],
            "answer_unit": (ANSWER, [c.unit for c in columns]),
        }
    )
    if drawn == "saltelli":
        found = _with_indices(study, found, columns)
    if distributed or drawn == "random":
        found = _with_scatter(study, found, columns)
    return found


def _with_indices(
    study: Study, dataset: xr.Dataset, columns: tuple[NumberColumn, ...]
) -> xr.Dataset:
    names = [p.name for p in study.varied]
    second = study.sample.second_order
    every = [
        indices(c.values, len(names), second_order=second, seed=study.sample.seed) for c in columns
    ]
    what = {
        "first": ("share of the variance that comes from the parameter alone", (PARAMETER,)),
        "total": ("share of the variance in which the parameter takes part", (PARAMETER,)),
        "second": ("share of the variance that comes from two parameters", (PARAMETER, OTHER)),
    }
    made = {}
    for name, (meaning, dims) in what.items():
        if name == "second" and not second:
            continue
        for field, words in (
            (name, f"Sobol index, {meaning}"),
            (f"{name}_confidence", f"half width of the 95 % interval of sobol_{name}"),
        ):
            shape = (len(columns), *(len(names) for _ in dims))
            values = np.array([getattr(one, field) for one in every]).reshape(shape)
            made[f"{SOBOL}{field}"] = named((ANSWER, *dims), values, "1", words)
    blocks = len(study.drawn.values) // rows_of(len(names), second)
    kept = np.array([blocks - len(one.dropped) for one in every], dtype=np.int32)
    made[f"{SOBOL}blocks"] = named(ANSWER, kept, "1", f"complete blocks of {blocks}")
    refused = {c.name: one.refused for c, one in zip(columns, every, strict=True) if one.refused}
    said = {
        "sobol_refused": json.dumps(refused, ensure_ascii=False),
        "sobol_dropped": dropped_words([one.dropped for one in every], blocks),
        "sobol_method": f"blocks of Saltelli (2010) by SALib, {RESAMPLES} bootstrap samples",
    }
    coords: dict[str, Any] = {PARAMETER: names}
    if second:
        coords[OTHER] = names
    return dataset.assign_coords(coords).assign(made).assign_attrs(said)


def independent(study: Study, values: Array) -> Array:
    """Answers of machines drawn independently of one another, (m,): blocks repeat numbers.

    Parameters
    ----------
    study : Study
    values : (n,)
        For each machine, any unit.
    """
    if study.drawn.kind != "saltelli":
        return values
    rows = rows_of(len(study.varied), study.sample.second_order)
    blocks = values.reshape(-1, rows)
    return np.concatenate([blocks[:, 0], blocks[:, -1]])


def _with_scatter(
    study: Study, dataset: xr.Dataset, columns: tuple[NumberColumn, ...]
) -> xr.Dataset:
    every = [scatter(independent(study, c.values)) for c in columns]
    unit = {"component_units": "that of each answer; see answer_unit"}

    def put(name: str, dims: tuple[str, ...], shape: tuple[int, ...], words: str) -> xr.Variable:
        values = np.array([getattr(one, name) for one in every]).reshape(len(every), *shape)
        return xr.Variable((ANSWER, *dims), values, unit | {"long_name": words})

    count = len(QUANTILES)
    made = {
        "scatter_machines": named(
            ANSWER, np.array([one.count for one in every], np.int32), "1", "machines that count"
        ),
        "scatter_at_mean": xr.Variable(
            ANSWER,
            _at_mean(study, columns),
            unit | {"long_name": "answer of the machine whose parameters are at their means"},
        ),
        "scatter_mean": put("mean", (), (), "mean"),
        "scatter_mean_interval": put("mean_interval", (BOUND,), (2,), "95 % interval of the mean"),
        "scatter_standard_deviation": put("deviation", (), (), "standard deviation (n - 1)"),
        "scatter_quantile": put("quantiles", (QUANTILE,), (count,), "quantiles"),
        "scatter_quantile_interval": put(
            "quantile_intervals", (QUANTILE, BOUND), (count, 2), "95 % intervals of the quantiles"
        ),
    }
    coords = {QUANTILE: list(QUANTILES), BOUND: ["low", "high"]}
    said = {"scatter_level": LEVEL}
    return dataset.assign_coords(coords).assign(made).assign_attrs(said)


def _at_mean(study: Study, columns: tuple[NumberColumn, ...]) -> Array:
    """Answers of the one machine in the middle; NaN where it cannot be."""
    middle = [
        float(p.scaled(np.array([0.5]))[0]) if p.distribution is None else p.distribution.middle
        for p in study.varied
    ]
    part = replace(study.machines, values=np.array([middle]))(Chunk(0, 0, 1))
    # columns are the entries of each variable in order
    names = dict.fromkeys(c.variable for c in columns)
    return np.concatenate([np.ravel(part[name][0]) for name in names])
