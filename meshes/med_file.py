"""What a MED file holds: read from its HDF5 by names and shapes, bounded before it is unpacked.

Read here, not by meshio, which keeps the first group of a cell and unpacks whatever is there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes import limits

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Kind and number of nodes of MED's geometries; empty for points and lines.
KINDS = {
    "PO1": ("", 1), "SE2": ("", 2), "SE3": ("", 3), "SE4": ("", 4),
    "TR3": ("triangle", 3), "TR6": ("triangle6", 6), "QU4": ("quad", 4), "QU8": ("quad8", 8),
    "QU9": ("quad9", 9), "TE4": ("tetra", 4), "T10": ("tetra10", 10), "HE8": ("hexahedron", 8),
    "H20": ("hexahedron20", 20), "PE6": ("wedge", 6), "P15": ("wedge15", 15),
    "P18": ("wedge18", 18), "PY5": ("pyramid", 5), "P13": ("pyramid13", 13),
    "H27": ("hexahedron27 of MED", 27), "TR7": ("triangle7", 7),
    "OG2": ("prism with six sides", 12),
}  # fmt: skip
#: Polygons and polyhedra, which have no fixed number of nodes.
FACES_ALONE = {"POG", "PO2"}
DAMAGED = "The file is cut short or damaged: export it again."


@dataclass
class MedFile:
    """What a file holds.

    Parameters
    ----------
    path : Path
    points : (n, 3)
        In the file's own unit.
    node_families : (n,)
        Family of each node.
    cells : list of (kind, (m, k) int, (m,) int)
        Nodes from 0, and the family of each cell.
    names : dict of int to tuple of str
        Groups of each family.
    """

    path: Path
    points: Array
    node_families: Ints
    cells: list[tuple[str, Ints, Ints]] = field(default_factory=list)
    names: dict[int, tuple[str, ...]] = field(default_factory=dict)

    def members(self, families: Ints) -> dict[str, Ints]:
        """Places (k,) of each group among cells or nodes of these families.

        Parameters
        ----------
        families : (m,) of int
            Family of each cell or node.
        """
        found: dict[str, list[Ints]] = {}
        for family in np.unique(families).tolist():
            own = np.flatnonzero(families == family)
            for name in self.names.get(family, ()):
                found.setdefault(name, []).append(own)
        return {name: np.sort(np.concatenate(own)) for name, own in found.items()}


def read_file(path: Path) -> MedFile:
    """Read a file.

    Parameters
    ----------
    path : Path
        .med, of ordinary size.

    Raises
    ------
    ModelError
        No MED file, several meshes or steps, links out of the file, more than the limits.
    """
    import h5py  # noqa: PLC0415 - a tenth of a second that most commands never need

    content = limits.read_bytes(path)
    if not content.startswith(b"\x89HDF"):
        raise ModelError(str(path), "is not a MED file: it is not HDF5.", DAMAGED)
    try:
        # from the path: the size is checked, and HDF5 reads what it needs
        with h5py.File(path, "r") as file:
            return _read(path, file)
    except (OSError, KeyError, ValueError, TypeError, RuntimeError) as error:
        raise ModelError(str(path), f"cannot be read as .med: {error}.", DAMAGED) from None


def _read(path: Path, file: Any) -> MedFile:
    meshes = _group(path, file, "ENS_MAA")
    mesh_name = _only(path, list(meshes), "meshes")
    mesh = _group(path, meshes, mesh_name)
    version = _group(path, mesh, _only(path, list(mesh), "steps of its mesh"))
    if int(mesh.attrs.get("ESP", 3)) != 3:
        raise ModelError(
            str(path), f"is a mesh in {int(mesh.attrs['ESP'])} dimensions.", "Export a solid mesh."
        )
    nodes = _group(path, version, "NOE")
    places = _values(path, nodes, "COO", float)
    if len(places) % 3 or not len(places):
        raise ModelError(str(path), f"has {len(places)} coordinates.", DAMAGED)
    points = places.reshape(3, -1).T
    limits.check_counts(path, len(points))
    found = MedFile(path, points, _families(path, nodes, len(points)))
    if "MAI" in version:
        kinds = _group(path, version, "MAI")
        for code in kinds:
            _cells(found, _group(path, kinds, code), code)
    _groups(found, file, mesh_name)
    return found


def _cells(found: MedFile, group: Any, code: str) -> None:
    path = found.path
    if code in FACES_ALONE:
        return
    if code not in KINDS:
        raise ModelError(
            str(path),
            f"has cells of MED's type {code}, which cannot be used.",
            "Mesh with hexahedra or tetrahedra only.",
        )
    kind, width = KINDS[code]
    if not kind:
        return
    nodes = _values(path, group, "NOD", np.int64)
    if len(nodes) % width:
        raise ModelError(str(path), f"has {len(nodes)} nodes in cells {code} of {width}.", DAMAGED)
    table = nodes.reshape(width, -1).T - 1
    if table.size and (table.min() < 0 or table.max() >= len(found.points)):
        raise ModelError(
            str(path),
            f"has cells {code} on node {int(table.max()) + 1}; there are {len(found.points)}.",
            DAMAGED,
        )
    limits.check_counts(path, 0, sum(len(n) for _, n, _ in found.cells) + len(table))
    found.cells.append((kind, table, _families(path, group, len(table))))


def _families(path: Path, group: Any, count: int) -> Ints:
    """The family of each node or cell; 0 where the file gives none."""
    if "FAM" not in group:
        return np.zeros(count, dtype=np.int64)
    families = _values(path, group, "FAM", np.int64)
    if len(families) != count:
        raise ModelError(
            str(path), f"has {len(families)} families for {count} nodes or cells.", DAMAGED
        )
    return families


def _groups(found: MedFile, file: Any, mesh_name: str) -> None:
    """Names of the groups of each family."""
    if "FAS" not in file or mesh_name not in file["FAS"]:
        return
    families = _group(found.path, _group(found.path, file, "FAS"), mesh_name)
    for what in ("ELEME", "NOEUD"):
        if what not in families:
            continue
        own = _group(found.path, families, what)
        for name in own:
            family = _group(found.path, own, name)
            if "GRO" not in family:
                continue
            table = _dataset(found.path, _group(found.path, family, "GRO"), "NOM")
            # names are rows of 80 characters, padded with zeros or blanks
            names = (bytes(np.asarray(row, dtype=np.int8).tobytes()) for row in table[()])
            found.names[int(family.attrs["NUM"])] = tuple(dict.fromkeys(map(_name, names)))


def _name(padded: bytes) -> str:
    plain = padded.split(b"\0", 1)[0]
    try:
        return plain.decode("utf-8").strip()
    except UnicodeDecodeError:
        return plain.decode("cp1252", "replace").strip()


def _only(path: Path, names: list[str], what: str) -> str:
    if len(names) != 1:
        raise ModelError(str(path), f"holds {len(names)} {what}.", "Export one mesh, at one step.")
    return names[0]


def _inside(path: Path, parent: Any, name: str) -> Any:
    """What stands under a name; ModelError where it is a link, which may lead to other files."""
    import h5py  # noqa: PLC0415 - see read_file

    link = parent.get(name, getlink=True)
    if link is not None and not isinstance(link, h5py.HardLink):
        raise ModelError(
            str(path),
            f"holds {name!r} as a link, which is not followed.",
            "Export the mesh into one file.",
        )
    return parent[name]


def _group(path: Path, parent: Any, name: str) -> Any:
    import h5py  # noqa: PLC0415 - see read_file

    found = _inside(path, parent, name) if name in parent else None
    if not isinstance(found, h5py.Group):
        raise ModelError(str(path), f"has no group {name!r}.", DAMAGED)
    return found


def _dataset(path: Path, parent: Any, name: str) -> Any:
    """A dataset whose size is within the limits and whose data are in the file."""
    import h5py  # noqa: PLC0415 - see read_file

    found = _inside(path, parent, name) if name in parent else None
    if not isinstance(found, h5py.Dataset):
        raise ModelError(str(path), f"has no array {name!r}.", DAMAGED)
    if found.external or found.is_virtual:
        raise ModelError(
            str(path), f"keeps the array {name!r} in other files.", "Export the mesh into one file."
        )
    limits.check_content(path, int(found.size or 0) * max(found.dtype.itemsize, 1))
    if found.chunks:
        # one chunk is unpacked as a whole, however little of it is asked for
        limits.check_content(path, int(np.prod(found.chunks, dtype=float)) * found.dtype.itemsize)
    return found


def _values(path: Path, parent: Any, name: str, type_: type) -> Array:
    found = _dataset(path, parent, name)
    if found.dtype.kind not in "iuf":
        raise ModelError(str(path), f"has an array {name!r} that is not of numbers.", DAMAGED)
    limit = 3 * limits.MOST_POINTS if name in {"COO", "FAM"} else 27 * limits.MOST_CELLS
    if found.size > limit:
        raise ModelError(
            str(path),
            f"has an array {name!r} of {found.size} numbers; {limit} is the limit.",
            limits.COARSER,
        )
    return np.asarray(found[()], dtype=type_).reshape(-1)
