"""What `strutwork study` says of all machines together: Sobol indices and scatter."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from strutwork.names import visible
from strutwork.reports.cli.manner import MANNER
from strutwork.reports.cli.output import table
from strutwork.reports.study_words import index_words, interval_words, reading, title_of
from strutwork.studies.study_table import NumberColumn

#: Parameters of each answer that the table of indices shows.
SHOWN = 5


def analysis(found: xr.Dataset) -> dict[str, Any]:
    """Indices and scatter as JSON: None where there is no number."""
    result: dict[str, Any] = {}
    answers = [str(a) for a in found["answer"].to_numpy()] if "answer" in found.dims else []
    if "sobol_first" in found:
        names = [str(p) for p in found["parameter"].to_numpy()]
        result["sobol"] = {
            "blocks_dropped": found.attrs["sobol_dropped"],
            "refused": json.loads(found.attrs["sobol_refused"]),
            "indices": {
                answer: {
                    name: {
                        what: _plain(found[f"sobol_{what}"].to_numpy()[i, k])
                        for what in ("first", "first_confidence", "total", "total_confidence")
                    }
                    for k, name in enumerate(names)
                }
                for i, answer in enumerate(answers)
            },
        }
        if "sobol_second" in found:
            values = found["sobol_second"].to_numpy()
            half = found["sobol_second_confidence"].to_numpy()
            pairs = [(j, k) for j in range(len(names)) for k in range(j + 1, len(names))]
            result["sobol"]["second"] = {
                answer: [
                    {
                        "parameters": [names[j], names[k]],
                        "index": _plain(values[i, j, k]),
                        "confidence": _plain(half[i, j, k]),
                    }
                    for j, k in pairs
                ]
                for i, answer in enumerate(answers)
            }
    if "scatter_mean" in found:
        shown = [str(v) for v in found.data_vars if str(v).startswith("scatter_")]
        result["scatter"] = {
            "quantiles": found["quantile"].to_numpy().tolist(),
            "answers": {
                answer: {v.removeprefix("scatter_"): _plain(found[v].to_numpy()[i]) for v in shown}
                for i, answer in enumerate(answers)
            },
        }
    return result


def _plain(value: Any) -> Any:
    array = np.asarray(value)
    if array.ndim:
        return [_plain(v) for v in array]
    number = array.item()
    return number if np.isfinite(number) else None


def print_analysis(out: Any, found: xr.Dataset, columns: Sequence[NumberColumn]) -> str:
    """Print the tables; the sentence that answers the question, empty without either."""
    last = ""
    if "scatter_mean" in found:
        last = _print_scatter(out, found, columns)
    if "sobol_first" in found:
        last = _print_indices(out, found, columns) or last
    return last


def _print_scatter(out: Any, found: xr.Dataset, columns: Sequence[NumberColumn]) -> str:
    rows, last = [], ""
    for column in columns:
        one = found.sel(answer=column.name)
        unit, factor = reading(column)
        mean = float(one["scatter_mean"]) * factor
        if not np.isfinite(mean):
            continue
        low, high = one["scatter_mean_interval"].to_numpy() * factor
        quantiles = one["scatter_quantile"].to_numpy() * factor
        ends = one["scatter_quantile_interval"].to_numpy() * factor
        said = [interval_words(q, *e) for q, e in zip(quantiles, ends, strict=True)]
        rows.append(
            (
                title_of(column),
                unit,
                float(one["scatter_at_mean"]) * factor,
                f"{mean:.4g} ± {(high - low) / 2:.2g}",
                float(one["scatter_standard_deviation"]) * factor,
                *said,
            )
        )
        last = last or (
            f"{title_of(column).capitalize()}: mean {mean:.4g} ± {(high - low) / 2:.2g} {unit}, "
            f"5 % of the machines are below {quantiles[0]:.4g} {unit}"
        )
    heads = ["", "unit", "at the means", "mean", "deviation", "5 %", "median", "95 %"]
    out.print(table("Scatter of the answers, with 95 % intervals", heads, rows, names=2))
    count = int(found["scatter_machines"].max())
    lost = int(found["scatter_machines"].size and found["status"].size - count)
    if lost and "sobol_first" not in found:
        out.print(
            f"{lost} machines have no answer and are left out; quantiles are of the others.",
            markup=False,
        )
    return last


def _print_indices(out: Any, found: xr.Dataset, columns: Sequence[NumberColumn]) -> str:
    refused = json.loads(found.attrs["sobol_refused"])
    names = [str(p) for p in found["parameter"].to_numpy()]
    rows, last = [], ""
    for column in columns:
        if column.name in refused:
            continue
        one = found.sel(answer=column.name)
        first, first_half, total, total_half = (
            one[f"sobol_{what}"].to_numpy()
            for what in ("first", "first_confidence", "total", "total_confidence")
        )
        order = np.argsort(-total)
        rows += [
            (
                title_of(column),
                visible(names[k]),
                index_words(first[k], first_half[k]),
                index_words(total[k], total_half[k]),
            )
            for k in (order if MANNER.whole else order[:SHOWN])
        ]
        top = order[0]
        last = last or (
            f"{title_of(column).capitalize()} depends most on {visible(names[top])}: total Sobol "
            f"index {index_words(total[top], total_half[top])}"
        )
    heads = ["", "parameter", "alone (first order)", "with interactions (total)"]
    out.print(table("Sobol indices, with 95 % intervals", heads, rows, names=2))
    if "sobol_second" in found:
        _print_second(out, found, [c for c in columns if c.name not in refused], names)
    if found.attrs["sobol_dropped"]:
        out.print(visible(found.attrs["sobol_dropped"]), markup=False, soft_wrap=True)
    for column in columns:
        if column.name in refused:
            out.print(
                f"No indices of {title_of(column)}: {refused[column.name]}",
                markup=False,
                soft_wrap=True,
            )
    return last


def _print_second(
    out: Any, found: xr.Dataset, columns: Sequence[NumberColumn], names: Sequence[str]
) -> None:
    rows = []
    pairs = [(j, k) for j in range(len(names)) for k in range(j + 1, len(names))]
    for column in columns:
        one = found.sel(answer=column.name)
        index, half = (one[f"sobol_second{end}"].to_numpy() for end in ("", "_confidence"))
        order = sorted(pairs, key=lambda pair: -abs(index[pair]))
        for j, k in order if MANNER.whole else order[:SHOWN]:
            both = f"{visible(names[j])} and {visible(names[k])}"
            rows.append((title_of(column), both, index_words(index[j, k], half[j, k])))
    out.print(table("Sobol indices of second order", ["", "parameters", "index"], rows, names=2))
