"""Frequencies side by side, where modes keep their strain energy, how posture moves them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from strutwork.reports.figures.theme import INK, LEGEND, PALETTE, axis, layout, rounded
from strutwork.reports.page import plain

#: Marker, colour and whether it is filled, by the series' place: published ones open.
STYLES = (
    ("diamond-open", "#000000"),
    ("diamond", PALETTE[0]),
    ("circle-open", "#000000"),
    ("circle", PALETTE[1]),
)

#: Hz; on a logarithmic axis plotly leaves the decade out of its own labels.
TICKS = [10, 20, 30, 50, 70, 100, 150, 200, 300, 500, 1000]


def frequency_dots(
    categories: Sequence[str], series: Mapping[str, Sequence[float | None]]
) -> dict[str, Any]:
    """Frequencies of each mode on one line, published ones as open marks; logarithmic.

    Parameters
    ----------
    categories : sequence of str
        Modes, from the top.
    series : mapping of name to values
        Hz; None: none.
    """
    traces = []
    for (name, values), (symbol, colour) in zip(series.items(), STYLES, strict=False):
        some = [(v, c) for v, c in zip(values, categories, strict=True) if v is not None]
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": plain(name),
                "x": rounded([v for v, _ in some]),
                "y": [plain(c) for _, c in some],
                "marker": {
                    "symbol": symbol,
                    "color": colour,
                    "size": 13 if symbol.endswith("open") else 8,
                    "line": {"width": 2 if symbol.endswith("open") else 0},
                },
                "hovertemplate": "%{y}: %{x:.4g} Hz<extra>" + plain(name) + "</extra>",
            }
        )
    return {
        "data": traces,
        "layout": layout(
            xaxis=axis(
                "frequency (Hz)", type="log", tickvals=TICKS, ticktext=list(map(str, TICKS))
            ),
            yaxis=axis(
                "",
                categoryorder="array",
                categoryarray=[plain(c) for c in reversed(categories)],
                type="category",
            ),
            legend=LEGEND,
        ),
    }


def energy_bars(
    categories: Sequence[str], shares: Mapping[str, Sequence[float]], title: str
) -> dict[str, Any]:
    """Stacked bars of shares in percent, one a mode, from the top.

    Parameters
    ----------
    categories : sequence of str
    shares : mapping of part to (n,)
        %.
    title : str
        Of the axis.
    """
    traces = [
        {
            "type": "bar",
            "orientation": "h",
            "name": plain(name),
            "y": [plain(c) for c in categories],
            "x": rounded(values, 4),
            "marker": {"color": colour, "line": {"color": "#ffffff", "width": 0.5}},
            "hovertemplate": "%{y}: %{x:.3g} %<extra>" + plain(name) + "</extra>",
        }
        for (name, values), colour in zip(
            shares.items(), ("#8d877b", "#3d4854", *PALETTE), strict=False
        )
    ]
    return {
        "data": traces,
        "layout": layout(
            barmode="stack",
            xaxis=axis(title, range=[0, 100]),
            yaxis=axis("", autorange="reversed", type="category"),
            legend=LEGEND,
        ),
    }


def singular_values(some: Mapping[str, Sequence[float]], threshold: float) -> dict[str, Any]:
    """Singular values beside the largest of each set; below the threshold nothing is determined.

    Parameters
    ----------
    some : mapping of name to (p,)
        Descending; zeros are drawn at the foot of the axis.
    threshold : float
        Share of the largest.
    """
    foot = threshold / 10
    symbols = ("circle", "square", "diamond", "triangle-up")
    traces = []
    for i, (name, values) in enumerate(some.items()):
        shown = [max(v / values[0], foot) for v in values]
        traces.append(
            {
                "type": "scatter",
                "mode": "lines+markers",
                "name": plain(name),
                "x": list(range(1, len(values) + 1)),
                "y": rounded(shown, 4),
                "customdata": rounded(values, 4),
                "line": {"color": PALETTE[i % len(PALETTE)], "width": 1.5},
                "marker": {"size": 9, "symbol": symbols[i % len(symbols)]},
                "hovertemplate": "combination %{x}: %{customdata:.3g}<extra>"
                + plain(name)
                + "</extra>",
            }
        )
    line = {
        "type": "line",
        "xref": "paper",
        "x0": 0,
        "x1": 1,
        "y0": threshold,
        "y1": threshold,
        "line": {"color": INK, "dash": "dash", "width": 1.5},
    }
    return {
        "data": traces,
        "layout": layout(
            xaxis=axis("combination of parameters", dtick=1),
            yaxis=axis("singular value / largest", type="log", exponentformat="power", dtick=1),
            shapes=[line],
            legend=LEGEND,
        ),
    }
