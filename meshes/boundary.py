"""The outer surface of a mesh: faces that one cell alone has, oriented outwards."""

from __future__ import annotations

import numpy as np

from strutwork.meshes.mesh import Faces, Mesh, Patch
from strutwork.meshes.rows import row_groups


def boundary(mesh: Mesh, region: str | None = None) -> Patch:
    """Outer faces, counter-clockwise seen from outside.

    Parameters
    ----------
    mesh : Mesh
        Its cells must not be inverted (`strutwork.meshes.quality`).
    region : str or None
        The surface of one region, which includes what it shares with others; by default
        that of the whole mesh.

    Returns
    -------
    Patch
        One `Faces` for each kind of face.

    Raises
    ------
    ModelError
        No region of that name.
    """
    chosen = mesh.regions.index(region) if region and len(mesh.region_nodes(region)) else None
    found: dict[str, list[np.ndarray]] = {}
    for block in mesh.blocks:
        cells = block.nodes if chosen is None else block.nodes[block.region == chosen]
        faces = cells[:, block.type.faces].reshape(-1, block.type.faces.shape[1])
        found.setdefault(block.type.face_kind, []).append(faces)
    return Patch(
        tuple(Faces(kind, _single(np.concatenate(faces), kind)) for kind, faces in found.items())
    )


def _single(faces: np.ndarray, kind: str) -> np.ndarray:
    """The faces that occur once."""
    corners = Faces(kind, faces[:0]).type.corners
    first, group = row_groups(faces[:, :corners])
    alone = np.bincount(group) == 1
    return np.asarray(faces[np.sort(first[alone])])
