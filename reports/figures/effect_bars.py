"""Bars to either side of zero: what a change of each dimension does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from numpy.typing import ArrayLike

from strutwork.reports.figures.theme import AXIS_COLOURS, INK, LEGEND, axis, layout, rounded
from strutwork.reports.numbers import percent
from strutwork.reports.page import plain


def effect_bars(
    names: Sequence[str], effects: Mapping[str, ArrayLike], title: str
) -> dict[str, Any]:
    """Horizontal bars of several effects for each name, in percent.

    Parameters
    ----------
    names : sequence of n str
        From the top.
    effects : mapping of x, y or z to (n,)
        Percent.
    title : str
        Of the axis.
    """
    shown = [plain(name) for name in names]
    traces = []
    for key, values in effects.items():
        numbers = [float(v) for v in values]  # type: ignore[union-attr]
        traces.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": f"stiffness along {key}",
                "y": shown,
                "x": rounded(numbers, 5),
                "text": [percent(v) for v in numbers],
                "textposition": "outside",
                "textfont": {"size": 11},
                "cliponaxis": False,
                "marker": {"color": AXIS_COLOURS[key], "line": {"color": INK, "width": 0.5}},
                "hovertemplate": "%{y}: %{x:.2f} %<extra>" + f"stiffness along {key}</extra>",
            }
        )
    size = max((abs(v) for t in traces for v in t["x"]), default=1.0) or 1.0  # type: ignore[attr-defined]
    low = min(min(t["x"], default=0.0) for t in traces) if traces else 0.0  # type: ignore[call-overload]
    high = max(max(t["x"], default=0.0) for t in traces) if traces else 0.0  # type: ignore[call-overload]
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
