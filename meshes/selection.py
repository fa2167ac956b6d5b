"""Selection by place: nodes in a box, patches of the outer surface in a box or by rule."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.boundary import boundary
from strutwork.meshes.mesh import Faces, Mesh, Patch
from strutwork.meshes.surface_integrals import face_centres, face_normals

Array = NDArray[Any]
#: Lower or upper corner of a box, m; None is open.
Corner = Sequence[float | None]
OPEN = (None, None, None)
#: Lower and upper corner, and the outward direction or None.
Box = tuple[Corner, Corner, Sequence[float] | None]
#: Takes the centres of faces (f, 3), returns which of them to keep (f,).
Rule = Callable[[Array], NDArray[np.bool_]]
#: How far the normal of a face may turn from the direction asked for, rad.
TURN = np.pi / 12


def in_box(mesh: Mesh, low: Corner = OPEN, high: Corner = OPEN) -> NDArray[np.int64]:
    """Nodes in a box, walls included, ascending, (k,).

    Parameters
    ----------
    mesh : Mesh
    low, high : (3,) of float or None
        Corners of the box, m; None is open. A wall is 1e-9 of the mesh thick.
    """
    return np.flatnonzero(_inside(mesh, mesh.points, low, high))


def patch(
    mesh: Mesh,
    name: str,
    low: Corner = OPEN,
    high: Corner = OPEN,
    normal: Sequence[float] | None = None,
    *,
    where: Rule | None = None,
    angle: float = TURN,
) -> Mesh:
    """The mesh with a further patch of outer faces, selected by box, normal or rule.

    Parameters
    ----------
    mesh : Mesh
    name : str
        Name of the patch; one of that name is replaced.
    low, high : (3,) of float or None
        Corners of the box that must hold all nodes of a face, m; None is open.
    normal : (3,) or None
        Outward direction that a face must have within `angle` at its centre; any length, no unit.
    where : callable or None
        Takes the centres of faces (f, 3) and returns which of them to keep (f,).
    angle : float
        rad.

    Raises
    ------
    ModelError
        No face is left, or the normal has no length.
    """
    outer = boundary(mesh)
    chosen = _chosen(mesh, outer, name, (low, high, normal), where=where, angle=angle)
    return replace(mesh, patches={**mesh.patches, name: chosen})


def patches(mesh: Mesh, boxes: Mapping[str, Box]) -> Mesh:
    """The mesh with several further patches; the surface is computed once.

    Parameters
    ----------
    mesh : Mesh
    boxes : mapping of name to (low, high, normal)
        As for `patch`.

    Raises
    ------
    ModelError
        As for `patch`.
    """
    outer = boundary(mesh)
    found = {name: _chosen(mesh, outer, name, box) for name, box in boxes.items()}
    return replace(mesh, patches={**mesh.patches, **found})


def _chosen(
    mesh: Mesh,
    outer: Patch,
    name: str,
    box: Box,
    *,
    where: Rule | None = None,
    angle: float = TURN,
) -> Patch:
    low, high, normal = box
    chosen = []
    for faces in outer.faces:
        keep = _inside(mesh, mesh.points[faces.nodes], low, high).all(axis=1)
        kept = Faces(faces.kind, faces.nodes[keep])
        if normal is not None:
            kept = _facing(mesh, name, kept, np.asarray(normal, dtype=float), angle)
        if where is not None:
            rule = np.asarray(where(face_centres(mesh.points, kept)), dtype=bool)
            kept = Faces(kept.kind, kept.nodes[rule])
        if len(kept.nodes):
            chosen.append(kept)
    if not chosen:
        raise ModelError(
            f"mesh {mesh.name}, patch {name!r}",
            "holds no face of the outer surface.",
            "Widen the box, refine the mesh so that its lines fall on the edges of the patch, "
            "or turn the normal outwards.",
        )
    return Patch(tuple(chosen))


def node_set(mesh: Mesh, name: str, low: Corner = OPEN, high: Corner = OPEN) -> Mesh:
    """The mesh with a further node set: the nodes in a box.

    Parameters
    ----------
    mesh : Mesh
        Stays as it is.
    name : str
        Name of the set; one of that name is replaced.
    low, high : (3,) of float or None
        Corners of the box, m; None is open.

    Raises
    ------
    ModelError
        No node lies in the box.
    """
    nodes = in_box(mesh, low, high)
    if not len(nodes):
        raise ModelError(f"mesh {mesh.name}, node set {name!r}", "holds no node.", "Widen the box.")
    return replace(mesh, node_sets={**mesh.node_sets, name: nodes})


def _inside(mesh: Mesh, points: Array, low: Corner, high: Corner) -> NDArray[np.bool_]:
    slack = 1e-9 * float(np.linalg.norm(mesh.extent))
    lowest = np.array([-np.inf if v is None else v for v in low]) - slack
    highest = np.array([np.inf if v is None else v for v in high]) + slack
    return np.asarray(((points >= lowest) & (points <= highest)).all(axis=-1))


def _facing(mesh: Mesh, name: str, faces: Faces, normal: Array, angle: float) -> Faces:
    length = np.linalg.norm(normal)
    if not (np.isfinite(length) and length > 0):
        raise ModelError(
            f"mesh {mesh.name}, patch {name!r}",
            f"its normal is {normal.tolist()}.",
            "Give a direction.",
        )
    along = face_normals(mesh.points, faces) @ (normal / length)
    return Faces(faces.kind, faces.nodes[along >= np.cos(angle)])
