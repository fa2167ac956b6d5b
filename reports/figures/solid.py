"""Parts of 3-D views: lines, joints by type, axes; lengths in mm, equal on all axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.figures.camera import camera_of
from strutwork.reports.figures.shapes import Shape, across, ball, box, cylinder, mesh
from strutwork.reports.figures.theme import FONT, LINE, SOFT, layout, rounded

Array = NDArray[Any]

#: Diagonal and longest side of a scene's box in the units of its camera, at most.
DIAGONAL, LONGEST_SIDE = 1.85, 1.55


@dataclass(frozen=True)
class JointStyle:
    """How a type of joint is drawn; shape and colour both tell it."""

    label: str
    colour: str
    shape: str


JOINT_STYLES: Mapping[str, JointStyle] = MappingProxyType(
    {
        "revolute": JointStyle("revolute joint", "#0072b2", "pin"),
        "prismatic": JointStyle("prismatic joint", "#d55e00", "block"),
        "circular": JointStyle("prismatic joint along the guide", "#9c4a12", "block"),
        "spherical": JointStyle("spherical joint", "#009e73", "ball"),
        "universal": JointStyle("universal joint", "#b0508a", "ball"),
        "cylindrical": JointStyle("cylindrical joint", "#b37b00", "pin"),
        "helical": JointStyle("helical joint", "#7a4b00", "pin"),
        "planar": JointStyle("planar joint", "#7a5cc0", "block"),
        "bushing": JointStyle("bushing", "#8c6d1f", "ball"),
        "fixed": JointStyle("fixed joint", "#444444", "block"),
        "support": JointStyle("support", "#000000", "block"),
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
    frame : (3, 3)
        Joint axes as columns; the third is the joint's axis.
    driven : tuple of (3, n) arrays
        Paths of driven motions, drawn as arrows with two heads, m.
    """

    name: str
    style: str
    at: Array
    frame: Array
    driven: tuple[Array, ...] = ()


def joint_traces(drawn: Sequence[DrawnJoint], size: float) -> list[dict[str, Any]]:
    """Joints by type as solid symbols of about `size` m, driven motions as arrows."""
    traces = []
    for key, style in JOINT_STYLES.items():
        shapes = [_symbol(j, style, size) for j in drawn if j.style == key]
        if shapes:
            traces.append(mesh(shapes, style.label, style.colour, legendgroup=key))
    arrows = [path for joint in drawn for path in joint.driven]
    if arrows:
        points = np.concatenate([_arrow(a, 0.45 * size) for a in arrows])
        traces.append(path(points, "driven motion", "#000000", 5))
    return traces


def _symbol(joint: DrawnJoint, style: JointStyle, size: float) -> Shape:
    label = f"{joint.name}: {style.label}{', driven' if joint.driven else ''}"
    if style.shape == "ball":
        return ball(joint.at, 0.62 * size, label)
    if style.shape == "pin":
        reach = 1.5 * size * joint.frame[:, 2]
        return cylinder(joint.at - reach, joint.at + reach, 0.32 * size, label)
    return box(joint.at, joint.frame, (1.1 * size, 1.1 * size, 1.5 * size), label)


def straight(at: Array, direction: Array, size: float) -> Array:
    """Path of a translation for `DrawnJoint.driven`, beside the joint, (n, 3)."""
    beside = at + 1.4 * size * across(direction)[0]
    return np.stack([beside - 2.5 * size * direction, beside + 2.5 * size * direction])


def turning(at: Array, axis: Array, size: float) -> Array:
    """Path of a rotation for `DrawnJoint.driven`: three quarters of a circle, (n, 3)."""
    u, v = across(axis)
    turn = np.linspace(0.0, 1.5 * np.pi, 37)[:, None]
    return np.asarray(at + 1.6 * size * (np.cos(turn) * u + np.sin(turn) * v))


def _arrow(points: Array, head: float) -> Array:
    """A path with a head at both ends, ended by NaN, (n, 3)."""
    gap = np.full((1, 3), np.nan)
    parts = [points, gap]
    for tip, before in ((points[0], points[1]), (points[-1], points[-2])):
        back = (before - tip) / np.linalg.norm(before - tip)
        for side in across(back):
            for sign in (-1.0, 1.0):
                barb = tip + head * (back + 0.45 * sign * side)
                parts += [np.stack([tip, barb]), gap]
    return np.concatenate(parts)


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


def triad(origin: Array, rotation: Array, size: float) -> list[dict[str, Any]]:
    """Axes x, y, z of a frame with their letters."""
    tips = origin + size * rotation.T
    lines = segments([(origin, tip) for tip in tips], "tool axes", SOFT, 4, showlegend=False)
    x, y, z = 1e3 * (origin + 1.2 * size * rotation.T).T
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


def colour_bar(title: str) -> dict[str, Any]:
    """A colour bar below a view, above its legend."""
    return {
        "orientation": "h",
        "title": {"text": title, "side": "top"},
        "thickness": 14,
        "len": 0.8,
        "x": 0.5,
        "y": 0.0,
        "yanchor": "top",
        "outlinewidth": 0,
    }


def _bounds(traces: Sequence[dict[str, Any]]) -> tuple[Array, Array]:
    """Box about everything drawn, with some air and no side that is flat, mm."""
    drawn = [np.array([t[a] for a in "xyz"], dtype=float) for t in traces]
    points = np.concatenate(drawn, axis=1)
    low, high = np.nanmin(points, axis=1), np.nanmax(points, axis=1)
    size = np.maximum(1.08 * (high - low), 0.2 * max(float((high - low).max()), 1e-3))
    return (low + high - size) / 2, (low + high + size) / 2


def scene(traces: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """A rotatable view of traces, the same scale on all axes."""
    low, high = _bounds(traces)
    ratio = (high - low) * min(
        DIAGONAL / np.linalg.norm(high - low), LONGEST_SIDE / (high - low).max()
    )

    def side(axis: int) -> dict[str, Any]:
        return {
            "title": {"text": f"{'xyz'[axis]} (mm)"},
            "range": [float(low[axis]), float(high[axis])],
            "backgroundcolor": "#f7f9fb",
            "gridcolor": LINE,
            "showbackground": True,
            "zerolinecolor": LINE,
            "tickfont": {"size": 11},
            # labels of a short side would stand on one another
            "nticks": 6 if ratio[axis] > 0.4 * ratio.max() else 3,
        }

    view = {
        # plotly's own equal scale lets a long structure run out of the view
        "aspectmode": "manual",
        "aspectratio": dict(zip("xyz", ratio.tolist(), strict=True)),
        "dragmode": "orbit",
        "xaxis": side(0),
        "yaxis": side(1),
        "zaxis": side(2),
        "camera": camera_of(ratio),
    }
    margin = {"l": 0, "r": 0, "t": 8, "b": 8}
    legend = {"orientation": "h", "x": 0, "y": 0, "yanchor": "top", "itemsizing": "constant"}
    return {
        "data": list(traces),
        "layout": layout(scene=view, margin=margin, legend=legend),
    }
