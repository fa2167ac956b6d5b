"""Mode shapes that move and frequency responses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.machines.model_solid_element import SolidElement
from strutwork.reports.figures.solid import colour_bar, path, scene
from strutwork.reports.figures.theme import INK, LEGEND, axis, layout, rounded
from strutwork.reports.numbers import significant
from strutwork.reports.page import plain
from strutwork.reports.vibration_study import VibrationStudy

Array = NDArray[Any]

#: The largest motion of a mode is drawn as this share of the structure's size.
EXAGGERATION = 0.09

#: Points of solids' surfaces beyond which a page would carry too much for each of its modes.
MOST_POINTS = 4000

#: Straight pieces of a drawn beam element.
PIECES = 4


def drawn_amplitude(study: VibrationStudy) -> float:
    """Length at which the largest motion of each mode is drawn, m."""
    at = study.placed.positions
    return EXAGGERATION * float(np.linalg.norm(at.max(axis=0) - at.min(axis=0)))


def mode_lines(study: VibrationStudy) -> tuple[Array, Array]:
    """Points of the structure's lines, (n, 3), and their motion in each mode, (m, n, 3).

    Along beams by the cubic of the ends' displacements and rotations; rigid parts straight; of
    solids their edges. NaN parts the lines. Each mode's largest motion is one.
    """
    points, motion = _lines(study)
    return points, motion / _largest(motion)


def _lines(study: VibrationStudy) -> tuple[Array, Array]:
    """As `mode_lines`, the modes as they are normalised."""
    structure, at = study.placed.structure, study.placed.positions
    shapes = study.modes.shapes
    where, moves = [], []
    s = np.linspace(0.0, 1.0, PIECES + 1)[:, None]
    gap = np.full((1, 3), np.nan)
    gaps = np.full((len(shapes), 1, 3), np.nan)
    for _, a, b in structure.segments:
        span = at[b] - at[a]
        length = float(np.linalg.norm(span))
        t = span / length
        first, last = shapes[:, a], shapes[:, b]

        def across(u: Array, along: Array = t) -> Array:
            return np.asarray(u - (u @ along)[:, None] * along)

        ua, ub = first[:, None, :3], last[:, None, :3]
        ta = length * np.cross(first[:, 3:], t)[:, None]
        tb = length * np.cross(last[:, 3:], t)[:, None]
        cubic = (
            (1 - 3 * s**2 + 2 * s**3) * across(first[:, :3])[:, None]
            + (s - 2 * s**2 + s**3) * ta
            + (3 * s**2 - 2 * s**3) * across(last[:, :3])[:, None]
            + (s**3 - s**2) * tb
        )
        axial = ((1 - s) * ua + s * ub) @ t
        where += [at[a] + s * span, gap]
        moves += [cubic + axial[..., None] * t, gaps]
    index = structure.mesh_index
    for solid in (e for e in structure.elements if isinstance(e, SolidElement)):
        motion_of = solid.motion(shapes[:, [index[n] for n in solid.nodes]], study.placed)
        points = solid.points_at(study.placed)
        for pair in solid.outline:
            where += [points[pair], gap]
            moves += [motion_of[:, pair], gaps]
    for a, b in study.lines:
        where += [at[[index[a], index[b]]], gap]
        moves += [shapes[:, [index[a], index[b]], :3], gaps]
    return np.concatenate(where), np.concatenate(moves, axis=1)


def _largest(motion: Array) -> Array:
    """Largest displacement of each mode, (m, 1, 1); one where nothing moves."""
    size = np.nanmax(np.linalg.norm(motion, axis=-1), axis=1)
    return np.asarray(np.where(size > 0, size, 1.0)[:, None, None])


def mode_surfaces(study: VibrationStudy) -> tuple[Array, Array, Array] | None:
    """Surfaces of the solids: points (n, 3), motion in each mode (m, n, 3), triangles (t, 3).

    None without solids, and where they have more points than `MOST_POINTS`: their edges are drawn
    alone.
    """
    structure, shapes = study.placed.structure, study.modes.shapes
    index = structure.mesh_index
    where, moves, faces, start = [], [], [], 0
    for solid in (e for e in structure.elements if isinstance(e, SolidElement)):
        used, corners = np.unique(solid.triangles, return_inverse=True)
        motion_of = solid.motion(shapes[:, [index[n] for n in solid.nodes]], study.placed)
        where.append(solid.points_at(study.placed)[used])
        moves.append(motion_of[:, used])
        faces.append(corners.reshape(-1, 3) + start)
        start += len(used)
    if not 0 < start <= MOST_POINTS:
        return None
    motion = np.concatenate(moves, axis=1)
    return np.concatenate(where), motion, np.concatenate(faces)


def mode_view(study: VibrationStudy, labels: Sequence[str]) -> dict[str, Any]:
    """The structure at rest in grey and swinging in a mode, which the page lets one choose.

    Beside `data` and `layout` the figure has `motion`: the trace that moves, its points at rest
    and the motion of each mode, mm.
    """
    points, motion = _lines(study)
    largest = _largest(motion)
    motion = motion / largest
    amplitude = drawn_amplitude(study)
    reach = np.concatenate([points + amplitude * sign * m for m in motion for sign in (-1, 1)])
    room = path(reach, "room", "#000000", 1, visible=False)
    resting = path(points, "at rest", "#a9b2bd", 3)
    sizes = [rounded(np.nan_to_num(np.linalg.norm(m, axis=-1)), 3) for m in motion]
    scale = {"color": sizes[0], "colorscale": "Viridis", "cmin": 0.0, "cmax": 1.0, "width": 9}
    scale |= {"showscale": True, "colorbar": colour_bar("motion over the largest")}
    swung = path(
        points + amplitude * motion[0], "swinging", "#0072b2", 9, line=scale, showlegend=False
    )
    figure = scene([resting, swung, room])
    # the invisible trace only sized the view
    figure["data"].pop()
    figure["layout"]["uirevision"] = "keep"
    # below the view: the colour bar, above the legend
    figure["layout"]["margin"] = figure["layout"]["margin"] | {"b": 100}
    figure["layout"]["legend"] = LEGEND
    modes = [
        {
            "label": label,
            "size": size,
            **dict(zip("xyz", (rounded(1e3 * amplitude * c, 4) for c in m.T), strict=True)),
        }
        for label, size, m in zip(labels, sizes, motion, strict=True)
    ]
    rest = dict(zip("xyz", (rounded(1e3 * c) for c in points.T), strict=True))
    moving: dict[str, Any] = {"trace": 1, "rest": rest, "modes": modes}
    surfaces = mode_surfaces(study)
    if surfaces is not None:
        where, swings, faces = surfaces
        trace, moving["also"] = _swinging(where, swings / largest, faces, amplitude)
        figure["data"].append(trace)
    return figure | {"motion": moving}


def _swinging(
    where: Array, motion: Array, faces: Array, amplitude: float
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The trace of surfaces, and what moves it beside the lines."""
    modes = [
        {
            "size": rounded(np.linalg.norm(m, axis=-1), 3),
            **dict(zip("xyz", (rounded(1e3 * amplitude * c, 3) for c in m.T), strict=True)),
        }
        for m in motion
    ]
    at = (where + amplitude * motion[0]).T
    trace = {
        "type": "mesh3d",
        "name": "solids",
        **dict(zip("xyz", (rounded(1e3 * c) for c in at), strict=True)),
        **dict(zip("ijk", (corner.tolist() for corner in faces.T), strict=True)),
        "intensity": modes[0]["size"],
        "colorscale": "Viridis",
        "cmin": 0.0,
        "cmax": 1.0,
        "showscale": False,
        "opacity": 0.8,
        "flatshading": True,
        "hoverinfo": "skip",
    }
    rest = dict(zip("xyz", (rounded(1e3 * c) for c in where.T), strict=True))
    return trace, {"trace": 2, "colour": "intensity", "rest": rest, "modes": modes}


