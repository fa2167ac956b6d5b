"""Distributions, maps and lines over continuous axes."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.reports.figures.theme import LEGEND, MAP_SCALE, PALETTE, axis, layout, rounded
from strutwork.reports.numbers import significant
from strutwork.reports.page import plain

Array = NDArray[Any]

#: Longest line beside a colour bar, characters.
BESIDE = 24

LIMIT, WORST = "#a02c2c", "#000000"

#: Lines over a map, told apart by their dashes as well.
OUTLINES, DASHES = ("#000000", "#a02c2c"), ("solid", "dash", "dot", "dashdot")


def limit_lines(limits: Mapping[str, float]) -> tuple[list[Any], list[Any]]:
    """Dashed lines across a plot and their labels: plotly shapes and annotations."""
    shapes = [
        {
            "type": "line",
            "xref": "paper",
            "x0": 0,
            "x1": 1,
            "y0": value,
            "y1": value,
            "line": {"color": LIMIT, "width": 2, "dash": "dash"},
        }
        for value in limits.values()
    ]
    notes = [
        {
            "xref": "paper",
            "x": 0.99,
            "xanchor": "right",
            "y": value,
            "yanchor": "bottom",
            "text": plain(label),
            "showarrow": False,
            "bgcolor": "rgba(255,255,255,0.8)",
            "font": {"color": LIMIT, "size": 12},
        }
        for label, value in limits.items()
    ]
    return shapes, notes


def histogram(
    edges: Array,
    counts: Array,
    worst: float,
    quantiles: Mapping[str, float],
    title: str,
    limit: float | None = None,
) -> dict[str, Any]:
    """How often a force falls where, with its quantiles and the exact worst case marked.

    Parameters
    ----------
    edges : (n + 1,)
        Of the bins, kN.
    counts : (n,)
        Samples in each.
    worst : float
        Exact worst case, kN.
    quantiles : mapping of label to float
        kN.
    title : str
        Of the axis, with the unit.
    limit : float, optional
        kN.
    """
    share = 100 * counts / max(float(np.sum(counts)), 1.0)
    middle = (edges[1:] + edges[:-1]) / 2
    below = np.concatenate([[0.0], np.cumsum(share)])
    bars = {
        "type": "bar",
        "name": "share of samples in each bin",
        "x": rounded(middle),
        "y": rounded(share, 4),
        "width": rounded(np.diff(edges)),
        "marker": {"color": PALETTE[5], "line": {"width": 0}},
        "hovertemplate": "%{x:.3g} kN: %{y:.3g} %<extra></extra>",
    }
    line = {
        "type": "scatter",
        "mode": "lines",
        "name": "samples below",
        "x": rounded(edges),
        "y": rounded(below, 5),
        "yaxis": "y2",
        "line": {"color": PALETTE[0], "width": 2},
        "hovertemplate": "%{y:.4g} % below %{x:.3g} kN<extra></extra>",
    }
    marks: list[dict[str, Any]] = []
    notes = []
    upright: list[tuple[str, float, str, str]] = [
        (label, value, PALETTE[0], "dot") for label, value in quantiles.items()
    ]
    upright.append(("worst", worst, WORST, "solid"))
    if limit is not None:
        upright.append(("limit", limit, LIMIT, "dash"))
    for n, (label, value, colour, dash) in enumerate(upright):
        marks.append(
            {
                "type": "line",
                "x0": value,
                "x1": value,
                "yref": "paper",
                "y0": 0,
                "y1": 1,
                "line": {"color": colour, "width": 2, "dash": dash},
            }
        )
        notes.append(
            {
                "x": value,
                "yref": "paper",
                "y": 1.0 - 0.09 * (n % 4),
                "xanchor": "right",
                "yanchor": "top",
                "text": f"{plain(label)} {significant(value)}",
                "showarrow": False,
                "bgcolor": "rgba(255,255,255,0.8)",
                "font": {"size": 11, "color": colour},
            }
        )
    right = max(v for _, v, _, _ in upright)
    return {
        "data": [bars, line],
        "layout": layout(
            bargap=0,
            xaxis=axis(title, range=[0, 1.04 * right]),
            yaxis=axis("share of samples (%)", rangemode="tozero"),
            yaxis2={
                "overlaying": "y",
                "side": "right",
                "range": [0, 100],
                "tickmode": "linear",
                "dtick": 20,
                "title": {"text": "samples below (%)"},
                "showgrid": False,
                "automargin": True,
            },
            shapes=marks,
            annotations=notes,
            legend=LEGEND,
        ),
    }


def heat(
    x: ArrayLike,
    y: ArrayLike,
    values: Array,
    titles: tuple[str, str, str],
    marks: Mapping[str, tuple[float, float]] | None = None,
    outlines: Mapping[str, Array] | None = None,
) -> dict[str, Any]:
    """A coloured map over two coordinates with some places marked.

    Parameters
    ----------
    x, y : (n,), (m,)
    values : (n, m)
        NaN stays blank.
    titles : (str, str, str)
        Of x, y and the colour bar, with units.
    marks : mapping of label to (x, y), optional
    outlines : mapping of label to (k, 2), optional
        Lines over the map; both axes then have one scale, so that shapes are drawn as they are.
    """
    traces: list[dict[str, Any]] = [
        {
            "type": "heatmap",
            "x": rounded(x),
            "y": rounded(y),
            "z": rounded(values.T, 5),
            "colorscale": MAP_SCALE,
            "hovertemplate": "%{x:.3g}, %{y:.3g}: %{z:.4g}<extra></extra>",
            "colorbar": {
                "title": {"text": _two_lines(titles[2]), "side": "right"},
                "thickness": 14,
                "outlinewidth": 0,
            },
        }
    ]
    symbols = ("triangle-down", "triangle-up", "circle")
    for i, (label, place) in enumerate((marks or {}).items()):
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": plain(label),
                "x": [float(place[0])],
                "y": [float(place[1])],
                "cliponaxis": False,
                "marker": {
                    "symbol": symbols[i % len(symbols)],
                    "size": 14,
                    "color": "#ffffff" if i == 0 else "#000000",
                    "line": {"color": "#000000" if i == 0 else "#ffffff", "width": 1.5},
                },
                "hovertemplate": plain(label) + "<extra></extra>",
            }
        )
    traces += _outlines(outlines or {})
    # the map stays beside its colours
    scale = {"constrain": "domain", "constraintoward": "right"} if outlines else {}
    anchor = {"scaleanchor": "x", "constrain": "domain"} if outlines else {}
    return {
        "data": traces,
        "layout": layout(
            xaxis=axis(titles[0], zeroline=False, range=_around(x), **scale),
            yaxis=axis(titles[1], zeroline=False, range=_around(y), **anchor),
        ),
    }


def _two_lines(title: str) -> str:
    """A long title beside a colour bar in two lines: one would run past a small map's ends."""
    return "<br>".join(textwrap.wrap(title, BESIDE)) if len(title) > BESIDE else title


