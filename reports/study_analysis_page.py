"""Chapters on all machines of a study together: Sobol indices and scatter."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from strutwork.reports.content import Answer, Answers, Chapter, Column, Figure, Row, Table, Text
from strutwork.reports.data_files import csv_file
from strutwork.reports.figures.study_analysis import histogram, index_bars
from strutwork.reports.study_words import index_words, interval_words, reading, title_of
from strutwork.studies.study_table import NumberColumn

#: Answers that are drawn, and parameters of each.
DRAWN, BARS = 6, 8

SCATTER, INDICES, PAIRS = "scatter.csv", "sobol-indices.csv", "sobol-second-order.csv"


def analysis_chapters(
    found: xr.Dataset, answers: Sequence[NumberColumn], machines: str
) -> tuple[Chapter, ...]:
    """The chapters; none of a study without distributions and blocks.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a study.
    answers : sequence of NumberColumn
        Those that are shown.
    machines : str
        Data file of the machines.
    """
    chapters = []
    if "scatter_mean" in found:
        chapters.append(_scatter(found, answers, machines))
    if "sobol_first" in found:
        chapters.append(_indices(found, answers))
    return tuple(chapters)


def _scatter(found: xr.Dataset, answers: Sequence[NumberColumn], machines: str) -> Chapter:
    said, rows, figures = [], [], []
    for i, column in enumerate(answers):
        one = found.sel(answer=column.name)
        unit, factor = reading(column)
        title = f"{title_of(column)} ({unit})" if unit else title_of(column)
        quantiles = one["scatter_quantile"].to_numpy() * factor
        ends = one["scatter_quantile_interval"].to_numpy() * factor
        low, high = one["scatter_mean_interval"].to_numpy() * factor
        mean, deviation, middle = (
            float(one[f"scatter_{what}"]) * factor
            for what in ("mean", "standard_deviation", "at_mean")
        )
        if not np.isfinite(mean):
            continue
        half = (high - low) / 2.0
        said.append(
            Answer(
                f"{title_of(column).capitalize()}: ",
                f"{mean:.4g} ± {half:.2g} {unit}".strip(),
                f" on average, with a standard deviation of {deviation:.3g} {unit}; nine of ten "
                f"machines lie between {quantiles[0]:.4g} and {quantiles[2]:.4g} {unit}.",
                "scatter",
            )
        )
        words = [interval_words(q, *e) for q, e in zip(quantiles, ends, strict=True)]
        rows.append(
            [title, f"{middle:.4g}", f"{mean:.4g} ± {half:.2g}", f"{deviation:.3g}", *words]
        )
        if i < DRAWN:
            names = ("5 % below", "median", "5 % above", "numbers at their means")
            figures.append(
                Figure(
                    f"scatter-{i}",
                    f"{title_of(column).capitalize()} of the machines; the grey bands are the 95 % "
                    "intervals of the quantiles.",
                    histogram(
                        column.values * factor,
                        title,
                        list(zip(names, [*quantiles, middle], strict=True)),
                        [(float(a), float(b)) for a, b in ends],
                        alone=len(answers) == 1,
                    ),
                    f"Histogram of {title} over the machines, with its quantiles.",
                    machines,
                    310,
                )
            )
    heads = ["answer", "at the means", "mean", "standard deviation", "5 %", "median", "95 %"]
    columns = [Column(h, numeric=h != "answer") for h in heads]
    blocks: list[Any] = [
        Answers(tuple(said)),
        Row(tuple(figures), 380),
        Table("Scatter, with 95 % intervals", columns, rows, SCATTER),
        Text(
            "An interval of a quantile is that of order statistics, whatever the distribution; an "
            "end for which there are too few machines is left open."
        ),
    ]
    return Chapter("scatter", "How much do the machines scatter?", tuple(blocks), (_file(found),))


def _file(found: xr.Dataset) -> Any:
    """Everything that the dataset says of the scatter, in SI."""
    shares = [f"{q:g}" for q in found["quantile"].to_numpy()]
    heads = ["answer", "unit", "machines", "at_mean", "mean", "mean_low", "mean_high", "deviation"]
    heads += [f"quantile_{q}{end}" for q in shares for end in ("", "_low", "_high")]
    rows = []
    for i, name in enumerate(found["answer"].to_numpy()):
        one = found.isel(answer=i)
        row = [str(name), str(one["answer_unit"].item()), int(one["scatter_machines"])]
        row += [float(one["scatter_at_mean"]), float(one["scatter_mean"])]
        row += [*one["scatter_mean_interval"].to_numpy().tolist()]
        row += [float(one["scatter_standard_deviation"])]
        for k in range(len(shares)):
            row += [float(one["scatter_quantile"][k])]
            row += [*one["scatter_quantile_interval"][k].to_numpy().tolist()]
        rows.append(row)
    return csv_file(SCATTER, "scatter of all answers with 95 % intervals, SI", heads, rows)


def _indices(found: xr.Dataset, answers: Sequence[NumberColumn]) -> Chapter:
    refused = json.loads(found.attrs["sobol_refused"])
    names = [str(p) for p in found["parameter"].to_numpy()]
    said, figures, rows = [], [], []
    for i, column in enumerate(answers):
        if column.name in refused:
            continue
        one = found.sel(answer=column.name)
        first, first_half, total, total_half = (
            one[f"sobol_{what}"].to_numpy()
            for what in ("first", "first_confidence", "total", "total_confidence")
        )
        order = np.argsort(-total)
        top = order[0]
        said.append(
            Answer(
                f"The variance of {title_of(column)} comes most from ",
                names[top],
                f": alone {index_words(first[top], first_half[top])}, with interactions "
                f"{index_words(total[top], total_half[top])}.",
                "sobol",
            )
        )
        shown = order[:BARS]
        series = [
            ("alone (first order)", first[shown], first_half[shown]),
            ("with interactions (total)", total[shown], total_half[shown]),
        ]
        if i < DRAWN:
            figures.append(
                Figure(
                    f"sobol-{i}",
                    f"Sobol indices of {title_of(column)}, with 95 % intervals.",
                    index_bars([names[k] for k in shown], series, alone=len(answers) == 1),
                    "Two bars for each parameter: its shares of the variance of "
                    f"{title_of(column)}.",
                    INDICES,
                    130 + 52 * len(shown),
                )
            )
        rows += [
            [
                title_of(column),
                names[k],
                index_words(first[k], first_half[k]),
                index_words(total[k], total_half[k]),
            ]
            for k in order[: max(1, 12 // len(answers))]
        ]
    heads = [
        Column("answer", numeric=False),
        Column("parameter", numeric=False),
        Column("alone (first order)"),
        Column("with interactions (total)"),
    ]
    words = (
        "A first-order index is the share of the variance that a parameter causes alone, a total "
        "index the share in which it takes part; their difference is interaction."
    )
    if found.attrs["sobol_dropped"]:
        words += f" {found.attrs['sobol_dropped']}."
    blocks: list[Any] = [
        Answers(tuple(said)),
        Row(tuple(figures), 440),
        Table("Sobol indices, the largest of each answer", heads, rows, INDICES),
        Text(words),
        *(
            Text(f"No indices of {title_of(c)}: {refused[c.name]}")
            for c in answers
            if c.name in refused
        ),
    ]
    return Chapter("sobol", "Where does the variance come from?", tuple(blocks), _files(found))


def _files(found: xr.Dataset) -> tuple[Any, ...]:
    heads = ["answer", "parameter", "first", "first_confidence", "total", "total_confidence"]
    every = [found[f"sobol_{what}"].to_numpy() for what in heads[2:]]
    answers = [str(a) for a in found["answer"].to_numpy()]
    names = [str(p) for p in found["parameter"].to_numpy()]
    rows: list[list[Any]] = [
        [answer, name, *(float(v[i, k]) for v in every)]
        for i, answer in enumerate(answers)
        for k, name in enumerate(names)
    ]
    files = [csv_file(INDICES, "Sobol indices of all answers, half widths at 95 %", heads, rows)]
    if "sobol_second" in found:
        index, half = (found[f"sobol_second{e}"].to_numpy() for e in ("", "_confidence"))
        rows = [
            [answer, names[j], names[k], float(index[i, j, k]), float(half[i, j, k])]
            for i, answer in enumerate(answers)
            for j in range(len(names))
            for k in range(j + 1, len(names))
        ]
        heads = ["answer", "parameter", "other_parameter", "index", "confidence"]
        files.append(csv_file(PAIRS, "Sobol indices of second order", heads, rows))
    return tuple(files)
