"""Results of solids as named fields: to .vtu, to glTF, and as a coloured surface for pages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.solid_matrices import SolidMatrices
from strutwork.fea.solid_modes import SolidModes
from strutwork.fea.solid_static import SolidStatic
from strutwork.fea.solid_stress import nodal_stresses, von_mises
from strutwork.files import write_whole
from strutwork.meshes.boundary import boundary
from strutwork.meshes.gltf import GltfPart, write_gltf
from strutwork.meshes.mesh import Patch
from strutwork.meshes.surfaces import Surface, surface_of

Array = NDArray[Any]
#: Dark blue over green to yellow, even in lightness and for the colour blind; red, green,
#: blue at equal steps, after matplotlib's viridis.
COLOURS = np.array(
    [
        [0.267, 0.005, 0.329], [0.283, 0.141, 0.458], [0.254, 0.265, 0.530],
        [0.207, 0.372, 0.553], [0.164, 0.471, 0.558], [0.128, 0.567, 0.551],
        [0.135, 0.659, 0.518], [0.267, 0.749, 0.441], [0.478, 0.821, 0.318],
        [0.741, 0.873, 0.150], [0.993, 0.906, 0.144],
    ]
)  # fmt: skip
#: VTK orders the components of a symmetric tensor xx, yy, zz, xy, yz, xz.
VTK_TENSOR = [0, 1, 2, 3, 5, 4]
#: Largest displacement drawn, as a share of the diagonal of the solid.
DRAWN = 0.08


@dataclass(frozen=True, repr=False)
class SurfaceField:
    """A field on the outer surface of a solid, as triangles.

    Parameters
    ----------
    points : (k, 3)
        m, undeformed.
    triangles : (t, 3) int
        Counter-clockwise from outside.
    values : (k,)
        What the colour shows, in the unit that `name` states: any unit.
    displacement : (k, 3)
        m, or of a mode in its own scale; zero where none was given.
    name : str
        Of the values, with their unit.
    """

    points: Array
    triangles: NDArray[np.int64]
    values: Array
    displacement: Array
    name: str

    def __repr__(self) -> str:
        return (
            f"SurfaceField({self.name}: {len(self.points)} points, {len(self.triangles)} "
            f"triangles, {self.values.min():.4g} to {self.values.max():.4g})"
        )

    @property
    def drawing_scale(self) -> float:
        """Factor that draws the largest displacement at 8 % of the diagonal."""
        largest = float(np.linalg.norm(self.displacement, axis=1).max(initial=0.0))
        return DRAWN * float(np.linalg.norm(np.ptp(self.points, axis=0))) / (largest or 1.0)

    @property
    def colours(self) -> Array:
        """Red, green, blue of each point, (k, 3), 0 to 1; smallest dark, largest light."""
        low, span = self.values.min(), np.ptp(self.values)
        place = (self.values - low) / (span if span > 0 else 1.0)
        steps = np.linspace(0.0, 1.0, len(COLOURS))
        return np.stack([np.interp(place, steps, channel) for channel in COLOURS.T], axis=1)


def surface_field(
    matrices: SolidMatrices,
    values: Array | None = None,
    displacement: Array | None = None,
    *,
    name: str = "displacement",
    fine: bool = False,
) -> SurfaceField:
    """A field on the outer faces, each quadrilateral split in two.

    Parameters
    ----------
    matrices : SolidMatrices
    values : (n,) or None
        At the nodes of the field, any unit; by default the size of the displacement, m.
    displacement : (3n,) or (n, 3) or None
        m; of a mode in its own scale.
    name : str
        Of the values, with their unit.
    fine : bool
        Use the nodes in the middle of edges and faces too: four times the triangles. Of a solid
        with quadratic cells they are always used, since its faces may be curved.

    Raises
    ------
    ModelError
        Arrays of another size, or not finite.
    """
    count = len(matrices.points)
    moved = np.zeros((count, 3)) if displacement is None else np.asarray(displacement, dtype=float)
    moved = _checked(matrices, "displacement", moved.reshape(-1, 3), (3,))
    shown = np.linalg.norm(moved, axis=1) if values is None else np.asarray(values, dtype=float)
    shown = _checked(matrices, name, shown, ())
    # the nodes of the solid's own mesh come first among those of the field
    mesh = matrices.mesh if fine else matrices.solid.mesh
    outer: Patch = boundary(mesh)
    surface = surface_of(mesh, outer)
    nodes = outer.nodes
    return SurfaceField(
        surface.points, np.asarray(surface.triangles), shown[nodes], moved[nodes], name
    )


def static_fields(static: SolidStatic, case: int = 0) -> dict[str, Array]:
    """Fields of a load case: displacement (n, 3), m, stress (n, 6), Pa, von Mises stress (n,), Pa.

    Parameters
    ----------
    static : SolidStatic
    case : int
        Its place among the load cases.
    """
    stress = nodal_stresses(static.matrices, static.displacements[:, case]).at_nodes()
    return {
        "displacement (m)": static.at_nodes(case),
        "stress (Pa)": stress,
        "von Mises stress (Pa)": von_mises(stress),
    }


def mode_fields(modes: SolidModes) -> dict[str, Array]:
    """Mode shapes (n, 3), named with number and frequency, the largest displacement 1.

    Parameters
    ----------
    modes : SolidModes
    """
    fields = {}
    for i, frequency in enumerate(modes.frequencies):
        shape = modes.shape(i)
        largest = np.linalg.norm(shape, axis=1).max()
        fields[f"mode {i + 1}: {frequency:.6g} Hz"] = shape / largest
    return fields


def write_fields(
    matrices: SolidMatrices,
    path: Path | str,
    node_fields: Mapping[str, Array],
    cell_fields: Mapping[str, Array] | None = None,
) -> Path:
    """Write fields to a .vtu file, which ParaView and others open; whole or not at all.

    Parameters
    ----------
    matrices : SolidMatrices
    path : Path or str
        Ends with .vtu.
    node_fields : mapping of str to (n,), (n, 3) or (n, 6)
        Six components are a symmetric tensor xx, yy, zz, xy, xz, yz; the file has VTK's order.
    cell_fields : mapping of str to (cells,), (cells, 3) or (cells, 6)
        The index of the region is added.

    Raises
    ------
    ModelError
        Another suffix, fields of another size or not finite, a folder that cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() != ".vtu":
        raise ModelError(str(path), f"is not written as {path.suffix!r}.", "Name it .vtu.")
    import meshio  # noqa: PLC0415 - half a second that most commands never need

    cells = matrices.mesh.blocks
    nodes = {k: _tensor(_sized(matrices, k, v, len(matrices.points))) for k, v in
             node_fields.items()}  # fmt: skip
    count = matrices.mesh.cell_count
    in_cells = {k: _tensor(_sized(matrices, k, v, count)) for k, v in (cell_fields or {}).items()}
    in_cells["region"] = matrices.solid.cell_regions
    ends = np.cumsum([len(b.nodes) for b in cells])[:-1]
    made = meshio.Mesh(
        matrices.points,
        [(b.kind, b.nodes) for b in cells],
        point_data=nodes,
        cell_data={k: np.split(v, ends) for k, v in in_cells.items()},
    )
    return write_whole(path, lambda temporary: meshio.vtu.write(str(temporary), made))


