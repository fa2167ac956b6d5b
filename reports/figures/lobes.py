"""Limiting depths over the spindle speed, and over the direction of the feed."""

from __future__ import annotations

from typing import Any

import numpy as np

from strutwork.reports.figures.curves import Curve, curves
from strutwork.reports.figures.theme import INK, LEGEND, PALETTE, layout, rounded
from strutwork.reports.lobes import TargetLobes
from strutwork.reports.numbers import significant


def lobes_diagram(found: TargetLobes) -> dict[str, Any]:
    """Depth over spindle speed: zero order, exact, the absolute limit and the best speeds.

    Parameters
    ----------
    found : TargetLobes
    """
    speeds, exact = found.lobes.speeds, found.exact
    lines = [Curve("zero order", 1e3 * _known(found.lobes.depth), PALETTE[1], "dash")]
    if exact is not None:
        depth = np.minimum(exact.depth, exact.deepest)
        lines.insert(0, Curve("exact", 1e3 * depth, PALETTE[0], "solid", 2.5))
    marks = [
        (
            "best speeds",
            [p.speed for p in found.pockets],
            [1e3 * p.depth for p in found.pockets],
            PALETTE[2],
        )
    ]
    absolute = 1e3 * found.absolute[0]
    spec = curves(
        speeds,
        lines,
        ("spindle speed (rpm)", "limiting depth of cut (mm)"),
        marks if found.pockets else (),
        {f"absolute: {significant(absolute)} mm": absolute},
        from_zero=True,
    )
    for note in spec["layout"]["annotations"]:
        # the axis is near: the label stands above its line
        note["yanchor"] = "bottom"
    if exact is not None:
        # above the line the cut chatters
        spec["data"][0] |= {"fill": "tozeroy", "fillcolor": "rgba(0,114,178,0.10)"}
    return spec


def _known(depth: Any) -> Any:
    return np.where(np.isfinite(depth), depth, np.nan)


def rose(found: TargetLobes) -> dict[str, Any]:
    """Depth that is stable at every speed over the direction of the feed.

    Parameters
    ----------
    found : TargetLobes
    """
    limits = found.rose
    angles = np.degrees(np.append(limits.feeds, limits.feeds[0] + 2.0 * np.pi))
    depth = 1e3 * _known(np.append(limits.depth, limits.depth[0]))
    worst = int(np.argmin(limits.depth))
    traces = [
        {
            "type": "scatterpolar",
            "mode": "lines",
            "name": "depth stable at every speed (mm)",
            "theta": rounded(angles),
            "r": rounded(depth),
            "line": {"color": PALETTE[0], "width": 2.5},
            "fill": "toself",
            "fillcolor": "rgba(0,114,178,0.10)",
            "hovertemplate": "%{theta:.3g}°: %{r:.4g} mm<extra></extra>",
        },
        {
            "type": "scatterpolar",
            "mode": "markers",
            "name": f"least, {significant(1e3 * float(limits.depth[worst]))} mm",
            "theta": rounded([float(np.degrees(limits.feeds[worst]))]),
            "r": rounded([1e3 * float(limits.depth[worst])]),
            "marker": {"symbol": "triangle-down", "size": 12, "color": INK},
            "hovertemplate": "%{theta:.3g}°: %{r:.4g} mm<extra>least</extra>",
        },
    ]
    round_ = {"tickmode": "linear", "dtick": 45, "ticksuffix": "°", "gridcolor": "#e6eaee"}
    return {
        "data": traces,
        "layout": layout(
            polar={
                "angularaxis": round_ | {"linecolor": "#8a94a0"},
                "radialaxis": {
                    "angle": 22.5,
                    "tickangle": 0,
                    "nticks": 3,
                    "gridcolor": "#e6eaee",
                    "rangemode": "tozero",
                },
            },
            legend=LEGEND,
            margin={"l": 48, "r": 48, "t": 40, "b": 70},
        ),
    }
