"""Solid shapes for 3-D views: vertices in m and triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.figures.theme import rounded
from strutwork.reports.page import plain

Array = NDArray[Any]


@dataclass(frozen=True)
class Shape:
    """A triangulated surface.

    Parameters
    ----------
    vertices : (n, 3)
        m.
    faces : (t, 3)
        Indices of vertices.
    label : str
        Shows under the pointer.
    """

    vertices: Array
    faces: Array
    label: str = ""


def across(direction: Array) -> tuple[Array, Array]:
    """Two unit vectors across a direction and each other."""
    d = direction / np.linalg.norm(direction)
    first = np.cross(d, np.eye(3)[int(np.abs(d).argmin())])
    first /= np.linalg.norm(first)
    return first, np.cross(d, first)


def cylinder(start: Array, end: Array, radius: float, label: str = "", sides: int = 20) -> Shape:
    """A closed cylinder."""
    u, v = across(end - start)
    turn = 2 * np.pi * np.arange(sides) / sides
    ring = radius * (np.cos(turn)[:, None] * u + np.sin(turn)[:, None] * v)
    vertices = np.concatenate([start + ring, end + ring, [start, end]])
    k = np.arange(sides)
    n = (k + 1) % sides
    first, last = np.full(sides, 2 * sides), np.full(sides, 2 * sides + 1)
    faces = np.concatenate(
        [
            np.stack([k, n, k + sides], -1),
            np.stack([n, n + sides, k + sides], -1),
            np.stack([first, n, k], -1),
            np.stack([last, k + sides, n + sides], -1),
        ]
    )
    return Shape(vertices, faces, label)


def box(centre: Array, frame: Array, sizes: Sequence[float], label: str = "") -> Shape:
    """A block with its edges along the columns of `frame`."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    vertices = centre + (0.5 * corners * np.asarray(sizes)) @ frame.T
    squares = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))]
    return Shape(vertices, np.array(faces), label)


def ball(centre: Array, radius: float, label: str = "", sides: int = 14) -> Shape:
    """A sphere."""
    rings = sides // 2
    tilt, turn = np.meshgrid(
        np.pi * np.arange(rings + 1) / rings, 2 * np.pi * np.arange(sides) / sides, indexing="ij"
    )
    grid = np.stack(
        [np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1
    )
    index = np.arange((rings + 1) * sides).reshape(rings + 1, sides)
    here, down = index[:-1], index[1:]
    there, corner = np.roll(here, -1, axis=1), np.roll(down, -1, axis=1)
    faces = np.concatenate(
        [
            np.stack([here, down, corner], -1).reshape(-1, 3),
            np.stack([here, corner, there], -1).reshape(-1, 3),
        ]
    )
    return Shape(centre + radius * grid.reshape(-1, 3), faces, label)


def plate(corners: Array, thickness: float, label: str = "") -> Shape:
    """A flat prism over a convex polygon, (k, 3)."""
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    shift = 0.5 * thickness * normal / np.linalg.norm(normal)
    k = len(corners)
    vertices = np.concatenate([corners - shift, corners + shift])
    caps = [t for i in range(1, k - 1) for t in ((0, i + 1, i), (k, k + i, k + i + 1))]
    walls = [t for i in range(k) for j in [(i + 1) % k] for t in ((i, j, i + k), (j, j + k, i + k))]
    return Shape(vertices, np.array(caps + walls), label)


def mesh(shapes: Sequence[Shape], name: str, colour: str, **changes: Any) -> dict[str, Any]:
    """Shapes of one colour as one trace, mm."""
    starts = np.cumsum([0, *(len(s.vertices) for s in shapes)])
    x, y, z = 1e3 * np.concatenate([s.vertices for s in shapes]).T
    i, j, k = np.concatenate([s.faces + start for s, start in zip(shapes, starts, strict=False)]).T
    labels = [plain(s.label or name) for s in shapes for _ in range(len(s.vertices))]
    trace: dict[str, Any] = {
        "type": "mesh3d",
        "x": rounded(x),
        "y": rounded(y),
        "z": rounded(z),
        "i": i.tolist(),
        "j": j.tolist(),
        "k": k.tolist(),
        "color": colour,
        "name": name,
        "text": labels,
        "hoverinfo": "text",
        "showlegend": True,
        "flatshading": False,
        "lighting": {"ambient": 0.62, "diffuse": 0.6, "specular": 0.15, "roughness": 0.7},
        "lightposition": {"x": 2000, "y": -3000, "z": 5000},
    }
    return trace | changes
