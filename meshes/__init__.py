"""Meshes: generated, imported and exported; surfaces and their mass properties."""

from strutwork.meshes.block import block, hexahedral_block
from strutwork.meshes.boundary import boundary
from strutwork.meshes.cells import CELL_TYPES, CellType
from strutwork.meshes.connectivity import Connectivity, check_connectivity, connectivity
from strutwork.meshes.curves import is_straight, straightened, unbent
from strutwork.meshes.gltf import GltfPart, to_glb, write_gltf
from strutwork.meshes.gmsh_volumes import tetrahedra
from strutwork.meshes.grading import lines, lines_through
from strutwork.meshes.grids import grid
from strutwork.meshes.l_frame import l_frame
from strutwork.meshes.mass_properties import MassProperties, mass_properties
from strutwork.meshes.mesh import CellBlock, Faces, Mesh, Patch
from strutwork.meshes.mesh_files import read_mesh, write_mesh
from strutwork.meshes.order import (
    linear,
    quadratic,
    refined,
    without_orphans,
)
from strutwork.meshes.plate import plate_with_patches
from strutwork.meshes.quality import Quality, cell_volumes, check_quality, quality
from strutwork.meshes.selection import in_box, node_set, patch, patches
from strutwork.meshes.surface_integrals import (
    face_areas,
    face_centres,
    face_normals,
    nodal_area_vectors,
    nodal_areas,
    patch_area,
)
from strutwork.meshes.surfaces import (
    Surface,
    check_closed,
    flipped,
    read_surface,
    surface_of,
    surface_properties,
    welded,
    write_surface,
)
from strutwork.meshes.transform import joined, mapped, merged, moved
from strutwork.meshes.tube import tube

__all__ = [
    "CELL_TYPES",
    "CellBlock",
    "CellType",
    "Connectivity",
    "Faces",
    "GltfPart",
    "MassProperties",
    "Mesh",
    "Patch",
    "Quality",
    "Surface",
    "block",
    "boundary",
    "cell_volumes",
    "check_closed",
    "check_connectivity",
    "check_quality",
    "connectivity",
    "face_areas",
    "face_centres",
    "face_normals",
    "flipped",
    "grid",
    "hexahedral_block",
    "in_box",
    "is_straight",
    "joined",
    "l_frame",
    "linear",
    "lines",
    "lines_through",
    "mapped",
    "mass_properties",
    "merged",
    "moved",
    "nodal_area_vectors",
    "nodal_areas",
    "node_set",
    "patch",
    "patch_area",
    "patches",
    "plate_with_patches",
    "quadratic",
    "quality",
    "read_mesh",
    "read_surface",
    "refined",
    "straightened",
    "surface_of",
    "surface_properties",
    "tetrahedra",
    "to_glb",
    "tube",
    "unbent",
    "welded",
    "without_orphans",
    "write_gltf",
    "write_mesh",
    "write_surface",
]
