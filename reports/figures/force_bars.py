"""Forces of joints as bars, with limits and published numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.reports.figures.curves import LIMIT, limit_lines
from strutwork.reports.figures.theme import INK, axis, layout, rounded
from strutwork.reports.numbers import significant
from strutwork.reports.page import plain

Array = NDArray[Any]


@dataclass(frozen=True)
class ForceBars:
    """Bars of one kind of force, with what is printed beside them.

    Parameters
    ----------
    name : str
    values : (n,)
        kN.
    colour : str
    pattern : str
    published : (n,), optional
        kN; drawn as markers on the bars.
    published_name : str
    limits : (n,), optional
        Where they differ from bar to bar, kN; not a number where there is none.
    """

    name: str
    values: ArrayLike
    colour: str
    pattern: str = ""
    published: ArrayLike | None = None
    published_name: str = "published"
    limits: ArrayLike | None = None


def force_bars(
    categories: Sequence[str],
    bars: Sequence[ForceBars],
    title: str,
    limits: Mapping[str, float] | None = None,
) -> dict[str, Any]:
    """Bars side by side, published numbers as markers, limits as lines across.

    Parameters
    ----------
    categories : sequence of str
    bars : sequence of ForceBars
    title : str
        Of the axis, with the unit.
    limits : mapping of label to float, optional
        kN.
    """
    limits = dict(limits or {})
    names = [plain(c) for c in categories]
    traces: list[dict[str, Any]] = []
    top = max(float(np.max(np.asarray(b.values, dtype=float))) for b in bars)
    for i, b in enumerate(bars):
        values = np.asarray(b.values, dtype=float)
        traces.append(
            {
                "type": "bar",
                "name": plain(b.name),
                "x": names,
                "y": rounded(values),
                "offsetgroup": str(i),
                "text": [significant(float(v)) for v in values],
                "textposition": "outside",
                "textangle": 0 if len(names) * len(bars) <= 18 else -90,
                "textfont": {"size": 11},
                "cliponaxis": False,
                "marker": {
                    "color": b.colour,
                    "line": {"color": INK, "width": 1},
                    "pattern": {
                        "shape": b.pattern,
                        "fgcolor": INK,
                        "bgcolor": b.colour,
                        "size": 6,
                        "solidity": 0.2,
                    },
                },
                "hovertemplate": "%{x}: %{y:.4g} kN<extra>" + plain(b.name) + "</extra>",
            }
        )
        if b.published is not None:
            printed = np.asarray(b.published, dtype=float)
            top = max(top, float(printed.max()))
            symbol = "diamond" if i == 0 else "circle"
            traces.append(_on_bars(names, printed, i, len(bars), b.published_name, symbol))
        if b.limits is not None and np.any(np.isfinite(np.asarray(b.limits, dtype=float))):
            allowed = np.asarray(b.limits, dtype=float)
            top = max(top, float(np.nanmax(allowed)))
            traces.append(_on_bars(names, allowed, i, len(bars), f"limit, {b.name}", "line-ew"))
    shapes, notes = limit_lines(limits)
    top = max([top, *limits.values()])
    numeric = {
        "zeroline": False,
        # a label that hangs to the right would be dropped at the edge
        "tickangle": -35 if len(names) > 6 else 0,
        "ticklabeloverflow": "allow",
        "tickmode": "array",
        "tickvals": list(range(len(names))),
        "ticktext": names,
        "range": [-0.5, len(names) - 0.5],
    }
    # bars stand at whole numbers, so that markers can be put on them
    for trace in traces:
        if trace["type"] == "bar":
            trace["customdata"] = trace["x"]
            trace["x"] = list(range(len(names)))
            trace["hovertemplate"] = trace["hovertemplate"].replace("%{x}", "%{customdata}")
    return {
        "data": traces,
        "layout": layout(
            barmode="group",
            bargap=0.2,
            xaxis=axis("", **numeric),
            yaxis=axis(title, range=[0, 1.18 * top]),
            shapes=shapes,
            annotations=notes,
        ),
    }


def _on_bars(
    names: Sequence[str], values: Array, group: int, groups: int, name: str, symbol: str
) -> dict[str, Any]:
    """Markers on the bars of one group, beside the numbers on top."""
    width = 0.8 / groups
    bar = symbol == "line-ew"
    x = np.arange(len(names)) - 0.4 + width * (group + (0.5 if bar else 0.86))
    return {
        "type": "scatter",
        "mode": "markers",
        "name": plain(name),
        "x": rounded(x),
        "y": rounded(values),
        "customdata": list(names),
        "marker": {
            "symbol": symbol,
            "size": 26 if bar else 9,
            "color": LIMIT if bar else "#ffffff",
            "line": {"color": LIMIT if bar else "#000000", "width": 3 if bar else 2},
        },
        "hovertemplate": "%{customdata}: %{y:.4g} kN<extra>" + plain(name) + "</extra>",
    }
