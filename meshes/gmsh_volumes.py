"""Tetrahedra from STEP or from a closed surface, through Gmsh.

Gmsh is the extra `cad` (`pip install strutwork[cad]`). It is licensed under GPL-2.0-or-later
with an exception for linking; this package calls it when it is installed and does not ship it.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from math import isfinite, radians, sqrt
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.boundary import boundary
from strutwork.meshes.curves import unbent
from strutwork.meshes.mesh import CellBlock, Faces, Mesh, Patch
from strutwork.meshes.order import without_orphans
from strutwork.meshes.quality import check_quality
from strutwork.meshes.rows import row_groups
from strutwork.meshes.self_intersections import check_simple
from strutwork.meshes.surfaces import Surface, check_closed, check_one_body

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Gmsh's element types, and our node for each of its nodes.
TETRAHEDRA = {4: ("tetra", [0, 1, 2, 3]), 11: ("tetra10", [0, 1, 2, 3, 4, 5, 6, 7, 9, 8])}
TRIANGLES = {2: "triangle", 9: "triangle6"}
#: A mesh of more takes more than 10 GB while it is made.
MOST_CELLS = 1e7
#: Share of the exact volume that a mesh may lack without a word.
VOLUME_ERROR = 0.01
LICENCE = "Gmsh, GPL-2.0-or-later with a linking exception"


def tetrahedra(
    source: Surface | Path | str,
    size: float,
    *,
    order: int | None = None,
    edge_angle: float = radians(40.0),
) -> Mesh:
    """Mesh a STEP file or a closed surface with tetrahedra.

    Parameters
    ----------
    source : Surface, Path or str
        A closed surface, which is meshed anew between its sharp edges; or a .step or .stp
        file, whose own unit is honoured. Bodies of one file that touch share their nodes.
    size : float
        Edge of a tetrahedron, m.
    order : int, optional
        1 or 2; quadratic tetrahedra have curved edges on the curved faces of a STEP file. By
        default 2 for a STEP file and 1 for a surface.
    edge_angle : float
        An edge of a surface is sharp where its triangles turn by more, rad.

    Returns
    -------
    Mesh
        A region for each body, "body 1" and so on; a patch for each face, "face 1" and so on.
        A face of a surface may come as several patches.

    Warns
    -----
    UserWarning
        The mesh lacks or adds more than 1 % of the volume of the part or the surface, with the
        size that reaches it; or curved edges would turn cells inside out, and are straight there.

    Raises
    ------
    ModelError
        Gmsh is not installed; a file that is missing, damaged or without a solid; a surface
        that is not closed or crosses itself; a mesh that Gmsh fails to make.
    """
    name = source.name if isinstance(source, Surface) else Path(source).name
    # a surface has flat triangles: nothing is gained by curved edges, which may invert cells
    straight = isinstance(source, Surface)
    order = (1 if straight else 2) if order is None else order
    if not (isfinite(size) and size > 0) or order not in {1, 2}:
        raise ModelError(
            f"mesh {name}",
            f"is requested with cells of {size!r} m of order {order!r}.",
            "Give a positive size in m, and order 1 or 2.",
        )
    if isinstance(source, Surface):
        check_closed(source)
        check_one_body(source)
        check_simple(source)
    else:
        _check_step(Path(source))
    with _session(name) as gmsh:
        if isinstance(source, Surface):
            _load_surface(gmsh, source, edge_angle)
        else:
            _load_step(gmsh, Path(source))
        if not gmsh.model.getEntities(3):
            raise ModelError(
                f"mesh {name}", "holds no solid body.", "Export a solid, not its surfaces."
            )
        # metres per unit of the model
        scale = 1.0 if isinstance(source, Surface) else 1e-3
        exact = _volume(gmsh, source)
        _check_count(name, exact, size)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size / scale)
        gmsh.option.setNumber("Mesh.MeshSizeMin", size / scale / 10.0)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        gmsh.model.mesh.generate(3)
        gmsh.option.setNumber("Mesh.SecondOrderLinear", int(straight))
        gmsh.model.mesh.setOrder(order)
        if order == 2 and not straight:
            gmsh.model.mesh.optimize("HighOrder")
        mesh = _collect(gmsh, name, scale)
    if order == 2 and not straight:
        mesh = _unbent(mesh)
    found = float(check_quality(mesh).volume.sum())
    _compare_volume(name, found, exact, size, order, straight=straight)
    return mesh


def _unbent(mesh: Mesh) -> Mesh:
    """The mesh without cells that curves turn inside out, and a warning that says so."""
    made, cells = unbent(mesh)
    if len(cells):
        warnings.warn(
            f"mesh {mesh.name}: {len(cells)} of {mesh.cell_count} cells would be inside out with "
            "curved edges; theirs are straight. Choose smaller cells to keep the curves.",
            stacklevel=3,
        )
    return made


def _volume(gmsh: Any, source: Surface | Path | str) -> float:
    """Volume of a surface or of the bodies of the geometry kernel, m³."""
    if isinstance(source, Surface):
        return float(np.linalg.det(source.points[source.triangles]).sum() / 6.0)
    cubic_mm = sum(gmsh.model.occ.getMass(3, tag) for _, tag in gmsh.model.getEntities(3))
    return 1e-9 * float(cubic_mm)


def _compare_volume(
    name: str, found: float, exact: float, size: float, order: int, *, straight: bool
) -> None:
    """Warn of a mesh whose volume is not that of the part, and say which cells would reach it."""
    error = found / exact - 1.0
    if abs(error) <= VOLUME_ERROR:
        return
    chords = straight or order == 1
    # chords err by the square of the size, parabolas by its fourth power at best
    reach = 0.9 * size * (VOLUME_ERROR / abs(error)) ** (1.0 / (2.0 if chords else 3.0))
    other = ", or quadratic cells (order 2)" if chords and not straight else ""
    warnings.warn(
        f"mesh {name}: its volume {found:.5g} m³ is {100 * error:+.1f} % off the exact "
        f"{exact:.5g} m³. Cells of {reach:.2g} m should reach 1 %{other}.",
        stacklevel=3,
    )


def _check_count(name: str, volume: float, size: float) -> None:
    """ModelError before a mesh that would fill the memory."""
    # a regular tetrahedron of edge a has the volume a³ / (6 √2)
    count = 6.0 * sqrt(2.0) * volume / size**3
    if count > MOST_CELLS:
        raise ModelError(
            f"mesh {name}",
            f"cells of {size:g} m in {volume:.4g} m³ are about {count:.2g}; {MOST_CELLS:.2g} is "
            "the limit.",
            "Choose larger cells, or check the unit of the part.",
        )


@contextmanager
def _session(name: str) -> Iterator[Any]:
    """Gmsh with an empty model, quiet, and its complaints as ModelError."""
    try:
        gmsh = import_module("gmsh")
    except (ImportError, OSError) as error:
        missing = isinstance(error, ImportError)
        raise ModelError(
            f"mesh {name}",
            "needs Gmsh, which is not installed." if missing else f"Gmsh does not start: {error}.",
            f"Install the extra: pip install strutwork[cad] ({LICENCE})."
            if missing
            else "Install its system libraries (Debian: libglu1-mesa libxcursor1 libxft2 "
            "libxinerama1 libxrender1).",
        ) from error
    mine = not gmsh.isInitialized()
    if mine:
        # without its own signal handler it may run in any thread
        gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add(f"strutwork {name}")
    try:
        yield gmsh
    except ModelError:
        raise
    except Exception as error:
        raise ModelError(
            f"mesh {name}",
            f"Gmsh cannot mesh it: {' '.join(str(error).split())[:300]}.",
            "Choose another size, or repair the part in CAD.",
        ) from error
    finally:
        # options outlive a session
        gmsh.option.restoreDefaults()
        if mine:
            gmsh.finalize()
        else:
            gmsh.model.remove()


def _check_step(path: Path) -> None:
    if path.suffix.lower() not in {".step", ".stp"}:
        raise ModelError(
            str(path),
            f"the suffix {path.suffix!r} is not that of STEP.",
            "Give .step or .stp; read an STL with `strutwork.meshes.surfaces.read_surface` first.",
        )
    if not path.is_file():
        raise ModelError(str(path), "there is no such file.", "Check the path.")
    content = path.read_bytes()
    if not content.lstrip().startswith(b"ISO-10303-21") or b"END-ISO-10303-21" not in content:
        raise ModelError(
            str(path),
            "does not begin and end as a STEP file: it is empty, cut short or of another format.",
            "Export it again.",
        )


def _load_step(gmsh: Any, path: Path) -> None:
    # Open CASCADE's own unit: another one would stay in force for the whole process
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.model.occ.importShapes(str(path))
    bodies = gmsh.model.occ.getEntities(3)
    if len(bodies) > 1:
        gmsh.model.occ.fragment(bodies[:1], bodies[1:])
    gmsh.model.occ.synchronize()


def _load_surface(gmsh: Any, surface: Surface, edge_angle: float) -> None:
    tag = gmsh.model.addDiscreteEntity(2)
    numbers = np.arange(1, len(surface.points) + 1)
    gmsh.model.mesh.addNodes(2, tag, numbers, surface.points.ravel())
    gmsh.model.mesh.addElementsByType(tag, 2, [], (surface.triangles + 1).ravel())
    gmsh.model.mesh.classifySurfaces(edge_angle, True, True, np.pi)
    gmsh.model.mesh.createGeometry()
    loop = gmsh.model.geo.addSurfaceLoop([t for _, t in gmsh.model.getEntities(2)])
    gmsh.model.geo.addVolume([loop])
    gmsh.model.geo.synchronize()


def _collect(gmsh: Any, name: str, scale: float) -> Mesh:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    number = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    number[tags.astype(np.int64)] = np.arange(len(tags))
    cells: dict[str, list[Ints]] = {}
    regions: dict[str, list[Ints]] = {}
    bodies = [tag for _, tag in gmsh.model.getEntities(3)]
    for index, body in enumerate(bodies):
        for kind, nodes in _elements(gmsh, 3, body, number):
            cells.setdefault(kind, []).append(nodes)
            regions.setdefault(kind, []).append(np.full(len(nodes), index))
    if not cells:
        raise ModelError(
            f"mesh {name}", "Gmsh made no tetrahedra.", "Choose another size, or repair the part."
        )
    blocks = tuple(
        CellBlock(kind, np.concatenate(cells[kind]), np.concatenate(regions[kind]))
        for kind in cells
    )
    names = tuple(f"body {i}" for i in range(1, len(bodies) + 1))
    mesh = Mesh(coordinates.reshape(-1, 3) * scale, blocks, names, name=name)
    outer = {faces.kind: faces.nodes for faces in boundary(mesh).faces}
    patches = {
        f"face {tag}": Patch(
            tuple(_oriented(k, n, outer) for k, n in _elements(gmsh, 2, tag, number))
        )
        for _, tag in gmsh.model.getEntities(2)
    }
    patches = {label: patch for label, patch in patches.items() if len(patch)}
    return without_orphans(Mesh(mesh.points, blocks, names, {}, patches, name))


def _elements(gmsh: Any, dimension: int, tag: int, number: Ints) -> Iterator[tuple[str, Ints]]:
    """Kind and nodes of the elements of an entity."""
    types, _, nodes = gmsh.model.mesh.getElements(dimension, tag)
    for type_, flat in zip(types, nodes, strict=True):
        if dimension == 3:
            kind, order = TETRAHEDRA[int(type_)]
        else:
            kind = TRIANGLES[int(type_)]
            order = list(range(3 if kind == "triangle" else 6))
        yield kind, number[flat.astype(np.int64)].reshape(-1, len(order))[:, order]


def _oriented(kind: str, faces: Ints, outer: dict[str, Ints]) -> Faces:
    """The faces as the outer surface has them; those between two bodies as they are."""
    known = outer[kind]
    first, group = row_groups(np.concatenate([known[:, :3], faces[:, :3]]))
    match = first[group[len(known) :]]
    outside = match < len(known)
    result = faces.copy()
    result[outside] = known[match[outside]]
    return Faces(kind, result)
