"""What all plots share: type, colours, margins. Colours are safe for colour-blind readers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

FONT = 'system-ui, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", Arial, sans-serif'
INK = "#1b2430"
SOFT = "#55606e"
LINE = "#d5dae1"

#: Okabe and Ito's palette, the darker ones first so that thin lines stay visible.
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#6b6b6b", "#000000")
AXIS_COLOURS = {"x": "#0072b2", "y": "#d55e00", "z": "#009e73"}
MAP_SCALE = "Viridis"

#: Below the plot: above it the buttons would cover it.
LEGEND = {"orientation": "h", "x": 0, "y": 0, "yanchor": "bottom", "yref": "container"}


def layout(**changes: Any) -> dict[str, Any]:
    """Layout of a plot, with `changes` on top."""
    base: dict[str, Any] = {
        "autosize": True,
        "font": {"family": FONT, "size": 13, "color": INK},
        "paper_bgcolor": "#ffffff",
        "plot_bgcolor": "#ffffff",
        "margin": {"l": 60, "r": 16, "t": 34, "b": 52},
        "legend": LEGEND,
        "hoverlabel": {"font": {"family": FONT, "size": 13}},
        "colorway": list(PALETTE),
    }
    return base | changes


def axis(title: str, **changes: Any) -> dict[str, Any]:
    """A Cartesian axis with its title, which states the unit."""
    base: dict[str, Any] = {
        "title": {"text": title, "standoff": 8},
        "automargin": True,
        "gridcolor": "#e6eaee",
        "linecolor": "#8a94a0",
        "ticks": "outside",
        "tickcolor": "#8a94a0",
        "zerolinecolor": "#8a94a0",
    }
    return base | changes


def rounded(values: ArrayLike, digits: int = 6) -> list[Any]:
    """Values for a plot with few digits, which keeps the page small; None where not finite."""
    array = np.asarray(values, dtype=float)

    def entry(value: float) -> float | None:
        return float(f"{value:.{digits}g}") if np.isfinite(value) else None

    if array.ndim == 1:
        return [entry(v) for v in array.tolist()]
    return [rounded(row, digits) for row in array]


def spec(data: Sequence[Any], **changes: Any) -> dict[str, Any]:
    """A figure as plain data."""
    return {"data": list(data), "layout": layout(**changes)}
