"""Measured responses beside computed ones, parameters with their intervals, and chosen poses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from strutwork.reports.figures.theme import INK, PALETTE, SOFT, axis, layout, rounded
from strutwork.reports.page import plain


def response(
    frequencies: ArrayLike, measured: ArrayLike, before: ArrayLike, after: ArrayLike, unit: str
) -> dict[str, Any]:
    """Magnitudes over the frequency.

    Parameters
    ----------
    frequencies : (f,)
        Hz.
    measured, before, after : (f,)
        In `unit`.
    unit : str
    """
    f = rounded(frequencies)

    def line(name: str, values: ArrayLike, **style: Any) -> dict[str, Any]:
        return {
            "type": "scatter",
            "name": name,
            "x": f,
            "y": rounded(values, 5),
            "hovertemplate": "%{x:.5g} Hz: %{y:.4g}<extra>" + name + "</extra>",
            **style,
        }

    return {
        "data": [
            line("measured", measured, mode="markers", marker={"color": INK, "size": 5}),
            line("first guess", before, mode="lines", line={"color": PALETTE[1], "dash": "dash"}),
            line("calibrated", after, mode="lines", line={"color": PALETTE[0], "width": 2.5}),
        ],
        "layout": layout(
            xaxis=axis("frequency (Hz)"),
            yaxis=axis(f"receptance ({unit})", type="log", exponentformat="power"),
            margin={"l": 60, "r": 16, "t": 34, "b": 96},
        ),
    }


def ratios(
    names: Sequence[str], values: ArrayLike, low: ArrayLike, high: ArrayLike
) -> dict[str, Any]:
    """Calibrated values as ratios of the first guess, with their intervals.

    Parameters
    ----------
    names : sequence of g str
    values, low, high : (g,)
        Ratios to the first guess, no unit; not a number where there is no interval.
    """
    v, a, b = (np.asarray(x, dtype=float) for x in (values, low, high))
    known = np.isfinite(a) & np.isfinite(b)
    shown = [plain(n) for n in names]

    def points(rows: Any, name: str, **style: Any) -> dict[str, Any]:
        return {
            "type": "scatter",
            "mode": "markers",
            "name": name,
            "y": [shown[i] for i in np.flatnonzero(rows)],
            "x": rounded(v[rows], 5),
            "hovertemplate": "%{y}: %{x:.4g} times the first guess<extra></extra>",
            **style,
        }

    spread = {
        "type": "data",
        "symmetric": False,
        "array": rounded((b - v)[known], 5),
        "arrayminus": rounded((v - a)[known], 5),
        "color": PALETTE[0],
        "thickness": 2,
        "width": 7,
    }
    traces = [
        points(
            known,
            "with 95 % interval",
            error_x=spread,
            marker={"color": PALETTE[0], "size": 9},
        )
    ]
    if not known.all():
        traces.append(
            points(
                ~known,
                "without interval",
                marker={"color": PALETTE[1], "size": 10, "symbol": "diamond-open"},
            )
        )
    return {
        "data": traces,
        "layout": layout(
            xaxis=axis("ratio to the first guess"),
            yaxis=axis("", autorange="reversed", type="category"),
            margin={"l": 60, "r": 16, "t": 34, "b": 52 if known.all() else 96},
            showlegend=not bool(known.all()),
            shapes=[
                {
                    "type": "line",
                    "x0": 1,
                    "x1": 1,
                    "yref": "paper",
                    "y0": 0,
                    "y1": 1,
                    "line": {"color": SOFT, "dash": "dot"},
                }
            ],
        ),
    }


def poses(
    x: ArrayLike, y: ArrayLike, chosen: Sequence[int], x_title: str, y_title: str
) -> dict[str, Any]:
    """Candidate poses in two coordinates, the chosen ones marked.

    Parameters
    ----------
    x, y : (n,)
        In the units of the titles.
    chosen : sequence of int
    x_title, y_title : str
    """
    a, b = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    kept = list(chosen)

    def points(rows: Any, name: str, **marker: Any) -> dict[str, Any]:
        return {
            "type": "scatter",
            "mode": "markers",
            "name": name,
            "x": rounded(a[rows]),
            "y": rounded(b[rows]),
            "hovertemplate": "%{x:.4g}, %{y:.4g}<extra>" + name + "</extra>",
            "marker": marker,
        }

    return {
        "data": [
            points(slice(None), "candidate", color="#9aa4b0", size=7),
            points(kept, "chosen", color=PALETTE[1], size=13, line={"width": 1, "color": INK}),
        ],
        "layout": layout(
            xaxis=axis(x_title), yaxis=axis(y_title), margin={"l": 60, "r": 16, "t": 34, "b": 96}
        ),
    }


def halves(names: Sequence[str], each: Mapping[str, ArrayLike]) -> dict[str, Any]:
    """Half-widths of intervals in percent.

    Parameters
    ----------
    names : sequence of g str
    each : mapping of name to (g,)
        Percent.
    """
    colours = ("#9aa4b0", PALETTE[1], PALETTE[0])
    return {
        "data": [
            {
                "type": "bar",
                "orientation": "h",
                "name": name,
                "y": [plain(n) for n in names],
                "x": rounded(values, 4),
                "marker": {"color": colour, "line": {"color": INK, "width": 0.5}},
                "hovertemplate": "%{y}: ± %{x:.3g} %<extra>" + name + "</extra>",
            }
            for (name, values), colour in zip(each.items(), colours, strict=True)
        ],
        "layout": layout(
            barmode="group",
            xaxis=axis("half-width of the 95 % interval (%, of the logarithm)", rangemode="tozero"),
            yaxis=axis("", autorange="reversed", type="category"),
            margin={"l": 60, "r": 16, "t": 34, "b": 110},
        ),
    }
