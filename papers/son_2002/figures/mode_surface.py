"""Mode shapes of a machine on its granite: a coloured surface that swings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea.solid_fields import SurfaceField
from strutwork.papers.son_2002.modes import ModePicture
from strutwork.reports.figures.shapes import Shape, cylinder, mesh
from strutwork.reports.figures.solid import scene, segments
from strutwork.reports.figures.theme import rounded

Array = NDArray[Any]

#: Radius of the mechanism's lines, which matters for the drawing alone, m.
LINE_RADIUS = 0.011

#: Neighbouring faces that turn by more than this make an edge of the outline, as a cosine.
EDGE = 0.5

#: From the front, where the machine stands before the granite's plate.
CAMERA = {"eye": {"x": 1.1, "y": 1.85, "z": 0.75}, "center": {"x": 0, "y": 0, "z": -0.2}}


def mode_surface(picture: ModePicture, name: str = "displacement") -> SurfaceField:
    """Granite and mechanism as one surface, its lines as thin rods."""
    rods = [_rod(picture, pair) for pair in picture.lines]
    quads = picture.faces
    triangles = [np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])]
    start = len(picture.points)
    for shape, _ in rods:
        triangles.append(shape.faces + start)
        start += len(shape.vertices)
    displacement = np.concatenate([picture.displacement, *(motion for _, motion in rods)])
    return SurfaceField(
        np.concatenate([picture.points, *(shape.vertices for shape, _ in rods)]),
        np.concatenate(triangles),
        np.linalg.norm(displacement, axis=1),
        displacement,
        name,
    )


def _rod(picture: ModePicture, pair: Array) -> tuple[Shape, Array]:
    """A rod between two nodes and the displacement of its points."""
    (a, b), (ua, ub) = picture.nodes[pair], picture.node_displacement[pair]
    shape = cylinder(a, b, LINE_RADIUS, sides=8)
    along = (shape.vertices - a) @ (b - a) / ((b - a) @ (b - a))
    return shape, ua + along[:, None] * (ub - ua)


def outline(picture: ModePicture) -> list[tuple[Array, Array]]:
    """The granite's edges at rest, as pairs of points in m."""
    corners = picture.points[picture.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    edges = np.stack([picture.faces, np.roll(picture.faces, -1, axis=1)], axis=-1).reshape(-1, 2)
    owner = np.repeat(np.arange(len(picture.faces)), picture.faces.shape[1])
    order = np.lexsort(np.sort(edges, axis=1).T)
    # a closed surface has every edge twice
    first, second = order[::2], order[1::2]
    turned = np.einsum("ij,ij->i", normals[owner[first]], normals[owner[second]]) < EDGE
    return [(picture.points[a], picture.points[b]) for a, b in edges[first[turned]]]


def modes_view(pictures: Mapping[str, ModePicture]) -> dict[str, Any]:
    """Shapes that the page lets one choose, turn and set swinging; at rest in grey.

    Beside `data` and `layout` the figure has `motion`: the trace that moves, what of it carries
    the colour, its points at rest and the motion of each mode, mm.

    Parameters
    ----------
    pictures : mapping of label to ModePicture
        Of one machine at one pose, in which only the displacements differ.
    """
    fields = {label: mode_surface(p) for label, p in pictures.items()}
    picture, field = next(iter(pictures.values())), next(iter(fields.values()))
    rest = [
        segments(outline(picture), "granite at rest", "#8a94a0", 3),
        segments([tuple(picture.nodes[pair]) for pair in picture.lines], "machine at rest",
                 "#5f6b78", 3),
    ]  # fmt: skip
    moved = {label: _drawn(f) for label, f in fields.items()}
    first = next(iter(moved.values()))
    swung = mesh(
        [Shape(field.points + first, field.triangles)],
        "displacement, share of the largest",
        "#0072b2",
        intensity=_colours(field),
        colorscale="Viridis",
        cmin=0.0,
        cmax=1.0,
        flatshading=True,
        showlegend=False,
        hoverinfo="skip",
        colorbar={
            "thickness": 12,
            "len": 0.6,
            "outlinewidth": 0,
            "title": {"text": "share of the largest displacement", "side": "right"},
        },
    )
    del swung["text"]
    # the invisible trace only sizes the view
    reach = [field.points + side * shift for shift in moved.values() for side in (-1, 1)]
    low, high = (pick([pick(r, axis=0) for r in reach], axis=0) for pick in (np.min, np.max))
    figure = scene([swung, *rest, segments([(low, high)], "room", "#000000", 1)])
    figure["data"].pop()
    figure["layout"]["uirevision"] = "keep"
    figure["layout"]["scene"]["camera"] = CAMERA
    at = dict(zip("xyz", (rounded(1e3 * c, 5) for c in field.points.T), strict=True))
    modes = [
        {
            "label": label,
            "size": _colours(fields[label]),
            **dict(zip("xyz", (rounded(1e3 * c, 4) for c in shift.T), strict=True)),
        }
        for label, shift in moved.items()
    ]
    return figure | {"motion": {"trace": 0, "colour": "intensity", "rest": at, "modes": modes}}


def _drawn(field: SurfaceField) -> Array:
    """Displacement as it is drawn at full swing, m."""
    return field.drawing_scale * field.displacement


def _colours(field: SurfaceField) -> list[Any]:
    return rounded(field.values / field.values.max(), 3)
