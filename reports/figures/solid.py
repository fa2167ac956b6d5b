"""Parts of 3-D views: lines, joints by type, axes; lengths in mm, equal on all axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reports.figures.theme import FONT, LINE, SOFT, layout, rounded
from reports.page import plain

Array = NDArray[Any]


@dataclass(frozen=True)
class JointStyle:
    """How a type of joint is drawn; shape and colour both tell it."""

    label: str
    colour: str
    symbol: str


JOINT_STYLES: Mapping[str, JointStyle] = MappingProxyType(
    {
        "revolute": JointStyle("revolute joint", "#0072b2", "circle"),
        "prismatic": JointStyle("prismatic joint", "#d55e00", "square"),
        "circular": JointStyle("prismatic joint on the circular guide", "#a0522d", "square"),
        "spherical": JointStyle("spherical joint", "#009e73", "diamond"),
        "universal": JointStyle("universal joint", "#cc79a7", "cross"),
        "cylindrical": JointStyle("cylindrical joint", "#e69f00", "square"),
        "planar": JointStyle("planar joint", "#7a5cc0", "x"),
        "bushing": JointStyle("bushing", "#8c6d1f", "circle"),
        "fixed": JointStyle("fixed joint", "#444444", "x"),
        "support": JointStyle("support", "#000000", "square"),
    }
)


@dataclass(frozen=True)
class DrawnJoint:
    """A joint where it is drawn.

    Parameters
    ----------
    name : str
    style : str
        Key of `JOINT_STYLES`.
    at : (3,)
        m.
    driven : bool
    axis : (3,) or None
        Unit vector of the axis it turns about or slides along.
    """

    name: str
    style: str
    at: Array
    driven: bool = False
    axis: Array | None = None


def segments(
    pairs: Sequence[tuple[Array, Array]], name: str, colour: str, width: float, **changes: Any
) -> dict[str, Any]:
    """Straight lines between points in m, as one trace."""
    gap = np.full(3, np.nan)
    points = np.array([p for first, second in pairs for p in (first, second, gap)])
    return path(points, name, colour, width, **changes)


def path(points: Array, name: str, colour: str, width: float, **changes: Any) -> dict[str, Any]:
    """A line through points in m, (n, 3); NaN parts it."""
    x, y, z = 1e3 * points.reshape(-1, 3).T
    trace: dict[str, Any] = {
        "type": "scatter3d",
        "mode": "lines",
        "x": rounded(x),
        "y": rounded(y),
        "z": rounded(z),
        "name": name,
        "line": {"color": colour, "width": width},
        "hoverinfo": "skip",
        "connectgaps": False,
    }
    return trace | changes


def points(
    at: Array, labels: Sequence[str], name: str, colour: str, symbol: str, **changes: Any
) -> dict[str, Any]:
    """Markers at points in m, (n, 3), each with a label that shows under the pointer."""
    x, y, z = 1e3 * at.reshape(-1, 3).T
    trace: dict[str, Any] = {
        "type": "scatter3d",
        "mode": "markers",
        "x": rounded(x),
        "y": rounded(y),
        "z": rounded(z),
        "name": name,
        "text": [plain(label) for label in labels],
        "hoverinfo": "text",
        "marker": {
            "color": colour,
            "symbol": symbol,
            "size": 6,
            "line": {"color": "#ffffff", "width": 1},
        },
    }
    return trace | changes


def joints(drawn: Sequence[DrawnJoint], size: float) -> list[dict[str, Any]]:
    """Joints by type, the driven ones ringed, axes as short lines of half-length `size` m."""
    traces = []
    for key, style in JOINT_STYLES.items():
        some = [j for j in drawn if j.style == key]
        if not some:
            continue
        axes = [(j.at - size * j.axis, j.at + size * j.axis) for j in some if j.axis is not None]
        if axes:
            traces.append(
                segments(axes, style.label, style.colour, 3, showlegend=False, legendgroup=key)
            )
        labels = [f"{j.name}: {style.label}{', driven' if j.driven else ''}" for j in some]
        traces.append(
            points(
                np.array([j.at for j in some]),
                labels,
                style.label,
                style.colour,
                style.symbol,
                legendgroup=key,
            )
        )
    driven = [j for j in drawn if j.driven]
    if driven:
        ring = {"color": "#000000", "symbol": "circle-open", "size": 13, "line": {"width": 2}}
        at = np.array([j.at for j in driven])
        traces.append(
            points(at, [""] * len(driven), "driven", "#000000", "circle-open")
            | {"marker": ring, "hoverinfo": "skip"}
        )
    return traces


def triad(origin: Array, rotation: Array, size: float) -> list[dict[str, Any]]:
    """Axes x, y, z of a frame with their letters."""
    tips = origin + size * rotation.T
    lines = segments(
        [(origin, tip) for tip in tips], "tool axes", SOFT, 3, showlegend=False
    )
    x, y, z = 1e3 * (origin + 1.25 * size * rotation.T).T
    letters = {
        "type": "scatter3d",
        "mode": "text",
        "x": rounded(x),
        "y": rounded(y),
        "z": rounded(z),
        "text": ["x", "y", "z"],
        "textfont": {"family": FONT, "size": 13, "color": SOFT},
        "hoverinfo": "skip",
        "showlegend": False,
    }
    return [lines, letters]


def scene(traces: Sequence[dict[str, Any]], **changes: Any) -> dict[str, Any]:
    """A rotatable view of traces, the same scale on all axes."""

    def side(title: str) -> dict[str, Any]:
        return {
            "title": {"text": title},
            "backgroundcolor": "#f7f9fb",
            "gridcolor": LINE,
            "showbackground": True,
            "zerolinecolor": LINE,
            "tickfont": {"size": 11},
            "nticks": 6,
        }

    view = {
        "aspectmode": "data",
        "dragmode": "orbit",
        "xaxis": side("x (mm)"),
        "yaxis": side("y (mm)"),
        "zaxis": side("z (mm)"),
        "camera": {"eye": {"x": 1.25, "y": -1.35, "z": 0.85}, "center": {"x": 0, "y": 0, "z": -0.1}},
    }
    margin = {"l": 0, "r": 0, "t": 8, "b": 8}
    legend = {"orientation": "h", "x": 0, "y": 0, "yanchor": "top", "itemsizing": "constant"}
    return {
        "data": list(traces),
        "layout": layout(scene=view, margin=margin, legend=legend, **changes),
    }
