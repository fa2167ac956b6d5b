"""Closed surfaces from CAD (STL, OBJ, glTF): checks, volume, mass, centre, inertia."""

from __future__ import annotations

import contextlib
import io
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from strutwork.errors import ModelError
from strutwork.files import write_whole
from strutwork.meshes.mass_properties import MassProperties
from strutwork.meshes.mesh import Mesh, Patch
from strutwork.meshes.surface_integrals import corner_triangles

Array = NDArray[Any]
Ints = NDArray[np.int64]
UNITS = {"m": 1.0, "mm": 1e-3}
SUFFIXES = (".stl", ".obj", ".glb", ".gltf")
LARGEST_FILE = 2 * 1024**3
#: STL holds single precision: vertices closer than this share of the diagonal are one.
SAME_VERTEX = 3e-7
#: glTF's y is up, ours is z.
FROM_GLTF = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


@dataclass(frozen=True, repr=False)
class Surface:
    """A triangulated surface.

    Parameters
    ----------
    points : (n, 3)
        m.
    triangles : (t, 3) int
        Counter-clockwise seen from outside.
    name : str
        For messages.

    Raises
    ------
    ModelError
        No triangle, points that are not finite, a point that does not exist.
    """

    points: Array
    triangles: Ints
    name: str = "surface"

    def __post_init__(self) -> None:
        points, triangles = np.asarray(self.points, float), np.asarray(self.triangles, np.int64)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "triangles", triangles)
        shaped = points.ndim == triangles.ndim == 2 and points.shape[1] == triangles.shape[1] == 3
        if not shaped or not len(triangles):
            raise ModelError(
                f"surface {self.name}", "holds no triangles.", "Export it as triangles."
            )
        if not np.isfinite(points).all():
            raise ModelError(
                f"surface {self.name}", "has points that are not finite.", "Export it again."
            )
        if triangles.min() < 0 or triangles.max() >= len(points):
            raise ModelError(
                f"surface {self.name}",
                f"refers to a point that does not exist; there are {len(points)}.",
                "The file is cut short or damaged: export it again.",
            )

    def __repr__(self) -> str:
        size = " × ".join(f"{s:.4g}" for s in np.ptp(self.points, axis=0))
        return (
            f"Surface({self.name}: {len(self.points)} points, {len(self.triangles)} triangles, "
            f"{size} m)"
        )


def read_surface(path: Path | str, unit: str = "m") -> Surface:
    """Read a surface; vertices that coincide in single precision are merged.

    Parameters
    ----------
    path : Path or str
        .stl, .obj, .glb or .gltf.
    unit : str
        Of the coordinates: `m` or `mm`; glTF is in m by its standard, and its y axis, which
        points up, becomes z.

    Raises
    ------
    ModelError
        A file that is missing, empty, cut short, or holds no triangles.
    """
    path = Path(path)
    scale = _scale(path, unit)
    if not path.is_file():
        raise ModelError(str(path), "there is no such file.", "Check the path.")
    size = path.stat().st_size
    if not 0 < size <= LARGEST_FILE:
        raise ModelError(
            str(path), f"the file has {size} bytes.", "Export it again, of at most 2 GiB."
        )
    text = _stl_text(path) if path.suffix.lower() == ".stl" else None
    import trimesh  # noqa: PLC0415 - a fifth of a second that most commands never need

    try:
        with contextlib.redirect_stdout(io.StringIO()):
            if text is None:
                found = trimesh.load_mesh(path, process=False)
            else:
                found = trimesh.load_mesh(io.BytesIO(text), file_type="stl_ascii", process=False)
        points, triangles = np.asarray(found.vertices, float), np.asarray(found.faces)
    except Exception as error:
        why = " ".join(str(error).split()) or type(error).__name__
        raise ModelError(
            str(path),
            f"cannot be read as {path.suffix.lower()}: {why[:200]}.",
            "The file is cut short or damaged, or of another format: export it again.",
        ) from error
    if path.suffix.lower() in {".glb", ".gltf"}:
        points = points @ FROM_GLTF.T
    if not len(triangles):
        raise ModelError(str(path), "holds no triangles.", "Export it as triangles.")
    return welded(Surface(points * scale, triangles, path.name))


