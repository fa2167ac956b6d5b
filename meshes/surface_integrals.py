"""Integrals over faces: areas, normals, and the area that belongs to each node."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.meshes.mesh import Faces, Mesh, Patch

Array = NDArray[Any]
#: Exact for the area of a plane face of any kind, and to 1e-6 or so for a curved one.
DEGREE = 6


def face_centres(points: Array, faces: Faces) -> Array:
    """Mean of the corners of each face, m, (f, 3).

    Parameters
    ----------
    points : (n, 3)
        Of the mesh, m.
    faces : Faces
        f of them.
    """
    return np.asarray(points[faces.nodes[:, : faces.type.corners]].mean(axis=1))


def face_normals(points: Array, faces: Faces) -> Array:
    """Outward unit normal at the middle of each face, (f, 3); zero where a face has no area.

    Parameters
    ----------
    points : (n, 3)
        Of the mesh, m.
    faces : Faces
        f of them.
    """
    middle = faces.type.reference[: faces.type.corners].mean(axis=0, keepdims=True)
    vectors = _area_vectors(points, faces, middle)[:, 0]
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0))


def face_areas(points: Array, faces: Faces) -> Array:
    """Area of each face, m², (f,).

    Parameters
    ----------
    points : (n, 3)
        Of the mesh, m.
    faces : Faces
        f of them.
    """
    at, weights = faces.type.quadrature(DEGREE)
    return np.asarray(np.linalg.norm(_area_vectors(points, faces, at), axis=-1) @ weights)


def patch_area(mesh: Mesh, patch: Patch) -> float:
    """Area of a patch, m².

    Parameters
    ----------
    mesh : Mesh
        Whose points count.
    patch : Patch
        Of this mesh.
    """
    return float(sum(face_areas(mesh.points, f).sum() for f in patch.faces))


def nodal_areas(mesh: Mesh, patch: Patch) -> tuple[NDArray[np.int64], Array]:
    """The share of the area that belongs to each node: ∫ N dA.

    A constant pressure p gives the force p ∫ N dA at a node along the normal of a plane
    patch. The shares add up to the area; those of corners of eight-node quadrilaterals are
    negative and those of six-node triangles zero, as is consistent with their functions.

    Parameters
    ----------
    mesh : Mesh
        Whose points count.
    patch : Patch
        Of this mesh.

    Returns
    -------
    nodes : (n,) int
        `patch.nodes`.
    areas : (n,)
        m².
    """
    nodes, vectors = _scatter(mesh, patch, as_vectors=False)
    return nodes, vectors[:, 0]


def nodal_area_vectors(mesh: Mesh, patch: Patch) -> tuple[NDArray[np.int64], Array]:
    """∫ N n dA with the outward normal n: minus the nodal forces of a unit pressure.

    Parameters
    ----------
    mesh : Mesh
        Whose points count.
    patch : Patch
        Of this mesh.

    Returns
    -------
    nodes : (n,) int
        `patch.nodes`.
    vectors : (n, 3)
        m²; over a closed surface they add up to zero.
    """
    return _scatter(mesh, patch, as_vectors=True)


def nodal_area_products(mesh: Mesh, patch: Patch) -> tuple[NDArray[np.int64], Array]:
    """∫ N Nᵀ dA over a patch: the flows of a heat transfer coefficient of one.

    Parameters
    ----------
    mesh : Mesh
        Whose points count.
    patch : Patch
        Of this mesh.

    Returns
    -------
    pairs : (m, 2) int
        Nodes of each entry; a pair may come several times, and its entries add.
    areas : (m,)
        m²; they add up to the area.
    """
    pairs, areas = [np.zeros((0, 2), np.int64)], [np.zeros(0)]
    for faces in patch.faces:
        at, weights = faces.type.quadrature(DEGREE)
        sizes = np.linalg.norm(_area_vectors(mesh.points, faces, at), axis=-1) * weights
        shape = faces.type.shape(at)
        areas.append(np.einsum("fq,qi,qj->fij", sizes, shape, shape).ravel())
        rows = np.broadcast_to(faces.nodes[:, :, None], (*faces.nodes.shape, faces.type.size))
        columns = np.swapaxes(rows, 1, 2)
        pairs.append(np.stack([rows.ravel(), columns.ravel()], axis=-1))
    return np.concatenate(pairs), np.concatenate(areas)


def _scatter(mesh: Mesh, patch: Patch, *, as_vectors: bool) -> tuple[NDArray[np.int64], Array]:
    nodes = patch.nodes
    total = np.zeros((len(nodes), 3 if as_vectors else 1))
    for faces in patch.faces:
        at, weights = faces.type.quadrature(DEGREE)
        vectors = _area_vectors(mesh.points, faces, at)
        if not as_vectors:
            vectors = np.linalg.norm(vectors, axis=-1, keepdims=True)
        shares = np.einsum("q,qn,fqc->fnc", weights, faces.type.shape(at), vectors)
        np.add.at(total, np.searchsorted(nodes, faces.nodes), shares)
    return nodes, total


def _area_vectors(points: Array, faces: Faces, at: Array) -> Array:
    """Normal times area per reference area, (f, q, 3)."""
    tangents = np.einsum("qnd,fnc->fqdc", faces.type.gradient(at), points[faces.nodes])
    return np.asarray(np.cross(tangents[..., 0, :], tangents[..., 1, :]))


#: Triangles that the nodes of a face make, over all its nodes.
_TRIANGLES = {
    "triangle": ((0, 1, 2),),
    "triangle6": ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    "quad": ((0, 1, 2), (0, 2, 3)),
    "quad8": ((0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 7), (5, 6, 7)),
    "quad9": (
        *((0, 4, 8), (0, 8, 7), (4, 1, 5), (4, 5, 8)),
        *((8, 5, 2), (8, 2, 6), (7, 8, 6), (7, 6, 3)),
    ),
}


def corner_triangles(faces: Faces) -> NDArray[np.int64]:
    """The faces cut into flat triangles between their nodes, outwards, (t, 3).

    Parameters
    ----------
    faces : Faces
        Of any kind.
    """
    return np.asarray(faces.nodes[:, np.array(_TRIANGLES[faces.kind])].reshape(-1, 3))
