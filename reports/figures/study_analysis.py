"""How answers scatter, and which parameters their variance comes from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from strutwork.reports.figures.study import broken
from strutwork.reports.figures.theme import INK, PALETTE, axis, layout, rounded
from strutwork.reports.page import plain

#: Bars of a histogram at most.
BARS = 40


def histogram(
    values: ArrayLike,
    title: str,
    lines: Sequence[tuple[str, float]],
    bands: Sequence[tuple[float, float]],
    *,
    alone: bool = False,
) -> dict[str, Any]:
    """How many machines have which value, with quantiles and their intervals.

    Parameters
    ----------
    values : (n,)
        In the unit of the title; those that are not finite are left out.
    title : str
        Of the axis.
    lines : sequence of (name, value)
        Marked, in the unit of the title.
    bands : sequence of (low, high)
        Shaded, in the unit of the title; an end that is not finite leaves one out.
    alone : bool
        Whether the figure shows its legend itself: several in a row share one.
    """
    x = np.asarray(values, dtype=float)
    x = x[np.isfinite(x)]
    if len(x) and np.ptp(x) > 1e-9 * np.abs(x).max():
        edges = np.histogram_bin_edges(x, "auto")
        counts, edges = np.histogram(x, min(BARS, len(edges) - 1))
    else:
        counts, edges = np.histogram(x, 1)
    top = float(counts.max() if len(counts) else 1.0)
    shapes = [
        {
            "type": "rect",
            "x0": low,
            "x1": high,
            "y0": 0,
            "y1": 1,
            "yref": "paper",
            "fillcolor": INK,
            "opacity": 0.12,
            "line": {"width": 0},
        }
        for low, high in bands
        if np.isfinite(low) and np.isfinite(high)
    ]
    bars = {
        "type": "bar",
        "name": "machines",
        "x": rounded((edges[:-1] + edges[1:]) / 2.0),
        "y": [int(c) for c in counts],
        "width": rounded(np.diff(edges)),
        "marker": {"color": PALETTE[5], "line": {"color": "#ffffff", "width": 1}},
        "hovertemplate": "%{y} machines about %{x:.4g}<extra></extra>",
        "showlegend": False,
    }
    dashes = ("dot", "solid", "dot", "dash")
    marks = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": plain(name),
            "x": rounded([value, value]),
            "y": [0.0, 1.08 * top],
            "line": {
                "color": PALETTE[1] if i == 3 else PALETTE[0],
                "width": 2.5,
                "dash": dashes[i % len(dashes)],
            },
            "hovertemplate": plain(name) + " %{x:.4g}<extra></extra>",
        }
        for i, (name, value) in enumerate(lines)
        if np.isfinite(value)
    ]
    return {
        "data": [bars, *marks],
        "layout": layout(
            shapes=shapes,
            xaxis=axis(plain(title)),
            yaxis=axis("machines", range=[0, 1.1 * top]),
            margin={"l": 60, "r": 16, "t": 34, "b": 110 if alone else 60},
        ),
    }


def index_bars(
    parameters: Sequence[str],
    series: Sequence[tuple[str, ArrayLike, ArrayLike]],
    *,
    alone: bool = False,
) -> dict[str, Any]:
    """Sobol indices of one answer with their intervals.

    Parameters
    ----------
    parameters : sequence of k str
    series : sequence of (name, (k,), (k,))
        Indices and half widths of their intervals, no unit.
    alone : bool
        Whether the figure shows its legend itself.
    """
    traces = [
        {
            "type": "bar",
            "orientation": "h",
            "name": plain(name),
            "y": [broken(p) for p in parameters],
            "x": rounded(index, 4),
            "error_x": {
                "type": "data",
                "array": rounded(half, 3),
                "color": INK,
                "thickness": 1.5,
                "width": 4,
            },
            "marker": {"color": PALETTE[i], "line": {"color": INK, "width": 1}},
            "hovertemplate": "%{y}: %{x:.2f}<extra>" + plain(name) + "</extra>",
        }
        for i, (name, index, half) in enumerate(series)
    ]
    return {
        "data": traces,
        "layout": layout(
            barmode="group",
            xaxis=axis("share of variance", rangemode="tozero"),
            yaxis=axis("", autorange="reversed", type="category"),
            margin={"l": 60, "r": 16, "t": 34, "b": 110 if alone else 60},
        ),
    }
