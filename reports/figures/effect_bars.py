"""Bars to either side of zero: what a change of each dimension does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from strutwork.reports.figures.theme import AXIS_COLOURS, INK, LEGEND, axis, layout, rounded
from strutwork.reports.numbers import percent
from strutwork.reports.page import plain

#: Bars below this have no number, percent.
SHOWN = 0.05


def effect_bars(
    names: Sequence[str], effects: Mapping[str, Sequence[float]], title: str
) -> dict[str, Any]:
    """Horizontal bars of several effects for each name, in percent.

    Parameters
    ----------
    names : sequence of n str
        From the top.
    effects : mapping of x, y or z to n floats
        Percent.
    title : str
        Of the axis.
    """
    shown = [plain(name) for name in names]
    traces = []
    for key, values in effects.items():
        numbers = [float(v) for v in values]
        traces.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": f"stiffness along {key}",
                "y": shown,
                "x": rounded(numbers, 5),
                "text": [percent(v) if abs(v) >= SHOWN else "" for v in numbers],
                "textposition": "outside",
                "textfont": {"size": 11},
                "cliponaxis": False,
                "marker": {"color": AXIS_COLOURS[key], "line": {"color": INK, "width": 0.5}},
                "hovertemplate": "%{y}: %{x:.2f} %<extra>" + f"stiffness along {key}</extra>",
            }
        )
    every = [0.0, *(float(v) for values in effects.values() for v in values)]
    low, high = min(every), max(every)
    size = max(-low, high) or 1.0
    room = 0.2 * size
    return {
        "data": traces,
        "layout": layout(
            barmode="group",
            bargap=0.25,
            xaxis=axis(title, range=[min(low - room, 0.0), high + room], ticksuffix=" %"),
            yaxis=axis("", autorange="reversed", ticks="", automargin=True),
            legend=LEGEND | {"traceorder": "normal"},
        ),
    }
