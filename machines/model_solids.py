"""Solids of a model file: meshed, reduced to their interfaces, placed."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import reduce_solid
from strutwork.fea.solid import Solid
from strutwork.fea.solid_source import solid_source
from strutwork.kinematics import axes_frame
from strutwork.machines.model import ModelWarning
from strutwork.machines.model_parts import material_of, unknown
from strutwork.machines.model_schema import ModelTable
from strutwork.machines.model_solid_element import SolidElement
from strutwork.machines.model_solid_mesh import (
    at_field,
    check_source,
    field_of,
    patch_name,
    solid_mesh,
)
from strutwork.machines.model_solid_schema import SolidTable
from strutwork.meshes.boundary import boundary
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.surfaces import surface_of
from strutwork.msa import Material
from strutwork.stages import stage

Array = NDArray[Any]

#: Modes with the interfaces held, where the file says neither how many nor up to where.
MODES = 12

#: Largest over smallest stiffness of a reduced solid; beyond it rounding spoils the statics.
SPREAD = 1e9

#: How far a node may stand from its patch's middle, beside the farthest point of the patch.
REACH = 1.0 + 1e-6


def solids_of(tables: ModelTable, folder: Path) -> tuple[SolidElement, ...]:
    """All solids; every table is checked before the first is meshed.

    Parameters
    ----------
    tables : ModelTable
    folder : Path
        Where names of files begin.

    Returns
    -------
    tuple of SolidElement

    Raises
    ------
    ModelError
        Names the field: a mesh that cannot be had or used, an unknown material or patch, a
        material without density, a node that does not stand at its patch.
    """
    for table in tables.solids:
        _check_table(table, tables)
    return tuple(_solid(table, tables, folder) for table in tables.solids)


def _check_table(table: SolidTable, tables: ModelTable) -> None:
    field = field_of(table)
    check_source(table)
    if table.cutoff is not None and table.modes is not None:
        raise ModelError(field, "has both cutoff and modes.", "Give one of the two, or none.")
    if (table.material is None) == (table.materials is None):
        found = "neither material nor" if table.material is None else "both material and"
        raise ModelError(
            field,
            f"has {found} materials.",
            "Give material for the entire solid, or materials = { REGION = MATERIAL }.",
        )
    named = {"material": table.material} if table.materials is None else table.materials
    for key, name in named.items():
        part = f"{field}.material" if table.materials is None else f"{field}.materials.{key}"
        if name not in tables.materials:
            raise unknown(part, "material", str(name), tables.materials)
        if tables.materials[name].density is None:
            raise ModelError(
                part,
                f'"{name}" has no density, and a solid needs its mass.',
                f"Give materials.{name} a density.",
            )
    if not table.interfaces:
        raise ModelError(
            f"{field}.interfaces",
            "are none: nothing holds the solid.",
            "Add [[solids.interfaces]] with a node and a patch or a box.",
        )
    times = Counter(i.node for i in table.interfaces)
    for i, interface in enumerate(table.interfaces):
        part = f"{field}.interfaces[{i}]"
        if (interface.patch is None) == (interface.box is None):
            found = "neither patch nor box" if interface.patch is None else "both patch and box"
            raise ModelError(part, f"has {found}.", "Name a patch of the mesh, or give a box.")
        if interface.normal is not None and interface.box is None:
            raise ModelError(
                f"{part}.normal", "applies only to a box.", "Remove it, or give a box."
            )
        if times[interface.node] > 1:
            raise ModelError(
                f"{part}.node",
                f'node "{interface.node}" is tied to this solid twice.',
                "Tie two nodes, and connect them by a rigid body.",
            )


def _solid(table: SolidTable, tables: ModelTable, folder: Path) -> SolidElement:
    field = field_of(table)
    rotation = axes_frame(table.axis, table.second_axis, field)
    shift = np.array(table.position)
    with stage(f"meshes solid {table.name}"):
        mesh = solid_mesh(table, folder)
    materials = _materials(table, tables, mesh)
    interfaces = []
    for i, interface in enumerate(table.interfaces):
        at = rotation.T @ (np.asarray(tables.nodes[interface.node]) - shift)
        patch = patch_name(table, i)
        _check_place(f"{field}.interfaces[{i}].node", interface.node, at, mesh, patch)
        x, y, z = (float(v) for v in at)
        interfaces.append(Interface(interface.node, patch, (x, y, z), interface.kind))
    with at_field(field):
        solid = Solid(mesh, materials, table.order, table.name)
        modes = MODES if table.modes is None else table.modes
        with stage(f"reduces solid {table.name}, {mesh.cell_count:,} cells, to its interfaces"):
            reduced = reduce_solid(solid, interfaces, cutoff=table.cutoff, modes=modes)
    _check_spread(field, reduced.local_stiffness)
    outer = boundary(mesh)
    surface = surface_of(mesh, outer)
    return SolidElement(
        reduced,
        rotation,
        shift,
        tuple(i.name for i in interfaces),
        tuple(dict.fromkeys(m.name for m in materials.values())),
        _loss_factor(field, materials),
        outer.nodes,
        surface.points @ rotation.T + shift,
        np.asarray(surface.triangles, dtype=np.int64),
        tuple({m.name: m for m in materials.values()}.values()),
        mesh.cell_count,
        table.order,
        solid_source(solid, tuple(interfaces)),
    )


def _check_spread(field: str, stiffness: Array) -> None:
    """NumericalError where no static answer could hold its residual."""
    values = np.linalg.eigvalsh(stiffness)
    # rigid motions cost nothing
    spread = float(values[-1] / max(values[6], 1e-300))
    if spread > SPREAD:
        raise NumericalError(
            field,
            f"the stiffnesses of its reduced model spread over {spread:.2g}: its mesh is too "
            "coarse to distinguish so many modes.",
            "Choose smaller cells, or retain fewer modes.",
        )


def _materials(table: SolidTable, tables: ModelTable, mesh: Mesh) -> dict[str, Material]:
    named = _by_region(table.materials or dict.fromkeys(mesh.regions, str(table.material)), mesh)
    with warnings.catch_warnings():
        # the beams' reader says it of every material once
        warnings.simplefilter("ignore", ModelWarning)
        return {region: material_of(name, tables.materials[name]) for region, name in named.items()}


def _by_region(named: Mapping[str, str], mesh: Mesh) -> dict[str, str]:
    """The material of each region: its own, or that of the smallest group of the file around it.

    Names that are neither region nor group stay, for the error that lists what there is.
    """
    found = {name: material for name, material in named.items() if name not in mesh.cell_sets}
    for region in mesh.regions:
        holders = [holder for holder in mesh.holders(region) if holder in named]
        if holders:
            found[region] = named[holders[0]]
    return found


def _loss_factor(field: str, materials: Mapping[str, Material]) -> float | None:
    """The material's; of several the least, since a reduced solid has one."""
    found = {m.loss_factor or 0.0 for m in materials.values()}
    if len(found) > 1:
        warnings.warn(
            f"{field}: its materials have different loss factors; a reduced solid has one, the "
            f"least of them, {min(found):g}.",
            ModelWarning,
            stacklevel=2,
        )
    return min(found) or None


def _check_place(field: str, node: str, at: Array, mesh: Mesh, patch: str) -> None:
    """ModelError where a node stands off its patch."""
    points = mesh.points[mesh.patch(patch).nodes]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    reach = float(np.linalg.norm(points - middle, axis=1).max())
    distance = float(np.linalg.norm(at - middle))
    if distance > REACH * reach:
        there = ", ".join(f"{1e3 * v:.6g}" for v in middle)
        here = ", ".join(f"{1e3 * v:.6g}" for v in at)
        raise ModelError(
            field,
            f'node "{node}" is at ({here}) mm of the mesh, {1e3 * distance:.4g} mm from the '
            f"middle of its patch, ({there}) mm, and no point of the patch is farther than "
            f"{1e3 * reach:.4g} mm.",
            "Move the node onto the patch, or place the solid by position and axis; a node "
            "farther off is carried by a rigid body.",
        )
