"""Flat charts: distributions, bars beside bars, stacked shares, lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.reports.figures.theme import (
    AXIS_COLOURS,
    INK,
    LEGEND,
    PALETTE,
    axis,
    layout,
    rounded,
)
from strutwork.reports.numbers import significant
from strutwork.reports.page import plain
from strutwork.reports.part_groups import REST

Array = NDArray[Any]

#: Bars of which one is so many times another stand on a logarithmic axis.
FAR = 50.0

#: Colour of what is left when the largest parts are told apart.
OTHERS = "#c9ced6"


def distributions(
    values: Mapping[str, Array],
    title: str,
    colours: Sequence[str] = tuple(AXIS_COLOURS.values()),
    top: float | None = None,
) -> dict[str, Any]:
    """A box for each set of values: quartiles, whiskers to the extremes, mean dashed, all points.

    Parameters
    ----------
    values : mapping of name to (n,)
        Finite.
    title : str
        Of the axis, with the unit.
    colours : sequence of str
        Of the points, set by set.
    top : float, optional
        End of the axis.
    """
    traces = [
        {
            "type": "box",
            "name": plain(name),
            "y": rounded(v, 5),
            "boxmean": True,
            "boxpoints": "all",
            "jitter": 0.7,
            "pointpos": 0,
            "whiskerwidth": 0.5,
            "fillcolor": "rgba(255,255,255,0)",
            "line": {"color": INK, "width": 1.5},
            "marker": {"color": colours[i % len(colours)], "size": 3, "opacity": 0.45},
            "hoverinfo": "y",
        }
        for i, (name, v) in enumerate(values.items())
    ]
    return {
        "data": traces,
        "layout": layout(
            showlegend=False,
            yaxis=axis(title, **({"rangemode": "tozero"} if top is None else {"range": [0, top]})),
            xaxis=axis(""),
            margin={"l": 56, "r": 12, "t": 34, "b": 40},
        ),
    }


@dataclass(frozen=True)
class Bars:
    """One colour of a bar chart.

    Parameters
    ----------
    name : str
    values : (n,)
    colour : str
    pattern : str
        Hatching, so that colour is not needed to tell bars apart; empty: none.
    """

    name: str
    values: ArrayLike
    colour: str
    pattern: str = ""


def grouped(categories: Sequence[str], bars: Sequence[Bars], title: str) -> dict[str, Any]:
    """Bars side by side for each category, each with its number; logarithmic where they differ."""
    traces = [
        {
            "type": "bar",
            "name": plain(b.name),
            "x": [plain(c) for c in categories],
            "y": rounded(b.values),
            "text": [significant(float(v)) for v in np.asarray(b.values, dtype=float)],
            "textposition": "outside",
            "textangle": -90,
            "textfont": {"size": 11},
            "cliponaxis": False,
            "marker": {
                "color": b.colour,
                "line": {"color": INK, "width": 1},
                "pattern": {"shape": b.pattern, "fgcolor": INK, "size": 6, "solidity": 0.25},
            },
            "hovertemplate": "%{x}: %{y:.4g}<extra>" + plain(b.name) + "</extra>",
        }
        for b in bars
    ]
    return {
        "data": traces,
        "layout": layout(
            barmode="group",
            bargap=0.2,
            xaxis=axis(""),
            yaxis=axis(title, **_bar_range(np.concatenate([np.ravel(b.values) for b in bars]))),
        ),
    }


def _bar_range(values: NDArray[Any]) -> dict[str, Any]:
    """An axis with room for the numbers on top; on a linear one the small bars would vanish."""
    low, high = float(values.min(initial=np.inf)), float(values.max(initial=0.0))
    if not 0.0 < FAR * low < high:
        return {"range": [0, 1.18 * high]}
    first, last = np.log10(low), np.log10(high)
    room = 0.18 * (last - first)
    return {
        "type": "log",
        "range": [first - room, last + room],
        "dtick": 1,
        "exponentformat": "power",
    }


def stacked_shares(
    categories: Sequence[str],
    shares: Mapping[str, ArrayLike],
    title: str,
    colours: Mapping[str, str] = MappingProxyType({}),
) -> dict[str, Any]:
    """Horizontal bars of 100 %, one for each category, parted by cause.

    Parameters
    ----------
    categories : sequence of str
    shares : mapping of cause to (n,)
        Percent.
    title : str
        Of the axis.
    colours : mapping of cause to str
        Where a cause has its own colour in every chart.
    """
    patterns = ("", "/", "", ".", "", "\\", "", "x")
    traces = []
    for i, (name, values) in enumerate(shares.items()):
        numbers = np.asarray(values, dtype=float)
        traces.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": plain(name),
                "y": [plain(c) for c in categories],
                "x": rounded(numbers, 5),
                "text": [f"{v:.0f} %" if v >= 7 else "" for v in numbers],
                "textposition": "inside",
                "insidetextanchor": "middle",
                "textangle": 0,
                "marker": {
                    "color": colours.get(
                        name, OTHERS if name == REST else PALETTE[i % len(PALETTE)]
                    ),
                    "line": {"color": "#ffffff", "width": 1},
                    "pattern": {
                        "shape": patterns[(i // len(PALETTE)) % len(patterns)],
                        "solidity": 0.2,
                    },
                },
                "customdata": [plain(name)] * len(numbers),
                "hovertemplate": "%{customdata}: %{x:.1f} %<extra>%{y}</extra>",
            }
        )
    return {
        "data": traces,
        "layout": layout(
            barmode="stack",
            bargap=0.3,
            xaxis=axis(title, range=[0, 100], ticksuffix=" %"),
            yaxis=axis("", autorange="reversed", ticks=""),
            legend=LEGEND | {"traceorder": "normal"},
        ),
    }


def lines(
    x: Sequence[float], series: Sequence[Bars], x_title: str, y_title: str, dashed: int = 0
) -> dict[str, Any]:
    """Lines with markers; the last `dashed` of them broken and with open markers."""
    symbols = ("circle", "square", "diamond")
    traces = []
    for i, s in enumerate(series):
        broken = i >= len(series) - dashed
        symbol = symbols[i % 3] + ("-open" if broken else "")
        traces.append(
            {
                "type": "scatter",
                "mode": "lines+markers",
                "name": plain(s.name),
                "x": list(x),
                "y": rounded(s.values),
                "line": {"color": s.colour, "width": 2, "dash": "dash" if broken else "solid"},
                "marker": {"symbol": symbol, "size": 9, "line": {"width": 1.5}},
                "hovertemplate": "%{x}: %{y:.4g}<extra>" + plain(s.name) + "</extra>",
            }
        )
    return {
        "data": traces,
        "layout": layout(
            xaxis=axis(x_title, tickvals=list(x)), yaxis=axis(y_title, rangemode="tozero")
        ),
    }
