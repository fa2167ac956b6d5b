"""How the answers of a study follow its parameters."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from strutwork.reports.figures.theme import INK, MAP_SCALE, PALETTE, axis, layout, rounded
from strutwork.reports.page import plain

#: Points beyond which a plot shows some of them, evenly: more hide one another.
MOST = 2000
#: Longest line of a title over one of several axes, characters.
ACROSS = 20


def parallel(titles: Sequence[str], values: Sequence[ArrayLike], colour: int) -> dict[str, Any]:
    """A line for each machine across axes of its parameters and answers.

    Parameters
    ----------
    titles : sequence of str
        Of the axes, with units.
    values : sequence of (n,)
        Along each axis.
    colour : int
        Number of the axis whose values colour the lines.
    """
    arrays = [np.asarray(v, dtype=float) for v in values]
    good = np.flatnonzero(np.all([np.isfinite(a) for a in arrays], axis=0))
    good = good[:: max(1, -(-len(good) // MOST))]
    return {
        "data": [
            {
                "type": "parcoords",
                "line": {"color": rounded(arrays[colour][good]), "colorscale": MAP_SCALE},
                "dimensions": [
                    {"label": broken(t), "values": rounded(a[good], 5)}
                    for t, a in zip(titles, arrays, strict=True)
                ],
                "labelfont": {"size": 12, "color": INK},
                "rangefont": {"size": 1, "color": "rgba(0,0,0,0)"},
            }
        ],
        "layout": layout(margin={"l": 70, "r": 80, "t": 96, "b": 24}),
    }


def broken(title: str) -> str:
    """A title on short lines: axes stand close to one another.

    Parameters
    ----------
    title : str
    """
    words = re.sub(r"([._])", r"\1 ", title).split(" ")
    lines = [""]
    for word in words:
        if lines[-1] and len(lines[-1]) + len(word) > ACROSS:
            lines.append("")
        gap = " " if lines[-1] and not lines[-1].endswith((".", "_")) else ""
        lines[-1] += f"{gap}{word}"
    return "<br>".join(plain(line) for line in lines)


def scatter(
    x: ArrayLike, y: ArrayLike, x_title: str, y_title: str, labels: Sequence[str], best: int
) -> dict[str, Any]:
    """Each machine as a point; the best one marked.

    Parameters
    ----------
    x, y : (n,)
        In the units of the titles.
    x_title, y_title : str
    labels : sequence of n str
        Shown with a point.
    best : int
        Number of the marked one.
    """
    a, b = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    some = np.flatnonzero(np.isfinite(a) & np.isfinite(b))
    some = some[:: max(1, -(-len(some) // MOST))]

    def points(rows: Any, **marker: Any) -> dict[str, Any]:
        return {
            "type": "scatter",
            "mode": "markers",
            "x": rounded(a[rows]),
            "y": rounded(b[rows]),
            "text": [plain(labels[i]) for i in rows],
            "hovertemplate": "%{text}<br>%{y:.4g}<extra></extra>",
            "showlegend": False,
            "marker": marker,
        }

    return {
        "data": [
            points(some, color=PALETTE[0], size=7, opacity=0.7),
            points(
                np.array([best]),
                symbol="circle-open",
                size=15,
                color=PALETTE[1],
                line={"width": 3, "color": PALETTE[1]},
            ),
        ],
        "layout": layout(xaxis=axis(plain(x_title)), yaxis=axis(plain(y_title))),
    }


def rank_bars(
    answers: Sequence[str], parameters: Sequence[str], correlation: ArrayLike
) -> dict[str, Any]:
    """How strongly each answer follows each parameter, from −1 to 1.

    Parameters
    ----------
    answers, parameters : sequence of str
    correlation : (answers, parameters)
        Rank correlations, no unit.
    """
    values = np.asarray(correlation, dtype=float)
    traces = [
        {
            "type": "bar",
            "orientation": "h",
            "name": plain(name),
            "y": [plain(a) for a in answers],
            "x": rounded(values[:, k], 3),
            "marker": {"color": PALETTE[k % len(PALETTE)], "line": {"color": INK, "width": 1}},
            "hovertemplate": "%{y}: %{x:.2f}<extra>" + plain(name) + "</extra>",
        }
        for k, name in enumerate(parameters)
    ]
    return {
        "data": traces,
        "layout": layout(
            barmode="group",
            xaxis=axis("rank correlation", range=[-1.05, 1.05]),
            yaxis=axis("", autorange="reversed", type="category"),
            margin={"l": 60, "r": 16, "t": 34, "b": 52 + 34 + 22 * len(parameters)},
            legend={"orientation": "v", "x": 0, "y": 0, "yanchor": "bottom", "yref": "container"},
        ),
    }