def _outlines(outlines: Mapping[str, Array]) -> list[dict[str, Any]]:
    """Lines over a map, on a white edge: they are seen on every colour."""
    traces: list[dict[str, Any]] = []
    for i, (label, points) in enumerate(outlines.items()):
        name = plain(label)
        line: dict[str, Any] = {
            "type": "scatter",
            "mode": "lines",
            "name": name,
            "legendgroup": name,
            "x": rounded(points[:, 0]),
            "y": rounded(points[:, 1]),
        }
        dash = DASHES[i % len(DASHES)]
        edge = {"color": "#ffffff", "width": 5}
        traces += [
            {**line, "line": edge, "hoverinfo": "skip", "showlegend": False},
            {
                **line,
                "line": {"color": OUTLINES[i % len(OUTLINES)], "width": 2.5, "dash": dash},
                "hovertemplate": name + "<extra></extra>",
            },
        ]
    return traces


def _around(places: ArrayLike) -> list[float]:
    """Range of an axis that shows whole cells about evenly spaced places."""
    some = np.asarray(places, dtype=float)
    half = float(np.diff(some).max(initial=0.0)) / 2 or 0.5
    return [float(some.min()) - half, float(some.max()) + half]


@dataclass(frozen=True)
class Curve:
    """A line of a plot over a continuous axis."""

    name: str
    y: ArrayLike
    colour: str
    dash: str = "solid"
    width: float = 2.0


def curves(
    x: ArrayLike,
    some: Sequence[Curve],
    titles: tuple[str, str],
    marks: Sequence[tuple[str, ArrayLike, ArrayLike, str]] = (),
    limits: Mapping[str, float] | None = None,
    *,
    from_zero: bool = False,
) -> dict[str, Any]:
    """Lines over a continuous axis, with markers and limits.

    Parameters
    ----------
    x : (n,)
    some : sequence of Curve
    titles : (str, str)
        Of the axes, with units.
    marks : sequence of (name, x, y, colour)
    limits : mapping of label to float, optional
    from_zero : bool
        The vertical axis begins at zero.
    """
    traces: list[dict[str, Any]] = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": plain(c.name),
            "x": rounded(x),
            "y": rounded(c.y),
            "line": {"color": c.colour, "width": c.width, "dash": c.dash},
            "hovertemplate": "%{x:.4g}: %{y:.4g}<extra>" + plain(c.name) + "</extra>",
        }
        for c in some
    ]
    for name, places, values, colour in marks:
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": plain(name),
                "x": rounded(places),
                "y": rounded(values),
                "marker": {
                    "symbol": "diamond-open",
                    "size": 9,
                    "color": colour,
                    "line": {"width": 2},
                },
                "hovertemplate": "%{x:.4g}: %{y:.4g}<extra>" + plain(name) + "</extra>",
            }
        )
    shapes, notes = limit_lines(limits or {})
    for note in notes:
        note["yanchor"] = "top"
    return {
        "data": traces,
        "layout": layout(
            xaxis=axis(titles[0]),
            yaxis=axis(titles[1], **({"rangemode": "tozero"} if from_zero else {})),
            shapes=shapes,
            annotations=notes,
        ),
    }