def responses(
    curves: Mapping[str, tuple[ArrayLike, ArrayLike, str, str]],
    marks: Sequence[tuple[str, float, float, str]],
) -> dict[str, Any]:
    """Receptance magnitudes over frequency, both logarithmic, with the exact minima marked.

    Parameters
    ----------
    curves : mapping of name to ((f,), (f,), str, str)
        Frequencies, Hz; magnitudes, m/N; colour and dash.
    marks : sequence of (str, float, float, str)
        Name, frequency (Hz), least dynamic stiffness (N/m) and colour of each minimum.
    """
    traces: list[dict[str, Any]] = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": plain(name),
            "x": rounded(frequencies, 6),
            "y": rounded(1e6 * np.asarray(values, dtype=float), 5),
            "line": {"color": colour, "width": 2, "dash": dash},
            "hovertemplate": "%{x:.5g} Hz: %{y:.4g} µm/N<extra>" + plain(name) + "</extra>",
        }
        for name, (frequencies, values, colour, dash) in curves.items()
    ]
    traces += [
        {
            "type": "scatter",
            "mode": "markers",
            "name": plain(name),
            "showlegend": False,
            "x": rounded([frequency]),
            "y": rounded([1e6 / value]),
            "marker": {
                "symbol": "diamond",
                "size": 11,
                "color": colour,
                "line": {"color": INK, "width": 1.5},
            },
            "hovertemplate": f"%{{x:.6g}} Hz: {significant(value / 1e6)} N/µm, the "
            f"least<extra>{plain(name)}</extra>",
        }
        for name, frequency, value, colour in marks
    ]
    return {
        "data": traces,
        "layout": layout(
            xaxis=axis("frequency (Hz)", type="log", dtick="D2", tickangle=0),
            yaxis=axis("receptance (µm/N)", type="log", exponentformat="power", dtick=1),
        ),
    }


def sensitivity(
    x: ArrayLike,
    curves: Mapping[str, tuple[ArrayLike, str, str]],
    x_title: str,
    mark: float | None,
) -> dict[str, Any]:
    """Least dynamic stiffness against a parameter, logarithmic, with the value in use marked.

    Parameters
    ----------
    x : (n,)
    curves : mapping of name to ((n,), str, str)
        N/m; colour and dash.
    x_title : str
    mark : float or None
        Where a vertical line stands.
    """
    traces = [
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": plain(name),
            "x": rounded(x),
            "y": rounded(np.asarray(values, dtype=float) / 1e6),
            "line": {"color": colour, "width": 2, "dash": dash},
            "marker": {"size": 6},
            "hovertemplate": "%{x:.4g}: %{y:.4g} N/µm<extra>" + plain(name) + "</extra>",
        }
        for name, (values, colour, dash) in curves.items()
    ]
    line = {
        "type": "line",
        "yref": "paper",
        "y0": 0,
        "y1": 1,
        "line": {"color": INK, "dash": "dot"},
    }
    return {
        "data": traces,
        "layout": layout(
            xaxis=axis(x_title),
            yaxis=axis(
                "least dynamic stiffness (N/µm)", type="log", exponentformat="power", dtick=1
            ),
            legend=LEGEND,
            shapes=[] if mark is None else [line | {"x0": mark, "x1": mark}],
        ),
    }
