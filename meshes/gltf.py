"""Surfaces as glTF 2.0 (.glb): colours at the vertices, displacement as a morph that swings."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.files import write_whole
from strutwork.meshes.surfaces import FROM_GLTF, Surface

Array = NDArray[Any]
FLOAT, UNSIGNED = 5126, 5125
VERTICES, INDICES = 34962, 34963
#: Time and weight of one swing, s: a sine by its extremes and the places between.
SWING = 2.0 * np.linspace(0.0, 1.0, 17)


@dataclass(frozen=True)
class GltfPart:
    """One body of a scene.

    Parameters
    ----------
    surface : Surface
    colours : (n, 3) or (3,) or None
        Red, green and blue from 0 to 1 as on a screen (sRGB), no unit, at each vertex or for all.
    displacement : (n, 3) or None
        m at full swing: a mode shape or a deflection, drawn as a morph target.
    """

    surface: Surface
    colours: Array | None = None
    displacement: Array | None = None


def write_gltf(parts: Sequence[GltfPart], path: Path | str, *, swings: bool = True) -> Path:
    """Write a scene for any glTF 2.0 viewer, with z pointing up.

    Parameters
    ----------
    parts : sequence of GltfPart
    path : Path or str
        Ends with .glb.
    swings : bool
        Animate the displacement as a sine of two seconds.

    Raises
    ------
    ModelError
        Another suffix, no part, colours or displacements of another size than the points.
    """
    path = Path(path)
    if path.suffix.lower() != ".glb":
        raise ModelError(str(path), f"is not written as {path.suffix!r}.", "Name it .glb.")
    content = to_glb(parts, swings=swings)
    return write_whole(path, lambda temporary: temporary.write_bytes(content))


def to_glb(parts: Sequence[GltfPart], *, swings: bool = True) -> bytes:
    """The bytes of a .glb file; see `write_gltf`.

    Parameters
    ----------
    parts : sequence of GltfPart
        At least one; drawn together.
    swings : bool
        Animate the displacement as a sine of two seconds.
    """
    if not parts:
        raise ModelError("glTF scene", "holds nothing.", "Give at least one part.")
    buffer = _Buffer()
    # the rotation from our z up to glTF's y up, as a column-major matrix
    matrix = np.eye(4)
    matrix[:3, :3] = FROM_GLTF.T
    nodes: list[dict[str, Any]] = [
        {"name": "z up", "matrix": matrix.T.ravel().tolist(), "children": []}
    ]
    made, channels = [], []
    for i, part in enumerate(parts, start=1):
        made.append(_mesh(buffer, part))
        nodes[0]["children"].append(i)
        nodes.append({"name": part.surface.name, "mesh": i - 1})
        if part.displacement is not None:
            target = {"node": i, "path": "weights"}
            channels.append({"sampler": 0, "target": target})
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "strutwork"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": made,
        "materials": [
            {"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0.1}},
        ],
    }
    if channels and swings:
        time = buffer.add(SWING[:, None], "SCALAR", limits=True)
        weight = buffer.add(np.sin(np.pi * SWING)[:, None], "SCALAR")
        sampler = {"input": time, "output": weight, "interpolation": "LINEAR"}
        document["animations"] = [{"name": "swing", "samplers": [sampler], "channels": channels}]
    document |= {
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.content)}],
    }
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(buffer.content), 0x004E4942) + bytes(buffer.content)
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


class _Buffer:
    """The binary part of a file, with its views and accessors."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(
        self,
        values: Array,
        shape: str,
        *,
        component: int = FLOAT,
        target: int | None = None,
        limits: bool = False,
    ) -> int:
        """Append an array (n, components); returns the number of its accessor."""
        array = np.ascontiguousarray(values, dtype="<f4" if component == FLOAT else "<u4")
        view = {"buffer": 0, "byteOffset": len(self.content), "byteLength": array.nbytes}
        self.views.append(view | ({} if target is None else {"target": target}))
        self.content += array.tobytes()
        accessor: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": component,
            "count": array.size if shape == "SCALAR" else len(array),
            "type": shape,
        }
        if limits:
            accessor |= {
                "min": array.min(axis=0).astype(float).tolist(),
                "max": array.max(axis=0).astype(float).tolist(),
            }
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _mesh(buffer: _Buffer, part: GltfPart) -> dict[str, Any]:
    surface = part.surface
    shape = surface.points.shape
    attributes = {
        "POSITION": buffer.add(surface.points, "VEC3", target=VERTICES, limits=True),
        "NORMAL": buffer.add(_vertex_normals(surface), "VEC3", target=VERTICES),
    }
    if part.colours is not None:
        colours = np.broadcast_to(_checked(part, "colours", part.colours, (shape, (3,))), shape)
        if colours.min() < 0 or colours.max() > 1:
            raise ModelError(
                f"surface {surface.name}", "has colours beyond 0 to 1.", "Scale them to 0 to 1."
            )
        attributes["COLOR_0"] = buffer.add(_linear(colours), "VEC3", target=VERTICES)
    triangles = surface.triangles.reshape(-1, 1)
    primitive: dict[str, Any] = {
        "attributes": attributes,
        "indices": buffer.add(triangles, "SCALAR", component=UNSIGNED, target=INDICES),
        "material": 0,
    }
    mesh: dict[str, Any] = {"name": surface.name, "primitives": [primitive]}
    if part.displacement is not None:
        moved = _checked(part, "displacements", part.displacement, (shape,))
        morph = buffer.add(moved, "VEC3", target=VERTICES, limits=True)
        primitive["targets"] = [{"POSITION": morph}]
        mesh["weights"] = [1.0]
    return mesh


def _checked(
    part: GltfPart, what: str, values: Array, shapes: tuple[tuple[int, ...], ...]
) -> Array:
    array = np.asarray(values, dtype=float)
    if array.shape not in shapes or not np.isfinite(array).all():
        raise ModelError(
            f"surface {part.surface.name}",
            f"has {what} of shape {array.shape}, or not finite.",
            f"Give finite numbers of shape {' or '.join(map(str, shapes))}.",
        )
    return array


def _vertex_normals(surface: Surface) -> Array:
    """Mean of the normals of the triangles around a vertex, by area; z where there is none."""
    corners = surface.points[surface.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.zeros_like(surface.points)
    for column in range(3):
        np.add.at(total, surface.triangles[:, column], normal)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(length > 0, total / np.where(length > 0, length, 1.0), [0.0, 0.0, 1.0])


def _linear(colours: Array) -> Array:
    """Linear light from sRGB (IEC 61966-2-1)."""
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