def write_surface(surface: Surface, path: Path | str, unit: str = "m") -> Path:
    """Write a surface as .stl (binary) or .obj; for glTF use `strutwork.meshes.gltf.write_gltf`.

    Parameters
    ----------
    surface : Surface
    path : Path or str
    unit : str
        Of the coordinates in the file: `m` or `mm`.
    """
    path = Path(path)
    scale = _scale(path, unit)
    kind = path.suffix.lower().removeprefix(".")
    if kind not in {"stl", "obj"}:
        raise ModelError(
            str(path), f"surfaces are not written as {path.suffix!r}.", "Use .stl or .obj."
        )
    made = _trimesh(replace(surface, points=surface.points / scale))
    return write_whole(path, lambda temporary: made.export(temporary, file_type=kind))


def surface_of(mesh: Mesh, patch: Patch) -> Surface:
    """A patch as triangles on the nodes that it uses; quadratic faces are split at them.

    The triangles' points are `mesh.points[patch.nodes]`, in that order.

    Parameters
    ----------
    mesh : Mesh
    patch : Patch
        Of this mesh.
    """
    nodes = patch.nodes
    triangles = np.concatenate([corner_triangles(faces) for faces in patch.faces])
    return Surface(mesh.points[nodes], np.searchsorted(nodes, triangles), mesh.name)


def welded(surface: Surface, tolerance: float | None = None) -> Surface:
    """The surface with coincident points merged and triangles without area removed.

    Parameters
    ----------
    surface : Surface
    tolerance : float, optional
        Distance up to which points coincide, m; default 3e-7 of the diagonal, single precision.
    """
    reach = SAME_VERTEX * float(np.linalg.norm(np.ptp(surface.points, axis=0)))
    pairs = cKDTree(surface.points).query_pairs(
        reach if tolerance is None else tolerance, output_type="ndarray"
    )
    size = len(surface.points)
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(size, size))
    group = connected_components(links, directed=False)[1]
    first = np.unique(group, return_index=True)[1]
    triangles = group[surface.triangles]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return replace(surface, points=surface.points[first], triangles=triangles[proper])


def flipped(surface: Surface) -> Surface:
    """The surface with reversed orientation.

    Parameters
    ----------
    surface : Surface
    """
    return replace(surface, triangles=surface.triangles[:, ::-1])


