"""Stiffness over the hemisphere, seen from above."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.figures.theme import INK, MAP_SCALE, SOFT, axis, layout, rounded

Array = NDArray[Any]


def hemisphere_map(
    positions: Array,
    values: Array,
    quantity: str,
    hover: list[str],
    limits: tuple[float, float] | None = None,
    small: bool = False,
    ring: tuple[float, float] | None = None,
) -> dict[str, Any]:
    """A coloured disc: one cell for every check point, the worst and the best one marked.

    Parameters
    ----------
    positions : (n, 3)
        Check points, m, whose x and y stand on a square lattice.
    values : (n,)
        N/µm; NaN where no pose counts: such cells stay blank.
    quantity : str
        Title of the colour bar.
    hover : list of str
        What shows under the pointer at each point.
    limits : (float, float), optional
        Ends of the colour scale; default those of the values.
    small : bool
        One of many: no axis titles, a thin colour bar.
    ring : (float, float), optional
        Radii of two circles about the points' middle between which poses are singular, m.
    """
    x, y = 1e3 * positions[:, 0], 1e3 * positions[:, 1]
    across, column = np.unique(np.round(x, 9), return_inverse=True)
    upward, line = np.unique(np.round(y, 9), return_inverse=True)
    grid = np.full((len(upward), len(across)), np.nan)
    grid[line, column] = values
    texts = np.full(grid.shape, "", dtype=object)
    texts[line, column] = hover
    low, high = limits or (float(np.nanmin(values)), float(np.nanmax(values)))
    heat = {
        "type": "heatmap",
        "x": rounded(across),
        "y": rounded(upward),
        "z": rounded(grid, 5),
        "text": texts.tolist(),
        "hoverinfo": "text",
        "colorscale": MAP_SCALE,
        "zmin": low,
        "zmax": high,
        "xgap": 0.6,
        "ygap": 0.6,
        "colorbar": {
            "orientation": "h",
            "x": 0.5,
            "y": -0.02 if small else -0.24,
            "yanchor": "top",
            "len": 0.95,
            "thickness": 10 if small else 14,
            "title": {"text": quantity, "side": "top", "font": {"size": 12 if small else 13}},
            "tickfont": {"size": 11 if small else 12},
            "nticks": 5,
            "outlinewidth": 0,
        },
    }
    dropped = np.flatnonzero(~np.isfinite(values))
    marks = [heat]
    if dropped.size:
        marks.append(_marks(x[dropped], y[dropped], "no valid pose", "x-thin", 6, SOFT, hover=[]))
    worst, best = int(np.nanargmin(values)), int(np.nanargmax(values))
    marks += [
        _marks(x[[worst]], y[[worst]], "worst", "triangle-down", 15, "#ffffff", [hover[worst]]),
        _marks(x[[best]], y[[best]], "best", "triangle-up", 15, "#000000", [hover[best]]),
    ]
    if ring is not None:
        marks += _circles(float(x.mean()), float(y.mean()), ring)
    bare: dict[str, Any] = {"showgrid": False, "zeroline": False}
    if small:
        bare |= {"visible": False}
    span = 1.1 * float(np.hypot(x, y).max())
    return {
        "data": marks,
        "layout": layout(
            xaxis=axis("x (mm)", constrain="domain", range=[-span, span], **bare),
            yaxis=axis("y (mm)", scaleanchor="x", constrain="domain", range=[-span, span], **bare),
            margin={"l": 6, "r": 6, "t": 24, "b": 62}
            if small
            # the legend stands between the plot and the buttons
            else {"l": 52, "r": 10, "t": 52, "b": 122},
            legend={"orientation": "h", "x": -0.1, "y": 1.01, "yanchor": "bottom"},
            showlegend=not small,
        ),
    }


def _circles(x: float, y: float, ring: tuple[float, float]) -> list[dict[str, Any]]:
    """Two dashed circles on a pale one, to be seen on every colour; m."""
    turn = np.linspace(0.0, 2.0 * np.pi, 121)
    marks: list[dict[str, Any]] = []
    for first, radius in enumerate(ring):
        common = {
            "type": "scatter",
            "mode": "lines",
            "x": rounded(x + 1e3 * radius * np.cos(turn)),
            "y": rounded(y + 1e3 * radius * np.sin(turn)),
            "hoverinfo": "skip",
            "name": "singular ring",
        }
        pale, dark = {"color": "#ffffff", "width": 4}, {"color": INK, "width": 1.8, "dash": "dash"}
        marks.append(common | {"line": pale, "showlegend": False})
        marks.append(common | {"line": dark, "showlegend": not first})
    return marks


def _marks(
    x: Array, y: Array, name: str, symbol: str, size: int, colour: str, hover: list[str]
) -> dict[str, Any]:
    edge = INK if colour != "#000000" else "#ffffff"
    return {
        "type": "scatter",
        "mode": "markers",
        "x": rounded(x),
        "y": rounded(y),
        "name": name,
        "text": hover,
        "hoverinfo": "text" if hover else "skip",
        "cliponaxis": False,
        "marker": {
            "symbol": symbol,
            "size": size,
            "color": colour,
            "line": {"color": edge if symbol != "x-thin" else SOFT, "width": 1.5},
        },
    }
