"""A structure from a model file in 3-D, as it stands and deformed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.extent import model_size
from strutwork.machines.model import Model
from strutwork.machines.model_solid_element import SolidElement
from strutwork.msa import LoadCase, StaticSolution
from strutwork.msa.sections import Section
from strutwork.reports.figures.shapes import Shape, ball, box, cylinder, mesh
from strutwork.reports.figures.solid import (
    DrawnJoint,
    colour_bar,
    joint_traces,
    path,
    scene,
    segments,
    straight,
    turning,
)
from strutwork.reports.figures.theme import LEGEND, rounded
from strutwork.reports.page import plain

Array = NDArray[Any]

#: Points drawn along each beam element of a deformed shape.
FINE = 9


def model_view(model: Model) -> dict[str, Any]:
    """Beams, rigid bodies, joints by type, supports, springs and the tool."""
    size = model_size(model)
    structure = model.structure
    widest = max((w for b in structure.beams for w in b.section.outline), default=0.0)
    symbol = min(max(0.02 * size, 0.7 * widest), 0.035 * size)
    at = dict(zip(structure.linkage.nodes, model.placement.positions, strict=True))
    traces = []
    if structure.beams:
        traces.append(mesh(_beams(model, size), "beam", "#8fa1b3"))
    if model.solids:
        places = [s.points_at(model.placed) for s in model.solids]
        shapes = [
            Shape(p, s.triangles, _named(s)) for s, p in zip(model.solids, places, strict=True)
        ]
        # glass, so that nodes and joints behind it stay in sight
        traces.append(mesh(shapes, "solid", "#b9b2a6", opacity=0.45, flatshading=True))
        edges = _edges(model)
        traces.append(segments(edges, "edge of a solid", "#7d766b", 2, showlegend=False))
    spokes = _spokes(model, at)
    if spokes:
        traces.append(segments(spokes, "rigid body", "#3d4854", 5))
    pairs = [tuple(at[n] for n in s.nodes) for s in structure.springs if len(s.nodes) == 2]
    if pairs:
        traces.append(
            segments(
                pairs, "spring", "#7a5cc0", 5, line={"color": "#7a5cc0", "dash": "dot", "width": 5}
            )
        )
    grounded = [s for s in structure.springs if len(s.nodes) == 1]
    if grounded:
        shapes = [
            ball(at[s.nodes[0]], 0.6 * symbol, f"{s.name}: spring to ground") for s in grounded
        ]
        traces.append(mesh(shapes, "spring to ground", "#7a5cc0"))
    traces += joint_traces(_joints(model, at, symbol), symbol)
    if model.tool is not None:
        tip = ball(at[model.tool], 0.55 * symbol, f"{model.tool}: tool centre point")
        traces.append(mesh([tip], "tool centre point", "#a02c2c"))
    traces.append(_nodes(model, at))
    return scene(traces)


def marked_view(model: Model, names: Sequence[str]) -> dict[str, Any]:
    """The same with some beams, joints, springs or solids in red.

    Parameters
    ----------
    model : Model
    names : sequence of str
    """
    figure = model_view(model)
    size = model_size(model)
    at = dict(zip(model.structure.linkage.nodes, model.placement.positions, strict=True))
    known = set(names)
    shapes = []
    start, end = model.placed.beam_ends
    for beam, a, b in zip(model.structure.beams, start, end, strict=True):
        if beam.name in known:
            widest = max((min(w, 0.06 * size) for w in beam.section.outline), default=0.012 * size)
            shapes.append(cylinder(a, b, 0.6 * widest, beam.name))
    nodes = [(j.name, j.between[-1]) for j in model.structure.linkage.joints]
    nodes += [(s.name, s.nodes[-1]) for s in model.structure.springs]
    # larger than the symbols of joints
    shapes += [ball(at[node], 0.042 * size, name) for name, node in nodes if name in known]
    shapes += [
        Shape(s.points_at(model.placed), s.triangles, _named(s))
        for s in model.solids
        if s.name in known
    ]
    if shapes:
        figure["data"].append(mesh(shapes, "deforms most", "#c62828"))
    # what the symbols mean stands beside the drawing of the structure
    figure["layout"]["showlegend"] = False
    return figure


def deformed_view(
    model: Model, shape: Array, moved: Array, case: LoadCase, label: str
) -> dict[str, Any]:
    """The undeformed lines in grey and the exaggerated ones, coloured by displacement.

    Parameters
    ----------
    model : Model
    shape : (n, 3)
        Points of the exaggerated shape, m; NaN parts the lines.
    moved : (n,)
        Displacement at each point, m.
    case : LoadCase
        Its forces are drawn as arrows.
    label : str
        Title of the colour bar.
    """
    at = dict(zip(model.structure.linkage.nodes, model.placement.positions, strict=True))
    start, end = model.placed.beam_ends
    resting = [*zip(start, end, strict=True), *_spokes(model, at)]
    resting += _edges(model)
    scale = {
        "color": rounded(np.nan_to_num(moved) * 1e6, 5),
        "colorscale": "Viridis",
        "width": 8,
        "showscale": True,
        "colorbar": colour_bar(label),
    }
    texts = [f"{m * 1e6:.4g} µm" if np.isfinite(m) else "" for m in moved]
    bent = path(
        shape, "deformed", "#000000", 8, line=scale, hoverinfo="text", text=texts, showlegend=False
    )
    traces = [segments(resting, "undeformed", "#8a94a0", 3), bent]
    arrows = _arrows(model, case, at)
    if arrows is not None:
        traces.append(path(arrows, "force", "#a02c2c", 5))
    figure = scene(traces)
    # room below for the colour bar, above the legend
    figure["layout"]["margin"] = figure["layout"]["margin"] | {"b": 100}
    figure["layout"]["legend"] = LEGEND
    return figure


def deformed_shape(
    model: Model, solution: StaticSolution, case: int, factor: float
) -> tuple[Array, Array]:
    """Points of the deformed lines, (n, 3) in m, and the true displacement there, (n,) in m.

    Along a beam element between the cubic (Hermite) shape of its end displacements and
    rotations; across rigid bodies straight; of a solid its edges. NaN parts the lines.
    """
    structure = model.structure
    positions, u = model.placed.positions, solution.displacements[..., case]
    share = np.linspace(0.0, 1.0, FINE)[:, None]
    gap = np.full((1, 3), np.nan)
    lines, moves = [], []
    for _, first, second in structure.segments:
        a, b = positions[first], positions[second]
        move = _between(b - a, u[first], u[second], share)
        lines += [a + share * (b - a) + factor * move, gap]
        moves += [move, gap]
    index = structure.linkage.node_index
    for solid in model.solids:
        motion = solid.motion(u[[index[n] for n in solid.nodes]], model.placed)
        points = solid.points_at(model.placed)
        for pair in solid.outline:
            lines += [points[pair] + factor * motion[pair], gap]
            moves += [motion[pair], gap]
    for group in _rigid_groups(model):
        rows = [index[n] for n in group]
        centre, shift = positions[rows].mean(axis=0), u[rows, :3].mean(axis=0)
        for row in rows:
            ends = np.stack([centre, positions[row]])
            move = np.stack([shift, u[row, :3]])
            lines += [ends + factor * move, gap]
            moves += [move, gap]
    if not lines:
        return np.zeros((0, 3)), np.zeros(0)
    return np.concatenate(lines), np.asarray(np.linalg.norm(np.concatenate(moves), axis=1))


def _between(span: Array, first: Array, second: Array, share: Array) -> Array:
    """Displacement along an element from those of its ends, (k, 3)."""
    length = np.linalg.norm(span)
    along = span / length
    s = share
    linear = (1 - s) * first[:3] + s * second[:3]
    cubic = (1 - 3 * s**2 + 2 * s**3) * first[:3] + (3 * s**2 - 2 * s**3) * second[:3]
    cubic = cubic + length * (s - 2 * s**2 + s**3) * np.cross(first[3:], along)
    cubic = cubic + length * (s**3 - s**2) * np.cross(second[3:], along)
    axial = (linear @ along)[:, None] * along
    return np.asarray(axial + cubic - (cubic @ along)[:, None] * along)


def _beams(model: Model, size: float) -> list[Shape]:
    start, end = model.placed.beam_ends
    length, axes = model.placed.beam_geometry
    shapes = []
    for i, beam in enumerate(model.structure.beams):
        label = f"{beam.name}: {beam.section.name}, {1e3 * float(length[i]):.4g} mm"
        widths = [min(w, 0.06 * size) for w in beam.section.outline] or [0.012 * size] * 2
        if _is_round(beam.section) or not beam.section.outline:
            shapes.append(cylinder(start[i], end[i], widths[0] / 2, label))
        else:
            sizes = (float(length[i]), widths[0], widths[1])
            shapes.append(box((start[i] + end[i]) / 2, axes[i].T, sizes, label))
    return shapes


def _edges(model: Model) -> list[tuple[Array, Array]]:
    """Edges of the solids where these stand."""
    found: list[tuple[Array, Array]] = []
    for solid in model.solids:
        points = solid.points_at(model.placed)
        found += [(points[a], points[b]) for a, b in solid.outline]
    return found


def _named(solid: SolidElement) -> str:
    return f"{solid.name}: {', '.join(solid.materials)}, {solid.weighed[0]:.4g} kg"


def _is_round(section: Section) -> bool:
    polar = section.second_moment_y + section.second_moment_z
    return bool(np.isclose(section.torsion_constant, polar, rtol=1e-6))


def _rigid_groups(model: Model) -> list[tuple[str, ...]]:
    structure = model.structure
    flexible = structure.flexible_bodies
    names = structure.linkage.body_names
    bodies = [
        b
        for b in structure.linkage.bodies
        if b.name in names and names.index(b.name) not in flexible
    ]
    return [b.nodes for b in (*structure.rigid, *bodies) if len(b.nodes) > 1]


def _spokes(model: Model, at: dict[str, Array]) -> list[tuple[Array, Array]]:
    """Lines from the middle of each rigid group to its nodes."""
    pairs = []
    for group in _rigid_groups(model):
        centre = np.mean([at[n] for n in group], axis=0)
        pairs += [(centre, at[n]) for n in group]
    return pairs


def _joints(model: Model, at: dict[str, Array], symbol: float) -> list[DrawnJoint]:
    held = set(model.supports.values())
    drawn = []
    for joint, frame in zip(model.structure.linkage.joints, model.placement.frames, strict=True):
        point = at[joint.between[1]]
        driven = tuple(
            (turning if d.startswith("r") else straight)(
                point, frame[:, "xyz".index(d[-1])], symbol
            )
            for d in joint.driven
        )
        style = "support" if joint.name in held else joint.type
        drawn.append(DrawnJoint(joint.name, style, point, frame, driven))
    return drawn


def _nodes(model: Model, at: dict[str, Array]) -> dict[str, Any]:
    x, y, z = 1e3 * np.array([at[n] for n in model.nodes]).T
    labels = [
        f"{plain(n)}<br>{1e3 * at[n][0]:.4g}, {1e3 * at[n][1]:.4g}, {1e3 * at[n][2]:.4g} mm"
        for n in model.nodes
    ]
    return {
        "type": "scatter3d",
        "mode": "markers",
        "name": "node",
        "x": rounded(x),
        "y": rounded(y),
        "z": rounded(z),
        "text": labels,
        "hoverinfo": "text",
        "marker": {"size": 3, "color": "#1b2430"},
    }


def _arrows(model: Model, case: LoadCase, at: dict[str, Array]) -> Array | None:
    """Arrows that end at the loaded nodes, in the sense of the forces."""
    forces = [(at[n], np.asarray(w[:3], dtype=float)) for n, w in case.wrenches if any(w[:3])]
    if not forces:
        return None
    size = model_size(model)
    largest = max(float(np.linalg.norm(f)) for _, f in forces)
    gap = np.full((1, 3), np.nan)
    parts = []
    for tip, force in forces:
        way = force / np.linalg.norm(force)
        tail = tip - (0.06 + 0.10 * float(np.linalg.norm(force)) / largest) * size * way
        side = np.cross(way, np.eye(3)[int(np.abs(way).argmin())])
        side /= np.linalg.norm(side)
        back = tip - 0.035 * size * way
        parts += [np.stack([tail, tip, back + 0.014 * size * side]), gap]
        parts += [np.stack([tip, back - 0.014 * size * side]), gap]
    return np.concatenate(parts)