def write_scene(field: SurfaceField, path: Path | str, *, swings: bool = True) -> Path:
    """Write a coloured surface to a .glb file, with its displacement as a motion.

    Parameters
    ----------
    field : SurfaceField
    path : Path or str
        Ends with .glb.
    swings : bool
        Move to and fro in two seconds, as a mode does.

    Raises
    ------
    ModelError
        Another suffix, a folder that cannot be written.
    """
    moved = field.displacement * field.drawing_scale if field.displacement.any() else None
    surface = Surface(field.points, field.triangles, field.name)
    return write_gltf([GltfPart(surface, field.colours, moved)], path, swings=swings)


def _tensor(values: Array) -> Array:
    return values[:, VTK_TENSOR] if values.ndim == 2 and values.shape[1] == 6 else values


def _sized(matrices: SolidMatrices, name: str, values: Array, count: int) -> Array:
    array = np.asarray(values, dtype=float)
    if array.shape not in {(count,), (count, 3), (count, 6)} or not np.isfinite(array).all():
        raise ModelError(
            f"solid {matrices.solid.name}, field {name!r}",
            f"has the shape {array.shape} or is not finite.",
            f"Give {count} finite values, or as many rows of 3 or 6.",
        )
    return array


def _checked(matrices: SolidMatrices, name: str, values: Array, shape: tuple[int, ...]) -> Array:
    count = len(matrices.points)
    if values.shape != (count, *shape) or not np.isfinite(values).all():
        raise ModelError(
            f"solid {matrices.solid.name}, field {name!r}",
            f"has the shape {values.shape} or is not finite.",
            f"Give finite values of shape {(count, *shape)}.",
        )
    return values
