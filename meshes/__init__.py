"""Meshes: generated, imported and exported; surfaces and their mass properties."""

from meshes.block import block, hexahedral_block
from meshes.boundary import boundary
from meshes.cells import CELL_TYPES, CellType
from meshes.connectivity import Connectivity, check_connectivity, connectivity
from meshes.gltf import GltfPart, to_glb, write_gltf
from meshes.gmsh_volumes import tetrahedra
from meshes.grading import lines, lines_through
from meshes.grids import grid
from meshes.l_frame import l_frame
from meshes.mass_properties import MassProperties, mass_properties
from meshes.mesh import CellBlock, Faces, Mesh, Patch
from meshes.mesh_files import read_mesh, write_mesh
from meshes.order import linear, quadratic, refined, without_orphans
from meshes.plate import plate_with_patches
from meshes.quality import Quality, cell_volumes, check_quality, quality
from meshes.selection import in_box, node_set, patch, patches
from meshes.surface_integrals import (
    face_areas,
    face_centres,
    face_normals,
    nodal_area_vectors,
    nodal_areas,
    patch_area,
)
from meshes.surfaces import (
    Surface,
    check_closed,
    flipped,
    read_surface,
    surface_of,
    surface_properties,
    welded,
    write_surface,
)
from meshes.transform import joined, mapped, merged, moved
from meshes.tube import tube

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
    "surface_of",
    "surface_properties",
    "tetrahedra",
    "to_glb",
    "tube",
    "welded",
    "without_orphans",
    "write_gltf",
    "write_mesh",
    "write_surface",
]