def check_closed(surface: Surface) -> None:
    """Return a surface that bounds a volume: closed, consistently oriented, outwards.

    Self-intersections are not looked for: `strutwork.meshes.self_intersections.check_simple`.

    Parameters
    ----------
    surface : Surface

    Raises
    ------
    ModelError
        Open edges, edges of more than two triangles, or triangles that disagree about the
        outside, with their count and place;
        a body that is inside out.
    """
    part = f"surface {surface.name}"
    ends = surface.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    _, first, edge, uses = np.unique(
        np.sort(ends, axis=1), axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    # +1 for each use from the lower to the higher number, −1 back: a closed surface cancels
    balance = np.bincount(edge.reshape(-1), np.where(ends[:, 0] < ends[:, 1], 1.0, -1.0))
    joined = np.flatnonzero(uses > 2)
    if len(joined):
        middle = surface.points[ends[first[joined[0]]]].mean(axis=0)
        raise ModelError(
            part,
            f"has {len(joined)} edges with more than two triangles, the first at "
            f"{_place(middle)}: bodies touch along them, or triangles lie on one another.",
            "Remove double triangles, or separate the bodies in CAD.",
        )
    alone = np.flatnonzero(uses == 1)
    if len(alone):
        middle = surface.points[ends[first[alone]]].mean(axis=1)
        raise ModelError(
            part,
            f"is not watertight: {len(alone)} open edges, the first at {_place(middle[0])}, "
            f"all between {_place(middle.min(axis=0))} and {_place(middle.max(axis=0))}.",
            "Close the gaps in CAD, or weld it with a tolerance "
            "(`strutwork.meshes.surfaces.welded`).",
        )
    turned = np.flatnonzero(balance)
    if len(turned):
        middle = surface.points[ends[first[turned[0]]]].mean(axis=0)
        raise ModelError(
            part,
            f"its triangles disagree about the outside at {len(turned)} edges, the first at "
            f"{_place(middle)}.",
            "Unify the normals in CAD and export it again.",
        )
    _check_outwards(part, surface)


def surface_properties(surface: Surface, density: float) -> MassProperties:
    """Mass properties of the body that a closed surface bounds (exact; Eberly 2002).

    Parameters
    ----------
    surface : Surface
    density : float
        kg/m³.

    Raises
    ------
    ModelError
        A surface that is not closed and outwards, a density that is not positive.
    """
    if not (isfinite(density) and density > 0):
        raise ModelError(
            f"surface {surface.name}",
            f"its density is {density!r} kg/m³.",
            "Give a positive number.",
        )
    check_closed(surface)
    # about its middle: far from the origin digits would be lost
    middle = (surface.points.min(axis=0) + surface.points.max(axis=0)) / 2.0
    made = _trimesh(replace(surface, points=surface.points - middle))
    made.density = density
    found = made.mass_properties
    centre = np.asarray(found["center_mass"]) + middle
    return MassProperties(
        float(found["volume"]), float(found["mass"]), centre, np.asarray(found["inertia"])
    )


def check_one_body(surface: Surface) -> None:
    """Pass a closed surface of one body, with or without cavities.

    Parameters
    ----------
    surface : Surface

    Raises
    ------
    ModelError
        Several shells that bound a volume, with their number.
    """
    shell, pieces = _shells(surface)
    bodies = int(np.sum(np.bincount(shell, pieces) > 0))
    if bodies > 1:
        raise ModelError(
            f"surface {surface.name}",
            f"holds {bodies} separate bodies (shells of triangles that touch nowhere).",
            "Export each part to a file of its own.",
        )


def _shells(surface: Surface) -> tuple[Ints, Array]:
    """Shell of each triangle, (t,), and its share of the volume, (t,)."""
    size = len(surface.points)
    start, end = surface.triangles[:, [0, 0]].ravel(), surface.triangles[:, 1:].ravel()
    links = coo_array((np.ones(len(start)), (start, end)), shape=(size, size))
    shell = connected_components(links, directed=False)[1][surface.triangles[:, 0]]
    corners = surface.points[surface.triangles] - surface.points.mean(axis=0)
    return shell.astype(np.int64), np.linalg.det(corners) / 6.0


def _check_outwards(part: str, surface: Surface) -> None:
    """ModelError for a shell that is inside out and no cavity of another."""
    shell, pieces = _shells(surface)
    corners = surface.points[surface.triangles] - surface.points.mean(axis=0)
    numbers = np.unique(shell)
    volumes = np.array([pieces[shell == n].sum() for n in numbers])
    boxes = [
        (corners[shell == n].min(axis=(0, 1)), corners[shell == n].max(axis=(0, 1)))
        for n in numbers
    ]
    for volume, (low, high) in zip(volumes, boxes, strict=True):
        around = [
            v > 0 and (other[0] <= low).all() and (other[1] >= high).all()
            for v, other in zip(volumes, boxes, strict=True)
        ]
        if not volume > 0 and not any(around):
            raise ModelError(
                part,
                f"bounds a volume of {volume:.6g} m³: it is inside out or flat.",
                "Turn it with `strutwork.meshes.surfaces.flipped`.",
            )


def _stl_text(path: Path) -> bytes | None:
    """A text STL as its reader wants it, small letters from `solid` on; None for a binary one.

    Programs write capitals, blank lines and a byte-order mark, which mean nothing.

    Raises
    ------
    ModelError
        A file that ends before its header or its first word says.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(84)
    count = int.from_bytes(head[80:84], "little")
    if len(head) == 84 and size == 84 + 50 * count:
        return None
    wanted = f"its header counts {count} triangles"
    if head.removeprefix(b"\xef\xbb\xbf").lstrip()[:5].lower() == b"solid":
        text = path.read_bytes().removeprefix(b"\xef\xbb\xbf").strip().lower()
        if text.rpartition(b"\n")[2].lstrip().startswith(b"endsolid"):
            return text + b"\n"
        wanted = "its last line is not `endsolid`"
    raise ModelError(
        str(path),
        f"is cut short or not an STL file: {wanted}, the file has {size} bytes.",
        "Export it again.",
    )


def _trimesh(surface: Surface) -> Any:
    import trimesh  # noqa: PLC0415 - see read_surface

    return trimesh.Trimesh(surface.points, surface.triangles, process=False, validate=False)


def _scale(path: Path, unit: str) -> float:
    if path.suffix.lower() not in SUFFIXES:
        raise ModelError(
            str(path),
            f"the suffix {path.suffix!r} is not that of a surface.",
            f"Use {', '.join(SUFFIXES)}; solid meshes are read by `strutwork.meshes.read_mesh`.",
        )
    if unit not in UNITS:
        raise ModelError(
            str(path), f"its unit is given as {unit!r}.", f"Choose {' or '.join(UNITS)}."
        )
    if unit != "m" and path.suffix.lower() in {".glb", ".gltf"}:
        raise ModelError(str(path), "glTF is in m by its standard.", "Omit the unit.")
    return UNITS[unit]


def _place(point: ArrayLike) -> str:
    return f"({', '.join(f'{v:.4g}' for v in np.asarray(point))}) m"
