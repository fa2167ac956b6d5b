"""The front of a design: what one objective costs in another."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.figures.theme import INK, MAP_SCALE, PALETTE, axis, layout, rounded
from strutwork.reports.page import plain

Array = NDArray[Any]

#: Machines beside the front that are drawn at most, evenly chosen: more hide one another.
MOST = 2000


def front_scatter(
    titles: Sequence[str],
    front: Sequence[Array],
    others: Sequence[Array],
    stated: Sequence[float],
    labels: Sequence[str],
) -> dict[str, Any]:
    """Machines of the front over two objectives, coloured by a third where there is one.

    Parameters
    ----------
    titles : sequence of m str
        Of the objectives, with units.
    front : sequence of m (f,)
        Their values, in the units of the titles.
    others : sequence of m (o,)
        Of the feasible machines beside the front.
    stated : sequence of m float
        Of the machine as described; not drawn where one is not finite.
    labels : sequence of f str
        Shown with a point.
    """
    colour: dict[str, Any] = {"color": PALETTE[0]}
    third = len(titles) > 2
    if third:
        bar = {"title": {"text": plain(titles[2]), "side": "right"}, "thickness": 12}
        colour = {"color": rounded(front[2]), "colorscale": MAP_SCALE, "colorbar": bar}
    some = slice(None, None, max(1, -(-len(others[0]) // MOST)))
    data: list[dict[str, Any]] = [
        {
            "type": "scatter",
            "mode": "markers",
            "name": "other feasible machines",
            "x": rounded(others[0][some]),
            "y": rounded(others[1][some]),
            "hoverinfo": "skip",
            "marker": {"color": "#b4bcc6", "size": 6},
        },
        {
            "type": "scatter",
            "mode": "markers" if third else "lines+markers",
            "name": "front",
            "x": rounded(front[0]),
            "y": rounded(front[1]),
            "customdata": list(range(len(front[0]))),
            "text": [plain(label) for label in labels],
            "hovertemplate": "%{text}<extra></extra>",
            "line": {"color": PALETTE[0], "width": 1, "dash": "dot"},
            "marker": {**colour, "size": 10, "line": {"color": INK, "width": 1}},
            "selected": {"marker": {"size": 17, "color": PALETTE[1]}},
            "unselected": {"marker": {"opacity": 1}},
        },
    ]
    if np.isfinite(stated).all():
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": "as described",
                "x": rounded([stated[0]]),
                "y": rounded([stated[1]]),
                "hovertemplate": "the machine as described<extra></extra>",
                "marker": {"symbol": "star", "size": 14, "color": INK},
            }
        )
    return {
        "data": data,
        "layout": layout(
            xaxis=axis(plain(titles[0])),
            yaxis=axis(plain(titles[1])),
            hovermode="closest",
            margin={"l": 60, "r": 16, "t": 34, "b": 100},
        ),
    }
